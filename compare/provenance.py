"""What made a file: schema, version, what it is about, and in which units."""

import json
from importlib.metadata import version
from typing import Any

SCHEMA = 1
UNITS = (
    "the system's own: Omega, eta and T in its unit of frequency; gamma, z and P pure numbers; of "
    "the report's beams frequencies over omega_1, T0 over E I/l^2 (4.4.12)"
)


def provenance(about: dict[str, Any]) -> dict[str, Any]:
    """A record that JSON can hold."""
    return {
        "schema": SCHEMA,
        "made_by": f"floquet-crosscheck {version('floquet-crosscheck')}",
        "units": UNITS,
    } | {name: _plain(value) for name, value in about.items()}


def as_line(about: dict[str, Any]) -> str:
    """The same in one line."""
    return json.dumps(provenance(about), allow_nan=False)


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float) and value in (float("inf"), float("-inf")):
        return str(value)
    return value if isinstance(value, str | int | float | bool | None) else str(value)
