"""The trial of the bounds, as a command."""

import argparse
import json
import os
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from benchmarks.honesty import edges, sensitivities, systems, table, trial
from benchmarks.honesty.judge import Judged, judged, truth
from benchmarks.honesty.systems import GROUP, members
from compare.output import check_writable, write_whole
from hill import HillEquation

# In all classes together: a full run.
COUNT = 10_400

# SUNDIALS takes some tenths of a second: the first system of every fourth group.
CVODES_EVERY = 4

# Seconds a group may take; the slowest took 20.
LONGEST = 300

# Violations that are printed; the rest is counted, and in the JSON.
PRINTED = 60

# Columns where there is no terminal to ask.
WIDE = 100


@dataclass(frozen=True)
class Part:
    """A part of the trial.

    Attributes
    ----------
    names, routes, numbers : tuple of str
        Its classes, who is asked, and the numbers that are judged.
    share : float
        Of the systems of the whole trial that this one has: its own are as much dearer.
    groups : callable
        From a class and how many systems of it are wanted to how many jobs these are.
    size : int
        Systems in a job.
    one : callable
        From a class, a seed, the job's number and `shrink` to what was judged.
    """

    names: tuple[str, ...]
    routes: tuple[str, ...]
    numbers: tuple[str, ...]
    share: float
    groups: Callable[[str, int], int]
    size: int
    one: Callable[[str, int, int, float], list[Judged]]


def _bounds(kind: str, seed: int, group: int, shrink: float) -> list[Judged]:
    return trial.trial(kind, seed, group, cvodes=group % CVODES_EVERY == 0, shrink=shrink)


def _sensitivities(kind: str, seed: int, group: int, shrink: float) -> list[Judged]:
    return sensitivities.trial(kind, seed, group, shrink=shrink)


def _edges(kind: str, seed: int, number: int, shrink: float) -> list[Judged]:
    return edges.trial(kind, seed, number, shrink=shrink)


