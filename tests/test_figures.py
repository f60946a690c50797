"""The figures, through their data; one smoke test of the drawing of each kind; the command."""

import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from commands import csv_lines

from compare.__main__ import main
from compare.report.figures import coupled as coupling
from compare.report.figures import draw as drawing
from compare.report.figures import style
from compare.report.figures.beams import beam_of, family_of, resonance_named
from compare.report.figures.catalogue import FIGURES, ORDER
from compare.report.figures.compute import KINDS, compute, named, tasks
from compare.report.figures.critical import BOTTOM, TOP
from compare.report.figures.data import FigureData, Series, as_csv, from_csv
from compare.report.figures.regions import section_parameters
from compare.report.figures.sampling import adaptive
from compare.report.one_route import T_of, equation, solve
from compare.report.steady import loss
from compare.report.tables import ETA, GAMMA, number, rows
from compare.stability.indicators import indicator
from hill import characteristic
from hill.averaging import modal

# The routes at the marks of the full set: 5e-11 in T (Figure 8, beside an edge, where T is steep),
# 7e-12 in Omega, 3e-12 in the integral, 4e-15 in a natural frequency.
DISAGREEMENT = {"T": 1e-9, "Omega": 1e-9, "the integral": 1e-10, "omega": 1e-12}


@cache
def data(figure: int, detail: float = 0.2) -> FigureData:
    return compute(figure, detail)


@cache
def coupled() -> FigureData:
    """Figure 29 at three thrusts, without its ordinary tongues."""
    figure, series = FIGURES[29], []
    for g in figure.values:
        for window in coupling.windows(figure.omega_L):
            for piece in coupling.about(figure, window, g, [8.0, 16.0, 24.0]):
                edges = (piece.lower, piece.upper)
                series.append(
                    Series(f"g = {g:g}", "region", "floquet", piece.y, *edges, panel=window.name)
                )
                series.append(
                    Series(f"g = {g:g}", "mark", "hill", piece.y, edges[0], panel=window.name)
                )
    return FigureData(29, tuple(series), "Omega", 0.0)


DRAWN = (4, 8, 13, 16, 26, 27, 28, 29)
"""One of each kind."""
COMPUTED = (4, 7, 8, 10, 13, 16, 26, 27, 28)


def one(figure: int, role: str, panel: str, damped: bool = False, name: str = "") -> Series:
    found = [
        s
        for s in data(figure).select(panel=panel)
        if s.role == role and s.damped == damped and name in s.name
    ]
    assert len(found) == 1
    return found[0]


@pytest.mark.parametrize("figure", COMPUTED)
def test_the_routes_agree_at_the_marks(figure: int) -> None:
    shown = data(figure)
    assert shown.disagreement < DISAGREEMENT[shown.quantity]
    assert sum(len(s.x) for s in shown.select("mark")) >= 5
    sources = {s.source for s in shown.select("mark")}
    curves = {s.source for s in (*shown.select("curve"), *shown.select("region"))}
    assert len(sources) == len(curves) == 1
    assert sources != curves


@pytest.mark.parametrize("figure", COMPUTED)
def test_csv_reads_back_exactly(figure: int) -> None:
    back = from_csv(as_csv(data(figure)))
    kept = [s for s in data(figure).series if len(s.x)]
    assert [(s.name, s.role, s.panel, s.damped) for s in merged(kept)] == [
        (s.name, s.role, s.panel, s.damped) for s in back
    ]
    assert np.array_equal(np.concatenate([s.x for s in kept]), np.concatenate([s.x for s in back]))
    for role in ("y", "y_upper"):
        before = [getattr(s, role) for s in kept if getattr(s, role) is not None]
        after = [getattr(s, role) for s in back if getattr(s, role) is not None]
        if before:
            assert np.array_equal(np.concatenate(before), np.concatenate(after))


def merged(series: list[Series]) -> list[Series]:
    """Two pieces of one curve that follow one another are one in a CSV."""
    kept: list[Series] = []
    for s in series:
        last = kept[-1] if kept else None
        key = (s.name, s.role, s.panel, s.damped, s.source)
        if last is None or key != (last.name, last.role, last.panel, last.damped, last.source):
            kept.append(s)
    return kept


