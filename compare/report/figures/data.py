"""What a figure shows, before any drawing: named curves, marks, printed points; and their CSV."""

import csv
import io
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from compare.provenance import as_comment
from compare.report.figures.catalogue import FIGURES

Float = NDArray[np.floating[Any]]
Role = Literal["curve", "region", "mark", "printed", "event"]
COLUMNS = ("figure", "panel", "series", "role", "from", "x", "y", "y_upper")


@dataclass(frozen=True, eq=False)
class Series:
    """One curve, region, or set of points.

    Attributes
    ----------
    name : str
        A resonance as the tables name it, or a parameter's value, "K_theta = 0.5".
    role : {"curve", "region", "mark", "printed", "event"}
        A region lies between `y` and `y_upper`; marks are the other route's, an event is a single
        point that the text speaks of, such as a critical thrust.
    source : str
        "hill", "floquet", or where it is printed.
    x, y : (k,) ndarray
    y_upper : (k,) ndarray, optional
    panel : str
        Which axes of the figure; empty where there is one.
    damped : bool
        Drawn dashed.
    """

    name: str
    role: Role
    source: str
    x: Float
    y: Float
    y_upper: Float | None = None
    panel: str = ""
    damped: bool = False

    @property
    def edges(self) -> tuple[Float, ...]:
        """`y`, and `y_upper` where there is one."""
        return (self.y,) if self.y_upper is None else (self.y, self.y_upper)


@dataclass(frozen=True, eq=False)
class FigureData:
    """All that a figure shows.

    Attributes
    ----------
    number : int
    series : tuple of Series
    quantity : str
        What the two routes are compared in, "T" or "Omega".
    disagreement : float
        Largest difference of the two routes at the marks.
    """

    number: int
    series: tuple[Series, ...]
    quantity: str
    disagreement: float

    def select(self, role: Role | None = None, panel: str | None = None) -> tuple[Series, ...]:
        """The series of a role, of a panel."""
        return tuple(
            s
            for s in self.series
            if (role is None or s.role == role) and (panel is None or s.panel == panel)
        )

    @property
    def panels(self) -> tuple[str, ...]:
        """Panels in the order of their first series."""
        return tuple(dict.fromkeys(s.panel for s in self.series))


def largest(differences: Iterable[Any]) -> float:
    """The largest modulus among arrays of differences; 0 of none."""
    return max((float(np.max(np.abs(d))) for d in differences if np.size(d)), default=0.0)


def about(data: FigureData) -> dict[str, Any]:
    """The figure, the beam and the forcing that it is of, and how far the routes differ."""
    figure = vars(FIGURES[data.number])
    given = {name: value for name, value in figure.items() if name not in ("number", "kind")}
    return (
        {"figure": data.number}
        | given
        | {"compared_in": data.quantity, "disagreement": data.disagreement}
    )


def as_csv(data: FigureData) -> str:
    """What made it behind "# ", then a line a point; numbers so that they read back exactly."""
    text = io.StringIO()
    text.write(as_comment(about(data)))
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    for s in data.series:
        name = f"{s.name} (damped)" if s.damped else s.name
        upper = s.y_upper if s.y_upper is not None else [""] * len(s.x)
        for x, y, u in zip(s.x, s.y, upper, strict=True):
            last = "" if isinstance(u, str) else repr(float(u))
            head = (data.number, s.panel, name, s.role, s.source)
            writer.writerow((*head, repr(float(x)), repr(float(y)), last))
    return text.getvalue()


def from_csv(text: str) -> tuple[Series, ...]:
    """Back to series, in order; neighbours of one name and role are one series."""
    found: list[Series] = []
    points: list[list[float]] = []
    before: tuple[str, ...] | None = None

    def close() -> None:
        if before is not None:
            panel, name, role, source = before
            x, y, u = np.array(points).T
            damped = name.endswith(" (damped)")
            upper = None if np.isnan(u).all() else u
            plain = name.removesuffix(" (damped)")
            found.append(
                Series(plain, cast(Role, role), source, x, y, upper, panel=panel, damped=damped)
            )

    for line in csv.DictReader(x for x in io.StringIO(text) if not x.startswith("#")):
        key = (line["panel"], line["series"], line["role"], line["from"])
        if key != before:
            close()
            before, points = key, []
        upper = float(line["y_upper"]) if line["y_upper"] else float("nan")
        points.append([float(line["x"]), float(line["y"]), upper])
    close()
    return tuple(found)
