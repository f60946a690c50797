"""A report as text, JSON, Markdown or CSV: outcomes in, a string out, nothing computed."""

import csv
import io
import json
from collections.abc import Callable
from typing import Any

from rich.console import Console
from rich.text import Text

from compare.console import bare_table, say, show
from compare.provenance import as_comment, in_words
from compare.verification import Report

SHOWN = ("all", "differs", "flips", "fail")
FORMATS = ("text", "json", "md", "csv")


def shown(report: Report, which: str) -> tuple[Any, ...]:
    """Outcomes to show: all, or those that differ from print, whose verdict flips, that fail."""
    if which == "differs":
        return tuple(o for o in report.outcomes if o.differs)
    if which == "flips":
        return tuple(o for o in report.outcomes if o.flips)
    if which == "fail":
        return tuple(o for o in report.outcomes if not (o.routes_agree and o.expected))
    return report.outcomes


def text(report: Report, which: str = "all", *, console: Console) -> None:
    """Print the table and what was found; colour is the console's business."""
    rendering = report.publication.rendering
    kept = [console.width >= column.width for column in rendering.columns]
    table = bare_table()
    for column, keep in zip(rendering.columns, kept, strict=True):
        if keep:
            table.add_column(column.name, justify="left" if column.words else "right", no_wrap=True)
    for outcome in shown(report, which):
        cells = []
        for cell, keep in zip(rendering.cells(outcome), kept, strict=True):
            words = cell.text if all(kept) else cell.short or cell.text
            if keep:
                cells.append(Text(words, style=cell.style) if cell.style else words)
        table.add_row(*cells)
    if table.row_count:
        show(console, table)
        console.print()
    more = _more_lines(report, which)
    for line in more:
        say(console, line, whole=True)
    if more:
        console.print()
    say(console, in_words(report.about), "dim")
    console.print()
    for line in report.summary.lines:
        say(console, line, "bold" if report.ok else "bold red", whole=True)


def as_json(report: Report, which: str = "all") -> str:
    """The report as JSON."""
    content = {
        "summary": vars(report.summary) | {"ok": report.ok},
        "rows": [_record(report, o) for o in shown(report, which)],
    }
    return json.dumps(content, indent=1, allow_nan=False) + "\n"


def _record(report: Report, outcome: Any) -> dict[str, Any]:
    found, more = report.publication.rendering.record(outcome), _more(report, outcome)
    return found | {"more_terms": more} if more else found


def _more(report: Report, outcome: Any) -> dict[str, Any]:
    """What JSON holds of more terms; nothing where there is none."""
    paper, found = report.publication, report.more_terms.get(outcome.row.id)
    return paper.more_terms.record(found) if paper.more_terms and found is not None else {}


def _more_lines(report: Report, which: str) -> list[str]:
    """The same in words, a line a row."""
    more, found = report.publication.more_terms, report.more_terms
    rows = [o.row for o in shown(report, which) if o.row.id in found]
    return [more.line(row, found[row.id]) for row in rows] if more else []


def markdown(report: Report, which: str = "all") -> str:
    """A table, what was found, and what made it."""
    rendering = report.publication.rendering
    names = [column.name.replace("|", "\\|") for column in rendering.columns]
    lines = ["| " + " | ".join(names) + " |"]
    lines.append("|" + "|".join(" --- " if c.words else " ---: " for c in rendering.columns) + "|")
    for outcome in shown(report, which):
        cells = [f"**{c.text}**" if c.loud else c.text for c in rendering.cells(outcome)]
        lines.append("| " + " | ".join(cells) + " |")
    more = [f"- {line}" for line in _more_lines(report, which)]
    found = [*([""] if more else []), *more, "", *report.summary.lines]
    return "\n".join([*lines, *found, "", in_words(report.about)]) + "\n"


def as_csv(report: Report, which: str = "all") -> str:
    """What made it behind "# ", then one line a row, every digit."""
    rendering = report.publication.rendering
    buffer = io.StringIO()
    buffer.write(as_comment(report.about))
    writer = csv.writer(buffer, lineterminator="\n")
    extra = [_more(report, outcome) for outcome in shown(report, which)]
    names = list(dict.fromkeys(name for more in extra for name in more))
    writer.writerow([*rendering.csv_header, *(f"more_terms_{name}" for name in names)])
    for outcome, more in zip(shown(report, which), extra, strict=True):
        values = [*rendering.csv_line(outcome), *(more.get(name, "") for name in names)]
        writer.writerow([repr(float(v)) if isinstance(v, float) else v for v in values])
    return buffer.getvalue()


WRITERS: dict[str, Callable[[Report, str], str]] = {
    "json": as_json,
    "md": markdown,
    "csv": as_csv,
}
