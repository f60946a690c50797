"""A study in words and rows, whatever they are written as: in Hz and in the vehicle's own units."""

import math
from dataclasses import dataclass

from compare.vehicle.convergence import Settling
from compare.vehicle.sensitivity import same_effects
from compare.vehicle.study import Row, Study, distance
from hill import CriticalThrust

KINDS = {"divergence": "buckling", "flutter": "flutter"}
"""How steady thrust is too much, in an engineer's word."""


@dataclass(frozen=True)
class Names:
    """What the vehicle's units are called, with a blank ahead; nothing where it has none."""

    frequency: str
    time: str
    length: str
    mass: str
    force: str


def names(study: Study) -> Names:
    """Of a study's units."""
    u = study.vehicle.units
    return Names(*(f" {x}" if x else "" for x in (u.frequency, u.time, u.length, u.mass, u.force)))


def cycles(Omega: float) -> float:
    """Radians to cycles."""
    return Omega / (2.0 * math.pi)


def number(value: float, digits: int = 4) -> str:
    """A few digits, none of them a minus before 0."""
    return f"{value + 0.0:.{digits}g}"


def summary(title: str, study: Study) -> tuple[str, str]:
    """Two lines: safe or not where it operates, and the nearest danger."""
    return _verdict(title, study), _danger(study)


def _verdict(title: str, study: Study) -> str:
    unit, x = names(study), study.operating
    pulsation = f"a pulsation ratio of {study.gamma:g}"
    if x is None or study.Omega is None:
        count = len(study.open_rows)
        found = f"{count} unstable band{'s' if count != 1 else ''}" if count else "no unstable band"
        span = f"{number(cycles(study.low))} to {number(cycles(study.high))}{unit.frequency}"
        return (
            f"{title}: {found} found from {span} at {pulsation}; no operating frequency is given."
        )
    word = {"stable": "SAFE", "unstable": "NOT SAFE", "undecided": "UNDECIDED"}[x.verdict]
    agree = "both routes agree" if x.routes_agree else "THE ROUTES DISAGREE"
    grows = f", doubling every {number(2.0 * math.log(2.0) / x.T)}{unit.time}" if x.T > 0.0 else ""
    return (
        f"{title}: {word} at {number(cycles(study.Omega))}{unit.frequency} and {pulsation}"
        f"{grows if x.verdict == 'unstable' else ''}; {agree}."
    )


def _danger(study: Study) -> str:
    unit, loss = names(study), study.loss
    if study.steadily_lost:
        return "Nearest danger: steady thrust alone is too much" + (
            f", from {number(loss.thrust)}{unit.force} on ({KINDS[loss.kind]})." if loss else "."
        )
    if study.open_rows:
        row = study.open_rows[0]
        low, high = row.band.edges or (0.0, 0.0)
        away = ""
        if study.Omega is not None:
            off = cycles(distance(row.band, study.Omega))
            away = f", {number(off)}{unit.frequency} away" if off else ", which it is in"
        return (
            f"Nearest danger: {row.resonance.name}, unstable from {number(cycles(low), 5)} to "
            f"{number(cycles(high), 5)}{unit.frequency}{away}; it doubles every "
            f"{number(doubling(row) or math.inf)}{unit.time}."
        )
    openings = [row for row in study.rows if row.critical is not None]
    if not openings:
        return "Nearest danger: none was found."
    row = min(openings, key=lambda r: r.critical or 0.0)
    return (
        f"Nearest danger: {row.resonance.name} at {number(cycles(row.band.Omega))}"
        f"{unit.frequency}, which opens at a pulsation ratio of {number(row.critical or 0.0)}."
    )


def doubling(row: Row) -> float | None:
    """Time in which it doubles; None where it does not grow."""
    return 2.0 * math.log(2.0) / row.band.T if row.band.T > 0.0 else None


def facts(study: Study) -> list[str]:
    """The vehicle, its frequencies, and what steady thrust it bears."""
    unit, body = names(study), study.body
    free = ", ".join(number(cycles(w), 6) for w in study.free)
    under = ", ".join(number(cycles(w), 6) for w in study.alone.frequencies)
    found = [
        f"mass {number(body.mass, 6)}{unit.mass}, centre of mass {number(body.centre, 6)}"
        f"{unit.length} from the nose, length {number(study.vehicle.length, 6)}{unit.length}",
        f"frequencies without thrust: {free}{unit.frequency}",
        f"frequencies under thrust: {under}{unit.frequency}",
    ]
    if study.loss is not None:
        found.append(_steady(study, study.loss))
    return found


