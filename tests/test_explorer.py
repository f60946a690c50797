"""The page to explore: what its script evaluates is what Python does; it moves; it is whole."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from compare import chart, crosscheck, tongues
from compare.__main__ import main
from compare.charts import surface
from compare.explorer import page as module
from compare.explorer.data import data_of
from compare.explorer.page import explorer_page
from compare.symbols import GREEK, in_letters
from hill import Fourier, MatrixSystem, PeriodicSystem, SteppedBeam, UniformBeam, Vehicle

pytest.importorskip("bokeh")

K = Fourier([[1.0, 0.0], [0.0, 5.29]], cos={1: [[0.4, 0.3], [0.2, 0.8]]})
C = Fourier([[0.04, 0.3], [-0.3, 0.06]], sin={1: [[0.1, 0.05], [0.0, 0.1]]})
WINDOW = [("Omega", 0.9, 1.3, 40), ("gamma", 0.0, 0.3, 30)]
BEAM = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5)
STEPPED = SteppedBeam(T0=20.0, K_theta=1.0, xi_G=0.5, xi_c=0.6, area_ratio=0.6, inertia_ratio=0.6)
CHARTS = {
    "one coordinate, damped": (
        MatrixSystem(F=[[1.0]], G=[[1.0]]),
        [("Omega", 0.5, 3.0, 40), ("gamma", 0.0, 0.8, 30)],
        {"eta": 0.02},
    ),
    "uniform": (BEAM, WINDOW, {}),
    "uniform, thrust": (BEAM, [*WINDOW, ("T0", 12.0, 20.0, 9)], {}),
    "uniform, thrust and damping": (
        UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=1),
        # enough points for a series to be worth its nodes
        [
            ("Omega", 1.0, 1.2, 100),
            ("gamma", 0.0, 0.3, 50),
            ("T0", 18.0, 20.0, 9),
            ("eta", 0.0, 0.02, 3),
        ],
        {},
    ),
    "stepped": (STEPPED, [("Omega", 0.7, 1.4, 40), ("gamma", 0.0, 0.4, 30)], {}),
    "five coordinates": (UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=4), WINDOW, {}),
    "no pairs": (
        PeriodicSystem(K=K, C=C, frequency_names=("low", "high")),
        [("Omega", 2.8, 3.8, 40), ("gamma", 0.0, 1.0, 30)],
        {},
    ),
    "poles askew": (
        UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5),
        [("Omega", 1.6, 2.4, 71), ("omega_L", 1.5, 3.0, 61)],
        {"gamma": 0.1},
    ),
    "poles": (
        UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, omega_L=2.3),
        [("Omega", 1.9, 2.6, 40), ("gamma", 0.0, 0.2, 20)],
        {},
    ),
}


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Each chart and its page, made when it is asked for."""
    made = {}

    def page(name):
        if name not in made:
            system, axes, forcing = CHARTS[name]
            own = chart(system, axes, forcing=forcing, route="floquet")
            path = tmp_path_factory.mktemp("pages") / "page.html"
            edges = tongues(own, 1) if name == "uniform" else ()
            path.write_text(explorer_page(own, title="mine & yours", tongues=edges))
            made[name] = own, path
        return made[name]

    return page


def opened(browser, path, **screen):
    browser.look(**screen)
    browser.open(path)
    wait(browser, "return document.body.dataset.ready === 'true'")


def wait(browser, condition):
    from selenium.webdriver.support.ui import WebDriverWait

    WebDriverWait(browser.driver, 30).until(lambda _: browser.run(condition))


@pytest.mark.parametrize("name", CHARTS)
def test_the_script_evaluates_what_python_does(name, pages, browser):
    own, path = pages(name)
    opened(browser, path)
    random = np.random.default_rng(7)
    points = np.column_stack([a.low + (a.high - a.low) * random.random(4000) for a in own.axes])
    has_series = np.isfinite(
        surface.evaluate(own.surface, own.scenario.smooth.to_smooth(points))[1]
    )
    points = points[has_series][:1000]
    assert len(points) == 1000
    found = browser.run(
        """const of = (v) => (Number.isFinite(v) ? v : null);
        return arguments[0].map((point) => {
            const {P, T, T_error, verdict, mu, nearby} = window.explorer.chart.at(point);
            return {P, T: of(T), T_error: of(T_error), verdict, mu, nearby};
        });""",
        points.tolist(),
    )
    expected = own.at(**dict(zip(own.scenario.names, points.T, strict=True)))
    size = np.abs(expected.polynomial).max(axis=1)
    P = np.array([f["P"] for f in found])
    # both sum the same series: rounding is what differs
    assert np.all(np.abs(P - expected.polynomial).max(axis=1) <= 1e-13 * size)
    T, T_error = (np.array([f[key] for f in found], float) for key in ("T", "T_error"))
    assert np.abs(T - expected.T).max() <= 1e-9
    verdicts = [f["verdict"] for f in found]
    assert verdicts == expected.verdict.tolist()
    assert {"stable", "unstable"} <= set(verdicts)
    # the radii tried are half a power of two apart: rounding may choose the next one
    ratio = T_error / expected.T_error
    assert np.all((ratio > 0.49) & (ratio < 2.05))
    moduli = np.sort(np.hypot(*np.moveaxis(np.array([f["mu"] for f in found]), 2, 0)))
    assert moduli[:, -1] == pytest.approx(np.abs(expected.multipliers).max(axis=1), abs=1e-7)
    assert all(f["nearby"] is None for f in found)
    assert browser.complaints() == []


