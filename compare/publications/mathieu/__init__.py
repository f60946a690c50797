"""Mathieu's characteristic values, Abramowitz and Stegun, table 20.1.

y'' + (a - 2 q cos 2x) y = 0 has a solution of period pi (r even) or 2 pi (r odd) where a = a_r(q),
even, or a = b_r(q), odd. It is the report's equation with F = a, G = 1, gamma = -2 q, Omega = 2,
and P(z) = z - cos 2 pi alpha: there P(1) = 0, or P(-1) = 0. A printed value is right if P changes
its sign within half a unit of its last digit, by more than the routes' bounds.
"""

from compare.publication import Publication
from compare.publications.mathieu.outcome import explain, solve
from compare.publications.mathieu.render import RENDERING
from compare.publications.mathieu.table import EVEN, ODD, errata, rows

__all__ = ["PUBLICATION"]

PUBLICATION = Publication(
    name="mathieu",
    title="Abramowitz and Stegun, Handbook of Mathematical Functions, table 20.1: a_r(q), b_r(q)",
    tables=(EVEN, ODD),
    rows=rows,
    errata=errata,
    solve=solve,
    explain=explain,
    rendering=RENDERING,
)
