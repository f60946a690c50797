"""The report's beams in balls, from exact decimals, straight from the weak form.

The modes are those of cosh x cos x = 1, whose roots Newton's interval step encloses; the integrals
are taken by rigorous quadrature (Petras's, as arb has it), not by hand; the axial force of the
stepped bar is solved for. What `floquet.weak_form` does in floats, and nothing of `hill`.
"""

from collections.abc import Callable
from functools import lru_cache
from typing import Any

from flint import acb, arb, arb_mat, ctx, fmpq

from floquet.enclosure.balls import Problem, identity, number
from hill.decimals import ExactBeam, ExactForcing

Function = Callable[[Any], Any]


def forced(F: Any, G: Any, H: list[Any], gamma: Any, under: ExactForcing, per: Any) -> Problem:
    """The equation in theta = Omega tau; `per` is 1/Omega^2, which may be an interval's ball."""
    eta = number(under.eta)
    pulses = [(1, G * (number(gamma) * per))]
    pulses += [(s * under.ratio, h * per) for s, h in enumerate(H, start=1)]
    return Problem((F - identity(F.nrows()) * (eta * eta / 4)) * per, tuple(pulses), None)


@lru_cache(maxsize=64)
def matrices(beam: ExactBeam, bits: int) -> tuple[Any, Any, list[Any]]:
    """F, G and the H_s, (modes + 1, modes + 1) each."""
    with ctx.workprec(bits):
        return _matrices(beam)


def _matrices(beam: ExactBeam) -> tuple[Any, Any, list[Any]]:
    roots = [_root(n) for n in range(1, beam.modes + 1)]
    shapes = [_mode(root) for root in roots]
    w = [*(s[0] for s in shapes), acb, _constant(acb(1))]
    slopes = [*(s[1] for s in shapes), _constant(acb(1)), None]
    bends = [*(s[2] for s in shapes), None, None]
    step = number(beam.xi_c)
    panels = [(arb(0), step), (step, arb(1))] if beam.stepped else [(arb(0), arb(1))]
    area, inertia = number(beam.area_ratio), number(beam.inertia_ratio)
    areas, inertias = ([area, arb(1)], [inertia, arb(1)]) if beam.stepped else ([arb(1)],) * 2

    mass = _table(w, w, panels, [_constant(a) for a in areas]) * roots[0] ** 4
    bending = _table(bends, bends, panels, [_constant(i) for i in inertias])
    at_end, at_sensor = acb(1), acb(number(beam.xi_G))
    side = [
        arb(0) if s is None else (s(at_end) + number(beam.K_theta) * s(at_sensor)).real
        for s in slopes
    ]
    T0 = number(beam.T0)
    end = arb_mat([[T0 * f(at_end).real * s for s in side] for f in w])

    def thrust(force: list[Function]) -> Any:
        return _table(slopes, slopes, panels, force) * -T0

    def reduced(stiffness: Any) -> Any:
        # slopes only: the translation, last, drives nothing and leaves with its row
        rows = mass.solve(stiffness).tolist()[:-1]
        return arb_mat([row[:-1] for row in rows])

    steady, pulsating = _force(beam, pulsating=False), _force(beam, pulsating=True)
    F = reduced(bending + end + thrust(steady))
    G = reduced(end + thrust(pulsating))
    H = []
    for s in range(1, beam.terms + 1):
        sine = _sine(s)
        start = _start(steady[0], pulsating[0], sine, number(beam.gamma))
        H.append(reduced(thrust([sine]) * start))
    return F, G, H


def _root(n: int) -> Any:
    """The n-th positive root of cosh x cos x = 1, by Newton's step on an interval.

    With f = cos x - sech x and a ball X about (n + 1/2) pi, m - f(m)/f'(X) in X shows that X has
    one root, and holds it.
    """
    middle = (arb(2 * n + 1) / 2) * arb.pi()
    inside, shown = middle + arb(0, 0.1), False
    for _ in range(2 + ctx.prec.bit_length()):
        m = inside.mid()
        slope = inside.sinh() / inside.cosh() ** 2 - inside.sin()
        step = m - (m.cos() - 1 / m.cosh()) / slope
        if not inside.contains(step):
            break
        inside, shown = step, True
    assert shown, "Newton's step leaves the interval"
    return inside


