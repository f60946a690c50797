"""The run: this project against its peers, in one run, to one JSON file."""

import argparse
import json
import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks import sections
from benchmarks.compete import Field, reason
from benchmarks.general import general
from benchmarks.machine import machine, vectors
from benchmarks.page import RESULTS, SCHEMA
from benchmarks.plan import FULL, QUICK, Plan
from compare.output import check_writable, write_whole

SECTIONS: dict[str, Callable[[Plan, Field], dict[str, Any]]] = {
    "contenders": sections.contenders,
    "chart": sections.chart,
    "number": sections.number,
    "modes": sections.modes,
    "tolerance": sections.tolerance,
    "limit": sections.limit,
    "general": general,
    "verify": sections.verify,
}


def main(arguments: list[str] | None = None) -> None:
    """Run, and write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--quick", action="store_true", help="less of everything, within a minute")
    parser.add_argument("--only", nargs="+", choices=SECTIONS, metavar="SECTION", help="a part")
    own = RESULTS / f"{vectors()}.json"
    parser.add_argument(
        "--output", type=Path, default=own, metavar="FILE", help=f"(default results/{own.name})"
    )
    parser.add_argument(
        "--before", type=Path, metavar="DIR", help="a checkout to time `verify` against"
    )
    options = parser.parse_args(arguments)
    check_writable(options.output)
    if options.before is not None and not (options.before / "compare").is_dir():
        parser.error(f"--before {options.before}: is not a checkout of this project")
    plan, field = QUICK if options.quick else FULL, Field(before=options.before)
    results: dict[str, Any] = {"schema": SCHEMA, "quick": options.quick, "machine": machine()}
    started = time.perf_counter()
    # what is compiled, by us and by heyoka, is kept in a cache: an empty one, so that builds count
    with tempfile.TemporaryDirectory() as empty:
        os.environ["XDG_CACHE_HOME"] = empty
        for name in options.only or SECTIONS:
            print(f"{name} ...", end=" ", flush=True, file=sys.stderr)
            before = time.perf_counter()
            try:
                results[name] = SECTIONS[name](plan, field)
            except Exception as error:  # what has been measured is not to be lost
                field.missing[f"section {name}"] = reason(error)
                print(f"failed: {error!r}", end=" ", file=sys.stderr)
            print(f"{time.perf_counter() - before:.0f} s", file=sys.stderr)
    results["missing"] = field.missing
    results["seconds"] = time.perf_counter() - started
    write_whole(options.output, json.dumps(_rounded(results), indent=1) + "\n")
    if any(name not in results for name in options.only or SECTIONS):
        sys.exit(1)


def _rounded(value: Any) -> Any:
    """Four digits of every float: more is noise."""
    if isinstance(value, dict):
        return {key: _rounded(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(v) for v in value]
    return float(f"{value:.4g}") if isinstance(value, float) else value