def _steady(study: Study, loss: CriticalThrust) -> str:
    unit, thrust = names(study), study.vehicle.thrust.mean
    sure = f"but for gaps of up to {number(loss.resolution, 1)}{unit.force}"
    if loss.kind == "none":
        return f"steady thrust alone: shown safe up to {number(loss.searched)}{unit.force}, {sure}"
    at = f" at {number(loss.frequency)}{unit.frequency}" if loss.frequency else ""
    return (
        f"steady thrust alone: {KINDS[loss.kind]}{at} from {number(loss.thrust, 6)}{unit.force}, "
        f"{number(loss.margin(study.vehicle))} times the vehicle's {number(thrust, 6)}{unit.force} "
        f"(shown safe below, {sure})"
    )


HEADS = (
    "resonance",
    "type",
    "at",
    "unstable from",
    "to",
    "grows in",
    "doubles in",
    "opens at",
    "both",
)


def cells(row: Row) -> tuple[str, ...]:
    """One resonance, as `HEADS` has it."""
    band, grows = row.band, doubling(row)
    low, high = band.edges or (None, None)
    return (
        row.resonance.name,
        row.resonance.type,
        number(cycles(band.Omega), 5),
        "-" if low is None else number(cycles(low), 5),
        "-" if high is None else number(cycles(high), 5),
        "-" if grows is None else number(2.0 / band.T),
        "-" if grows is None else number(grows),
        "-" if row.critical is None else number(row.critical),
        _both(row),
    )


def _both(row: Row) -> str:
    if row.witnessed is None:
        return "not asked"
    if not row.witnessed.agrees:
        return "DISAGREE"
    return row.witnessed.verdict + ("*" if row.witnessed.another else "")


def moved(row: Row) -> str:
    """What moves T there, for one per cent more of each."""
    words = [f"{e.name} {0.01 * e.relative:+.2g}" for e in row.effects]
    both = any(e.witness is not None for e in row.effects)
    agree = ", by both routes" if same_effects(row.effects) else "; THE ROUTES DISAGREE"
    return f"{row.resonance.name}: " + ", ".join(words) + (agree if both else "")


def settling_table(study: Study, columns: int | None = None) -> tuple[list[str], list[list[str]]]:
    """What more modes change, heads and rows: with every number of modes or so many of them."""
    if not study.settling:
        return [], []
    modes = study.settling[0].modes
    every = columns is None
    # the first ones and the last
    shown = sorted({*range(len(modes) if columns is None else columns - 1), len(modes) - 1})
    heads = ["", "", *(f"{modes[k]} modes" for k in shown), "limit", "+-"]
    rows, last = [], None
    for one in study.settling:
        name = one.of.name if one.of else "steady thrust"
        values = [_settled(one, one.values[k]) for k in shown]
        error = "-" if one.error is None else number(_in_hertz(one, one.error), 1)
        label = name if every or name != last else ""
        rows.append([label, WHAT[one.what], *values, _settled(one, one.limit), error])
        last = name
    return heads, rows


WHAT = {
    "critical thrust": "critical",
    "T": "T",
    "width": "width",
    "critical pulsation ratio": "opens at",
}


def _in_hertz(one: Settling, value: float) -> float:
    return cycles(value) if one.what == "width" else value


def _settled(one: Settling, value: float | None) -> str:
    return "-" if value is None else number(_in_hertz(one, value), 5)


def few_modes(study: Study) -> str:
    """Over the table of what more modes change."""
    if not study.settling:
        return (
            "What more modes would change is not known: the damping matrix fixes their number."
            if study.vehicle.damping.matrix is not None
            else "There is nothing to tell of with more modes."
        )
    return "With more modes, and the limit of all of them with an estimate of its error:"


def remarks(study: Study) -> list[str]:
    """What the table leaves out."""
    unit = names(study)
    found = [
        f"frequencies in{unit.frequency or ' cycles'}, times in{unit.time or ' units of time'}"
    ]
    if any(row.witnessed and row.witnessed.another for row in study.rows):
        found.append("* there another oscillation grows more than the two named")
    if study.others:
        found.append(
            f"{len(study.others)} more resonances of the range, less dangerous by averaging, were "
            "not solved for"
        )
    if study.refused:
        found.append(f"{len(study.refused)} have no band of their own, beside or within others'")
    return found
