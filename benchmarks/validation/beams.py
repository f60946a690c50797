"""Beams and vehicles of textbooks and of NASTRAN's print. Needs the extra `vehicle`."""

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Literal

import numpy as np

from benchmarks.validation.comparison import Comparison, Source
from floquet.vehicle.discretise import discretised
from hill import HillEquation, Section, Sensor, Thrust, Units, Vehicle, critical_thrust
from hill.vehicle.mesh import mesh
from hill.vehicle.series import Series, series
from hill.vehicle.stiffness import grouped

# as the vehicle has them
End = Literal["free", "pinned", "clamped"]

ONE = Section(1.0, 1.0, 1.0)

# Blevins, Formulas for Natural Frequency and Mode Shape, table 8-1: lambda l.
TEXTBOOK: dict[tuple[End, End], tuple[str, ...]] = {
    ("free", "free"): ("4.73004074", "7.85320462", "10.9956078", "14.1371655", "17.2787597"),
    ("clamped", "free"): ("1.87510407", "4.69409113", "7.85475744", "10.99554073", "14.13716839"),
    ("pinned", "free"): ("3.92660231", "7.06858275", "10.21017612", "13.35176878", "16.49336143"),
    ("clamped", "pinned"): (
        "3.92660231",
        "7.06858275",
        "10.21017612",
        "13.35176878",
        "16.49336143",
    ),
    ("clamped", "clamped"): ("4.73004074", "7.85320462", "10.9956078", "14.1371655", "17.2787597"),
    ("pinned", "pinned"): ("3.14159265", "6.28318531", "9.42477796", "12.56637061", "15.70796327"),
}
HINGED = ("14.61968", "77.37659", "180.8778")
THREE_STAGES = ("9.4057", "25.2445", "44.0537", "73.590", "109.926")
FLUTTER = {2: "116.097", 3: "109.984", 4: "109.967", 6: "109.782", 8: "109.722"}
# Wright and others, Journal of Applied Mechanics 104, 1982, as in Bir, AIAA 2009-1035, table 3a.
ROTATING: dict[int, tuple[str, ...]] = {
    0: ("3.516", "22.035", "61.697"),
    1: ("3.682", "22.181", "61.842"),
    2: ("4.137", "22.615", "62.273"),
    3: ("4.797", "23.320", "62.985"),
    4: ("5.585", "24.273", "63.967"),
    5: ("6.450", "25.446", "65.205"),
    6: ("7.360", "26.809", "66.684"),
    7: ("8.300", "28.334", "68.386"),
    8: ("9.257", "29.995", "70.293"),
    9: ("10.226", "31.771", "72.387"),
    10: ("11.202", "33.640", "74.649"),
    11: ("12.184", "35.589", "77.064"),
    12: ("13.170", "37.603", "79.615"),
}


def _stiffness(vehicle: Vehicle) -> np.ndarray:
    """The witness's F, of finite elements."""
    equation = discretised(vehicle, 1.0, 0.0)
    if not isinstance(equation, HillEquation):
        raise TypeError("a vehicle without rates and servo has the report's equation")
    return equation.F


def by_elements(vehicle: Vehicle) -> np.ndarray:
    """Omega of the witness's F, lowest first, without the rigid rotation."""
    squares = np.sort(np.linalg.eigvals(_stiffness(vehicle)).real)
    return np.sqrt(squares[-vehicle.modes :])


def frequencies() -> Source:
    """A uniform beam with the textbook's ends."""
    numbers = []
    for ends, printed in TEXTBOOK.items():
        v = Vehicle(sections=(ONE,), ends=ends, units=Units.named("none"), modes=len(printed))
        # the hundred elements' print ends after five of them
        exact, elements = 2.0 * math.pi * v.frequencies(), by_elements(v)
        for n, text in enumerate(printed):
            ours = math.sqrt(exact[n]), math.sqrt(elements[n])
            # two of Blevins' are digits cut off; the elements' own error is below 1e-9
            numbers.append(Comparison(f"{ends[0]}, {ends[1]}: {n + 1}", text, *ours, rounding=1e-9))
    return Source(
        "A uniform beam",
        "lambda l of cos and cosh, Blevins, table 8-1: hill's exact modes, floquet's elements.",
        tuple(numbers),
    )


