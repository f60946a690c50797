"""The chart's picture: cells and edges that meet, names beside their tongues, words that fit."""

import io
import re
from dataclasses import replace

import numpy as np
import pytest

from compare import chart, tongues
from compare.__main__ import main
from compare.chart_edges import lines
from compare.chart_names import names, spread
from compare.chart_picture import CHARACTERS, STYLE, _columns, _title, _wrapped, picture
from compare.chart_pixels import pixels
from compare.charts.certified import Certified
from compare.edges.tongue import Tongue
from compare.edges.unnamed import unnamed
from hill import Fourier, PeriodicSystem, UniformBeam
from hill.averaging import Resonance

matplotlib = pytest.importorskip("matplotlib")
BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
WINDOW = [("Omega", 0.95, 1.25, 12), ("gamma", 0.05, 0.3, 9)]


@pytest.fixture(scope="module")
def own():
    return chart(BEAM, WINDOW, route="floquet")


@pytest.fixture(scope="module")
def edges(own):
    return tongues(own, 1)


@pytest.fixture
def words(monkeypatch):
    """An SVG's words, as they are."""
    monkeypatch.setitem(matplotlib.rcParams, "svg.fonttype", "none")

    def read(drawn):
        return re.findall(r"<text[^>]*>([^<]+)</text>", drawn.decode())

    return read


def test_every_pixel_is_evaluated(own):
    shown = pixels(own, (50, 40))
    Omega, gamma = np.meshgrid(*shown.points)
    there = own.at(Omega=Omega.ravel(), gamma=gamma.ravel())
    assert shown.T.ravel() == pytest.approx(there.T, abs=1e-9)
    assert shown.verdict.ravel().tolist() == there.verdict.tolist()
    # the pixels fill the frame
    for edges, axis in zip(shown.edges, own.axes, strict=True):
        assert (edges[0], edges[-1]) == pytest.approx((axis.low, axis.high))
        assert np.diff(edges) == pytest.approx((axis.high - axis.low) / (len(edges) - 1))


def test_of_multipliers_and_along_a_logarithm_too():
    K = Fourier([[1.0, 0.0], [0.0, 5.29]], cos={1: [[0.4, 0.3], [0.2, 0.8]]})
    C = Fourier([[0.04, 0.3], [-0.3, 0.06]], sin={1: [[0.1, 0.05], [0.0, 0.1]]})
    axes = [("Omega", 2.8, 3.8, 9), ("gamma", 0.01, 1.0, 9)]
    own = chart(PeriodicSystem(K=K, C=C), axes, route="floquet")
    shown = pixels(own, (20, 10), log=("gamma",))
    ratios = shown.edges[1][1:] / shown.edges[1][:-1]
    assert ratios == pytest.approx(100.0**0.1)
    Omega, gamma = np.meshgrid(*shown.points)
    there = own.at(Omega=Omega.ravel(), gamma=gamma.ravel())
    assert shown.T.ravel() == pytest.approx(there.T, abs=1e-9)


def test_without_a_series_a_pixel_has_its_nearest_points_values():
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2.3)
    own = chart(beam, [("Omega", 2.25, 2.35, 6), ("gamma", 0.0, 0.2, 5)], route="floquet")
    assert own.direct == 30
    shown = pixels(own, (60, 50))
    near = [
        np.abs(a.points[:, None] - p).argmin(axis=0)
        for a, p in zip(own.axes, shown.points, strict=True)
    ]
    assert np.array_equal(shown.T, own.T[np.ix_(near[1], near[0])])
    assert np.array_equal(shown.verdict, own.verdict()[np.ix_(near[1], near[0])])


@pytest.mark.parametrize("seed", range(5))
def test_names_keep_their_distance_and_their_order(seed):
    random = np.random.default_rng(seed)
    wanted, gap = random.random(12) ** 3, 0.03
    found = spread(wanted, gap)
    placed = found[np.argsort(wanted)]
    assert np.all(np.diff(placed) >= gap - 1e-12)
    assert placed.min() >= -1e-12
    assert placed.max() <= 1.0 + 1e-12
    # no other way to keep them is nearer to what is wanted
    best = np.sum((found - wanted) ** 2)
    for _ in range(200):
        other = np.sort(placed + 0.02 * random.standard_normal(12))
        if np.all(np.diff(other) >= gap) and other.min() >= 0.0 and other.max() <= 1.0:
            assert np.sum((other - np.sort(wanted)) ** 2) >= best


def test_a_name_alone_is_where_its_tongue_is():
    assert spread(np.array([0.3]), 0.1).tolist() == [0.3]
    assert spread(np.array([]), 0.1).tolist() == []


def test_a_tongue_is_named_where_it_is_seen(own):
    Omega, gamma = own.axes
    y = np.array([0.05, 0.3])
    half_outside = Tongue(Resonance(1, 1), y, np.array([0.94, 0.8]), np.array([0.96, 0.99]))
    closes = Tongue(Resonance(1, 0), y - 0.1, np.array([1.1, 1.12]), np.array([1.15, 1.12]))
    beyond = Tongue(Resonance(2, 0), y, np.array([2.0, 2.1]), np.array([2.2, 2.3]))
    first, second = names([half_outside, closes, beyond], Omega, gamma)
    assert first.Omega == pytest.approx(0.5 * (0.95 + 0.99))
    assert first.leaves
    assert (second.Omega, second.other) == pytest.approx((1.12, 0.2))
    assert not second.leaves


