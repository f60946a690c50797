"""What is measured: one function a section of the page, each returns what the JSON keeps."""

import os
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks import heyoka_peer, limits, ours, peers
from benchmarks.compete import Built, Field, compete, errors, line
from benchmarks.measure import once, rounds, timed
from benchmarks.plan import Plan
from benchmarks.reference import Reference
from benchmarks.systems import Contender, Float, Points, Solver, grid, grid_points, one, points
from compare.stability.roots import growth
from hill import HillEquation

AT = 1e-10
"""The chart that is to be shown."""
BLOCK = 100_000
"""Points at a time of a chart point by point: a gigabyte otherwise."""
NARROW = (4.5, 5.5)
"""Omega for the sweep over modes: the cost grows with modes squared over Omega."""
SLOWEST = 0.5
"""Seconds a point: a contender slower than this is left out with more modes."""
# With 16 modes it turns to its stiff method, whose Jacobian of 1,156 states takes half a minute.
LSODA_MODES = 12


def contenders(plan: Plan, field: Field) -> dict[str, Any]:
    """Everybody, over the whole chart and at its two ends."""
    spread = points(plan.most)
    built = field.build(field.everyone(), spread)
    reference = field.reference(points(plan.reference, seed=1))
    lines = compete(built, spread, plan.rounds, plan.target, reference)
    made = points(1000)
    return {
        "lines": lines,
        "single": [_single(Omega, built, plan, field) for Omega in (0.38, 5.0)],
        "equations_seconds": timed(lambda: _make(made)) / len(made),
        "reference": {
            "points": plan.reference,
            "digits": reference.digits if reference else None,
        },
    }


def _make(made: Points) -> list[HillEquation]:
    return made.first(len(made)).equations


def _single(Omega: float, built: list[Built], plan: Plan, field: Field) -> dict[str, Any]:
    """One equation alone: what a call costs that many points cannot share."""
    point = one(Omega)
    jobs = {b.contender.name: partial(b.solve, point) for b in built}
    _ = point.equations
    seconds = rounds(jobs, plan.rounds)
    reference = field.reference(point)
    return {
        "Omega": Omega,
        "lines": [line(b, 1, seconds[b.contender.name], reference) for b in built],
    }


def chart(plan: Plan, field: Field) -> dict[str, Any]:
    """The chart of a million points, by every route, against the same points one by one."""
    reference = field.reference(points(plan.reference, seed=1))
    kept: dict[str, Any] = {}
    jobs: dict[str, Callable[[], Any]] = {}
    lines: list[dict[str, Any]] = []

    def draw(name: str, route: str, workers: int) -> None:
        kept[name] = ours.drawn(plan.chart, route, AT, workers)

    for route, workers in plan.routes:
        name = f"chart, {route}" + (f", {workers} processes" if workers > 1 else "")
        jobs[name] = partial(draw, name, route, workers)
        about = {"settings": f"tolerance {AT:.0e}", "ours": True, "build_seconds": 0.0}
        lines.append({"name": name} | about)
    for built, size in _point_by_point(plan, field, reference):
        where = grid_points(size) if size > plan.few else points(size)
        name = built.contender.name
        jobs[name] = partial(_growth, built.solve, where)
        about = {"settings": built.contender.settings, "build_seconds": built.seconds}
        head: dict[str, Any] = {"name": name, "points": len(where), "ours": False}
        lines.append(head | about | errors(built.solve, reference))
    seconds = rounds(jobs, plan.chart_rounds)
    for entry in lines:
        found = kept.get(entry["name"])
        if found is not None:
            entry["points"], entry["nodes"], entry["bound"] = found.T.size, found.nodes, found.error
            entry |= errors(partial(ours.read, found), reference)
        entry["seconds"] = [s / entry["points"] for s in seconds[entry["name"]]]
    return {"points": plan.chart, "tolerance": AT, "lines": lines}


def _growth(solve: Solver, where: Points) -> Float:
    """T at every point from P, as a chart has it."""
    T = np.empty(len(where))
    for k in range(0, len(where), BLOCK):
        part = slice(k, k + BLOCK)
        P = solve(Points(where.F, where.G, where.Omega[part], where.gamma[part]))
        T[part] = growth(np.ascontiguousarray(P.T)) * where.Omega[part] / np.pi
    return T


def _point_by_point(
    plan: Plan, field: Field, reference: Reference | None
) -> list[tuple[Built, int]]:
    """Both heyoka and LSODA, each at its tightest and at the loosest that reaches 1e-10."""
    start = points(1)
    chosen: list[tuple[Contender, int]] = []
    if field.heyoka():
        wide = 4
        chosen += [
            (heyoka_peer.make("heyoka batch of 4", heyoka_peer.plain(wide)), plan.plain),
            (heyoka_peer.make("heyoka batch of 8, half period", heyoka_peer.best(3)), plan.batch),
            (heyoka_peer.make("heyoka batch of 8, n columns", heyoka_peer.NARROW), plan.batch),
        ]
    chosen.append((peers.make("LSODA", peers.TIGHT["LSODA"], False), plan.few))
    found = [(b, size) for c, size in chosen for b in field.build([c], start)]
    loose: list[tuple[Callable[[float], Contender], int]] = [
        (lambda tol: peers.make("LSODA", tol, True), plan.few)
    ]
    if field.heyoka():
        loose.append((lambda tol: heyoka_peer.make("heyoka", heyoka_peer.best(3, tol)), plan.plain))
    for make, size in loose:
        for tolerance in (1e-8, 1e-9, 1e-10, 1e-11, 1e-12):
            (built,) = field.build([make(tolerance)], start)
            worst = errors(built.solve, reference)["error"]
            if worst is not None and worst <= AT:
                name = f"{built.contender.name.split(',')[0]}, just {AT:.0e}"
                renamed = Contender(name, built.contender.settings, built.contender.build)
                found.append((Built(renamed, built.solve, built.seconds), size))
                break
    return found