def test_what_has_no_series_is_told_of_the_charts_own_point(pages, browser):
    own, path = pages("poles")
    opened(browser, path)
    Omega, gamma = own.axes
    indices = np.indices([axis.count for axis in own.axes])
    alone = np.concatenate([indices[:, *cells.where].reshape(2, -1) for cells in own.alone], 1).T
    assert len(alone) > 50
    points = np.column_stack([Omega.points[alone[:, 0]], gamma.points[alone[:, 1]]])
    found = browser.run(
        """return arguments[0].map((point) => {
            const {T, verdict, nearby} = window.explorer.chart.at(point);
            return [String(T), verdict, nearby];
        });""",
        (points + 0.2 * np.array([Omega.points[1] - Omega.points[0], 0.0])).tolist(),
    )
    beside = [f[2] is not None for f in found]
    # the last ones before a series are nearer to it than to themselves
    assert np.mean(beside) > 0.7
    T = own.T[alone[:, 1], alone[:, 0]]
    for (told, _, nearby), expected, point in zip(found, T, points, strict=True):
        if nearby is not None and np.allclose(nearby, point, atol=1e-12):
            assert float(told) == pytest.approx(expected, abs=1e-7)


def test_its_sliders_redraw_the_map_and_the_point(pages, browser):
    own, path = pages("uniform, thrust")
    opened(browser, path)
    slide = """const slider = document.querySelector("input[type=range]");
        slider.value = arguments[0];
        slider.dispatchEvent(new Event("input", {bubbles: true}));
        const {state, nx} = window.explorer.window();
        return [slider.getAttribute("aria-valuetext"), document.querySelector("#share").textContent,
            nx, state.reduce((sum, s) => sum + (s === 1), 0) / state.length];"""
    shares = []
    for at in (0, 8):
        value, words, columns, unstable = browser.run(slide, at)
        T0 = own.axes[2].points[at]
        assert float(value) == pytest.approx(T0)
        # the coarse map is there before anything else happens
        assert columns == 140
        assert words.startswith(f"{100 * unstable:.1f} %")
        assert unstable == pytest.approx(own.unstable()[at].mean(), abs=0.02)
        shares.append(unstable)
        wait(browser, "return window.explorer.window().nx > 140")
    assert shares[1] > 1.2 * shares[0]
    assert browser.complaints() == []


def test_a_click_tells_of_the_point_and_hovering_too(pages, browser):
    from selenium.webdriver.common.action_chains import ActionChains

    own, path = pages("uniform")
    opened(browser, path)
    box = browser.driver.find_element("css selector", "#map")
    ActionChains(browser.driver).move_to_element(box).perform()
    wait(browser, "return !document.querySelector('#bubble').hidden")
    bubble = browser.run("return document.querySelector('#bubble').innerText")
    ActionChains(browser.driver).click(box).perform()
    wait(browser, "return document.querySelector('[name=Omega]').value !== '1.1'")
    at = {
        n: float(browser.run(f"return document.querySelector('[name={n}]').value"))
        for n in own.scenario.names
    }
    told = browser.run("return document.querySelector('#told').innerText")
    there = own.at(**at)
    T = float(re.search(r"T\s+([\d.e−-]+)", told)[1].replace("−", "-"))
    assert pytest.approx(there.T[0], abs=1e-5) == T
    assert there.verdict[0] in told
    assert there.verdict[0] in bubble
    names = [
        t.resonance.name.replace("omega_", "ω")
        for t in tongues(own, 1)
        if (e := t.at(at["gamma"])) and e[0] <= at["Omega"] <= e[1]
    ]
    assert names
    assert all(name in told and name in bubble for name in names)
    rows = browser.run("return document.querySelectorAll('#multipliers tbody tr').length")
    assert rows == there.multipliers.shape[1]
    per_unit = float(re.search(r"exponent ([\d.]+)", told)[1])
    assert per_unit == pytest.approx(0.5 * there.T[0], rel=1e-3)
    browser.run("""const f = document.querySelector("[name=hertz]"); f.value = 2;
        f.dispatchEvent(new Event("change"));""")
    told = browser.run("return document.querySelector('#told').innerText")
    assert f"per second, exponent {0.5 * there.T[0] * 4.0 * np.pi:.3f}" in told
    assert browser.complaints() == []


