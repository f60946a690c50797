"""Half and whole period of a matrix Hill equation of many coordinates, in parts.

The steps of one period follow from few of them (`floquet.integrate.phases`), and what their
rounding adds is known element by element: slow motion is not burdened with that of the fastest.
"""

import numpy as np

from floquet.accuracy import OVERFLOW
from floquet.arrays import EPS, Float
from floquet.charpoly import MAX_EXACT
from floquet.integrate.normal_form import NormalForm, normal_form
from floquet.integrate.parts import Grid, parts_needed
from floquet.integrate.parts_taylor import PartsTaylor
from floquet.products import chain
from hill import HillEquation

# Up to this size the polynomial is exact, and so is the comparison of two runs by it.
MAX_FEW = MAX_EXACT

# Steps of the run and of its check in one part: orders 24 and 29 need steps in about that ratio.
STEPS, CHECK_STEPS = 3, 2

# Rounding of a step, in ulps of the moduli summed.
ULPS = 1.5


def rounded(equation: HillEquation) -> Float:
    """What K is off in general form: gamma G is rounded, and so is what it may be added to."""
    largest = abs(equation.gamma) * np.abs(equation.G) + sum(map(np.abs, equation.H))
    return np.asarray(EPS * largest)


def without_damping(equation: HillEquation) -> NormalForm:
    """The equation in u of Eq. (6.1.2)."""
    n, shift = equation.n, 0.25 * equation.damping**2
    own = HillEquation(
        F=equation.F - shift * np.eye(n),
        G=equation.G,
        gamma=equation.gamma,
        Omega=equation.Omega,
        H=equation.H,
        omega_L=equation.omega_L,
    )
    return normal_form(own.general(), rounded(equation))


def integrated(form: NormalForm, *, half: bool = False) -> tuple[Float, Float]:
    """The fundamental matrix after the period, or half of it, and what rounding may do, in ulps."""
    parts, times = parts_needed(PartsTaylor().steps(form), STEPS)
    grid = Grid.of(form, parts + parts % 2, STEPS * times, half=half)
    return _product(form, grid, PartsTaylor())


def checked(form: NormalForm) -> Float:
    """The whole period again, by another order and other steps."""
    parts, times = parts_needed(PartsTaylor().steps(form), STEPS)
    grid = Grid.of(form, parts + parts % 2, CHECK_STEPS * times)
    return _product(form, grid, PartsTaylor(order=29))[0]


def _product(form: NormalForm, grid: Grid, method: PartsTaylor) -> tuple[Float, Float]:
    with np.errstate(over="ignore", invalid="ignore"):
        parts = method.bounded(form, grid)
        product, rounding = chain(parts.matrices, parts.rounding)
    if not (np.all(np.isfinite(product)) and np.all(np.isfinite(rounding))):
        raise OverflowError(OVERFLOW)
    units = form.state_units(grid.unit)
    return units[:, None] * product / units, units[:, None] * rounding / units


def second_half_rounding(U: Float, Phi: Float, rounding: Float) -> Float:
    """What rounding in U does to Phi = S U^-1 S U: |U^-1| dU and |U^-1| dU |Phi|, in ulps."""
    return np.abs(np.linalg.inv(U)) @ rounding @ (np.eye(len(U)) + np.abs(Phi))
