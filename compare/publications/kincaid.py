"""Kincaid, Pearson, Hill and Wang: Tables 1 to 3 of the report that this project reproduces.

Its own matters, the program of its appendix, its figures and its conclusions, are in
`compare.report`.
"""

from compare.publication import Publication
from compare.report import render, row, tables, terms
from compare.report.errata import all_errata

PUBLICATION = Publication(
    name="kincaid",
    title="Kincaid, Pearson, Hill and Wang: a beam under a gimbaled, pulsating thrust",
    tables=tables.TABLES,
    rows=tables.rows,
    errata=all_errata,
    as_run=row.as_run,
    solve=row.solve,
    explain=row.explain,
    rendering=render.RENDERING,
    modes=2,
    more_terms=terms.MORE_TERMS,
    is_named=tables.is_named,
)

check = PUBLICATION.check
"""One row of the report, by both routes and explained."""