def number(plan: Plan, field: Field) -> dict[str, Any]:
    """Cost and memory against the number of points."""
    start = points(1)
    contenders = ours.batches()
    if field.heyoka():
        contenders.append(heyoka_peer.make("heyoka batch of 8, half period", heyoka_peer.best(3)))
    built = field.build(contenders, start)
    jobs: dict[str, Callable[[], Any]] = {}
    sizes: dict[str, tuple[str, int]] = {}
    nominal: dict[str, int] = {}
    for count in plan.counts:
        name = f"chart {count}"
        sizes[name], nominal[name] = ("chart", grid(count)[0] * grid(count)[1]), count
        jobs[name] = partial(ours.drawn, count, "floquet", AT)
        if count > plan.direct:
            continue
        where = points(count)
        _ = where.equations  # made once, not timed
        for b in built:
            name = f"{b.contender.name} {count}"
            sizes[name], nominal[name] = (b.contender.name, count), count
            jobs[name] = partial(b.solve, where)
    seconds = rounds(jobs, plan.sweep_rounds)
    curves: dict[str, list[dict[str, Any]]] = {}
    for job, (name, count) in sizes.items():
        point: dict[str, Any] = {"points": count, "nominal": nominal[job]}
        point["seconds"] = [s / count for s in seconds[job]]
        curves.setdefault(name, []).append(point)
    for point, count in zip(curves["chart"], plan.counts, strict=True):
        point["peak_bytes"] = _peak(partial(ours.drawn, count, "floquet", AT)) / point["points"]
    return {"curves": curves}


def _peak(job: Callable[[], Any]) -> int:
    """Bytes at the most at once, what numpy allocates included."""
    tracemalloc.start()
    try:
        job()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def modes(plan: Plan, field: Field) -> dict[str, Any]:
    """Cost and accuracy against the number of modes."""
    curves: dict[str, list[dict[str, Any]]] = {}
    slow: set[str] = set()
    for count in plan.modes:
        where = points(plan.most // 8, count, NARROW)
        chosen = [*ours.singles(), *ours.batches(), peers.make("cvodes Adams", 1e-14, True)]
        if count <= LSODA_MODES:
            chosen.append(peers.make("LSODA", 1e-12, True))
        if field.heyoka():
            chosen.append(heyoka_peer.make("heyoka batch of 8", heyoka_peer.best(count + 1)))
        built = field.build([c for c in chosen if c.name not in slow], where)
        least = (1, max(8, 1024 // count**2))
        small = count <= plan.referenced
        reference = field.reference(points(1, count, NARROW)) if small else None
        for entry in compete(built, where, plan.sweep_rounds, plan.target / 2, reference, least):
            curves.setdefault(entry["name"], []).append({"modes": count} | entry)
            if min(entry["seconds"]) > SLOWEST:
                slow.add(entry["name"])
    left_out = {"slow": sorted(slow), "slowest": SLOWEST, "LSODA": LSODA_MODES}
    return {"curves": curves, "Omega": NARROW, "left_out": left_out}


def tolerance(plan: Plan, field: Field) -> dict[str, Any]:
    """Accuracy reached against time."""
    start = points(plan.most)
    reference = field.reference(points(plan.reference, seed=1))
    curves: dict[str, list[dict[str, Any]]] = {}
    for tol in plan.tolerances:
        chosen = [peers.make(m, tol, True) for m in ("LSODA", "DOP853", "cvodes Adams")]
        if field.heyoka():
            name = "heyoka batch of 8, half period"
            chosen.append(heyoka_peer.make(name, heyoka_peer.best(3, tol)))
        built = field.build(chosen, start)
        for entry in compete(built, start, plan.sweep_rounds, plan.target / 2, reference):
            curves.setdefault(entry["name"], []).append({"tolerance": tol} | entry)
        draw = partial(ours.drawn, plan.chart, "floquet", tol)
        times = [once(draw) for _ in range(plan.sweep_rounds)]
        found = times[0][0]
        entry = {"tolerance": tol, "points": found.T.size, "nodes": found.nodes}
        entry["seconds"] = [s / found.T.size for _, s in times]
        entry |= errors(partial(ours.read, found), reference)
        curves.setdefault("chart", []).append(entry)
    return {"curves": curves}


def limit(plan: Plan, field: Field) -> dict[str, Any]:
    """Operations and bytes a point, and what the machine could do with them."""
    return {
        "machine": limits.machine(),
        "chart": limits.chart_parts(plan.chart, AT),
        "batch": limits.batch_work(points(plan.reference * 8)),
    }


def verify(plan: Plan, field: Field) -> dict[str, Any]:
    """Wall time of the whole command in processes of their own, on as many threads as they like.

    Beside it that of another checkout, where one was named: an earlier version.
    """
    places = {"seconds": Path(__file__).parents[1]}
    if field.before is not None:
        places["before"] = field.before
    jobs = {name: partial(_command, place) for name, place in places.items()}
    return dict(rounds(jobs, plan.rounds))


def _command(place: Path) -> None:
    own = ("_NUM_THREADS", "XDG_CACHE_HOME")
    free = {k: v for k, v in os.environ.items() if not k.endswith(own)}
    subprocess.run(
        [sys.executable, "-m", "compare"],
        cwd=place,
        env=free | {"PYTHONPATH": str(place)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=True,
    )
