"""The pages of the report: what stands on each, from outcomes, claims, errata and proofs."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from compare.pages.motion import Motion
from compare.pages.printed_row import held, row_page
from compare.pages.site import Page, Site
from compare.provenance import in_words, provenance
from compare.publication import Cell, Column
from compare.report import errata_tables, tables
from compare.report.claims.page import summary as claims_summary
from compare.report.claims.run import JudgedClaim
from compare.report.claims.run import count as count_claims
from compare.report.errata import all_errata
from compare.report.errata_tables import BACK, KINDS, VERDICTS, Entry
from compare.report.figures.catalogue import FIGURES
from compare.report.figures.style import parameters as held_constant
from compare.report.proofs import RowProof
from compare.report.proofs import lines as proof_lines
from compare.report.row import Outcome
from compare.verification import Report
from compare.verification_text import as_csv, as_json

NAME = "A beam under pulsating thrust, its tables recomputed"
TABLES = {table: f"table-{table}.html" for table in (1, 2, 3)}

# What of the JSON stands in a column of the table; the others are made of two.
KEYS = {
    "Omega": "Omega_printed",
    "run at": "Omega",
    "T printed": "printed.T",
    "as run": "as_run.T",
    "Hill": "hill.T",
    "Floquet": "floquet.T",
    "|dP|": "difference",
    "cause": "cause",
    "verdict": "verdict",
}

COLUMNS = {
    "row": "the row in printed order; a and b are the two columns of Table 3, without and with "
    "initial conditions",
    "Omega": "the forcing frequency as printed",
    "run at": "the one it was run at, recovered from the printed values",
    "T printed": "the characteristic argument, twice the growth exponent; 0 is stable",
    "as run": "the report's program, truncation and slips included, run again",
    "Hill": "the determinant with its tail summed",
    "Floquet": "the monodromy matrix",
    "T +-": "the larger of the two routes' bounds on the error of T",
    "|dP|": "the largest difference between the coefficients of the two characteristic polynomials",
    "bound": "the sum of the two error bounds of P, which the difference must not exceed",
    "cause": "why print differs",
    "verdict": "what is shown of stability; marked where print has it wrong",
}


@dataclass(frozen=True, eq=False)
class Line:
    """A row in a table: its cells, and what each is in the JSON."""

    id: str
    path: str
    cells: tuple[tuple[Column, Cell, str], ...]
    record: Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class TableOfRows:
    """A printed table.

    Attributes
    ----------
    number : int
    title : str
        As printed.
    held : tuple of (str, str)
        Parameters of the run.
    lines : tuple of Line
    summary : tuple of str
        What was found over its rows.
    """

    number: int
    title: str
    held: tuple[tuple[str, Any], ...]
    lines: tuple[Line, ...]
    summary: tuple[str, ...]
    columns: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Index:
    """What was found."""

    summary: tuple[str, ...]
    flips: tuple[Line, ...]
    tables: tuple[tuple[int, str, str, int, int], ...]
    claims: tuple[str, ...]
    proofs: tuple[str, ...]
    errata: int
    figures: int
    record: Mapping[str, Any]


@dataclass(frozen=True, eq=False)
class Errata:
    """The errata by kind, and two tables."""

    kinds: tuple[tuple[str, str, str, tuple[Entry, ...]], ...]
    tables: tuple[tuple[str, str, errata_tables.Table], ...]


@dataclass(frozen=True, eq=False)
class Claims:
    """The conclusions judged."""

    summary: tuple[str, ...]
    counts: Mapping[str, int]
    judged: tuple[JudgedClaim, ...]


@dataclass(frozen=True)
class Drawn:
    """A figure: its file, and its caption as mathtext."""

    number: int
    path: str
    data: str
    caption: str
    held: str


@dataclass(frozen=True)
class Figures:
    """All figures that there are."""

    drawn: tuple[Drawn, ...]


def site(
    report: Report,
    *,
    motions: Mapping[str, Motion | str] | None = None,
    claims: Sequence[JudgedClaim] = (),
    proofs: Iterable[RowProof] = (),
    figures: Mapping[str, bytes] | None = None,
) -> Site:
    """All pages.

    Parameters
    ----------
    report : Report
        Of all rows.
    motions : mapping, optional
        By row id.
    claims, proofs : sequences, optional
    figures : mapping of str to bytes, optional
        ``figure03.svg`` and so on, as `verify figures` writes them.
    """
    outcomes: tuple[Outcome, ...] = report.outcomes
    proven = tuple(proofs)
    by_row = {proof.row.id: proof for proof in proven}
    entries = errata_tables.entries(outcomes)
    lines = {o.row.id: _line(report, o) for o in outcomes}
    ids = [o.row.id for o in outcomes]
    pages = []
    for table in TABLES:
        of_table = [o for o in outcomes if o.row.table == table]
        own = report.publication.rendering.count(of_table).lines
        content = TableOfRows(
            table,
            _title(table),
            held(table),
            tuple(lines[o.row.id] for o in of_table),
            tuple(own),
            COLUMNS,
        )
        title = f"Table {table}: {content.title.lower()}"
        pages.append(Page(TABLES[table], title, "table.html", content))
    for k, o in enumerate(outcomes):
        content_of_row = row_page(
            report,
            o,
            (motions or {}).get(o.row.id, ""),
            tuple(e for e in entries if e.erratum.row == o.row.id),
            by_row.get(o.row.id),
            (ids[k - 1] if k else "", ids[k + 1] if k + 1 < len(ids) else ""),
        )
        title = f"Row {o.row.id}, Omega {o.row.Omega_printed}"
        pages.append(
            Page(lines[o.row.id].path, title, "row.html", content_of_row, TABLES[o.row.table])
        )
    drawn = _drawn(figures or {})
    if drawn:
        pages.append(Page("figures.html", "Figures 3 to 29", "figures.html", Figures(drawn)))
    if claims:
        judged = Claims(claims_summary(claims), count_claims(claims), tuple(claims))
        pages.append(Page("claims.html", "The report's conclusions", "claims.html", judged))
    pages.append(
        Page("errata.html", "Errata of the report", "errata.html", _errata(outcomes, entries))
    )
    index = Index(
        summary=tuple(report.summary.lines),
        flips=tuple(lines[o.row.id] for o in outcomes if o.flips),
        tables=tuple(
            (
                table,
                TABLES[table],
                _title(table),
                sum(o.row.table == table for o in outcomes),
                sum(o.row.table == table and o.flips for o in outcomes),
            )
            for table in TABLES
        ),
        claims=claims_summary(claims) if claims else (),
        proofs=proof_lines(proven) if proven else (),
        errata=len(all_errata()),
        figures=len(drawn),
        record=vars(report.summary),
    )
    first = Page("index.html", "What was found", "index.html", index)
    named = [first, *(p for p in pages if not p.part)]
    about = report.about
    files = {f"figures/{name}": data for name, data in (figures or {}).items()}
    files |= {"rows.json": as_json(report).encode(), "rows.csv": as_csv(report).encode()}
    return Site(
        name=NAME,
        navigation=tuple((_short(page), page.path) for page in named),
        pages=(first, *pages),
        made=in_words(about),
        about=provenance(about),
        files=files,
    )


def _short(page: Page) -> str:
    """A page's name in the navigation."""
    names = {"index": "Found", "errata": "Errata", "claims": "Conclusions", "figures": "Figures"}
    stem = page.path.removesuffix(".html")
    return names.get(stem, stem.replace("table-", "Table "))