def _mode(root: Any) -> tuple[Function, Function, Function]:
    """Phi and its first two derivatives, of a complex station."""
    s = (root.cosh() - root.cos()) / (root.sinh() - root.sin())

    def parts(x: Any) -> tuple[Any, Any, Any, Any]:
        sinh, cosh = (x * root).sinh_cosh()
        sin, cos = (x * root).sin_cos()
        return sinh, cosh, sin, cos

    def phi(x: Any) -> Any:
        sinh, cosh, sin, cos = parts(x)
        return cosh + cos - s * (sinh + sin)

    def slope(x: Any) -> Any:
        sinh, cosh, sin, cos = parts(x)
        return root * (sinh - sin - s * (cosh + cos))

    def bend(x: Any) -> Any:
        sinh, cosh, sin, cos = parts(x)
        return root**2 * (cosh - cos - s * (sinh - sin))

    return phi, slope, bend


def _constant(value: Any) -> Function:
    return lambda x: value


def _sine(s: int) -> Function:
    return lambda x: (x * (arb.pi() * s)).sin()


def _start(steady: Function, pulsating: Function, sine: Function, gamma: Any) -> Any:
    """C_s of the bar that starts unstrained, xi + gamma Phi + sum C_s sin(s pi xi) = 0 (4.6)."""
    return -2 * _integral(lambda x: (steady(x) + gamma * pulsating(x)) * sine(x), arb(0), arb(1))


def _table(rows: list[Any], columns: list[Any], panels: list[Any], weights: list[Function]) -> Any:
    """Integrals of row times column times weight, a weight a panel; None is zero."""
    n = len(rows)
    table = [[arb(0)] * n for _ in range(n)]
    for j in range(n):
        for k in range(j + 1):
            f, g = rows[j], columns[k]
            if f is None or g is None:
                continue
            total = arb(0)
            for (a, b), weight in zip(panels, weights, strict=True):
                total += _integral(_product(f, g, weight), a, b)
            table[j][k] = table[k][j] = total
    return arb_mat(table)


def _product(f: Function, g: Function, h: Function) -> Function:
    return lambda x: f(x) * g(x) * h(x)


def _integral(f: Function, a: Any, b: Any) -> Any:
    # every integrand is entire
    return acb.integral(lambda x, _: acb(f(x)), acb(a), acb(b)).real


def _force(beam: ExactBeam, *, pulsating: bool) -> list[Function]:
    """P_x/T with P_x(0) = 0, P_x(1) = 1, a function a panel."""
    sigma = beam.sigma if pulsating else fmpq(0)
    if beam.stepped:
        return _stepped(beam, number(sigma))
    if not sigma and not (pulsating and beam.g):
        return [lambda x: x]
    wave = (acb(number(sigma)) ** 2 - acb(0, 1) * number(beam.g)).sqrt() * arb.pi()
    if not beam.g:
        wave = acb(wave.real)

    def force(x: Any) -> Any:
        # half of the wave and of its conjugate: the real part, as an entire function
        return (
            (x * wave).sin() / wave.sin() + (x * wave.conjugate()).sin() / wave.conjugate().sin()
        ) / 2

    return [force]


def _stepped(beam: ExactBeam, sigma: Any) -> list[Function]:
    """Ahead of the step r a sin(nu x)/nu; behind it d sin(nu (x - c))/nu + b cos(nu (x - c))."""
    c, r = number(beam.xi_c), number(beam.area_ratio)
    nu = sigma * arb.pi()

    def sine(x: Any) -> Any:
        return x * (x * nu).sinc()

    def cosine(x: Any) -> Any:
        return (x * nu).cos()

    zero, one = arb(0), arb(1)
    system = arb_mat(
        [
            [cosine(c), -one, zero],
            [r * sine(c), zero, -one],
            [zero, sine(1 - c), cosine(1 - c)],
        ]
    )
    (a,), (d,), (b,) = system.solve(arb_mat([[zero], [zero], [one]])).tolist()
    return [
        lambda x: r * a * sine(x),
        lambda x: d * sine(x - c) + b * cosine(x - c),
    ]
