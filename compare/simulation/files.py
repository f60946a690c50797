"""A simulated motion as CSV and JSON, each with what made it."""

import json
import math
from typing import Any

import numpy as np

from compare.provenance import as_comment, provenance
from compare.simulation.followed import Float, Followed
from compare.simulation.text import about


def as_csv(f: Followed) -> str:
    """A line of provenance behind "# ", then one a sample: time, coordinates, bound, velocities."""
    h = f.history
    names = [_name(name) for name in f.names]
    rates = [f"d_{name}" for name in names[: h.v.shape[1]]]
    lines = [as_comment(about(f)), ",".join(["tau", *names, *rates, "error"]) + "\n"]
    for row in np.column_stack([h.tau, h.q, h.v, h.error]):
        lines.append(",".join([*(f"{x:.12g}" for x in row[:-1]), f"{row[-1]:.1e}"]) + "\n")
    return "".join(lines)


def as_json(f: Followed) -> str:
    """Every digit; complex numbers are [re, im], what is not known is null."""
    h, m = f.history, f.modes
    content = f.content
    found: dict[str, Any] = provenance(about(f)) | {
        "title": f.subject.title,
        "T": f.known.T,
        "T_error": f.known.T_error,
        "verdict": f.known.verdict,
        "T_printed": f.subject.printed or None,
        "measured": None if f.measured is None else vars(f.measured),
        "coordinates": list(f.names),
        "modes": [
            {
                "exponent": _pair(m.exponents[i]),
                "exponent_error": _known(m.exponent_errors[i]),
                "multiplier": _pair(m.multipliers[i]),
                "participation": m.participation[i].tolist(),
                "share": None if content is None else float(content.shares[i]),
            }
            for i in range(len(m.exponents))
        ],
        "shares": None if content is None else content.coordinates.tolist(),
        "tau": h.tau.tolist(),
        "q": h.q.tolist(),
        "v": h.v.tolist(),
        "error": [_known(x) for x in h.error],
        "envelope": _finite(f.envelope),
    }
    return json.dumps(found, allow_nan=False) + "\n"


def _finite(values: Float) -> list[Any]:
    return [[_known(x) for x in row] for row in values]


def _known(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _pair(z: complex) -> list[float]:
    return [float(z.real), float(z.imag)]


def _name(words: str) -> str:
    return words.replace(" ", "_").replace(",", "_")