def nastran() -> Source:
    """Demonstration problem 13-1-1, and the stages of 10-1-1."""
    hinged = Vehicle(
        sections=(Section(100.0, 0.0002 * 2.0, 10.4e6 * 0.666667),),
        ends=("pinned", "pinned"),
        thrust=Thrust(3423.17, direction="fixed"),
        units=Units.named("in-lbf-s"),
        modes=3,
    )
    exact = hinged.frequencies(under_thrust=True)
    elements = by_elements(hinged) / (2.0 * math.pi)
    numbers = [
        Comparison(f"hinged, half Euler's load, Hz: {n + 1}", text, float(a), float(b))
        for n, (text, a, b) in enumerate(zip(HINGED, exact, elements, strict=True))
    ]
    stages = Vehicle(
        sections=(
            Section(150.0, 400.0, 6.24e11),
            Section(100.0, 200.0, 2.08e11),
            Section(50.0, 100.0, 5.2e10),
        ),
        units=Units.named("none"),
        modes=5,
    )
    exact, elements = 2.0 * math.pi * stages.frequencies(), by_elements(stages)
    numbers += [
        Comparison(f"three stages, rad/s: {n + 1}", text, float(a), float(b))
        for n, (text, a, b) in enumerate(zip(THREE_STAGES, exact, elements, strict=True))
    ]
    return Source(
        "NASTRAN's demonstration problems",
        "13-1-1, a hinged beam under half of Euler's load, seven digits of its print. The stages "
        "of 10-1-1 as three uniform sections: their numbers are finite elements' of another hand.",
        tuple(numbers),
    )


def crossing(unstable: Callable[[float], bool], low: float, high: float) -> float:
    """By bisection, to 1e-6."""
    while high - low > 1e-6:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return 0.5 * (low + high)


def loads() -> Source:
    """Beal's free beam, Beck's column, and buckling under inertia."""

    def witness(v: Vehicle, low: float, high: float) -> float:
        """The witness's F is linear in the thrust: two of them are all of them."""
        F = [_stiffness(_pushed(v, thrust)) for thrust in (1.0, 2.0)]

        def unstable(thrust: float) -> bool:
            squares = np.linalg.eigvals(F[0] + (thrust - 1.0) * (F[1] - F[0]))
            size = np.max(np.abs(squares))
            # rounding of the rotation's zero, and of a pair that meets, is some 1e-10 of the size
            flutter = np.abs(squares.imag) > 1e-7 * size
            return bool(np.any(flutter | (squares.real < -1e-7 * size)))

        return crossing(unstable, low, high)

    numbers = []
    for modes, printed in FLUTTER.items():
        free = Vehicle(sections=(ONE,), thrust=Thrust(1.0), units=Units.named("none"), modes=modes)
        ours = critical_thrust(free).thrust, witness(free, 90.0, 130.0)
        numbers.append(Comparison(f"free beam, flutter, {modes} modes", printed, *ours))
    steered = Vehicle(
        sections=(ONE,),
        thrust=Thrust(1.0),
        sensors=(Sensor(0.5, 0.5),),
        units=Units.named("none"),
        modes=2,
    )
    ours = critical_thrust(steered).thrust, witness(steered, 20.0, 40.0)
    numbers.append(Comparison("steered free beam, buckling, 2 modes", "26.58", *ours))
    column = Vehicle(
        sections=(ONE,),
        ends=("clamped", "free"),
        thrust=Thrust(1.0),
        units=Units.named("none"),
        modes=14,
    )
    ours = critical_thrust(column).thrust, witness(column, 15.0, 25.0)
    numbers.append(Comparison("Beck's column, flutter", "20.05", *ours))
    return Source(
        "Critical thrusts",
        "In E I/l^2. A free beam under a follower thrust, by the number of modes, from a "
        "computation of another hand (Beal 1965 has 109.7 to 109.9 in the limit); Beck 1952, with "
        "14 modes.",
        tuple(numbers),
    )


def rotating() -> Source:
    """A clamped beam that turns: its tension is an axial force, quadratic in the station."""
    length, m, EI = math.sqrt(1000.0), 100.0, 1e8
    v = Vehicle(sections=(Section(length, m, EI),), ends=("clamped", "free"))
    cut = mesh(v, 4e4)
    x, half = cut.nodes[:-1] + cut.half, cut.half
    numbers = []
    for speed, printed in ROTATING.items():
        # -N over EI/l^2 about the middle of each piece, N = m speed^2 (l^2 - x^2)/2
        size = -0.5 * m * speed**2 * length**4 / EI
        force = size * np.stack([1.0 - x**2, -2.0 * x * half, -(half**2)], axis=1)
        solutions = series(cut, force)

        def above(omega: float, n: int, solutions: Series = solutions) -> bool:
            """Whether n frequencies are below it."""
            return grouped(solutions, cut, v.ends, (omega * cut.scales.time) ** 2).below >= n

        for n, text in enumerate(printed, start=1):
            about = float(text)
            omega = crossing(partial(above, n=n), 0.9 * about, 1.1 * about)
            numbers.append(Comparison(f"speed {speed}: {n}", text, omega, None))
    return Source(
        "A rotating beam",
        "Wright and others 1982, as in Bir, AIAA 2009-1035, table 3a. The axial force is not a "
        "thrust's, so only hill's exact modes, which take any, have it.",
        tuple(numbers),
    )


def _pushed(v: Vehicle, thrust: float) -> Vehicle:
    return replace(v, thrust=Thrust(thrust))
