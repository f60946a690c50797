"""What a step in area and inertia does, and how far two uniform modes carry (5.4 and 8.2)."""

from compare.report.claims.both_routes import both, real_frequencies
from compare.report.claims.cases import stepped, uniform
from compare.report.claims.finding import VISIBLE, Finding, Number, check_for, graded, share


@check_for("stepped-shifts")
def stepped_shifts() -> Finding:
    """What the step does to frequencies and regions."""
    plain = uniform(K_theta=1.0)
    changed = {
        "A_1/A_2 from 1 to .6": stepped(inertia_ratio=1.0),
        "I_1/I_2 from 1 to .6": stepped(area_ratio=1.0),
        "xi_c from .6 to .3, both ratios .6": stepped(xi_c=0.3),
    }
    numbers, shifts = [], []
    for name, beam in changed.items():
        before = real_frequencies(stepped() if name.startswith("xi_c") else plain)
        shift = [abs(b / a - 1.0) for a, b in zip(before, real_frequencies(beam), strict=True)]
        shifts.append(max(shift))
        numbers.append(Number(f"largest shift of a frequency, {name}", max(shift), None, 3))
    severity = []
    for i, name in ((0, "2 omega_(B)"), (2, "2 omega_(2)")):
        T = [both(beam, 2.0 * real_frequencies(beam)[i]) for beam in (plain, stepped())]
        numbers.append(T[0].number(f"T_x at {name}, uniform, K_theta = 1"))
        numbers.append(T[1].number(f"T_x at {name}, stepped"))
        severity.append(abs(T[1].hill / T[0].hill - 1.0))
    verdict = graded(min(shifts) > VISIBLE and max(severity) > VISIBLE, max(shifts) > VISIBLE)
    because = (
        f"Each change moves some frequency by {share(min(shifts))} or more, and with both ratios "
        f".6 a T_x by {share(max(severity))}."
    )
    return Finding(tuple(numbers), verdict, because)


@check_for("stepped-galerkin")
def stepped_galerkin() -> Finding:
    """How far two uniform modes carry on a stepped beam."""
    two, twelve = (real_frequencies(stepped(modes=N)) for N in (2, 12))
    u_two, u_twelve = (real_frequencies(uniform(modes=N)) for N in (2, 12))
    errors = [abs(a / b - 1.0) for a, b in zip(two, twelve, strict=False)]
    own = [abs(a / b - 1.0) for a, b in zip(u_two, u_twelve, strict=False)]
    names = ("omega_(B)", "omega_(1)", "omega_(2)")
    numbers = [
        Number(f"{n}, 2 against 12 modes", e, None, 3) for n, e in zip(names, errors, strict=True)
    ]
    numbers.append(Number("largest on the uniform beam", max(own), None, 3))
    for N in (2, 4):
        beam = stepped(modes=N)
        T = both(beam, 2.0 * real_frequencies(beam)[2])
        numbers.append(T.number(f"T_x at 2 omega_(2), {N} modes"))
    verdict = graded(max(errors) < 0.2, max(errors[1:]) < 0.2)
    because = (
        f"Two modes are within {share(max(errors))} of twelve, {share(max(own))} on the uniform "
        "beam: right in kind and to a tenth or so, which is what was hoped for."
    )
    return Finding(tuple(numbers), verdict, because)