def test_edges_that_merge_do_not_cross():
    """Once they have run into one another the outer edges are drawn, once; nothing leads there."""
    y = np.linspace(0.1, 0.5, 5)
    left = Tongue(Resonance(1, 0), y, 1.0 - y, np.array([1.02, 1.04, 1.06, 2.0, 2.1]))
    right = Tongue(
        Resonance(2, 1, -1),
        y,
        np.array([1.5, 1.4, 1.3, 0.6, 0.5]),
        np.array([1.7, 1.8, 1.9, 2.0, 2.1]),
    )
    left.lower[3:] = right.lower[3:]
    drawn = [line for t in (left, right) for line in lines(t, [left, right], "Omega")]
    assert len(drawn) == 6
    for x, at in drawn:
        assert np.all(np.abs(np.diff(x)) < 0.11)
        assert at[0] == 0.1 or at[0] == pytest.approx(0.4)
    outer = [x for x, at in drawn if at[0] != 0.1]
    assert [x[-1] for x in outer] == [0.5, 2.1]


def test_titles_fit(own):
    for width in (3.0, 7.2, 20.0):
        characters = int(width * CHARACTERS)
        title = _title(own, "a name of some length " * 4, characters).split("\n")
        assert all(len(re.sub(r"[$\\{}_]", "", line)) <= characters + 30 for line in title)
    fixed = [f"$K$ = {k}," for k in range(30)]
    wrapped = _wrapped(fixed, 40)
    # a number stays with its name
    assert all(re.fullmatch(r"(\$K\$ = \d+, ?)+", line) for line in wrapped)
    assert max(len(line.replace("$", "")) for line in wrapped) <= 40


@pytest.mark.parametrize(
    ("kind", "start"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")]
)
def test_size_and_kind_are_as_asked(own, edges, kind, start):
    drawn = picture(own, edges, kind, size=(4.0, 3.0))
    assert drawn.startswith(start)
    assert drawn == picture(own, edges, kind, size=(4.0, 3.0))
    if kind == "png":
        from matplotlib.image import imread

        assert imread(io.BytesIO(drawn)).shape[:2] == (600, 800)


def test_what_has_no_name_has_a_sign(own, edges, words):
    assert unnamed(own, edges) == ()
    assert "unstable, no tongue's name" not in words(picture(own, edges, "svg"))
    (region,) = unnamed(own, ())
    at = dict(zip(("Omega", "gamma"), region.at, strict=True))
    assert own.at(**at).T[0] == pytest.approx(region.T, abs=1e-9)
    assert "unstable, no tongue's name" in words(picture(own, (), "svg"))


def test_what_is_infinite_is_not_drawn_as_stable(words):
    beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2.3)
    own = chart(beam, [("Omega", 2.2, 2.4, 3), ("gamma", 0.0, 0.2, 3)], route="floquet")
    assert np.isinf(own.T[:, 1]).all()
    said = words(picture(own, (), "svg"))
    assert "no equation" in said
    lost = tuple(replace(c, P=np.full_like(c.P, np.inf)) for c in own.alone)
    fast = replace(own, alone=lost)
    assert fast.unstable()[:, 1].all()
    assert "growth beyond a float" in words(picture(fast, (), "svg"))


def test_one_axis_is_a_curve(words):
    own = chart(BEAM, WINDOW[:1], forcing={"gamma": 0.1}, route="floquet")
    said = words(picture(own, (), "svg"))
    assert "unstable" in said
    assert "stable" not in said


@pytest.mark.parametrize(
    ("more", "says"),
    [
        (["--output", "a.png", "--log", "gamma"], "greater than 0"),
        (["--output", "a.png", "--log", "T0"], "must be an axis"),
        (["--output", "a.png", "--size", "0.1", "3"], "width of the picture"),
        (["--output", "a.csv", "--size", "4", "3"], "--size: needs a picture"),
        (["--output", "a.csv", "--log", "Omega"], "--log: needs a picture"),
        (["--output", "a.png", "--also", "T0", "1", "2", "3"], "one or two axes"),
        (["--output", "a.html", "--log", "Omega"], "--log: needs a picture"),
    ],
)
def test_pictures_that_cannot_be_are_refused_before_the_work(
    more, says, tmp_path, monkeypatch, capsys
):
    monkeypatch.chdir(tmp_path)
    chart_of_two = ["chart", "--x", "Omega", "1", "2", "9", "--y", "gamma", "0", "0.3", "9"]
    assert main([*chart_of_two, *more]) == 2
    assert says in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_cells_that_are_not_proven_are_veiled(own, words):
    assert not pixels(own, (20, 20)).unproven.any()
    cells = np.where(own.T > 0.0, "unstable", "undecided")
    proven = replace(own, certified=Certified(cells, 0.2, 0.3, 0.5, 0.5, 9, 0.0, True, 0.0))
    shown = pixels(proven, (len(own.T[0]) * 10 - 10, len(own.T) * 10 - 10))
    # a cell is what is nearest to its point
    assert np.array_equal(shown.unproven[4::10, 4::10], cells[:-1, :-1] == "undecided")
    assert "cell not proven as a whole" in words(picture(proven, (), "svg"))


@pytest.mark.parametrize("width", [3.0, 7.2])
def test_a_legend_is_no_wider_than_its_picture(width):
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    labels = ["stable", r"$\mu = 1$", "printed: unstable", "printed: stable", "a long one of words"]
    labels += ["unstable, no tongue's name", "undecided", "no equation"]
    figure = Figure(figsize=(width, 4.0))
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    handles = [axes.plot([0.0], [0.0], label=label)[0] for label in labels]
    with matplotlib.rc_context(STYLE):
        columns = _columns(labels, 0.8 * width)
        legend = axes.legend(handles=handles, ncols=columns, fontsize=6.5)
    figure.draw_without_rendering()
    assert columns > (0 if width < 5.0 else 2)
    assert legend.get_window_extent().width / figure.dpi < width
