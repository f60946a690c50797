"""What both routes can be asked about: a system, its parameters, and one made of matrices."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, Literal, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hill import checks
from hill.equation import HillEquation
from hill.oscillations.steady import mean_frequencies

Complex = NDArray[np.complexfloating[Any, Any]]
Float = NDArray[np.float64]

FORCING = ("Omega", "gamma", "eta")
"""What every system is asked at; no parameter of its own may be called so."""

SMOOTH = ("value", "reciprocal", "ratio")


@dataclass(frozen=True)
class Parameter:
    """A number of a system that may be varied.

    Attributes
    ----------
    name : str
    low, high : float
        Between which it has a meaning.
    dependence : {"analytic", "linear"}
        How F, G and H move with it: analytically between singular points, or linearly everywhere
        (a constant and a slope).
    smooth : {"value", "reciprocal", "ratio"}
        The variable in which a chart's series runs: the parameter itself; one over it (for a
        length, say, that is divided by); or Omega over it, where the system knows a frequency by
        that ratio alone, so that its poles are there. `low` must then be 0 or more.
    moves : tuple of str
        Which of "F", "G" and "H" move with it.
    """

    name: str
    low: float = -math.inf
    high: float = math.inf
    dependence: Literal["analytic", "linear"] = "analytic"
    smooth: Literal["value", "reciprocal", "ratio"] = "value"
    moves: tuple[str, ...] = ("F", "G", "H")

    def __post_init__(self) -> None:
        if self.name in FORCING:
            raise ValueError(f"parameter = {self.name!r}: must not be called like the forcing")
        for name, known in (("dependence", ("analytic", "linear")), ("smooth", SMOOTH)):
            if getattr(self, name) not in known:
                raise ValueError(
                    f"parameter {self.name!r}: {name} = {getattr(self, name)!r}: must be one of "
                    f"{', '.join(known)}"
                )
        if self.smooth != "value" and not self.low >= 0.0:
            raise ValueError(
                f"parameter {self.name!r}: low = {self.low:g}: must be at least 0 with "
                f"smooth = {self.smooth!r}"
            )


@runtime_checkable
class System(Protocol):
    """Anything that has an equation under every forcing.

    A frozen dataclass whose fields of the parameters' names are numbers needs no more than this.
    What else it may have:

    frequency_names
        A sequence of str, one a natural frequency, ascending; "1", "2", ... where there is none.
    depends_on_Omega
        Whether F and G move with Omega. To have it at all is to promise that they do not move with
        gamma and eta, and that the equation's forcing is the one that was asked for: a chart then
        makes them once for many points. (It looks at a few, and refuses a promise not kept.)
    singular_Omega(low, high)
        Forcing frequencies between `low` and `high` at which there is no equation, because a
        coefficient has a pole there; ``equation`` raises `hill.errors.Singular` at them.
    natural_frequencies()
        Of the unforced, undamped system; from F where it is not there.
    varied(name=value, ...)
        The system with other values of some parameters, where it is no dataclass.
    values
        A mapping of the parameters' names to their numbers, where they are no attributes.
    damping_apart()
        The system without the damping that it adds to eta, and that damping.
    """

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What may be varied."""
        ...

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> Any:
        """The equation at a forcing."""
        ...


def parameter_values(system: System) -> dict[str, float]:
    """The numbers of a system by their names."""
    own = getattr(system, "values", None)
    given = own if isinstance(own, Mapping) else vars(system)
    return {p.name: float(given[p.name]) for p in system.parameters}


def varied(system: Any, values: Mapping[str, float]) -> Any:
    """The system with other values of some parameters.

    Raises
    ------
    ValueError
        A name that it does not have, or a value out of its range.
    """
    known = {p.name: p for p in system.parameters}
    for name, value in values.items():
        if name not in known:
            raise ValueError(f"{name}: must be one of {', '.join(known) or 'none'}")
        if value != math.inf:  # what is too large for the system it says itself
            checks.between(name, value, known[name].low, known[name].high)
    if not values:
        return system
    if hasattr(system, "varied"):
        return system.varied(**values)
    if is_dataclass(system) and not isinstance(system, type):
        return replace(system, **values)
    raise ValueError(f"{type(system).__name__}: must be a dataclass, or have varied(**values)")


def with_damping_apart(system: Any, eta: float) -> tuple[Any, float]:
    """The same under the same damping, all of it in eta, by which a chart reads T."""
    bare, own = system.damping_apart() if hasattr(system, "damping_apart") else (system, 0.0)
    return bare, eta + own


def natural_frequencies(system: System, Omega: float = 1.0) -> Complex:
    """Of the unforced, undamped system, ascending by real part; complex where it is unstable.

    The square roots of F's eigenvalues, F at `Omega`, where the system does not say them itself;
    of a general equation those of its mean.
    """
    if hasattr(system, "natural_frequencies"):
        return np.asarray(system.natural_frequencies(), complex)
    equation = system.equation(Omega, 0.0)
    if not isinstance(equation, HillEquation):
        return mean_frequencies(equation)
    squares = np.linalg.eigvals(equation.F).astype(complex)
    found = np.sqrt(squares)
    return np.asarray(found[np.lexsort((found.imag, found.real))])


