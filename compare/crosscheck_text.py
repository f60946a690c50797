"""A cross-check as text, JSON, Markdown or CSV: nothing computed but the time to double."""

import csv
import io
import json
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from compare.both_routes import CrossCheck, Method
from compare.console import bare_table, say, show
from compare.provenance import as_comment, in_words, provenance

FORMATS = ("text", "json", "md", "csv")
STYLES = {"stable": "bold green", "unstable": "bold red", "undecided": "bold yellow"}


@dataclass(frozen=True, eq=False)
class Subject:
    """What was cross-checked: a title, its parameters and forcing, its natural frequencies."""

    title: str
    kind: str
    values: dict[str, float]
    forcing: dict[str, float]
    frequencies: tuple[tuple[str, complex], ...]
    system: str
    """The type of the system."""
    fingerprint: str | None
    """A name for all that the system holds, matrices too."""
    method: Method

    @property
    def about(self) -> dict[str, Any]:
        """What a file says of what it is of."""
        return {
            "title": self.title,
            "kind": self.kind,
            "system": self.system,
            "values": self.fingerprint,
            "parameters": self.values,
            "forcing": self.forcing,
            "method": self.method,
        }


def doubling_time(T: float) -> float | None:
    """Dimensionless time in which a growing q doubles: q grows like exp(T tau/2)."""
    return 2.0 * math.log(2.0) / T if T > 0.0 else None


def summary(subject: Subject, x: CrossCheck) -> tuple[str, str]:
    """Two lines that say what was found."""
    growth = doubling_time(x.T) if x.verdict == "unstable" else None
    T = f"T = {_short(x.T)} +- {x.T_error:.0e}"
    doubles = f", doubling every {growth:.4g}" if growth else ""
    agree = "agree" if x.routes_agree else "DISAGREE"
    matrices = (
        "both were given the same matrices" if x.shared_matrices else "each has its own matrices"
    )
    if x.matrices:
        matrices += f", which differ by {x.matrices:.0e}"
    of_it = f" ({x.discretisation:.1e} for the elements)" if x.discretisation else ""
    return (
        f"{subject.title}: {x.verdict.upper()}, {T}{doubles}.",
        f"The routes {agree}: P({_variable(x)}) differs by {x.difference:.1e}, their bounds allow "
        f"{x.bound:.1e}{of_it}; {matrices}.",
    )


def text(subject: Subject, x: CrossCheck, console: Console) -> None:
    """Print everything, at 80 columns too."""
    first, second = summary(subject, x)
    say(console, first, STYLES[x.verdict])
    say(console, second, "" if x.routes_agree else "bold red")
    for who, remark in remarks(x):
        say(console, f"{who}: {remark}.", "yellow")
    console.print()
    for title, words in facts(subject):
        say(console, f"{title}: {words}")
    console.print()
    table = _table("", "hill", "floquet")
    for name, left, right in compared(x):
        table.add_row(name, left, right)
    show(console, table)
    console.print()
    table = _table("multiplier", "modulus", "phase/pi")
    for mu in x.floquet.multipliers:
        phase = float(np.angle(mu)) / np.pi
        table.add_row(_complex(complex(mu)), f"{abs(mu):.9f}", f"{phase:+.6f}")
    show(console, table)
    console.print()
    say(console, made_by(subject), "dim")


def as_dict(subject: Subject, x: CrossCheck) -> dict[str, Any]:
    """What JSON holds; complex numbers are [re, im]."""
    return provenance(subject.about) | {
        "parameters": {k: _finite(v) for k, v in subject.values.items()},
        "frequencies": {name: _pair(value) for name, value in subject.frequencies},
        "hill": _route(x.hill),
        "floquet": _route(x.floquet),
        "difference": x.difference,
        "bound": x.bound,
        "discretisation": x.discretisation,
        "matrices": x.matrices,
        "shared_matrices": x.shared_matrices,
        "routes_agree": x.routes_agree,
        "verdict": x.verdict,
        "T": x.T,
        "T_error": x.T_error,
        "remark": x.remark,
        "doubling_time": doubling_time(x.T) if x.verdict == "unstable" else None,
    }


def as_json(subject: Subject, x: CrossCheck) -> str:
    """The cross-check as JSON."""
    return json.dumps(as_dict(subject, x), indent=1, allow_nan=False) + "\n"


def markdown(subject: Subject, x: CrossCheck) -> str:
    """Two lines and a table for a report."""
    lines = [*summary(subject, x), *(f"{who}: {said}." for who, said in remarks(x)), ""]
    lines += [f"- {title}: {words}" for title, words in facts(subject)]
    lines += ["", "| | hill | floquet |", "| --- | ---: | ---: |"]
    lines += [f"| {name} | {left} | {right} |" for name, left, right in compared(x)]
    lines += ["", "| multiplier | modulus |", "| ---: | ---: |"]
    lines += [f"| {_complex(complex(mu))} | {abs(mu):.9f} |" for mu in x.floquet.multipliers]
    return "\n".join([*lines, "", made_by(subject)]) + "\n"