def test_buckling_and_coalescence() -> None:
    """25.67 of section 7.2 is 26.58 for two modes, whatever K_theta; 15 is at xi_G = 0."""
    events = {s.name: float(s.x[0]) for s in data(4).select("event")}
    assert events["xi_G = 0, coalescence"] == pytest.approx(14.662, abs=1e-3)
    assert events["xi_G = 0.25, coalescence"] == pytest.approx(17.152, abs=1e-3)
    assert events["xi_G = 1, inertial buckling"] == pytest.approx(26.577, abs=1e-3)
    for K_theta in (0.1, 3.0):
        end, how = loss(
            lambda T0, K=K_theta: beam_of(FIGURES[3], K_theta=K, T0=T0), FIGURES[3].span[1]
        )
        assert (how, end) == ("inertial buckling", pytest.approx(26.577, abs=1e-3))


def test_frequencies_end_where_they_meet() -> None:
    ends = [one(4, "curve", "omega_(B), omega_(1)", name=f"xi_G = 0, omega_({i})") for i in "B1"]
    assert ends[1].y[-1] - ends[0].y[-1] < 0.05
    assert ends[0].x[-1] < 14.663


def test_frequencies_are_the_listing_s() -> None:
    at_20 = [
        np.interp(20.0, s.x, s.y)
        for s in compute(3).select("curve")
        if s.name.startswith("K_theta = 0.5,")
    ]
    # FORMAT 1 of the uniform listing, to what straight lines between 80 points leave
    assert at_20 == pytest.approx([0.191271, 0.909014, 2.501638], abs=1e-4)


def test_omega_1_of_example_2() -> None:
    """0.974 is read off Figure 7 for xi_c = .6 (Appendix A)."""
    printed = data(7).select("printed")[0]
    curve = one(7, "curve", "omega_(B), omega_(1)", name="xi_c = 0.6, omega_(1)")
    assert (printed.x[0], printed.y[0]) == (0.0, 0.974)
    assert np.interp(0.0, curve.x, curve.y) == pytest.approx(0.974, abs=1e-3)


@pytest.mark.parametrize("panel", ORDER)
def test_T_is_a_half_circle(panel: str) -> None:
    """T^2 + (Omega - Omega_0)^2 = T_x^2, near 2 omega_(B) as well, where the report saw none."""
    curve = one(8, "curve", panel)
    x, T = curve.x, curve.y
    # the tongue, without narrow ones of higher order beside it
    stable, top = np.flatnonzero(T < 1e-4), int(T.argmax())
    within = slice(stable[stable < top][-1] + 1, stable[stable > top][0])
    centre, T_x = 0.5 * (x[within][0] + x[within][-1]), T[top]
    off = T[within] ** 2 + (x[within] - centre) ** 2 - T_x**2
    # to first order in gamma: .010 T_x^2 measured at 2 omega_(B), .002 at most elsewhere
    assert np.abs(off).max() < (0.02 if panel == "2 omega_(B)" else 0.004) * T_x**2


def test_damping_shifts_T_by_eta() -> None:
    """Section 7.3.1. F loses eta^2/4 too, which moves T at its top by less than eta^2."""
    for panel in ORDER:
        undamped, damped = one(8, "curve", panel), one(8, "curve", panel, damped=True)
        assert damped.y.min() == pytest.approx(-ETA, abs=1e-12)
        # 1.5e-5 measured, near omega_(B), where eta^2/(8 omega) is largest
        assert damped.y.max() == pytest.approx(undamped.y.max() - ETA, abs=3e-5)


def test_printed_points_are_as_printed() -> None:
    shown = [s for s in data(8).select("printed") if len(s.x)]
    points = {(x, y) for s in shown for x, y in zip(s.x, s.y, strict=True)}
    # 3.411, omega_(2) + omega_(1), has a panel in neither figure: T = 0
    expected = {(number(r.Omega_printed), r.T) for r in rows(1) if r.Omega_printed != "3.411"}
    assert points == expected
    shown = [s for s in data(10).select("printed") if len(s.x)]
    assert sum(len(s.x) for s in shown) == len(rows(1))
    assert {x for s in shown for x in s.x} == {GAMMA}


