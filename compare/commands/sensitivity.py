"""``verify sensitivity``: how T moves with every parameter of a system."""

import argparse
import json
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import Console

from compare.charts.identity import known_values, type_name
from compare.charts.limits import checked
from compare.commands import asked
from compare.commands.terminal import deliver, terminal, working
from compare.console import as_file, bare_table, say
from compare.output import check_writable
from compare.provenance import in_words, provenance
from compare.system_file import Described
from floquet import SystemSensitivities, system_sensitivities
from hill import System
from hill.averaging import Resonance
from hill.system import natural_frequencies

SUMMARY = "how the argument T moves with every parameter"
EPILOG = """\
examples:
  verify sensitivity
  verify sensitivity --beam stepped --set Omega=1.1 --set eta=0.01
  verify sensitivity --set omega_L=10 --set g=0.02 --format json
  verify sensitivity mine.toml --set gamma=0.2

Without a file the system is the report's beam (Table 1, or Table 2 with --beam
stepped) but for what --set changes; gamma is 0.1 and Omega the beam's own
omega_(B) + omega_(1) where they are not set. A file is the one that `verify
system` takes. The derivatives come from automatic differentiation of the
integration over one period, and each has an error bound. JSON has those of z
too.

exit status: 0 done; 2 wrong usage or input, or T has no derivative there."""

FORMATS = ("text", "json")
GAMMA = 0.1
RESONANCE = Resonance(1, 0)


def configure(p: argparse.ArgumentParser) -> None:
    """Options of the command."""
    asked.configure(p)
    p.add_argument("--format", choices=FORMATS, help="text, or what --output's suffix says (.json)")
    p.add_argument(
        "--output", type=Path, metavar="FILE", help="write there instead of the terminal"
    )


def run(options: argparse.Namespace) -> int:
    """Run it; return the exit status."""
    wanted = asked.asked(options)
    if options.output is not None:
        check_writable(options.output)
    forcing = {"eta": 0.0} | wanted.forcing
    if not options.file:
        forcing = {"gamma": GAMMA} | forcing
        if "Omega" not in forcing:
            forcing["Omega"] = _resonant(wanted.system)
    for name in ("Omega", "gamma"):
        if name not in forcing:
            raise ValueError(f"{name}: has no value; give it in [forcing] or as --set {name}=")
    checked(wanted.system, {}, forcing)
    with working("differentiating over one period"):
        found = system_sensitivities(wanted.system, **forcing)
    suffix = options.output.suffix[1:] if options.output else ""
    if (options.format or suffix) == "json":
        deliver(json.dumps(content(wanted, found), indent=2) + "\n", options.output)
    elif options.output is None:
        show(wanted, found, terminal())
    else:
        deliver(as_file(lambda console: show(wanted, found, console)), options.output)
    return 0


def show(wanted: Described, found: SystemSensitivities, console: Console) -> None:
    """Print where, what T is, and a line for each parameter."""
    title, T = wanted.title, round(found.T, 6) + 0.0
    at = ", ".join(f"{name} = {found.values[name]:.7g}" for name in ("Omega", "gamma", "eta"))
    say(console, f"{title[:1].upper()}{title[1:]} at {at}: T = {T:.6f}", "bold")
    console.print()
    table = bare_table(gap=2)
    table.add_column("parameter p", no_wrap=True)
    for name in ("value", "dT/dp", "known to", "p + 1%: T moves by"):
        table.add_column(name, justify="right", no_wrap=True)
    for name, value in found.values.items():
        slope, error = found.dT[name], found.dT_error[name]
        share = _signed(0.01 * value * slope, 0.01 * abs(value) * error) if value else "-"
        known = f"{error:.0e}" if error else "exact"
        table.add_row(name, f"{value:.7g}", _signed(slope, error), known, share)
    console.print(table)
    if found.remark:
        console.print()
        say(console, f"{found.remark[0].upper()}{found.remark[1:]}.", "yellow")
    if not any(slope for name, slope in found.dT.items() if name != "eta"):
        console.print()
        say(console, "Stable, and not on a boundary: T = -eta, and nothing else moves it.")
    if found.left_out:
        console.print()
        names = ", ".join(found.left_out)
        say(console, f"Left out, since other values take the equation out of Hill's form: {names}.")
    if found.shared_matrices:
        console.print()
        say(console, "The matrices are the system's own; the time domain has no others for it.")
    console.print()
    say(console, in_words(_about(wanted, found)), "dim")


def content(wanted: Described, found: SystemSensitivities) -> dict[str, Any]:
    """What JSON holds; complex numbers are [re, im]."""
    return provenance(_about(wanted, found)) | {
        "T": found.T,
        "remark": found.remark,
        "left_out": list(found.left_out),
        "z": _pairs(found.z),
        "parameters": [
            {
                "name": name,
                "value": value,
                "dT": found.dT[name],
                "dT_error": found.dT_error[name],
                "dz": _pairs(found.dz[name]),
                "dz_error": found.dz_error[name].tolist(),
            }
            for name, value in found.values.items()
        ],
    }


def _about(wanted: Described, found: SystemSensitivities) -> dict[str, Any]:
    """The system, by what it holds; its parameters and forcing stand with their derivatives."""
    about = {
        "title": wanted.title,
        "kind": wanted.kind,
        "system": type_name(wanted.system),
        "values": known_values(wanted.system),
        "shared_matrices": found.shared_matrices,
    }
    return about | ({"beam": wanted.kind} if wanted.kind in asked.BEAMS else {})


def _resonant(beam: System) -> float:
    Omega = RESONANCE.Omega(natural_frequencies(beam))
    if not np.isfinite(Omega) or Omega <= 0.0:
        raise ValueError("Omega: has no value; this beam has no omega_(B) + omega_(1), set Omega")
    return Omega


def _signed(value: float, error: float = 0.0) -> str:
    """Six decimals, or four digits of what is small or large; 0 where it may be."""
    if abs(value) <= error or value == 0.0:
        return " 0"
    return f"{value:+.6f}" if 1e-3 <= abs(value) < 1e4 else f"{value:+.3e}"


def _pairs(values: Any) -> list[list[float]]:
    return [[float(z.real), float(z.imag)] for z in np.asarray(values, complex)]
