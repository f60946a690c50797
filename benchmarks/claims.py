"""What was to be shown, each with its figures and whether it holds."""

from collections.abc import Sequence
from typing import Any

from benchmarks.measure import Spread, ratios, spread
from benchmarks.text import error, factor, micro, size

Results = dict[str, Any]

HEYOKA, LSODA = 40.0, 1000.0
"""Times faster than heyoka's batch, than LSODA."""

REASON = """\
  What differs: heyoka compiles the recurrence of this very system, F and G as constants, into
  straight code for eight points at a time, with steps by an estimate; ours serves any matrices,
  keeps to steps that a bound guarantees, and computes its own error bound, too. How far from the
  machine's limit that is, see "Where the limit is"."""


def section(results: Results) -> str:
    """One line a claim."""
    lines = _lines(results)
    return "## To be shown\n\n" + "\n".join(lines or ["- nothing measured"])


def told(results: Results) -> dict[str, str]:
    """Each claim with whether it holds and its figure, in a few words."""
    found = {}
    for line in _lines(results):
        if line.startswith("- **"):
            verdict, words = line.removeprefix("- **").split("**: ", 1)
            name, _, figure = words.partition(": ")
            found[name] = f"{verdict}: {figure.split(' (')[0].split(';')[0]}".rstrip(".: ")
    return found


def _lines(results: Results) -> list[str]:
    lines: list[str] = []
    if "chart" in results:
        lines += chart(results["chart"])
    if "contenders" in results:
        lines += batch(results["contenders"]["lines"])
    if "modes" in results:
        lines += with_modes(results["modes"]["curves"])
    if any("direct batches" in line or "more modes" in line for line in failed(lines)):
        lines.append(REASON)
    if "number" in results:
        lines += falling(results["number"]["curves"])
    if "verify" in results:
        lines += verify(results["verify"])
    return lines


def failed(lines: Sequence[str]) -> list[str]:
    """Those that do not hold."""
    return [line for line in lines if line.startswith(f"- **{_verdict(False)}**")]


def direct(lines: Sequence[Results]) -> Results | None:
    """Our direct batch: the quickest there is."""
    own = [line for line in lines if line["ours"] and "batch" in line["name"]]
    return min(own, key=lambda line: spread(line["seconds"]).median, default=None)


def chart(found: Results) -> list[str]:
    """The chart against heyoka's batch and LSODA: each against the quickest that is as accurate."""
    own = {line["name"]: line for line in found["lines"] if line["name"].startswith("chart")}
    head = f"chart of {size(found['points'])} points"
    lines = []
    for peer, wanted in (("heyoka", HEYOKA), ("LSODA", LSODA)):
        named = [line for line in found["lines"] if peer in line["name"]]
        if not named:
            lines.append(f"- **not measured**: {head} against {peer}.")
            continue
        ours = own["chart, floquet"]
        rival, why = _rival(named, ours, found["tolerance"])
        against = ratios(rival["seconds"], ours["seconds"])
        others = [(line["name"], line, ours) for line in named if line is not rival]
        if "chart, both" in own:
            others.append(("the chart by both routes", rival, own["chart, both"]))
        further = "".join(
            f"; {name} {factor(ratios(theirs['seconds'], mine['seconds']).median)}"
            for name, theirs, mine in others
        )
        lines.append(
            f"- **{_verdict(against.median >= wanted)}**: {head} at {found['tolerance']:.0e}, "
            f"nodes included, at least {wanted:,.0f} times faster than {peer}, point by point: "
            f"{_ratio(against)} times ({rival['name']}, error {error(rival['error'])}, {why}; "
            f"the chart's {error(ours['error'])}){further}."
        )
    return lines


def _rival(named: Sequence[Results], ours: Results, tolerance: float) -> tuple[Results, str]:
    """The quickest, against ours, of those within the tolerance, and why it was chosen."""
    accurate = [e for e in named if e["error"] is not None and e["error"] <= tolerance]
    rival = min(accurate or named, key=lambda e: ratios(e["seconds"], ours["seconds"]).median)
    return rival, f"the quickest{' of those as accurate' if accurate else ', accurate or not'}"


def batch(lines: Sequence[Results]) -> list[str]:
    """Direct batches against heyoka's at equal accuracy."""
    ours = direct(lines)
    named = [line for line in lines if line["name"].startswith("heyoka batch")]
    if ours is None or not named:
        return ["- **not measured**: direct batch against heyoka's batch."]
    rival = min(named, key=lambda line: spread(line["seconds"]).median)
    plain = max(named, key=lambda line: spread(line["seconds"]).median)
    against, other = (ratios(ours["seconds"], line["seconds"]) for line in (rival, plain))
    holds = against.median <= 1.0
    return [
        f"- **{_verdict(holds)}**: direct batches not slower than heyoka's at equal accuracy: "
        f"{ours['name']} takes {_ratio(against)} times as long as {rival['name']} "
        f"({micro(spread(ours['seconds']).median)} to {micro(spread(rival['seconds']).median)} us, "
        f"errors {error(ours['error'])} and {error(rival['error'])}), and {_ratio(other)} times as "
        f"long as {plain['name']}."
    ]


def with_modes(curves: dict[str, list[Results]]) -> list[str]:
    """The same against the number of modes: where heyoka's batch is quicker."""
    ours = [curve for name, curve in curves.items() if name.startswith("floquet batch")]
    theirs = next((c for name, c in curves.items() if name.startswith("heyoka")), None)
    if not ours or theirs is None:
        return []
    words, slower = [], []
    for rival in theirs:
        same = [p for curve in ours for p in curve if p["modes"] == rival["modes"]]
        if same:
            mine = min(same, key=lambda p: spread(p["seconds"]).median)
            against = ratios(mine["seconds"], rival["seconds"]).median
            words.append(f"{factor(against)} with {rival['modes']}")
            slower += [f"{rival['modes']}"] if against > 1.0 else []
    found = f"- **{_verdict(not slower)}**: the same with more modes, in heyoka's times: "
    return [found + ", ".join(words) + (f"; slower with {', '.join(slower)}." if slower else ".")]


def falling(curves: dict[str, list[Results]]) -> list[str]:
    """Cost a point of the chart, decade by decade."""
    costs = [spread(point["seconds"]).median for point in curves["chart"]]
    counts = [point["nominal"] for point in curves["chart"]]
    steps = zip(costs, costs[1:], counts[1:], strict=False)
    rises = [size(count) for before, after, count in steps if after >= before]
    figures = ", ".join(f"{micro(c)}" for c in costs)
    words = f"cost a point of a chart falls as points grow: {figures} us"
    words += f" from {size(counts[0])} to {size(counts[-1])} points"
    words += f"; it rises at {', '.join(rises)}." if rises else "."
    return [f"- **{_verdict(not rises)}**: {words}"]


def verify(found: Results) -> list[str]:
    """The command's wall time against an earlier version's, in the same rounds."""
    s, head = spread(found["seconds"]), "`verify` not slower than before"
    if "before" not in found:
        return [f"- **not measured**: {head}: {s.median:.1f} s; --before names an earlier version."]
    against = ratios(found["seconds"], found["before"])
    return [
        f"- **{_verdict(against.median <= 1.0)}**: {head}: {_ratio(against)} times as long, "
        f"{s.median:.1f} s ({s.least:.1f} to {s.most:.1f})."
    ]


def _verdict(holds: bool) -> str:
    return "holds" if holds else "does not hold"


def _ratio(s: Spread) -> str:
    return f"{factor(s.median)} ({factor(s.low)} to {factor(s.high)})"
