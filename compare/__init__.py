"""The judge: one system by two routes, the report reproduced, charts, the command.

The names are imported when they are asked for: the command starts in a tenth of the time.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from compare.both_routes import CrossCheck, crosscheck
    from compare.charts.compute import chart
    from compare.charts.result import Chart
    from compare.edges.curves import Curve, boundaries
    from compare.edges.instabilities import Instability, instabilities
    from compare.edges.on_chart import tongues
    from compare.edges.tongue import Tongue
    from compare.jobs.cluster import over
    from compare.publication import Publication
    from compare.report.row import Outcome
    from compare.verification import Report, verify

_HOMES = {
    "Chart": "compare.charts.result",
    "CrossCheck": "compare.both_routes",
    "Curve": "compare.edges.curves",
    "Instability": "compare.edges.instabilities",
    "Outcome": "compare.report.row",
    "Publication": "compare.publication",
    "Report": "compare.verification",
    "Tongue": "compare.edges.tongue",
    "boundaries": "compare.edges.curves",
    "chart": "compare.charts.compute",
    "crosscheck": "compare.both_routes",
    "instabilities": "compare.edges.instabilities",
    "over": "compare.jobs.cluster",
    "tongues": "compare.edges.on_chart",
    "verify": "compare.verification",
}

__all__ = [
    "Chart",
    "CrossCheck",
    "Curve",
    "Instability",
    "Outcome",
    "Publication",
    "Report",
    "Tongue",
    "boundaries",
    "chart",
    "crosscheck",
    "instabilities",
    "over",
    "tongues",
    "verify",
]


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'compare' has no attribute {name!r}")
    found = getattr(import_module(_HOMES[name]), name)
    globals()[name] = found
    return found
