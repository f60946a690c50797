"""P, its roots and T as balls that hold the true values, by the time domain; needs python-flint."""

from collections.abc import Sequence
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from hill import HillEquation, PeriodicEquation, SteppedBeam, UniformBeam, checks
from hill.decimals import Number

if TYPE_CHECKING:
    from floquet.enclosure.region import Over, Progress
    from floquet.enclosure.result import Enclosure, IntervalProof, RegionProof

NO_BALLS = "enclosures need python-flint: pip install 'floquet-crosscheck[proof]'"

System = HillEquation | PeriodicEquation | UniformBeam | SteppedBeam


def enclose(
    what: System,
    *,
    Omega: Number | None = None,
    gamma: Number | None = None,
    eta: Number = 0.0,
    initial_terms: int = 0,
    ratio: int | None = None,
    bits: int = 140,
) -> "Enclosure":
    """Enclose the characteristic polynomial, its roots and T.

    An undamped equation, or one whose damping is one number, is summed as a power series in
    sin^2(Omega tau/2); any other goes by Taylor steps over the whole period. What they leave out is
    bounded, by Cauchy's estimate, and part of the balls.

    Parameters
    ----------
    what : HillEquation, PeriodicEquation, UniformBeam or SteppedBeam
        An equation is taken with its floats as they are. A beam is taken with its parameters as
        they are written in decimals, and its matrices are integrated in ball arithmetic.
    Omega, gamma, eta : float, str or Fraction
        The forcing of a beam; an equation has its own.
    initial_terms, ratio : int, optional
        Of a beam: how many H_s there are, and omega_L as an exact multiple of Omega.
    bits : int, optional
        To which P's coefficients are known, of the largest.

    Returns
    -------
    Enclosure

    Raises
    ------
    ValueError
        python-flint is not there; a forcing beside an equation, or none for a beam; a number out of
        range; a system that takes more steps or digits than are spent.
    """
    if find_spec("flint") is None:
        raise ValueError(NO_BALLS)
    from floquet.enclosure import prove

    forcing = {"Omega": Omega, "gamma": gamma}
    if isinstance(what, HillEquation | PeriodicEquation):
        given = any(v is not None for v in (*forcing.values(), ratio)) or eta != 0 or initial_terms
        if given:
            raise ValueError("Omega, gamma, eta: an equation has its own; leave them out")
        return prove.of_equation(what, bits)
    return prove.of_beam(_beam(what), _given(forcing), eta, initial_terms, ratio, bits)


def enclose_interval(
    beam: UniformBeam | SteppedBeam,
    *,
    Omega: tuple[Number, Number],
    gamma: Number,
    eta: Number = 0.0,
    initial_terms: int = 0,
    ratio: int | None = None,
) -> "IntervalProof":
    """Prove what holds for every Omega of an interval.

    Returns
    -------
    IntervalProof
        Parts of the interval on which the beam is shown to be stable or unstable, and the rest.

    Raises
    ------
    ValueError
        As `enclose`; and matrices that move with Omega, of a finite omega_L without `ratio`.
    """
    if find_spec("flint") is None:
        raise ValueError(NO_BALLS)
    from floquet.enclosure import interval

    return interval.prove(_beam(beam), Omega, gamma, eta, initial_terms, ratio)


def enclose_region(
    what: UniformBeam | SteppedBeam | HillEquation,
    *,
    Omega: Sequence[Number],
    gamma: Sequence[Number],
    eta: Number = 0.0,
    halvings: int = 9,
    over: "Over" = map,
    progress: "Progress | None" = None,
) -> "RegionProof":
    """Prove what holds at every point of the cells of a grid in Omega and gamma.

    Parameters
    ----------
    what : UniformBeam, SteppedBeam or HillEquation
        Of an equation F, G and the damping are taken, as floats.
    Omega, gamma : sequence of float, str or Fraction
        The cells' edges, ascending.
    eta : float, str or Fraction, optional
        Of a beam.
    halvings : int, optional
        How often what is not decided is halved.
    over : map-like, optional
        Maps like `map`, in order; the enclosures are its jobs.
    progress : callable, optional
        Called with what is being done, how much of it is done, and of how much.

    Returns
    -------
    RegionProof

    Raises
    ------
    ValueError
        As `enclose`; matrices that move with Omega, H, a damping matrix; no natural frequencies, by
        flutter or buckling; ranges that take too many enclosures.
    """
    if find_spec("flint") is None:
        raise ValueError(NO_BALLS)
    from floquet.enclosure import region

    halvings = checks.count("halvings", halvings, least=0)
    given = what if isinstance(what, HillEquation) else _beam(what)
    return region.prove(given, Omega, gamma, eta, halvings, over, progress)


def _beam(what: Any) -> UniformBeam | SteppedBeam:
    if not isinstance(what, UniformBeam | SteppedBeam):
        raise ValueError(
            f"{type(what).__name__}: must be a HillEquation, a PeriodicEquation, a UniformBeam or "
            "a SteppedBeam"
        )
    return what


def _given(forcing: dict[str, Number | None]) -> tuple[Number, Number]:
    for name, value in forcing.items():
        if value is None:
            raise ValueError(f"{name}: must be given for a beam")
    Omega, gamma = forcing.values()
    assert Omega is not None
    assert gamma is not None
    return Omega, gamma
