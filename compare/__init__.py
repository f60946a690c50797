from compare.charts.compute import chart as chart
from compare.charts.result import Chart as Chart
from compare.row import Outcome as Outcome
from compare.run import Report as Report
from compare.run import verify as verify
