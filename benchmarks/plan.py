"""How much of everything: the full run, and a quick one for development."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Plan:
    """Sizes of a run.

    Attributes
    ----------
    rounds, chart_rounds, sweep_rounds : int
        Interleaved rounds of the contenders, of the chart, of each sweep.
    target : float
        Seconds a contender is given in a round.
    most : int
        Points of a contender at most.
    reference : int
        Points at which accuracy is measured.
    chart : int
        Points of the chart.
    batch, plain : int
        Points of it for heyoka's batch at its best, and for other formulations.
    few : int
        Points for a general integrator's.
    routes : tuple of (str, int)
        Routes by which the chart is drawn, with the processes of each.
    counts, direct : tuple of int, int
        Points of the charts in the sweep; the most that are computed one by one.
    modes, referenced : tuple of int, int
        Bending modes in the sweep; the most for which the reference does not take minutes.
    tolerances : tuple of float
    """

    rounds: int
    chart_rounds: int
    sweep_rounds: int
    target: float
    most: int
    reference: int
    chart: int
    batch: int
    plain: int
    few: int
    routes: tuple[tuple[str, int], ...]
    counts: tuple[int, ...]
    direct: int
    modes: tuple[int, ...]
    referenced: int
    tolerances: tuple[float, ...]


FULL = Plan(
    rounds=9,
    chart_rounds=3,
    sweep_rounds=3,
    target=0.15,
    most=4096,
    reference=24,
    chart=10**6,
    batch=10**6,
    plain=10**5,
    few=200,
    routes=(("floquet", 1), ("hill", 1), ("both", 1), ("both", 2)),
    counts=(10**2, 10**3, 10**4, 10**5, 10**6, 10**7),
    direct=10**5,
    modes=(2, 3, 5, 8, 12, 16, 20),
    referenced=8,
    tolerances=(1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13),
)

QUICK = Plan(
    rounds=2,
    chart_rounds=1,
    sweep_rounds=1,
    target=0.03,
    most=1024,
    reference=6,
    chart=10**6,
    batch=10**5,
    plain=10**4,
    few=16,
    routes=(("floquet", 1), ("both", 1)),
    counts=(10**2, 10**4, 10**6),
    direct=10**4,
    modes=(2, 5),
    referenced=5,
    tolerances=(1e-7, 1e-11),
)