@pytest.mark.parametrize("resonance", ["2 omega_(2)", "omega_(2) + omega_(B)"])
def test_boundaries_are_linear_in_gamma(resonance: str) -> None:
    """Section 7.3: width over gamma is constant, here to 3 % up to .3 (.1 and 2.5 % measured)."""
    region = one(10, "region", resonance)
    assert region.y_upper is not None
    assert region.x[0] == 0.0
    assert region.y[0] == region.y_upper[0]
    slope = (region.y_upper - region.y)[1:] / region.x[1:]
    assert np.ptp(slope) < 0.03 * slope.mean()


def test_boundary_is_resonance_plus_minus_T_x() -> None:
    """Eq. (7.3.1), within a tenth of T_x at gamma = .1 away from 2 omega_(B)."""
    for name in ("2 omega_(2)", "omega_(2) + omega_(B)", "omega_(1) + omega_(B)"):
        region, T = one(10, "region", name), one(8, "curve", name)
        assert region.y_upper is not None
        T_x = float(np.interp(region.y[0], T.x, T.y))
        edges = [np.interp(GAMMA, region.x, e) for e in (region.y, region.y_upper)]
        assert edges == pytest.approx([region.y[0] - T_x, region.y[0] + T_x], abs=0.1 * T_x)


@pytest.mark.parametrize(("figure", "eta"), [(10, 0.0), (16, ETA)])
def test_regions_are_unstable_inside_and_bounded_by_zeros_of_P(figure: int, eta: float) -> None:
    family = family_of(FIGURES[figure], "hill", eta)
    for region in data(figure).select("region"):
        assert region.y_upper is not None
        resonance = resonance_named(region.name)
        i = len(region.x) - 1
        gamma, lower, upper = float(region.x[i]), float(region.y[i]), float(region.y_upper[i])
        width = upper - lower
        for edge, inwards in ((lower, 0.02 * width), (upper, -0.02 * width)):
            Omega = np.array([edge])
            P = family.along(Omega, gamma)
            # slope of the indicator times 1e-12 of Omega; 4e-12 measured
            assert abs(indicator(resonance.indicator, P, Omega, eta)[0]) < 1e-9
            assert characteristic(family.equation(edge + inwards, gamma)).T > 0.0


def test_nothing_at_example_1_of_appendix_a() -> None:
    """T0 = 5.1, gamma = .1 with damping: stable for any forcing frequency, here the resonances."""
    for name in ORDER:
        beam = beam_of(FIGURES[15], T0=5.1)
        Omega = resonance_named(name).Omega(modal(beam.equation(1.0, 0.0))[0])
        assert characteristic(beam.equation(Omega, GAMMA, ETA)).T < 0.0


def test_critical_curve_is_where_T_x_is_eta() -> None:
    shown = data(13)
    tops = {s.name: s for s in shown.select("curve", TOP)}
    (envelope,) = shown.select("curve", BOTTOM)
    for T0 in (10.0, 15.0, 20.0):
        top = tops[f"T0 = {T0:g}"]
        gamma = np.interp(ETA, top.y, top.x)
        # straight lines between 13 thrusts
        assert np.interp(T0, envelope.x, envelope.y) == pytest.approx(gamma, rel=0.05)
    (stable,) = shown.select("region", BOTTOM)
    assert stable.x[0] == 0.0
    assert np.all(stable.y_upper == np.where(stable.x < envelope.x[0], 0.3, stable.y_upper))


def test_longitudinal_integral_in_closed_form() -> None:
    for s in data(27).select("curve"):
        g = float(s.name.split(" = ")[1])
        z = np.pi * np.sqrt(s.x**2 - 1j * g)
        exact = np.real(np.tan(0.5 * z) / z)
        assert s.y == pytest.approx(exact, rel=1e-10, abs=1e-12)
    damped = next(s for s in data(27).select("curve") if s.name == "g = 0.04")
    # section 7.3.2: finite with damping, and zero close to resonance
    assert abs(np.interp(1.0, damped.x, damped.y)) < 0.02 * damped.y.max()


