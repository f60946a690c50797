"""What both routes found as HTML, for a notebook to show; nothing is computed."""

import base64
from html import escape
from importlib.util import find_spec

from compare.both_routes import CrossCheck
from compare.chart_picture import picture
from compare.chart_text import describe
from compare.charts.result import Chart
from compare.crosscheck_text import compared
from compare.provenance import in_words
from compare.verification import Report
from hill.notebook import paragraphs, table


def of_crosscheck(x: CrossCheck) -> str:
    """The two routes beside each other, and whether they agree."""
    agree = "agree" if x.routes_agree else "DISAGREE"
    told = [
        f"The routes {agree}: P differs by {x.difference:.1e}, their bounds allow {x.bound:.1e}."
    ]
    told += [f"{x.remark}."] if x.remark else []
    caption = f"By both routes: {x.verdict}, T = {x.T + 0.0:.9g} +- {x.T_error:.0e}"
    return "\n".join([table(caption, compared(x), ("", "Hill", "Floquet")), paragraphs(told)])


def of_chart(chart: Chart) -> str:
    """What was found in a few lines; of one or two axes the picture, where matplotlib is there."""
    told = paragraphs(describe(chart))
    if len(chart.axes) > 2 or find_spec("matplotlib") is None:
        return told
    image = base64.b64encode(picture(chart, (), "png")).decode()
    names = " and ".join(axis.name for axis in chart.axes)
    words = escape(f"T over {names}, 0 or white where it is stable", quote=True)
    shown = f'<img alt="{words}" style="max-width: 45em" src="data:image/png;base64,{image}">'
    return f"{shown}\n{told}"


def of_report(report: Report) -> str:
    """The rows of a table, what was found, and what made it."""
    rendering = report.publication.rendering
    heads = [column.name for column in rendering.columns]
    rows = [[cell.text for cell in rendering.cells(o)] for o in report.outcomes]
    words = [k for k, column in enumerate(rendering.columns) if column.words]
    told = [*report.summary.lines, in_words(report.about)]
    return "\n".join([table(report.publication.title, rows, heads, words), paragraphs(told)])
