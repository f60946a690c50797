"""The page: each source's numbers in a table."""

import textwrap
from collections.abc import Sequence

from benchmarks.validation import beams, periodic
from benchmarks.validation.comparison import Comparison, Source

SOURCES = (
    periodic.mathieu_values,
    periodic.exponents,
    periodic.coupled,
    periodic.friswell,
    beams.frequencies,
    beams.nastran,
    beams.loads,
    beams.rotating,
)

HEADS = "| of | printed | hill | floquet | the same |\n| --- | ---: | ---: | ---: | --- |"

INTRODUCTION = """\
# Outside numbers, ours beside them

<!-- Written by python -m benchmarks.validation from the computation. -->

Numbers that others printed or that are known in closed form, and what each route makes of the same
system. "Yes": both come within half a unit of the last printed digit and what double precision may
add; "to a unit": within a whole one, the source having cut digits off or rounded twice. The
report's own printed numbers are another matter, and most of them differ: [errata](errata.md).
Random systems and difficult classes, to which nobody has printed answers, are held against extended
precision by `python -m benchmarks.honesty`; Abramowitz and Stegun's table 20.1 by
`verify --publication mathieu`."""


def page(sources: Sequence[Source]) -> str:
    """As Markdown."""
    numbers = [number for source in sources for number in source.numbers]
    same = sum(number.found == "yes" for number in numbers)
    cut = sum(number.found == "to a unit" for number in numbers)
    summary = f"> {len(numbers)} numbers: {same} are the same, {cut} to a unit of the last digit, "
    summary += f"{len(numbers) - same - cut} differ."
    return "\n\n".join([INTRODUCTION, summary, *map(section, sources)]) + "\n"


def section(source: Source) -> str:
    """A heading, words and a table."""
    lines = [line(number) for number in source.numbers]
    words = textwrap.fill(source.words, 100)
    return "\n\n".join([f"## {source.title}", words, "\n".join([HEADS, *lines])])


def line(number: Comparison) -> str:
    """Of the table."""
    return "| " + " | ".join(number.cells()) + " |"
