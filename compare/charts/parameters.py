"""A chart's parameters: which there are, how one varies, and the equation at a point."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from floquet.weak_form import galerkin
from hill import HillEquation, SteppedBeam, UniformBeam, checks
from hill.errors import LongitudinalResonance

Float = NDArray[np.floating[Any]]
Beam = UniformBeam | SteppedBeam

MOST_POINTS = 50_000_000
"""Of a whole chart: T, P and the verdict of a point take some 100 bytes together."""

FORCING = ("Omega", "gamma", "eta")
WHOLE = ("modes",)
MARGIN = 1.1

CHARTED = (1e-3, 1e6)
"""Omega, over omega_1, that a chart may have; a beam moves at about 1."""

MOST_DECAY = 200.0
"""eta/Omega: exp(-pi eta/Omega) stays above 1e-273."""

MOST_RADIANS = 3000.0
"""Of the fastest motion in a period; one evaluation then takes a tenth of a second, and a growth as
fast as that leaves the floats four times over."""

NEAR = 0.25
"""Widths of a box: a series over it whose nearest pole is farther than this converges by 2.6 a
term, whatever the residue."""


@dataclass(frozen=True)
class Axis:
    """One varied parameter: `count` points from `low` to `high`.

    Raises
    ------
    ValueError
        `low` not below `high`, or fewer than 2 points.
    """

    name: str
    low: float
    high: float
    count: int

    def __post_init__(self) -> None:
        low = checks.number(f"{self.name} from", self.low)
        high = checks.number(f"{self.name} to", self.high)
        if checks.count(f"points of {self.name}", self.count, least=2) > MOST_POINTS:
            raise ValueError(
                f"points of {self.name} = {self.count}: must be at most {MOST_POINTS:,}"
            )
        if not low < high:
            raise ValueError(f"{self.name} from {low:g} to {high:g}: must ascend")
        if self.name == "Omega" and low <= 0.0:
            raise ValueError(f"Omega from {low:g}: must be greater than 0")

    @property
    def points(self) -> Float:
        """Where the chart is evaluated."""
        return np.linspace(self.low, self.high, self.count)

    def to_smooth(self, value: Float) -> Float:
        """The variable in which P(z) is smooth: P depends on Omega through 1/Omega."""
        return 1.0 / value if self.name == "Omega" else np.asarray(value, float)

    def from_smooth(self, value: Float) -> Float:
        """Back again."""
        return self.to_smooth(value)

    @property
    def span(self) -> tuple[float, float]:
        """The axis in its smooth variable, ascending; Omega a little wider than it is drawn.

        A boundary is looked for in a window about its resonance, which may reach over the edge.
        """
        margin = MARGIN if self.name == "Omega" else 1.0
        ends = sorted(float(self.to_smooth(np.asarray(v))) for v in self._ends(margin))
        return ends[0], ends[1]

    def _ends(self, margin: float) -> tuple[float, float]:
        return self.low / margin, self.high * margin


@dataclass(frozen=True)
class Family:
    """A beam and its forcing, with some parameters left to vary.

    Attributes
    ----------
    beam : UniformBeam or SteppedBeam
    forcing : mapping
        Omega, gamma and eta, as far as they are fixed.
    """

    beam: Beam
    forcing: Mapping[str, float] = field(default_factory=dict)

    def check(self, axes: tuple[Axis, ...]) -> None:
        """Refuse parameters that the beam does not have, twice or not at all."""
        names = [axis.name for axis in axes]
        known = [f.name for f in fields(self.beam) if f.name not in WHOLE] + list(FORCING)
        for name in names:
            if name not in known:
                raise ValueError(f"axis = {name!r}: must be one of {', '.join(known)}")
            if names.count(name) > 1:
                raise ValueError(f"axis = {name!r}: is there twice")
        for name, value in self.forcing.items():
            if name not in FORCING:
                raise ValueError(f"{name}: must be one of {', '.join(FORCING)}")
            checks.number(name, value)
            if name in names:
                raise ValueError(f"{name} = {value:g}: is an axis too; leave one of them out")
        missing = {"Omega", "gamma"} - set(names) - set(self.forcing)
        if missing:
            raise ValueError(f"{min(missing)}: has no value; fix it, or make it an axis")
        # the corners find what the ranges would run into later
        for corner in product(*((axis.low, axis.high) for axis in axes)):
            self._check_corner(dict(zip(names, corner, strict=True)))

    def _check_corner(self, varied: Mapping[str, float]) -> None:
        """Refuse what would take for ever, or leave the floats, far into the work."""
        beam, forcing = self.at(varied)
        where = ", ".join(f"{k} = {v:g}" for k, v in (dict(varied) or forcing).items())
        Omega, gamma, eta = (forcing[name] for name in ("Omega", "gamma", "eta"))
        checks.between("Omega", checks.positive("Omega", Omega), *CHARTED)
        if abs(eta) > MOST_DECAY * Omega:
            raise ValueError(
                f"{where}: eta/Omega = {eta / Omega:.3g} must be at most {MOST_DECAY:g}, or a "
                "period's decay leaves the floats"
            )
        try:
            model = beam.equation(Omega, gamma, eta)
        except LongitudinalResonance:  # the corner's own misfortune
            return
        fastest = np.sqrt(np.linalg.norm(model.F, 2) + abs(gamma) * np.linalg.norm(model.G, 2))
        radians = 2.0 * np.pi * float(fastest) / Omega
        if not radians <= MOST_RADIANS:
            raise ValueError(
                f"{where}: the motion turns by {radians:.1e} radians a period, and "
                f"{MOST_RADIANS:g} at most can be charted"
            )

    def at(self, varied: Mapping[str, float]) -> tuple[Beam, dict[str, float]]:
        """The beam and the forcing at a point."""
        forcing = {"eta": 0.0} | dict(self.forcing)
        forcing |= {name: float(varied[name]) for name in FORCING if name in varied}
        own = {name: float(value) for name, value in varied.items() if name not in FORCING}
        return (replace(self.beam, **own) if own else self.beam), forcing  # type: ignore[arg-type]

    @property
    def coordinates(self) -> int:
        """Coordinates of the system, n."""
        return self.beam.modes + 1

    def singular(self, low: Mapping[str, float], high: Mapping[str, float]) -> str | None:
        """The parameter to cut by where a longitudinal resonance is in a box, or close by; or None.

        The system says where its resonances are; the box counts with a margin of `NEAR` on each
        side, in Omega/omega_L, so that a series over it has none at its door.
        """
        beams, ratios = [], []
        for corner in product(*((low[name], high[name]) for name in low)):
            beam, forcing = self.at(dict(zip(low, corner, strict=True)))
            omega_L = getattr(beam, "omega_L", np.inf)
            if not hasattr(beam, "longitudinal_resonances") or np.isinf(omega_L):
                return None
            beams.append(beam)
            ratios.append(forcing["Omega"] / omega_L)
        least, most = min(ratios), max(ratios)
        margin = NEAR * (most - least) + 1e-9 * most
        least, most = max(least - margin, 0.0), most + margin
        distinct = set(beams)
        below = {len(beam.longitudinal_resonances(0.0, least)) for beam in distinct}
        # one that is on another side of the box at another corner has passed through
        if len(below) == 1 and not any(
            len(beam.longitudinal_resonances(least, most)) for beam in distinct
        ):
            return None
        spans = {
            name: high[name] / low[name] - 1.0 if low[name] > 0.0 else np.inf
            for name in low
            if name not in ("gamma", "eta", "T0", "K_theta", "xi_G", "g", "inertia_ratio")
        }
        return max(spans, key=lambda name: spans[name]) if spans else None

    def equations(self, points: Mapping[str, Float], *, closed_form: bool) -> list[HillEquation]:
        """The equations at many points, their matrices made once where they are the same.

        Parameters
        ----------
        points : mapping of str to (k,) ndarray
        closed_form : bool
            Matrices from the report's formulas, or by quadrature of the weak form.
        """
        made: dict[Any, HillEquation] = {}
        found = []
        for values in zip(*points.values(), strict=True):
            beam, forcing = self.at(dict(zip(points, map(float, values), strict=True)))
            # without compliance F and G do not know Omega
            rigid = np.isinf(beam.omega_L)
            key = (beam, None if rigid else forcing["Omega"])
            if key not in made:
                source = beam.equation if closed_form else _quadrature(beam)
                made[key] = source(forcing["Omega"], forcing["gamma"], forcing["eta"])
            found.append(made[key].forced(**forcing))
        return found


def _quadrature(beam: Beam) -> Any:
    return lambda Omega, gamma, eta: galerkin(beam, Omega, gamma, eta)