def test_stable_gap_at_resonance() -> None:
    """Section 7.3.2: a narrow stable region at Omega = 2.0 for g = .04; none above for .08."""

    def T(g: float, Omega: float) -> float:
        curves = [s for s in data(28).select("curve") if s.name == f"g = {g:g}"]
        x, y = (np.concatenate([getattr(s, axis) for s in curves]) for axis in "xy")
        return float(np.interp(Omega, x, y))

    assert T(0.0, 1.98) > 0.5
    assert T(0.0, 2.02) > 0.5
    assert [T(0.04, x) > 1e-6 for x in (1.97, 2.0, 2.03)] == [True, False, True]
    assert T(0.08, 1.9) > 0.1
    assert all(T(0.08, x) == pytest.approx(0.0, abs=1e-9) for x in (1.97, 2.0, 2.03, 2.1))


def test_instability_at_twice_the_longitudinal_frequency() -> None:
    """Section 7.3.2: at Omega = 4 without damping, gone with g = .08."""
    shown = coupled()
    beside = [s for s in shown.select("region") if s.panel == "2 omega_L"]
    assert {s.name for s in beside} == {"g = 0"}
    below, above = beside
    assert below.y[-1] == pytest.approx(3.952, abs=1e-3)
    assert above.y_upper is not None
    assert above.y_upper[-1] == pytest.approx(4.042, abs=1e-3)
    assert (below.x[0], below.y[0]) == (0.0, 4.0)
    broad = [s for s in shown.select("region") if "and" in s.panel]
    assert [s.name for s in broad] == ["g = 0", "g = 0", "g = 0.08"]


def test_T_x_tends_to_the_rigid_bar_s() -> None:
    for name in ORDER:
        rigid = one(8, "curve", name)
        beam = beam_of(FIGURES[26])
        Omega = resonance_named(name).Omega(modal(beam.equation(1.0, 0.0))[0])
        compliant = [s for s in data(26).select("curve") if s.name == name][-1]
        assert compliant.x[-1] == pytest.approx(30.0)
        # T_x + c/omega_L^2: 3e-4 at 30
        assert compliant.y[-1] == pytest.approx(np.interp(Omega, rigid.x, rigid.y), abs=1e-3)
        assert compliant.y[0] > 0.1


def test_adaptive_follows_a_corner() -> None:
    x, y = adaptive(np.abs, np.linspace(-1.0, 1.0, 4), 1.0)
    fine = np.linspace(-1.0, 1.0, 1001)
    assert np.abs(np.interp(fine, x, y) - np.abs(fine)).max() < 2e-3
    assert len(x) < 40


def test_a_half_period_that_cannot_be_inverted() -> None:
    """Beside a longitudinal resonance the solution grows by 1e9 and more in a period."""
    beam = replace(beam_of(FIGURES[28]), omega_L=0.383, g=0.0)
    e = equation("floquet", beam, 0.38254, GAMMA)
    T = T_of("floquet", solve("floquet", [e]), np.array([e.Omega]))[0]
    from floquet import monodromy

    assert pytest.approx(monodromy(e).T, rel=1e-6) == T


def test_catalogue_is_the_report_s() -> None:
    assert sorted(FIGURES) == list(range(3, 30))
    assert {figure.kind for figure in FIGURES.values()} == set(KINDS) == set(drawing.DRAWERS)
    done = [n for group in tasks(tuple(FIGURES)) for n in group]
    assert sorted(done) == sorted(FIGURES)
    assert tasks((8, 15, 9)) == [(9, 15), (8,)]
    with pytest.raises(ValueError, match="must be one of 3 to 29"):
        named(2)


def test_every_caption_is_set() -> None:
    from matplotlib.mathtext import MathTextParser

    parser = MathTextParser("agg")
    for figure in FIGURES.values():
        curves = Series("c", "curve", "hill", np.ones(1), np.ones(1))
        marks = Series("c", "mark", "floquet", np.ones(1), np.ones(1))
        shown = FigureData(figure.number, (curves, marks), "T", 3e-12)
        text = style.wrapped(style.caption(figure, shown), lambda word: float(len(word)), 140.0)
        assert rf"Figure\ {figure.number}." in text
        assert r"$3\times10^{-12}$" in text
        assert figure.caption.split(" ")[0] in text
        assert ("assumed" in text) == bool(figure.assumed)
        for line in text.splitlines():
            assert line.count("$") % 2 == 0
            if figure.number not in DRAWN:
                parser.parse(line)


