"""The pages of docs/: their code runs and prints what they say, and every link leads somewhere."""

import contextlib
import io
import re
import shlex
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path

import pytest

from compare.__main__ import main

ROOT = Path(__file__).parents[1]
TOLD = ("tutorial.md", "howto.md")
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def blocks(name: str, language: str) -> list[str]:
    page = text_of(ROOT / "docs" / name)
    return re.findall(rf"^```{language}\n(.*?)^```$", page, flags=re.M | re.S)


@pytest.fixture
def aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty place with the examples in sight."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("name", TOLD)
def test_python_blocks_print_what_they_say(name: str, aside: Path) -> None:
    namespace: dict[str, object] = {"__name__": "told"}
    shown = blocks(name, "text")
    for block in blocks(name, "python"):
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(block, name, "exec"), namespace)
        lines = printed.getvalue().splitlines()
        said = re.findall(r"^print\(.*\)  # (.*)$", block, flags=re.M)
        assert lines[: len(said)] == said
        # what a loop prints, at the end, stands in a block of its own
        looped = "".join(f"{line}\n" for line in lines[len(said) :])
        assert looped in shown if re.search(r"^ +print", block, flags=re.M) else not looped


COMMANDS = [line for name in TOLD for block in blocks(name, "sh") for line in block.splitlines()]


@pytest.mark.parametrize("line", COMMANDS)
def test_commands_run(line: str, aside: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = shlex.split(line)
    assert words[0] == "verify"
    assert main(words[1:]) == 0
    assert capsys.readouterr().out


@pytest.mark.parametrize("name", TOLD)
def test_files_are_files(name: str) -> None:
    for block in blocks(name, "toml"):
        assert tomllib.loads(block)["kind"]


# ---- links ---------------------------------------------------------------------------------------


def without_code(text: str) -> str:
    text = re.sub(r"^(```+).*?^\1$", "", text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "", text)


def links(page: Path) -> list[str]:
    return re.findall(r"\]\(([^)\s]+)\)", without_code(text_of(page)))


def anchors(page: Path) -> set[str]:
    """As GitHub makes them: words in small letters, hyphens between."""
    found: set[str] = set()
    text = re.sub(r"^(```+).*?^\1$", "", text_of(page), flags=re.M | re.S)
    for title in re.findall(r"^#+ (.*)$", text, flags=re.M):
        plain = re.sub(r"[`*$]|\]\([^)]*\)|\[", "", title).strip().lower()
        slug = re.sub(r"[^\w\- ]", "", plain).replace(" ", "-")
        taken = sum(1 for other in found if re.fullmatch(rf"{re.escape(slug)}(-\d+)?", other))
        found.add(f"{slug}-{taken}" if slug in found else slug)
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page: Path) -> None:
    for link in links(page):
        if link.startswith("https://"):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.is_relative_to(ROOT), link
        assert target.exists(), link
        assert not anchor or anchor in anchors(target), link


def test_there_are_links() -> None:
    """Else the pattern above sees none."""
    assert sum(len(links(page)) for page in PAGES) > 40


def test_every_page_is_in_the_table_of_contents() -> None:
    listed = re.findall(r"^([\w/-]+)$", text_of(ROOT / "docs" / "index.md"), flags=re.M)
    pages = {page.relative_to(ROOT / "docs") for page in ROOT.glob("docs/**/*.md")}
    names = (page.with_suffix("").as_posix() for page in pages if page.name != "index.md")
    assert sorted(listed) == sorted(names)


# ---- the site ------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built with warnings as errors."""
    if not (find_spec("sphinx") and find_spec("myst_parser") and find_spec("furo")):
        pytest.skip("needs the extra: docs")
    out = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "sphinx", "-q", "-W", "-b", "html", ROOT / "docs", out]
    built = subprocess.run(command, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stderr
    return out


LOADED = r"<(?:script|img|link|iframe)[^>]*?(?:src|href)=\"([^\"]+)\""


def test_the_site_loads_nothing_from_elsewhere(site: Path) -> None:
    pages = list(site.rglob("*.html"))
    assert len(pages) > 10
    for page in pages:
        loaded = re.findall(
            r"<(?:script|img|link|iframe)[^>]*?(?:src|href)=\"([^\"]+)\"", text_of(page)
        )
        assert loaded
        assert not [name for name in loaded if re.match(r"(https?:)?//", name)], page
    for sheet in site.rglob("*.css"):
        assert not re.findall(r"(?:url\(|@import )[\"']?(?:https?:)?//", text_of(sheet)), sheet


def test_the_reference_has_every_public_name(site: Path) -> None:
    for package in ("hill", "floquet", "compare"):
        page = text_of(site / "reference" / f"{package}.html")
        for name in __import__(package).__all__:
            assert f'id="{package}.{name}"' in page, name


def test_mathematics_is_mathematics(site: Path) -> None:
    theory = text_of(site / "theory.html")
    assert theory.count("<math") > 100
    assert "merror" not in theory
