"""The pages of a system of one's own: by both routes, its resonances, its chart."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from compare.both_routes import CrossCheck
from compare.crosscheck_text import Subject, as_dict, as_json, compared, facts, remarks, summary
from compare.pages import pictures
from compare.pages.drawing import Picture
from compare.pages.motion import Motion
from compare.pages.site import Page, Site, Table
from compare.provenance import in_words, provenance
from compare.report.match import order
from compare.vehicle.study import Study
from compare.vehicle.words import HEADS, cells, few_modes, moved, settling_table
from compare.vehicle.words import facts as vehicle_facts
from compare.vehicle.words import remarks as vehicle_remarks
from compare.vehicle.words import summary as vehicle_summary
from compare.vehicle.write import about as vehicle_about
from compare.vehicle.write import as_json as vehicle_json

DRAWABLE = 1e12
"""P's largest coefficient: beyond it a picture of P is a line up the sheet."""


@dataclass(frozen=True, eq=False)
class Charted:
    """A chart as a page shows it.

    Attributes
    ----------
    lines : tuple of str
        What was found, in words.
    picture, explorer : bytes
        As SVG, and as a page of its own that evaluates P; empty where there is none, and the lines
        say why.
    tongues : Table or None
    files : mapping of str to bytes
        Its numbers.
    """

    lines: tuple[str, ...]
    picture: bytes = b""
    explorer: bytes = b""
    tongues: Table | None = None
    files: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class OwnIndex:
    """The first page.

    Attributes
    ----------
    verdict : str
        By both routes at the forcing; empty without one.
    summary : tuple of str
    remarks : tuple of str
    facts : tuple of (str, str)
    record : mapping or None
        What JSON of `verify system` holds.
    compared : Table or None
    multipliers : tuple of (complex, complex)
        By Hill and by Floquet.
    pictures, motion : tuple of Picture
    moves : Motion or str
        What `motion` is drawn of, or why nothing is.
    proof : mapping or None
    data : tuple of str
        Files with its numbers.
    """

    verdict: str
    summary: tuple[str, ...]
    remarks: tuple[str, ...]
    facts: tuple[tuple[str, str], ...]
    record: Mapping[str, Any] | None
    compared: Table | None
    multipliers: tuple[tuple[complex, complex], ...]
    pictures: tuple[Picture, ...]
    motion: tuple[Picture, ...]
    moves: Motion | str
    proof: Mapping[str, Any] | None
    data: tuple[str, ...]


@dataclass(frozen=True)
class Resonances:
    """A vehicle's resonances, and what moves them."""

    table: Table
    moved: tuple[str, ...]
    more_modes: str
    settling: Table | None
    remarks: tuple[str, ...]


@dataclass(frozen=True)
class OwnChart:
    """The chart's page; `picture` and `explorer` are paths, or empty."""

    lines: tuple[str, ...]
    picture: str
    explorer: str
    describes: str
    tongues: Table | None
    data: tuple[str, ...]


def site(
    title: str,
    subject: Subject,
    x: CrossCheck | None,
    *,
    study: Study | None = None,
    charted: Charted | None = None,
    motion: Motion | str = "",
    edge: float | None = None,
    proof: Mapping[str, Any] | None = None,
) -> Site:
    """All pages.

    Parameters
    ----------
    title : str
        What the system is called.
    subject, x : Subject, CrossCheck or None
        What was cross-checked, and what was found; a vehicle without an operating frequency has
        no cross-check.
    study : Study, optional
        Of a vehicle.
    charted : Charted, optional
    motion : Motion or str, optional
        Or why there is none.
    edge : float, optional
        Stable z lie between it and its negative; None where there are no z.
    proof : mapping, optional
        What JSON of `verify prove` holds.
    """
    files: dict[str, bytes] = {}
    if x is not None:
        files["system.json"] = as_json(subject, x).encode()
    if study is not None:
        files["vehicle.json"] = vehicle_json(title, study).encode()
    index = _index(title, subject, x, study, motion, edge, proof, tuple(files))
    pages = [Page("index.html", f"{title}: what was found", "own.html", index)]
    if study is not None:
        content = _resonances(study)
        pages.append(Page("resonances.html", f"{title}: resonances", "resonances.html", content))
    if charted is not None:
        files |= charted.files
        shown = {"chart.svg": charted.picture, "explore.html": charted.explorer}
        files |= {name: data for name, data in shown.items() if data}
        chart = OwnChart(
            charted.lines,
            "chart.svg" if charted.picture else "",
            "explore.html" if charted.explorer else "",
            _in_one(charted.lines),
            charted.tongues,
            tuple(charted.files),
        )
        pages.append(Page("chart.html", f"{title}: chart", "chart.html", chart))
    about = vehicle_about(study) if study else subject.about
    names = {"index.html": "Found", "resonances.html": "Resonances", "chart.html": "Chart"}
    return Site(
        name=title,
        navigation=tuple((names[page.path], page.path) for page in pages),
        pages=tuple(pages),
        made=in_words(about),
        about=provenance(about),
        files=files,
    )


def _in_one(lines: Sequence[str]) -> str:
    return "The growth T as colour, tongues by name. " + " ".join(lines)


def _index(
    title: str,
    subject: Subject,
    x: CrossCheck | None,
    study: Study | None,
    motion: Motion | str,
    edge: float | None,
    proof: Mapping[str, Any] | None,
    data: tuple[str, ...],
) -> OwnIndex:
    told = vehicle_summary(title, study) if study else ()
    known = [("", line) for line in vehicle_facts(study)] if study else []
    common: dict[str, Any] = {
        "proof": proof,
        "data": data,
        "motion": pictures.of_motion(motion),
        "moves": motion,
    }
    if x is None:
        return OwnIndex("", told, (), tuple(known), None, None, (), (), **common)
    table = Table("What either route says", ("", "Hill", "Floquet"), tuple(compared(x)))
    one, other = (tuple(map(complex, r.multipliers)) for r in (x.hill, x.floquet))
    paired = tuple(other[k] for k in order(one, other)) if len(one) == len(other) else other
    return OwnIndex(
        verdict=x.verdict,
        summary=(*told, *summary(subject, x)),
        remarks=tuple(f"{who}: {said}." for who, said in remarks(x)),
        facts=(*known, *facts(subject)),
        record=as_dict(subject, x),
        compared=table,
        multipliers=tuple(zip(one, paired, strict=False)),
        pictures=_drawn(x, edge),
        **common,
    )


def _drawn(x: CrossCheck, edge: float | None) -> tuple[Picture, ...]:
    one, other = (tuple(map(complex, r.multipliers)) for r in (x.hill, x.floquet))
    circle = pictures.multipliers(one, other)
    if edge is None or not np.max(np.abs(x.floquet.polynomial)) < DRAWABLE:
        return (circle,)
    roots = pictures.Roots(
        polynomial=tuple(map(float, x.floquet.polynomial)),
        hill=tuple(map(complex, x.hill.z)),
        floquet=tuple(map(complex, x.floquet.z)),
        edge=edge,
    )
    return circle, pictures.whole(roots), pictures.closest(roots)


def _resonances(study: Study) -> Resonances:
    heads, rows = settling_table(study)
    return Resonances(
        table=Table(
            "Resonances, the most dangerous first", HEADS, tuple(map(cells, study.rows)), words=2
        ),
        moved=tuple(moved(row) for row in study.rows if row.effects),
        more_modes=few_modes(study),
        settling=Table("With more modes", tuple(heads), tuple(map(tuple, rows)), words=2)
        if rows
        else None,
        remarks=tuple(vehicle_remarks(study)),
    )