PARTS = {
    "bounds": Part(
        systems.NAMES, trial.ROUTES, trial.NUMBERS, 1.0, systems.count, GROUP, _bounds
    ),
    "sensitivities": Part(
        sensitivities.NAMES, sensitivities.ROUTES, sensitivities.NUMBERS, 0.2, systems.count,
        GROUP, _sensitivities,
    ),
    "edges": Part(
        edges.NAMES, edges.ROUTES, edges.NUMBERS, 0.01, lambda _, wanted: wanted, 1, _edges
    ),
}  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; 0 without violations, 1 with."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.honesty",
        description="Hostile systems by every route, each bound held against ball arithmetic.",
    )
    parser.add_argument(
        "--part", nargs="+", choices=PARTS, metavar="PART", default=tuple(PARTS),
        help=f"of {', '.join(PARTS)}; default all",
    )  # fmt: skip
    parser.add_argument(
        "--count", type=_at_least_one, default=COUNT, metavar="N",
        help=f"systems of the bounds, about, and as much less of the rest as it is dearer; "
        f"default {COUNT}",
    )  # fmt: skip
    every = tuple(dict.fromkeys(name for part in PARTS.values() for name in part.names))
    parser.add_argument("--classes", nargs="+", choices=every, metavar="CLASS", default=every,
                        help=f"of {'; '.join(every)}")  # fmt: skip
    parser.add_argument("--seed", type=_not_negative, default=0, metavar="N")
    parser.add_argument("--jobs", type=_at_least_one, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--json", type=Path, metavar="FILE", help="the tables and all violations")
    parser.add_argument(
        "--show", nargs=2, metavar=("CLASS", "NUMBER"),
        help="one system of the bounds and all that is said of it; with the --seed of the run",
    )  # fmt: skip
    parser.add_argument(
        "--shrink", type=_positive, default=1.0, metavar="FACTOR",
        help="multiply every bound by it; below 1 the trial must find fault",
    )  # fmt: skip
    options = parser.parse_args(arguments)
    if options.show:
        kind, number = _named(parser, *options.show)
        return show(kind, options.seed, number)
    if options.json is not None:
        try:
            check_writable(options.json)
        except (OSError, ValueError) as error:
            parser.error(f"--json {options.json}: {error}")
    console = Console(width=None if sys.stdout.isatty() else WIDE, highlight=False)
    content: dict[str, Any] = {"seed": options.seed}
    bad = 0
    for name in options.part:
        part = PARTS[name]
        kinds = [kind for kind in part.names if kind in options.classes]
        if not kinds:
            continue
        each = max(1, -(-int(options.count * part.share) // len(kinds)))
        tasks = [(kind, group) for kind in kinds for group in range(part.groups(kind, each))]
        job = partial(_one, name, options.seed, options.shrink)
        found = sorted(_run(name, part.size, job, tasks, options.jobs), key=_order(kinds))
        bad += report(console, part, found, options.seed)
        content[name] = table.content(found, part.numbers)
    console.print(table.LEGEND)
    if options.json is not None:
        write_whole(options.json, json.dumps(content, indent=1) + "\n")
    return 1 if bad else 0


def _order(kinds: Sequence[str]) -> Any:
    return lambda x: (kinds.index(x.kind), x.number)


def _run(
    name: str,
    size: int,
    job: Callable[[tuple[str, int]], list[Judged]],
    tasks: list[tuple[str, int]],
    jobs: int,
) -> Iterator[Judged]:
    progress = Progress(
        TextColumn(name), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
        TextColumn("{task.fields[bad]} violations"), console=Console(stderr=True),
    )  # fmt: skip
    with progress, ProcessPoolExecutor(jobs) as pool:
        bar = progress.add_task("", total=size * len(tasks), bad=0)
        bad = 0
        # groups of all classes mixed, so that the time left is soon known
        mixed = np.random.default_rng(0).permutation(len(tasks))
        for future in as_completed([pool.submit(job, tasks[i]) for i in mixed]):
            found = future.result()
            bad += sum(bool(x.violations) for x in found)
            progress.update(bar, advance=size, bad=bad)
            yield from found


def _one(name: str, seed: int, shrink: float, task: tuple[str, int]) -> list[Judged]:
    """One job, or the word that it does not end."""
    kind, group = task
    signal.signal(signal.SIGALRM, _too_long)
    signal.alarm(LONGEST)
    try:
        return PARTS[name].one(kind, seed, group, shrink)
    except TimeoutError as error:
        number = group * PARTS[name].size
        return [Judged(kind, number, 0, "all", "failed", {"other": str(error)})]
    finally:
        signal.alarm(0)


def _too_long(*_: Any) -> None:
    raise TimeoutError(f"the job takes more than {LONGEST} s")


def report(console: Console, part: Part, found: list[Judged], seed: int) -> int:
    """Print the tables and the violations; return how many there are."""
    for field, first in (("kind", "class"), ("route", "route")):
        for one in table.tables(found, part.numbers, field, first):
            console.print(one)
            console.print()
    bad = [x for x in found if x.violations]
    if bad:
        console.print(table.cells(found, part.numbers, part.routes))
        console.print()
    for x in bad[:PRINTED]:
        console.print(f"{x.kind} {x.number} (n = {x.n}), {x.route}: {_said(x)}", soft_wrap=True)
    if len(bad) > PRINTED:
        console.print(f"and {len(bad) - PRINTED} more")
    if bad and part.one is _bounds:
        x = bad[0]
        console.print(f'see one by: --seed {seed} --show "{x.kind}" {x.number}', soft_wrap=True)
    return len(bad)


def _said(x: Judged) -> str:
    return "; ".join(f"{kind}: {said}" for kind, said in x.violations.items())


def show(kind: str, seed: int, number: int) -> int:
    """Print one system, the truth, and what every route says."""
    group, place = divmod(number, GROUP)
    equations = members(kind, seed, group)
    e = equations[place]
    print(repr_of(e))
    known = truth(e)
    if known.P is None or known.growth is None:
        print("beyond the arbiter")
    else:
        print("P =", ", ".join(p.str(20, radius=False) for p in known.P))
        print(f"T = {known.growth.T.str(20)}, {known.growth.truth}")
    worst = 0
    for route, answer in trial.answers_of(equations, place, shared=kind != "known").items():
        print(f"\n{route}:", answer.refused or answer.failed or answer.verdict, answer.warned)
        if answer.polynomial is None or answer.errors is None:
            continue
        print("  P =", ", ".join(f"{p:.17g}" for p in answer.polynomial))
        print("  reported", ", ".join(f"{p:.3g}" for p in answer.errors))
        x = judged(kind, number, route, answer, known)
        print(f"  T = {answer.T:.17g} +- {answer.T_error:.3g}")
        shares = ", ".join(f"{name} {m.ratio:.3g}" for name, m in x.measured.items())
        print(f"  true/reported: {shares or 'unknown'}")
        print(f"  {_said(x) or 'holds'}")
        worst = max(worst, bool(x.violations))
    return worst


def repr_of(e: HillEquation) -> str:
    """The equation as it can be typed."""
    eta = e.eta.tolist() if isinstance(e.eta, np.ndarray) else e.eta
    text = f"HillEquation(\n    F={e.F.tolist()},\n    G={e.G.tolist()},\n"
    text += f"    gamma={e.gamma!r}, Omega={e.Omega!r}, eta={eta!r},\n"
    if e.H:
        text += f"    H={[H.tolist() for H in e.H]}, omega_L={e.omega_L!r},\n"
    return text + ")"


def _named(parser: argparse.ArgumentParser, kind: str, number: str) -> tuple[str, int]:
    if kind not in systems.NAMES:
        parser.error(f"--show {kind!r}: must be one of {', '.join(systems.NAMES)}")
    try:
        found = _not_negative(number)
        members(kind, 0, found // GROUP)[found % GROUP]
    except argparse.ArgumentTypeError as error:
        parser.error(f"--show {kind!r} {number}: {error}")
    except IndexError:
        parser.error(f"--show {kind!r} {number}: this class has no such number")
    return kind, found


def _whole(text: str, least: int) -> int:
    try:
        value = int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r}: must be a whole number") from None
    if not least <= value <= 10**9:
        raise argparse.ArgumentTypeError(f"{value}: must be from {least} to 1,000,000,000")
    return value


def _at_least_one(text: str) -> int:
    return _whole(text, 1)


def _not_negative(text: str) -> int:
    return _whole(text, 0)


def _positive(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = float("nan")
    if not 0.0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text!r}: must be a number above 0")
    return value