def _title(table: int) -> str:
    return str(tables.heading(table)["title"])


def _line(report: Report, o: Outcome) -> Line:
    rendering = report.publication.rendering
    columns, cells = rendering.columns, rendering.cells(o)
    return Line(
        o.row.id,
        f"rows/{o.row.id}.html",
        tuple((c, cell, KEYS.get(c.name, "")) for c, cell in zip(columns, cells, strict=True)),
        rendering.record(o),
    )


def _errata(outcomes: Sequence[Outcome], entries: Sequence[Entry]) -> Errata:
    kinds = tuple(
        (kind, title, lead, tuple(e for e in entries if e.erratum.kind == kind))
        for kind, (title, lead) in KINDS.items()
    )
    return Errata(
        kinds,
        (
            ("Verdicts that change", VERDICTS, errata_tables.flips(outcomes)),
            ("How well the tables come back", BACK, errata_tables.misses(outcomes)),
        ),
    )


def _drawn(files: Mapping[str, bytes]) -> tuple[Drawn, ...]:
    found = []
    for number, figure in FIGURES.items():
        names = [f"figure{number:02d}.{kind}" for kind in ("svg", "png")]
        pictured = next((name for name in names if name in files), "")
        if pictured:
            data = f"figure{number:02d}.csv"
            found.append(
                Drawn(
                    number,
                    f"figures/{pictured}",
                    f"figures/{data}" if data in files else "",
                    figure.caption,
                    held_constant(figure),
                )
            )
    return tuple(found)