@pytest.mark.parametrize("figure", DRAWN)
def test_drawing(figure: int) -> None:
    shown = coupled() if figure == 29 else data(figure)
    drawn = drawing.draw(shown, ("svg",))["svg"].decode()
    assert "<dc:date>" not in drawn
    assert len(drawn) > 20_000


def test_the_same_bytes_every_time() -> None:
    shown = data(27)
    first, second = (drawing.draw(shown, ("png", "svg")) for _ in range(2))
    assert first == second
    assert first["png"].startswith(b"\x89PNG")


def test_captions_may_be_left_out(tmp_path: Path) -> None:
    words = ["figures", "27", "--format", "png", "--workers", "1", "--output"]
    assert main([*words, str(tmp_path / "with")]) == 0
    assert main([*words, str(tmp_path / "without"), "--no-captions"]) == 0
    image = pytest.importorskip("matplotlib.image")
    tall, short = (
        image.imread(tmp_path / name / "figure27.png").shape for name in ("with", "without")
    )
    assert tall[1] == short[1]
    assert tall[0] > short[0] + 50


@pytest.mark.parametrize("figure", [24, 29])
def test_sections_are_closer_where_the_rotation_slows_down(figure: int) -> None:
    """Below buckling its frequency goes like the root of the distance: chords were seen there."""
    high = FIGURES[figure].span[1]
    for resonance in (resonance_named("omega_(1) + omega_(B)"), resonance_named("2 omega_(B)")):
        T0 = np.array(section_parameters(FIGURES[figure], resonance, 1.0))
        assert np.all(np.diff(T0) > 0.0)
        assert T0[-1] == high
        middle = np.diff(T0[(0.2 * high < T0) & (0.6 * high > T0)])
        assert np.diff(T0[0.65 * high < T0]).max() == pytest.approx(middle.min() / 3.0)


def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "drawn"
    words = ["figures", "27", "27", "--output", str(out), "--workers", "1"]
    assert main(words) == 0
    assert sorted(p.name for p in out.iterdir()) == [
        f"figure27.{kind}" for kind in ("csv", "png", "svg")
    ]
    assert (out / "figure27.svg").read_bytes().startswith(b"<?xml")
    line = capsys.readouterr().out
    assert line == (
        f"Figure 27  csv, png, svg  the routes differ by {data(27, 1.0).disagreement:.0e} "
        "in the integral at most\n"
    )


def test_two_processes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["figures", "27", "3", "--format", "csv", "--workers", "2"]
    assert main([*words, "--output", str(tmp_path)]) == 0
    assert [line[:9] for line in capsys.readouterr().out.splitlines()] == ["Figure  3", "Figure 27"]
    for name in ("figure03.csv", "figure27.csv"):
        text = (tmp_path / name).read_text()
        about, lines = csv_lines(text)
        assert about["figure"] == int(lines[0]["figure"]) == int(name[6:8])
        assert list(lines[0]) == ["figure", "panel", "series", "role", "from", "x", "y", "y_upper"]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["30"], "figure = 30: must be one of 3 to 29"),
        (["27", "--workers", "0"], "workers"),
        (["27", "--output", "{file}"], "cannot be made"),
        (["27", "--output", "{file}/a/b"], "no such directory"),
    ],
)
def test_refusals(
    words: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "file"
    file.write_text("")
    filled = [word.format(file=file) for word in words]
    output = [] if "--output" in words else ["--output", str(tmp_path / "out")]
    assert main(["figures", *filled, *output]) == 2
    error = capsys.readouterr().err
    assert message in error
    assert error.count("\n") == 1


def test_without_matplotlib(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    out = tmp_path / "out"
    assert main(["figures", "27", "--output", str(out)]) == 2
    assert 'pip install "floquet-crosscheck[plot]"' in capsys.readouterr().err
    assert not out.exists()
    # numbers need no drawing
    words = ["figures", "27", "--format", "csv", "--output", str(out), "--workers", "1"]
    assert main(words) == 0
    assert [p.name for p in out.iterdir()] == ["figure27.csv"]
