"""What the thrust's pulsation does to a vehicle: everything that `verify vehicle` tells."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from compare.both_routes import CrossCheck, crosscheck
from compare.vehicle.candidates import Candidate, candidates
from compare.vehicle.convergence import Settling, settling
from compare.vehicle.critical import critical_gamma
from compare.vehicle.near import Band, Near
from compare.vehicle.sensitivity import Effect, effects, same_effects, witnessed_effects
from compare.vehicle.witnessed import Witnessed, witnessed
from hill import CriticalThrust, Vehicle, critical_thrust
from hill.averaging import Resonance, first_order
from hill.errors import Refused
from hill.oscillations.steady import Steady, steady
from hill.vehicle.inertia import RigidBody, rigid_body

Stage = Callable[[str, int, int], None]

# Resonances that are looked at closely, of those that averaging finds the most dangerous.
CLOSELY = 20

# Of the vehicle's own: a thrust that is smaller is not looked at; with many modes.
LEAST_THRUST, LEAST_THRUST_MANY = 1e-3, 1e-2

# Modes beyond which less is asked of more of them: the whole study has some seconds.
FEW_MODES = 10

# Resonances, and times that two modes are added, to tell what more modes change; with many modes.
SETTLING, MORE = 6, 5
SETTLING_MANY, MORE_MANY = 1, 3

# And of these, by the witness too, and for what helps.
WITNESSED = 6


NO_PULSATION = "gamma = 0: must not be 0, there is no parametric resonance without it"


@dataclass(frozen=True, eq=False)
class Row:
    """One resonance.

    Attributes
    ----------
    band : Band
    critical : float or None
        The pulsation at which it opens; None where it does not.
    witnessed : Witnessed or None
        The time domain's word at the band's worst Omega; None where it was not asked.
    effects : tuple of Effect
        What moves T there the most.
    """

    band: Band
    critical: float | None
    witnessed: Witnessed | None = None
    effects: tuple[Effect, ...] = ()

    @property
    def resonance(self) -> Resonance:
        """Which."""
        return self.band.resonance

    @property
    def opens(self) -> bool:
        """Whether it is unstable at the asked pulsation."""
        return self.band.edges is not None


@dataclass(frozen=True, eq=False)
class Study:
    """Attributes are in the vehicle's units; frequencies in radians per unit of time.

    Attributes
    ----------
    vehicle : Vehicle
    gamma, eta : float
    Omega : float or None
        The operating pulsation.
    low, high : float
        The range of Omega that was looked at.
    orders : int
    body : RigidBody
    free : tuple of float
        Frequencies without thrust, of the elastic modes.
    alone : Steady
        Under the mean thrust.
    loss : CriticalThrust or None
        Where steady thrust is too much, its `kind` "none" where it is nowhere found; None without
        thrust.
    operating : CrossCheck or None
        Both routes at the operating pulsation.
    rows : tuple of Row
        The resonances looked at closely, the most dangerous first.
    others : tuple of Candidate
        The rest of the range, by averaging only.
    refused : tuple of str
        Resonances within others' bands, and why they have none of their own.
    settling : tuple of Settling
        What more modes change of the steady thrust and of the first rows; empty where a damping
        matrix fixes the number of modes.
    """

    vehicle: Vehicle
    gamma: float
    eta: float
    Omega: float | None
    low: float
    high: float
    orders: int
    body: RigidBody
    free: tuple[float, ...]
    alone: Steady
    loss: CriticalThrust | None
    operating: CrossCheck | None
    rows: tuple[Row, ...]
    others: tuple[Candidate, ...]
    refused: tuple[str, ...]
    settling: tuple[Settling, ...]

    @property
    def open_rows(self) -> tuple[Row, ...]:
        """The bands there are at this pulsation, the nearest to the operating one first."""
        found = [row for row in self.rows if row.opens]
        if self.Omega is None:
            return tuple(sorted(found, key=lambda row: -row.band.T))
        return tuple(sorted(found, key=lambda row: distance(row.band, self.Omega or 0.0)))

    @property
    def of_itself(self) -> bool:
        """Whether the range is the one that is taken where none is asked for."""
        return (self.low, self.high) == _own_range(self.alone)

    @property
    def steadily_lost(self) -> bool:
        """Whether the vehicle is unstable without pulsation."""
        return self.loss is not None and self.loss.margin(self.vehicle) <= 1.0

    @property
    def routes_agree(self) -> bool:
        """Wherever both were asked."""
        asked = [row.witnessed.agrees for row in self.rows if row.witnessed]
        asked += [same_effects(row.effects) for row in self.rows]
        return all(asked) and (self.operating is None or self.operating.routes_agree)


def distance(band: Band, Omega: float) -> float:
    """From Omega to a band; 0 within it."""
    assert band.edges is not None
    low, high = band.edges
    return max(low - Omega, Omega - high, 0.0)


def study(
    vehicle: Vehicle,
    *,
    gamma: float,
    eta: float = 0.0,
    Omega: float | None = None,
    span: tuple[float, float] | None = None,
    orders: int = 2,
    closely: int = CLOSELY,
    witness: int = WITNESSED,
    more: int | None = None,
    stage: Stage = lambda *_: None,
) -> Study:
    """Study a vehicle.

    Parameters
    ----------
    vehicle : Vehicle
    gamma : float
        Pulsation ratio, not 0.
    eta : float, optional
        Damping beside the vehicle's own.
    Omega : float, optional
        The operating pulsation, radians per unit of time.
    span : (float, float), optional
        Omega between which resonances are looked for; up to twice the fourth elastic frequency by
        default.
    orders : int, optional
    closely, witness : int, optional
        How many resonances are solved for, and how many of these by the time domain too.
    more : int, optional
        How often two modes are added to see what they change, 3 or more times.
    stage : callable, optional
        Called with what is done, how much of it, and how much there is of it.

    Raises
    ------
    ValueError
        `gamma` is 0; whatever is out of range.
    """
    if gamma == 0.0:
        raise ValueError(NO_PULSATION)
    scale = Omega or 1.0
    alone = steady(vehicle.equation(scale, 0.0, eta))
    frequencies = alone.frequencies
    if not len(frequencies):
        raise ValueError(
            f"thrust = {vehicle.thrust.mean:g}: nothing oscillates under it, so that no "
            "resonance is to be found"
        )
    low, high = span or _own_range(alone)

    def near(resonance: Resonance, at: float) -> Near:
        return Near(lambda x: vehicle.equation(x, at, eta), resonance, alone)

    stage("resonances guessed", 0, 0)
    anyone = first_order(1)[0]
    names = vehicle.frequency_names
    listed = candidates(near(anyone, gamma), names, orders, low, high)
    rows, refused = [], []
    for done, candidate in enumerate(listed[:closely]):
        stage("resonances solved", done, min(closely, len(listed)))
        try:
            rows.append(_row(lambda at, r=candidate.resonance: near(r, at), gamma))  # type: ignore[misc]
        except Refused as why:
            refused.append(str(why))
    rows.sort(key=lambda row: (-row.opens, -row.band.T if row.opens else row.critical or math.inf))
    operating = None
    if Omega is not None:
        stage("both routes at the operating pulsation", 0, 0)
        operating = crosscheck(vehicle, Omega=Omega, gamma=gamma, eta=eta)
    for done in range(min(witness, len(rows))):
        stage("both routes", done, min(witness, len(rows)))
        rows[done] = replace(
            rows[done], witnessed=witnessed(vehicle, gamma, eta, rows[done].band, alone)
        )
    told = effects(
        vehicle,
        gamma,
        eta,
        [row.band for row in rows[:witness]],
        lambda k, n: stage("effects", k, n),
    )
    rows = [replace(row, effects=own) for row, own in zip(rows, told, strict=False)] + rows[
        witness:
    ]
    for done, row in enumerate(rows[:witness]):
        if row.witnessed is not None and row.witnessed.agrees and not row.witnessed.another:
            stage("effects by both routes", 0, 0)
            own = witnessed_effects(vehicle, gamma, eta, row.band, row.witnessed, row.effects)
            rows[done] = replace(row, effects=own)
            break
    stage("steady thrust", 0, 0)
    loss = _loss(vehicle, eta)
    few = vehicle.modes <= FEW_MODES
    settled = settling(
        vehicle,
        gamma,
        eta,
        loss,
        [(row.band, row.critical) for row in rows[: SETTLING if few else SETTLING_MANY]],
        more or (MORE if few else MORE_MANY),
        lambda k, n: stage("more modes", k, n),
    )
    return Study(
        vehicle=vehicle,
        gamma=gamma,
        eta=eta,
        Omega=Omega,
        low=low,
        high=high,
        orders=orders,
        body=rigid_body(vehicle),
        free=tuple(float(2.0 * math.pi * f) for f in vehicle.frequencies()),
        alone=alone,
        loss=loss,
        operating=operating,
        rows=tuple(rows),
        others=tuple(listed[closely:]),
        refused=tuple(refused),
        settling=settled,
    )


def _own_range(alone: Steady) -> tuple[float, float]:
    frequencies = alone.frequencies
    return 0.0, 2.0 * float(frequencies[min(4, len(frequencies) - 1)])


def _row(near: Callable[[float], Near], gamma: float) -> Row:
    at = near(gamma)
    band = at.band()
    return Row(band, critical_gamma(near, band, gamma))


def _loss(vehicle: Vehicle, eta: float) -> CriticalThrust | None:
    if not vehicle.thrust.mean:
        return None
    damping = replace(vehicle.damping, eta=vehicle.damping.eta + eta)
    share = LEAST_THRUST if vehicle.modes <= FEW_MODES else LEAST_THRUST_MANY
    least = share * abs(vehicle.thrust.mean)
    return critical_thrust(replace(vehicle, damping=damping), least=least)
