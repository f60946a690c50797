"""What made a file: schema, version, what it is about, and in which units.

One record, `provenance`, in the form that the file can hold: JSON has it among its keys, CSV and
the metadata of pictures as one line of JSON, text and Markdown in words. No time, no place, no
command: what is the same is written as the same bytes.
"""

import json
from importlib.metadata import version
from typing import Any

SCHEMA = 1
UNITS = (
    "Omega, eta and T in the system's own unit of frequency (the report's beams: omega_1; T0 in "
    "E I/l^2); gamma, z and P pure numbers"
)


def provenance(about: dict[str, Any]) -> dict[str, Any]:
    """A record that JSON can hold; `about` may have units of its own."""
    return {
        "schema": SCHEMA,
        "made_by": f"floquet-crosscheck {version('floquet-crosscheck')}",
        "units": UNITS,
    } | {name: _plain(value) for name, value in about.items()}


def as_line(about: dict[str, Any]) -> str:
    """The same in one line of JSON."""
    return json.dumps(provenance(about), allow_nan=False)


def as_comment(about: dict[str, Any]) -> str:
    """That line behind "# ", for the top of a CSV file."""
    return f"# {as_line(about)}\n"


def in_words(about: dict[str, Any]) -> str:
    """The same in a sentence or two, for text and Markdown."""
    record = provenance(about)
    told = [
        f"{name.replace('_', ' ')} {_words(value)}"
        for name, value in record.items()
        if name not in ("schema", "made_by", "units") and value is not None
    ]
    made = f"Made by {record['made_by']}"
    return f"{made}{': ' if told else ''}{', '.join(told)}. Units: {_words(record['units'])}."


def picture_metadata(about: dict[str, Any], kind: str) -> dict[str, str | None]:
    """It as the metadata that a picture of this kind can hold, without the time; for savefig."""
    made, line = str(provenance(about)["made_by"]), as_line(about)
    found: dict[str, dict[str, str | None]] = {
        "png": {"Software": made, "Description": line},
        "svg": {"Creator": made, "Description": line, "Date": None},
        "pdf": {"Creator": made, "Subject": line, "CreationDate": None},
    }
    return found[kind]


def _words(value: Any) -> str:
    if isinstance(value, dict):
        return ", ".join(f"{k} {_words(v)}" for k, v in value.items())
    if isinstance(value, list):
        return ", ".join(map(_words, value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float) and value in (float("inf"), float("-inf")):
        return str(value)
    return value if isinstance(value, str | int | float | bool | None) else str(value)
