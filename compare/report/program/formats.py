"""The FORMAT statements of DRIVER and STAB: events in, lines of text out.

Lines stand in the columns of the FORMATs, carriage control included, and with a page eject (1H1)
left out. "FORMAT (n)" at the start of a run is the report's caption, not the program's. A number
too wide for its field becomes asterisks, which the 7094 did not know: it lost the leading digits.
A search that SWITCH would not end, and a resonance that cannot be computed, get a line of our own.
"""

from decimal import ROUND_HALF_UP, Decimal

from compare.report.program.driver import (
    Evaluation,
    Event,
    FrequencyLine,
    Note,
    ResonanceHeading,
    Start,
    TableHeading,
)
from compare.report.program.listing import Case


def lines(event: Event) -> list[str]:
    """The lines that one event writes, without trailing blanks."""
    match event:
        case Start(number):
            written = [f"FORMAT ({number})"]
        case TableHeading(case, modes, count):
            written = _table_heading(case, modes, count)
        case FrequencyLine():
            written = _format_70(event)
        case ResonanceHeading():
            written = _resonance_heading(event)
        case Evaluation():
            written = _stab(event)
        case Note(why):
            written = [" " * 5 + why]
    return [line.rstrip() for line in written]


def F(value: float, width: int, decimals: int) -> str:
    """Fw.d of the 7094: no zero before the point, a sign wherever the number is negative."""
    if not abs(value) < 10.0**width:
        return "*" * width
    rounded = Decimal(value).quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP)
    digits = format(abs(rounded), "f").removeprefix("0")
    text = ("-" if value < 0.0 else "") + digits
    return text.rjust(width) if len(text) <= width else "*" * width


def _table_heading(case: Case, modes: int, count: int) -> list[str]:
    """FORMAT 28; then 27 and 60 in the uniform program, 60 and 27 in the stepped one."""
    title = [*[""] * 5, " " * 20 + "NATURAL           FREQUENCIES", "", "", ""]
    names, constants = _format_60(count), _format_27(case, modes)
    return title + (constants + names if case.RC is None else names + constants)


def _resonance_heading(h: ResonanceHeading) -> list[str]:
    """FORMAT 502, 503 or 504; 60; 70; 27."""
    place = f"2 X FREQ({h.high})" if h.sign == "2" else f"FREQ({h.high}) {h.sign} FREQ({h.low})"
    title = ["", "", " " * 12 + "CHARACTERISTIC VALUES IN VICINITY OF " + place, "", ""]
    constants = [] if h.case is None else _format_27(h.case, h.modes)
    return [*title, *_format_60(len(h.line.frequencies)), *_format_70(h.line), *constants]


def _format_27(case: Case, modes: int) -> list[str]:
    start = f"        GAMMA={F(case.GAMMA, 4, 2)}, N={modes},OMEGL={F(case.OMEGL, 6, 2)}"
    end = f", SPC={F(case.SPC, 4, 2)}, XG={F(case.XG, 3, 1)}"
    if case.RC is None:
        return [f"{start}, ETA={F(case.ETA, 4, 3)}{end}, GA={F(case.GA, 4, 3)}", ""]
    step = ", ".join(
        f"{name}={F(x, 4, 2)}" for name, x in zip(("RC", "RA", "RI"), _step(case), strict=True)
    )
    return [f"{start}, ETA={F(case.ETA, 6, 3)}{end}", "", " " * 9 + step, ""]


def _step(case: Case) -> tuple[float, float, float]:
    assert case.RC is not None
    return case.RC, case.RA, case.RI


def _format_60(count: int) -> list[str]:
    return [" " * 15 + "TO " + "".join(f"{'':8}FREQ({k})" for k in range(1, count + 1)), ""]


def _format_70(line: FrequencyLine) -> list[str]:
    return [
        " " * 13 + F(line.TO, 5, 1) + "".join(F(f, 15, 6) for f in line.frequencies),
        "",
        "",
    ]


def _stab(e: Evaluation) -> list[str]:
    """FORMAT 202, 21 or 22, 23 and 50."""
    at = " " * 18
    return [
        *["     CONVERGENCE OF DETERMINANT DOUBTFUL"] * e.doubtful,
        f"           OMEGB={F(e.OMEGB, 6, 3)}     {'UNSTABLE' if e.unstable else 'STABLE'}",
        f"{at}ROOTR            " + "".join(F(z.real, 10, 5) for z in e.roots),
        f"{at}ROOTI            " + "".join(F(z.imag, 10, 5) for z in e.roots),
        f"{at}STAB1            " + F(e.STAB1, 10, 5),
    ]
