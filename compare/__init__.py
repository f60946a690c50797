"""The judge: one system by two routes, the report reproduced, charts, the command.

The names are imported when they are asked for: the command starts in a tenth of the time.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from compare.both_routes import CrossCheck, crosscheck
    from compare.charts.compute import chart
    from compare.charts.result import Chart
    from compare.report.row import Outcome
    from compare.report.run import Report, verify

__all__ = ["Chart", "CrossCheck", "Outcome", "Report", "chart", "crosscheck", "verify"]

_HOMES = {
    "Chart": "compare.charts.result",
    "CrossCheck": "compare.both_routes",
    "Outcome": "compare.report.row",
    "Report": "compare.report.run",
    "chart": "compare.charts.compute",
    "crosscheck": "compare.both_routes",
    "verify": "compare.report.run",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'compare' has no attribute {name!r}")
    found = getattr(import_module(_HOMES[name]), name)
    globals()[name] = found
    return found