def frequency_names(system: System, count: int) -> tuple[str, ...]:
    """What the system calls its natural frequencies, ascending: "1", "2", ... if it does not.

    Raises
    ------
    ValueError
        It has other than `count` names.
    """
    given = getattr(system, "frequency_names", None)
    if given is None:
        return tuple(str(k) for k in range(1, count + 1))
    if len(given) != count:
        raise ValueError(f"frequency_names: must be {count}, one a frequency; got {len(given)}")
    return tuple(map(str, given))


def singular_Omega(system: Any, low: float, high: float) -> Float:
    """Forcing frequencies between `low` and `high` where the system has no equation, ascending."""
    if not hasattr(system, "singular_Omega"):
        return np.empty(0)
    return np.sort(np.asarray(system.singular_Omega(low, high), float))


@dataclass(frozen=True, eq=False)
class MatrixSystem:
    r"""A system of given matrices, M q'' + eta M q' + (F + gamma cos(Omega tau) G) q = 0.

    Parameters
    ----------
    F, G : (n, n) array_like
        Constant and pulsating stiffness; any consistent unit of frequency, squared.
    M : (n, n) array_like, optional
        Mass, constant and nonsingular. F and G are divided by it.
    H : sequence of (n, n) array_like, optional
        ``H[s - 1]`` multiplies ``cos(s omega_L tau)``.
    omega_L : float, optional
        A whole multiple of Omega, with `H`.
    F_terms, G_terms : mapping of str to (n, n) array_like, optional
        Parameters of one's own: F gains ``values[name] * F_terms[name]``, G likewise.
    values : mapping of str to float, optional
        Their values; 0 where none is given.
    frequency_names : sequence of str, optional
        One a coordinate, ascending.

    Raises
    ------
    ValueError
        As `HillEquation`; a singular M; a value for a term that is not there.
    """

    F: Float
    G: Float
    H: tuple[Float, ...]
    omega_L: float
    F_terms: Mapping[str, Float]
    G_terms: Mapping[str, Float]
    values: Mapping[str, float]
    frequency_names: tuple[str, ...] | None

    def __init__(
        self,
        F: ArrayLike,
        G: ArrayLike,
        *,
        M: ArrayLike | None = None,
        H: Sequence[ArrayLike] = (),
        omega_L: float = math.inf,
        F_terms: Mapping[str, ArrayLike] | None = None,
        G_terms: Mapping[str, ArrayLike] | None = None,
        values: Mapping[str, float] | None = None,
        frequency_names: Sequence[str] | None = None,
    ) -> None:
        stiffness = checks.square("F", F)
        n = len(stiffness)
        over = _divider(M, n)
        own = {
            f"{which}_terms": {
                name: over(checks.square(f"{which}_terms[{name!r}]", term, n=n))
                for name, term in (terms or {}).items()
            }
            for which, terms in (("F", F_terms), ("G", G_terms))
        }
        names = list(dict.fromkeys([*own["F_terms"], *own["G_terms"]]))
        for name in values or {}:
            if name not in names:
                raise ValueError(f"values[{name!r}]: must be one of {', '.join(names) or 'none'}")
        if frequency_names is not None and len(frequency_names) != n:
            raise ValueError(f"frequency_names: must be {n}, one a coordinate")
        checks.store(
            self,
            F=over(stiffness),
            G=over(checks.square("G", G, n=n)),
            H=tuple(map(over, checks.matrices("H", H, n=n))),
            omega_L=checks.positive("omega_L", omega_L, or_infinite=True),
            values={k: checks.number(k, (values or {}).get(k, 0.0)) for k in names},
            frequency_names=None if frequency_names is None else tuple(frequency_names),
            **own,
        )

    depends_on_Omega = False

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The names of the terms, in which F and G are linear."""
        return tuple(Parameter(name, dependence="linear") for name in self.values)

    def varied(self, **values: float) -> "MatrixSystem":
        """The same with other values of the terms."""
        other = object.__new__(MatrixSystem)
        own = {f.name: getattr(self, f.name) for f in fields(self)}
        checks.store(other, **(own | {"values": dict(self.values) | values}))
        return other

    def equation(self, Omega: float, gamma: float, eta: float = 0.0) -> HillEquation:
        """The equation at a forcing, as `HillEquation`."""
        return HillEquation(
            F=self._with(self.F, self.F_terms),
            G=self._with(self.G, self.G_terms),
            gamma=gamma,
            Omega=Omega,
            eta=eta,
            H=self.H,
            omega_L=self.omega_L,
        )

    def _with(self, matrix: Float, terms: Mapping[str, Float]) -> Float:
        return matrix + sum(
            (self.values[name] * term for name, term in terms.items()), np.zeros_like(matrix)
        )


def _divider(M: ArrayLike | None, n: int) -> Any:
    """A function that divides a matrix by M from the left."""
    if M is None:
        return lambda matrix: matrix
    mass = checks.square("M", M, n=n)
    # beyond this an element of M^-1 F has lost every digit
    if np.linalg.cond(mass) > 1e15:
        raise ValueError("M: must be nonsingular")

    def over(matrix: Float) -> Float:
        found = np.linalg.solve(mass, matrix)
        found.flags.writeable = False
        return np.asarray(found)

    return over
