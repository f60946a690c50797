"""The judge: one system by two routes, the report reproduced, charts, the command."""

from compare.charts.compute import chart
from compare.charts.result import Chart
from compare.crosscheck import CrossCheck, crosscheck
from compare.row import Outcome
from compare.run import Report, verify

__all__ = ["Chart", "CrossCheck", "Outcome", "Report", "chart", "crosscheck", "verify"]
