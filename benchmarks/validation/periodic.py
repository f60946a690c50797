"""Periodic systems of the literature: Mathieu, Meissner, Vinograd, rotors."""

import math
from collections.abc import Callable, Iterable
from typing import Any

import casadi
import numpy as np
from scipy.optimize import brentq

from benchmarks.validation.comparison import Comparison, Source
from benchmarks.validation.literature import EXPONENTS
from benchmarks.validation.rotor import PRINTED, rotor
from floquet import monodromy
from hill import HillEquation, PeriodicEquation, characteristic

ROUTES: tuple[Callable[[Any], Any], ...] = (characteristic, monodromy)

# DLMF 28: which value, q, and z = trace/2 over pi there.
MATHIEU = (
    ("a0", 1, "-0.45513860410741355", 1.0),
    ("b1", 1, "-0.11024881699209517", -1.0),
    ("a1", 1, "1.8591080725143635", -1.0),
    ("b2", 1, "3.9170247729984712", 1.0),
    ("a2", 1, "4.3713009827350857", 1.0),
    ("a0", 5, "-5.8000460208515084", 1.0),
    ("b1", 5, "-5.7900805986377710", -1.0),
    ("a1", 5, "1.8581875415477509", -1.0),
    ("b2", 5, "2.0994604454866654", 1.0),
    ("a2", 5, "7.4491097395291778", 1.0),
)
INTERIOR = ((0.1, "-0.85479289278902375"), (1.0, "-4.1560549385828014"))
COUPLED = ("-1.124942799147935", "-0.888934086921956")
EXPONENT_DIGITS = 12
"""Of the exactly known exponents, which are compared to so many decimals."""

# Above twice the highest frequency of the rotor: no exponent is folded.
UNFOLDED = 120.0

MEISSNER = "0.041379744661220644"


def mathieu(a: float, q: float) -> HillEquation:
    """X'' + (a - 2 q cos 2 t) x = 0."""
    return HillEquation([[a]], [[1.0]], -2.0 * q, 2.0)


def characteristic_value(solve: Callable[[Any], Any], printed: str, q: float, z: float) -> float:
    """Where z is 1 or -1: the root within a thousandth of the printed number."""

    def miss(a: float) -> float:
        return float(-solve(mathieu(a, q)).polynomial[1]) - z

    about = float(printed)
    # not about the number itself, so that no bisection happens on it
    return float(brentq(miss, about - 1.1e-3, about + 0.9e-3, xtol=1e-15, rtol=1e-15))


def mathieu_values() -> Source:
    """DLMF's, and two multipliers inside a tongue."""
    numbers = []
    for name, q, printed, z in MATHIEU:
        ours = [characteristic_value(solve, printed, q, z) for solve in ROUTES]
        # z is known to some 1e-13 at q = 5, and |dz/da| is 1.6 and more but for b1, a1 at q = 1
        numbers.append(Comparison(f"{name}, q = {q}", printed, ours[0], ours[1], rounding=2e-13))
    for share, printed in INTERIOR:
        ours = []
        for solve in ROUTES:
            z = float(solve(mathieu(1.0, share)).z[0].real)
            larger = z - math.sqrt(z * z - 1.0)
            ours.append(larger if abs(float(printed)) > 1.0 else 1.0 / larger)
        what = f"multiplier at a = 1, q = {share:g}"
        numbers.append(Comparison(what, printed, ours[0], ours[1], rounding=2e-14))
    return Source(
        "Mathieu's equation",
        "Characteristic values, DLMF chapter 28, found as the roots of z -+ 1 within a thousandth; "
        "multipliers over the period pi.",
        tuple(numbers),
    )


def nearest(found: Iterable[complex], value: complex, Omega: float) -> complex:
    """Of our exponents, which are known up to whole multiples of i Omega."""
    moved = [x - 1j * Omega * round((x - value).imag / Omega) for x in found]
    return min(moved, key=lambda x: abs(x - value))


def exponents() -> Source:
    """Systems whose exponents are known exactly; real parts."""
    numbers = []
    for name, (equation, exact) in EXPONENTS.items():
        found = [solve(equation).exponents for solve in ROUTES]
        for value in sorted({round(x.real, 15): x for x in exact}.values(), key=lambda x: -x.real):
            ours = [nearest(x, value, equation.Omega).real for x in found]
            printed = f"{value.real:.{EXPONENT_DIGITS}f}"
            numbers.append(Comparison(name, printed, ours[0], ours[1], rounding=1e-11))
    meissner = monodromy(_meissner, period=math.pi, breaks=[math.pi / 3.0])
    growth = float(np.max(meissner.exponents.real))
    numbers.append(
        Comparison("Meissner, a third of the period", MEISSNER, None, growth, rounding=2e-16)
    )
    return Source(
        "Exponents known exactly",
        "Vinograd 1952; Zhou and Hagiwara 2002; Bittanti and Colaneri, whose second multiplier is "
        "3e-66 of the first; the asymmetric rotor seen from where it does not turn, sqrt(-2 + "
        "sqrt 4.04) and zero. Real parts. Meissner's equation (Richards 1983, Figure 3.1, digits "
        "of PeriodicMatrices.jl) jumps, so the time domain is alone with it.",
        tuple(numbers),
    )


def _meissner(t: Any) -> Any:
    within = t - math.pi * casadi.floor(t / math.pi)
    return [[0, 1], [-1 + 0.2 * casadi.if_else(within < math.pi / 3.0, 1, -1), 0]]


def coupled() -> Source:
    """Two Mathieu equations with a spring between."""
    equation = HillEquation([[2.0, -1.0], [-1.0, 2.0]], np.eye(2), 0.15, 2.0).general()
    found = [solve(equation).multipliers for solve in ROUTES]
    numbers = []
    for printed in COUPLED:
        ours = [float(x[np.argmin(np.abs(x - float(printed)))].real) for x in found]
        numbers.append(Comparison("multiplier", printed, ours[0], ours[1], rounding=1e-13))
    return Source(
        "Two coupled Mathieu equations",
        "Chicone, example 2.91, which chebfun and ApproxFun integrate too; no digits are printed "
        "there, these are another integration's.",
        tuple(numbers),
    )


def friswell() -> Source:
    """The rotor at 4000 rpm."""
    equation = rotor(4000.0, 14, 12.0)
    found = [solve(equation).exponents for solve in ROUTES]
    numbers = []
    for value in PRINTED[4000.0]:
        ours = [1e3 * nearest(x, 1e-3j * value, equation.Omega).imag for x in found]
        numbers.append(Comparison("whirl, rad/s", f"{value:.2f}", ours[0], ours[1]))
    # at rest its planes are alike: each is one of 14 coordinates
    still = PeriodicEquation(K=rotor(0.0, 14, UNFOLDED).K.mean[:14, :14], Omega=UNFOLDED)  # type: ignore[union-attr]
    found = [solve(still).exponents for solve in ROUTES]
    for value in sorted(set(PRINTED[0.0])):
        ours = [1e3 * nearest(x, 1e-3j * value, UNFOLDED).imag for x in found]
        numbers.append(Comparison("at rest, rad/s", f"{value:.2f}", ours[0], ours[1]))
    return Source(
        "A rotor on two bearings",
        "Friswell, Penny, Garvey, Lees, Dynamics of Rotating Machines, example 5.9.1 at 4000 rpm, "
        "as in the tests of ROSS: 28 coordinates, gyroscopic; and at rest.",
        tuple(numbers),
    )