@pytest.mark.parametrize("dark", [False, True])
def test_it_has_names_and_fits_a_phone(dark, pages, browser):
    _, path = pages("uniform, thrust")
    opened(browser, path, width=390, height=800, dark=dark)
    assert browser.driver.title == "mine & yours: T over Ω and γ, with T₀"
    assert browser.nameless() == []
    assert browser.run("return document.documentElement.scrollWidth") == 390
    paper = browser.run("return getComputedStyle(document.body).backgroundColor")
    assert (sum(map(int, re.findall(r"\d+", paper))) < 200) is dark
    assert browser.run("return window.explorer.map.background_fill_color") == (
        "#15171a" if dark else "#ffffff"
    )
    assert browser.complaints() == []


def test_it_is_whole_and_the_same_each_time(pages):
    own, path = pages("uniform, thrust")
    text = path.read_text()
    # Bokeh's two scripts are long
    scripts = re.findall(r"<script>.*?</script>", text, flags=re.DOTALL)
    library = [script for script in scripts if len(script) > 100_000]
    assert len(library) == 2
    own_parts = text
    for script in library:
        own_parts = own_parts.replace(script, "")
    assert len(own_parts) < 200_000 < len(text) < 3_000_000
    assert not re.search(r"(src|href)=(?!\"data:)", own_parts)
    assert "http" not in own_parts
    assert "BSD" in text
    assert "Redistributions" in text
    assert '"error_of_P"' not in text
    assert "made by floquet-crosscheck" in text.lower()
    assert explorer_page(own, title="mine & yours") == text


def test_what_a_title_says_is_words(pages):
    own, _ = pages("one coordinate, damped")
    text = explorer_page(own, title="</title><script>alert(1)</script>")
    assert "<script>alert" not in text


def test_no_page_of_one_axis_or_of_five(tmp_path):
    one = chart(BEAM, WINDOW[:1], forcing={"gamma": 0.1}, route="floquet")
    with pytest.raises(ValueError, match="2 to 4"):
        data_of(one)
    with pytest.raises(ValueError, match="2 to 4"):
        one.save(tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_too_large_a_page_is_refused(pages, monkeypatch):
    own, _ = pages("stepped")
    monkeypatch.setattr(module, "LARGEST", 1000)
    with pytest.raises(ValueError, match="at most in a page"):
        explorer_page(own)


def test_without_bokeh_it_is_refused_before_the_work(monkeypatch, capsys):
    monkeypatch.setattr(module, "find_spec", lambda _: None)
    words = ["chart", "--x", "Omega", "1", "2", "9", "--y", "gamma", "0", "1", "9"]
    assert main([*words, "--output", "page.html"]) == 2
    assert "floquet-crosscheck[explore]" in capsys.readouterr().err


def test_the_command_writes_one(tmp_path):
    path = tmp_path / "page.html"
    words = ["chart", "--x", "Omega", "0.9", "1.3", "9", "--y", "gamma", "0", "0.3", "9"]
    more = ["--also", "T0", "18", "20", "3", "--also", "eta", "0", "0.01", "3"]
    assert main([*words, *more, "--route", "floquet", "--output", str(path)]) == 0
    data = re.search(r'id="data">(.*?)</script>', path.read_text(), re.DOTALL)[1]
    assert [axis["name"] for axis in json.loads(data)["axes"]] == ["Omega", "gamma", "T0", "eta"]


def test_names_in_letters():
    assert [in_letters(n) for n in ("T0", "K_theta", "Omega", "omega_L", "c12", "area_ratio")] == [
        "T₀",
        "K_θ",
        "Ω",
        "ω_L",
        "c₁₂",
        "area ratio",
    ]
    assert all(len(in_letters(name)) == 1 for name in GREEK)


def test_a_chart_saves_itself(pages, tmp_path):
    own, _ = pages("one coordinate, damped")
    for kind in ("html", "npz", "csv", "json"):
        own.save(tmp_path / f"chart.{kind}")
    assert len(list(tmp_path.iterdir())) == 4
    assert json.loads((tmp_path / "chart.json").read_text())["tongues"]
    with pytest.raises(ValueError, match="must end in"):
        own.save(Path(tmp_path / "chart.doc"))


def test_a_vehicle_of_ones_own_is_in_hertz_and_grows_per_second():
    pytest.importorskip("skfem")
    vehicle = Vehicle.from_file(Path(__file__).parent.parent / "examples" / "uniform.toml")
    assert vehicle.damping.eta > 0.0
    own = chart(vehicle, [("Omega", 6.0, 8.0, 30), ("gamma", 0.0, 0.3, 20)], route="floquet")
    for Omega, gamma in ((7.114, 0.25), (6.5, 0.2)):
        x = crosscheck(vehicle, Omega=Omega, gamma=gamma)
        there = own.at(Omega=Omega, gamma=gamma)
        assert there.T[0] == pytest.approx(x.T, abs=1e-8)
        assert there.verdict[0] == x.verdict
    data = data_of(own)
    assert (data["axes"][0]["label"], data["time"]) == ("pulsation, Hz", "s")
    assert data["axes"][0]["per"] == pytest.approx(2.0 * np.pi)
