"""Parts whose slips no larger test would notice: each is held against its definition."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from compare import verify
from compare.publications.kincaid import PUBLICATION
from compare.report.program.deck import constants
from compare.report.program.listing import Case, coefficients
from compare.report.render import decimal
from compare.stability.indicators import edge_function
from compare.verification import Report
from floquet.sensitivity.derivative import NODES, _on
from floquet.sensitivity.equation import Derivatives
from floquet.sensitivity.numbers import Moved
from floquet.sensitivity.system import _chain
from hill import UniformBeam


@pytest.mark.parametrize("eta", [0.0, 0.2])
@pytest.mark.parametrize(("kind", "sign"), [("+1", 1.0), ("-1", -1.0)])
def test_edge_functions_are_values_of_P(kind: str, sign: float, eta: float) -> None:
    """At +-cosh(pi eta/Omega)."""
    P = np.array([[1.0, -0.4, 0.3, 0.7], [1.0, 2.0, -3.0, 0.1]])
    Omega = np.array([0.8, 1.7])
    found = edge_function(kind, P, Omega, eta)
    for p, at, value in zip(P, sign * np.cosh(np.pi * eta / Omega), found, strict=True):
        assert value == pytest.approx(np.prod(at - np.roots(p)).real, rel=1e-12)


def test_the_discriminant_is_that_of_the_roots() -> None:
    P = np.poly([0.3, -0.5, 0.9])[None]
    found = edge_function("pair", P, np.array([1.0]))
    # a quarter for each of three pairs, negative for each of these
    assert found[0] == pytest.approx(-((0.8 * 0.6 * 1.4) ** 2) / 64.0, rel=1e-12)


def test_the_summary_counts() -> None:
    report = verify(tables=[1], rows=["T1-01", "T1-12", "T1-14"])
    first, second, third = report.outcomes
    made = Report(
        (
            replace(
                first, routes_agree=False, difference=0.3 * (first.hill.error + first.floquet.error)
            ),
            replace(second, cause="misprint", difference=0.0, verdict="undecided"),
            replace(third, cause="misprint", difference=0.0),
        ),
        PUBLICATION,
    )
    s = made.summary
    assert (s.rows, s.routes_agree, s.misprint, s.undecided) == (3, 2, 2, 1)
    assert s.flips == int(first.flips) + int(third.flips)
    assert s.largest_share == pytest.approx(0.3)
    expected = made.outcomes[0].difference / np.max(np.abs(first.hill.polynomial))
    assert s.largest_difference == pytest.approx(expected)
    counted = s.agrees + s.truncation + s.listing_slip + s.misprint + s.unexplained
    assert counted == 3


def test_every_cause_is_counted_as_itself() -> None:
    (one,) = verify(tables=[1], rows=["T1-01"]).outcomes
    times = {"agrees": 1, "truncation": 2, "listing-slip": 3, "misprint": 4, "unexplained": 5}
    s = Report(
        tuple(replace(one, cause=cause) for cause, k in times.items() for _ in range(k)),
        PUBLICATION,
    ).summary
    found = (s.agrees, s.truncation, s.listing_slip, s.misprint, s.unexplained)
    assert found == (1, 2, 3, 4, 5)


def test_the_listing_damps_as_the_equations_do() -> None:
    """(SIG^2 - i GA)^(1/2) of (4.4.17): its G against the closed form's, to the deck's digits."""
    case = Case(TO=20.0, SPC=0.5, XG=0.5, OMEGL=2.6, GA=0.3, GAMMA=0.1, ETA=0.0)
    _, G, _ = coefficients(constants("uniform"), case, 2.0)
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2.6, g=0.3)
    expected = beam.equation(2.0, 0.1).G
    # five figures of the deck; without the damping they differ by 1.3
    assert np.max(np.abs(np.asarray(G)[:2, :2] - expected[:2, :2])) < 2e-3 * np.max(
        np.abs(expected)
    )


def of_degree(k: int) -> Any:
    row = np.zeros(k + 1)
    row[k] = 1.0
    return lambda x: np.array([[[float(chebyshev.chebval(x, row))]]])


def test_the_last_four_coefficients_say_whether_a_series_has_converged() -> None:
    found, error = _on(of_degree(NODES - 5), 0.3, -1.0, 1.0)
    slope = chebyshev.chebval(0.3, chebyshev.chebder([0.0] * (NODES - 5) + [1.0]))
    assert abs(found[0, 0, 0] - slope) <= error[0]
    for k in range(NODES - 4, NODES):
        with pytest.raises(ValueError, match="converge"):
            _on(of_degree(k), 0.3, -1.0, 1.0)


def test_what_is_unsure_of_a_matrix_adds_to_the_bound() -> None:
    """|dT/dF| is off by 1 and dF by 1/2: the product by 1/2 at least, wherever dF is zero."""
    one, none = np.ones((1, 1)), np.zeros((1, 1))
    slope = Derivatives(0.0, 0.0, 0.0, none, none, np.zeros((0, 1, 1)))
    error = Derivatives(0.0, 0.0, 0.0, one, none, np.zeros((0, 1, 1)))
    moved = Moved({"F": none, "G": none}, {"F": 0.5, "G": 0.0})
    assert _chain("T0", slope, error, moved)[1] >= 0.5
    # dT/dF is 1 for certain, dF off by 1/2
    assert _chain("T0", error, slope, moved)[1] >= 0.5


def test_what_may_be_zero_is_printed_as_zero() -> None:
    assert decimal(1e-7) == "0"
    assert decimal(0.25, 0.25) == "0"
    assert decimal(0.25, 0.2) == ".25000"
