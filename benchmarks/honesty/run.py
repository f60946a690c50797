"""The trial of the bounds, as a command."""

import argparse
import json
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from benchmarks.honesty import table
from benchmarks.honesty.systems import GROUP, NAMES, SHARED, count, members
from benchmarks.honesty.trial import Judged, answers_of, judged, trial, truth
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


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; 0 without violations, 1 with."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.honesty",
        description="Hostile systems by every route, each bound held against ball arithmetic.",
    )
    parser.add_argument(
        "--count", type=_at_least_one, default=COUNT, metavar="N",
        help=f"systems in all, about; default {COUNT}",
    )  # fmt: skip
    parser.add_argument("--classes", nargs="+", choices=NAMES, metavar="CLASS", default=NAMES,
                        help=f"of {', '.join(NAMES)}")  # fmt: skip
    parser.add_argument("--seed", type=_not_negative, default=0, metavar="N")
    parser.add_argument("--jobs", type=_at_least_one, default=os.cpu_count() or 1, metavar="N")
    parser.add_argument("--json", type=Path, metavar="FILE", help="the table and all violations")
    parser.add_argument(
        "--show", nargs=2, metavar=("CLASS", "NUMBER"),
        help="one system and all that is said of it; with the --seed of the run",
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
    each = -(-options.count // len(options.classes))
    tasks = [
        (kind, options.seed, group)
        for kind in options.classes
        for group in range(count(kind, each))
    ]
    found = sorted(_run(tasks, options.jobs, options.shrink), key=_order(options.classes))
    return report(found, options.json, options.seed)


def _order(kinds: Sequence[str]) -> Any:
    return lambda x: (kinds.index(x.kind), x.number)


def _run(tasks: list[tuple[str, int, int]], jobs: int, shrink: float) -> Iterator[Judged]:
    progress = Progress(
        TextColumn("systems"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(),
        TextColumn("{task.fields[bad]} violations"), console=Console(stderr=True),
    )  # fmt: skip
    with progress, ProcessPoolExecutor(jobs) as pool:
        bar = progress.add_task("", total=GROUP * len(tasks), bad=0)
        bad = 0
        # groups of all classes mixed, so that the time left is soon known
        mixed = np.random.default_rng(0).permutation(len(tasks))
        futures = []
        for kind, seed, group in (tasks[i] for i in mixed):
            futures.append(pool.submit(_one, kind, seed, group, shrink))
        for future in as_completed(futures):
            found = future.result()
            bad += sum(bool(x.violations) for x in found)
            progress.update(bar, advance=GROUP, bad=bad)
            yield from found


def _one(kind: str, seed: int, group: int, shrink: float) -> list[Judged]:
    """One group, or the word that it does not end."""
    signal.signal(signal.SIGALRM, _too_long)
    signal.alarm(LONGEST)
    try:
        return trial(kind, seed, group, cvodes=group % CVODES_EVERY == 0, shrink=shrink)
    except TimeoutError as error:
        n = members(kind, seed, group)[0].n
        return [Judged(kind, GROUP * group, n, "all", "failed", {"other": str(error)})]
    finally:
        signal.alarm(0)


def _too_long(*_: Any) -> None:
    raise TimeoutError(f"the group takes more than {LONGEST} s")


def report(found: list[Judged], path: Path | None, seed: int) -> int:
    """Print the tables and the violations, write the JSON."""
    console = Console(width=None if sys.stdout.isatty() else 200, highlight=False)
    console.print(table.lines(found, "kind", "class"))
    console.print(table.lines(found, "route", "route"))
    console.print(table.cells(found))
    bad = [x for x in found if x.violations]
    for x in bad[:PRINTED]:
        console.print(f"{x.kind} {x.number} (n = {x.n}), {x.route}: {_said(x)}", soft_wrap=True)
    if len(bad) > PRINTED:
        console.print(f"and {len(bad) - PRINTED} more")
    if bad:
        x = bad[0]
        console.print(f'see one by: --seed {seed} --show "{x.kind}" {x.number}', soft_wrap=True)
    if path is not None:
        groups = table.by(found, "kind", "route").items()
        content = {
            "seed": seed,
            "shared": SHARED,
            "lines": [{"class": k, "route": r} | asdict(table.line(g)) for (k, r), g in groups],
            "violations": [asdict(x) for x in bad],
        }
        write_whole(path, json.dumps(content, indent=1) + "\n")
    return 1 if bad else 0


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
    for route, answer in answers_of(equations, place, shared=kind != "known").items():
        print(f"\n{route}:", answer.refused or answer.failed or answer.verdict, answer.warned)
        if answer.polynomial is None or answer.errors is None:
            continue
        print("  P =", ", ".join(f"{p:.17g}" for p in answer.polynomial))
        print("  reported", ", ".join(f"{p:.3g}" for p in answer.errors))
        x = judged(kind, number, route, answer, known)
        print(f"  T = {answer.T:.17g} +- {answer.T_error:.3g}")
        print(f"  true/reported: P {x.P_ratio}, T {x.T_ratio}")
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
    if kind not in NAMES:
        parser.error(f"--show {kind!r}: must be one of {', '.join(NAMES)}")
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
