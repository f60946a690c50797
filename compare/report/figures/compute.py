"""From a figure's number to what it shows."""

from collections.abc import Callable

from compare.report.figures.catalogue import FIGURES, Figure
from compare.report.figures.compliance import integral, of_longitudinal_frequency
from compare.report.figures.coupled import coupled_regions
from compare.report.figures.critical import critical_values
from compare.report.figures.data import FigureData
from compare.report.figures.frequencies import steady_frequencies
from compare.report.figures.growth import near_longitudinal_resonance, near_resonances
from compare.report.figures.regions import instability_regions

KINDS: dict[str, Callable[[Figure, float], FigureData]] = {
    "frequencies": steady_frequencies,
    "growth": near_resonances,
    "regions": instability_regions,
    "critical": critical_values,
    "compliance": of_longitudinal_frequency,
    "integral": integral,
    "resonant": near_longitudinal_resonance,
    "coupled": coupled_regions,
}

# A damped figure starts from its undamped one: computed together, that is done once.
TOGETHER = ((9, 15), (10, 16), (18, 24), (19, 25))


def compute(number: int, detail: float = 1.0) -> FigureData:
    """What a figure shows.

    Parameters
    ----------
    number : int
        3 to 29.
    detail : float, optional
        Share of the usual number of points.

    Raises
    ------
    ValueError
        The report has no such figure, or it is not one of results.
    """
    figure = named(number)
    return KINDS[figure.kind](figure, detail)


def named(number: int) -> Figure:
    """A figure by its number."""
    if number not in FIGURES:
        raise ValueError(
            f"figure = {number}: must be one of {min(FIGURES)} to {max(FIGURES)} "
            "(Figures 1 and 2 are sketches)"
        )
    return FIGURES[number]


def tasks(numbers: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Figures in groups for one process each, the slow ones first."""
    groups = [tuple(n for n in group if n in numbers) for group in TOGETHER]
    rest = [n for n in numbers if not any(n in group for group in groups)]
    slow_first = sorted(rest, key=lambda n: -n if n > 25 or n in (8, 17) else 0)
    return [group for group in groups if group] + [(n,) for n in slow_first]
