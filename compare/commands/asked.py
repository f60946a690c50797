"""What a command is asked about: a file's system or one of the report's beams, and --set."""

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Any

from compare import system_file
from compare.report.tables import STEPPED, UNIFORM
from compare.system_file import Described
from hill import SteppedBeam, UniformBeam, checks
from hill.system import with_damping_apart

BEAMS = ("uniform", "stepped")

FILE = """\
mine.toml, as `verify system` takes it (verify help system has more of it):

  kind = "matrices"
  [system]
  F = [[2.0, -1.0], [-1.0, 2.0]]
  G = [[1.0, 0.0], [0.0, 1.0]]
  [forcing]
  gamma = 0.15
  Omega = 2.0"""


def configure(p: argparse.ArgumentParser) -> None:
    """The options that say what is asked about."""
    p.add_argument("file", nargs="?", type=Path, metavar="FILE.toml", help="the system")
    p.add_argument("--beam", choices=BEAMS, help="without a file: of Table 1 or of Table 2")
    p.add_argument(
        "--set", action="append", default=[], metavar="NAME=VALUE", help="a number; repeatable"
    )


def asked(options: argparse.Namespace) -> Described:
    """The file's system or the report's beam, as the settings change it.

    Raises
    ------
    ValueError
        The file cannot be read; a beam beside it; a setting that is not of the system.
    """
    if options.file and options.beam:
        raise ValueError(f"--beam {options.beam}: {options.file} says which system; leave it out")
    if options.file:
        found = system_file.read(options.file)
    elif options.beam == "stepped":
        stepped: dict[str, Any] = dict(STEPPED)
        found = Described(SteppedBeam(**stepped), kind="stepped", title="stepped beam")
    else:
        uniform: dict[str, Any] = dict(UNIFORM)
        found = Described(UniformBeam(**uniform), kind="uniform", title="uniform beam")
    return _damping_in_forcing(system_file.with_settings(found, settings(options.set)))


def _damping_in_forcing(found: Described) -> Described:
    own = found.forcing.get("eta", 0.0)
    system, eta = with_damping_apart(found.system, own)
    return (
        found if eta == own else replace(found, system=system, forcing=found.forcing | {"eta": eta})
    )


def with_axes(found: Described, typed: list[list[str]], set_words: list[str]) -> Described:
    """The axes that are typed, in place of a file's; [forcing] says nothing of an axis.

    Raises
    ------
    ValueError
        Words that are no axis; an axis that is set as well.
    """
    axes = tuple(_axis(words) for words in typed) or found.axes
    names = [name for name, *_ in axes]
    for name in settings(set_words):
        if name in names:
            raise ValueError(f"--set {name}: is an axis; leave one of them out")
    forcing = {k: v for k, v in found.forcing.items() if k not in names}
    return replace(found, axes=axes, forcing=forcing)


def settings(words: list[str]) -> dict[str, float]:
    """NAME=VALUE as typed.

    Raises
    ------
    ValueError
        Words that are not of this form.
    """
    found = {}
    for word in words:
        name, equals, value = word.partition("=")
        if not equals or not name:
            raise ValueError(f"--set {word}: must be NAME=VALUE")
        number = _number(f"--set {word}", value)
        found[name] = number if number == float("inf") else checks.number(name, number)
    return found


def _axis(words: list[str]) -> tuple[str, float, float, int]:
    name, low, high, count = words
    try:
        number = _number("", count)
        if number != int(number):
            raise ValueError
    except (ValueError, OverflowError):
        raise ValueError(f"points of {name}: {count!r} is not a whole number") from None
    return name, _number(f"axis {name}", low), _number(f"axis {name}", high), int(number)


def _number(where: str, text: str) -> float:
    try:
        if not text.isascii() or "_" in text:
            raise ValueError
        return float(text)
    except ValueError:
        raise ValueError(f"{where}: {text!r} is not a number") from None