def as_csv(subject: Subject, x: CrossCheck) -> str:
    """What made it behind "# ", then one line a quantity, every digit."""
    buffer = io.StringIO()
    buffer.write(as_comment(subject.about))
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(["quantity", "index", "hill", "floquet"])
    for name in ("T", "T_error", "error", "verdict", "remark"):
        writer.writerow([name, "", *(_cell(getattr(r, name)) for r in (x.hill, x.floquet))])
    for k, pair in enumerate(zip(x.hill.polynomial, x.floquet.polynomial, strict=True)):
        writer.writerow(["P", k, *map(_cell, pair)])
    for k, pair in enumerate(zip(x.hill.z, x.floquet.z, strict=True)):
        writer.writerow(["z_re", k, *(_cell(z.real) for z in pair)])
        writer.writerow(["z_im", k, *(_cell(z.imag) for z in pair)])
    for k, pair in enumerate(zip(x.hill.multipliers, x.floquet.multipliers, strict=True)):
        writer.writerow(["multiplier_re", k, *(_cell(mu.real) for mu in pair)])
        writer.writerow(["multiplier_im", k, *(_cell(mu.imag) for mu in pair)])
    for name, value in (*subject.forcing.items(), *subject.values.items()):
        writer.writerow([name, "", _cell(value), _cell(value)])
    return buffer.getvalue()


WRITERS: dict[str, Callable[[Subject, CrossCheck], str]] = {
    "json": as_json,
    "md": markdown,
    "csv": as_csv,
}


def made_by(subject: Subject) -> str:
    """What made it; its parameters and forcing stand among the facts."""
    about = {k: v for k, v in subject.about.items() if k not in ("title", "parameters", "forcing")}
    return in_words(about)


def facts(subject: Subject) -> list[tuple[str, str]]:
    """Its parameters and forcing, and its natural frequencies."""
    given = ", ".join(f"{k} = {v:.9g}" for k, v in (subject.forcing | subject.values).items())
    frequencies = ", ".join(f"omega_({n}) = {_complex(w, 7)}" for n, w in subject.frequencies)
    return [("at", given), ("natural frequencies", frequencies)]


def remarks(x: CrossCheck) -> list[tuple[str, str]]:
    """What is poorly known: of both together, or of one route where the other knows better."""
    if x.remark:
        return [("Note", x.remark)]
    routes = (("By hill", x.hill), ("By floquet", x.floquet))
    return [(who, r.remark) for who, r in routes if r.remark]


def compared(x: CrossCheck) -> list[tuple[str, str, str]]:
    """What either route says, a line a number."""
    h, f = x.hill, x.floquet
    degree = len(h.polynomial) - 1
    rows = [
        ("verdict", str(h.verdict), str(f.verdict)),
        ("T", _short(h.T), _short(f.T)),
        ("T known to", f"{h.T_error:.0e}", f"{f.T_error:.0e}"),
    ]
    for k in range(1, degree + 1):
        rows.append(
            (
                f"P, {_variable(x)}^{degree - k}",
                f"{h.polynomial[k]:.12g}",
                f"{f.polynomial[k]:.12g}",
            )
        )
    rows.append(("P known to", f"{h.error:.0e}", f"{f.error:.0e}"))
    if x.discretisation:
        rows.append(("and for the elements", "", f"{x.discretisation:.0e}"))
    for k, (one, other) in enumerate(zip(h.z, f.z, strict=True), start=1):
        rows.append((f"z_{k}", _complex(complex(one)), _complex(complex(other))))
    return rows


def _variable(x: CrossCheck) -> str:
    """What P is a polynomial of."""
    return "z" if len(x.hill.z) else "mu"


def _table(*heads: str) -> Table:
    table = bare_table(gap=2)
    for k, head in enumerate(heads):
        table.add_column(head, justify="right" if k else "left", no_wrap=True)
    return table


def _short(value: float) -> str:
    return f"{value + 0.0:.9g}"


def _complex(value: complex, digits: int = 9) -> str:
    if value.imag == 0.0:
        return f"{value.real:.{digits}g}"
    return f"{value.real:.{digits}g} {'+-'[value.imag < 0]} {abs(value.imag):.{digits}g}i"


def _route(r: Any) -> dict[str, Any]:
    return {
        "T": r.T,
        "T_error": r.T_error,
        "z": [_pair(z) for z in r.z],
        "multipliers": [_pair(mu) for mu in r.multipliers],
        "exponents": [_pair(s) for s in r.exponents],
        "polynomial": [float(p) for p in r.polynomial],
        "error": r.error,
        "data_error": r.data_error,
        "verdict": r.verdict,
        "remark": r.remark,
        "stable": r.stable,
    }


def _pair(value: complex) -> list[float]:
    return [float(np.real(value)), float(np.imag(value))]


def _cell(value: Any) -> str:
    return value if isinstance(value, str) else repr(float(value))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
