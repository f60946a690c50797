"""The compiled march is the user's own, is what was built, and costs nothing but speed."""

import ctypes
import os
import shutil
import signal
import stat
import subprocess
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from floquet.batch import c_kernel
from floquet.batch.numpy_kernel import ORDER, TOLERANCE, Found, Points, by_numpy
from floquet.batch.which_kernel import kernel_in_use
from floquet.integrate.step_length import RADII, fastest_rate, longest_step

pytestmark = pytest.mark.skipif(
    c_kernel.compiler() is None or os.name != "posix", reason="no C compiler here, or no POSIX"
)


@pytest.fixture(autouse=True)
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    c_kernel.forget()
    yield tmp_path / "cache" / "floquet-crosscheck"
    c_kernel.forget()


def library(folder: Path) -> Path:
    (found,) = folder.glob("march-*.so")
    return found


def works() -> bool:
    march = c_kernel.march(2, 1)
    if march is None:
        return False
    points = Points(np.array([np.eye(2), np.eye(2)]), np.full((2, 1), 0.1), np.zeros(1), (1,))
    return bool(np.allclose(march(points).P, by_numpy(points).P, rtol=0, atol=1e-13))


def fake(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str) -> None:
    """A compiler of one's own."""
    path = tmp_path / "fakecc"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    monkeypatch.setenv("CC", str(path))


def test_it_is_kept_and_belongs_to_the_user(own_cache: Path) -> None:
    assert works()
    assert stat.S_IMODE(own_cache.stat().st_mode) == 0o700
    first = library(own_cache).stat().st_mtime_ns
    c_kernel.forget()
    assert works()
    assert library(own_cache).stat().st_mtime_ns == first


def test_it_is_said_which_kernel_is_in_use(
    own_cache: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert kernel_in_use().endswith("none built yet")
    assert works()
    assert kernel_in_use().endswith("1 built and kept")
    library(own_cache).chmod(0o666)  # what others can write to does not count
    assert kernel_in_use().endswith("none built yet")
    fake(tmp_path, monkeypatch, f"touch {tmp_path}/run; sleep 60")
    assert kernel_in_use().startswith("compiled by fakecc")
    assert not (tmp_path / "run").exists()
    monkeypatch.setattr(c_kernel, "compiler", lambda: None)
    assert kernel_in_use() == "by numpy, as there is no C compiler"


@pytest.mark.parametrize("content", [b"", b"\x7fELF", None], ids=["empty", "ELF", "truncated"])
def test_a_spoilt_library_is_built_again(own_cache: Path, content: bytes | None) -> None:
    assert works()
    path = library(own_cache)
    # in its place, not in it: it is mapped here
    other = path.with_suffix(".other")
    other.write_bytes(path.read_bytes()[:4000] if content is None else content)
    other.replace(path)
    c_kernel.forget()
    assert works()
    assert path.stat().st_size > 8000


@pytest.mark.parametrize("content", [b"", b"\xff\xfe", None], ids=["empty", "no text", "missing"])
def test_a_spoilt_digest_is_written_again(own_cache: Path, content: bytes | None) -> None:
    assert works()
    path = library(own_cache).with_suffix(".sha256")
    good = path.read_bytes()
    path.unlink()
    if content is not None:
        path.write_bytes(content)
    c_kernel.forget()
    assert works()
    assert path.read_bytes() == good


def test_nobody_else_may_write_whatever_the_umask(own_cache: Path) -> None:
    before = os.umask(0)
    try:
        assert works()
    finally:
        os.umask(before)
    first = library(own_cache).stat().st_mtime_ns
    assert [p.name for p in own_cache.iterdir() if p.stat().st_mode & 0o022] == []
    c_kernel.forget()
    assert works()
    assert library(own_cache).stat().st_mtime_ns == first


@pytest.mark.parametrize("suffix", [".so", ".sha256"])
def test_what_others_could_write_to_is_built_again(own_cache: Path, suffix: str) -> None:
    assert works()
    path = library(own_cache).with_suffix(suffix)
    path.chmod(0o666)
    c_kernel.forget()
    assert works()
    assert not path.stat().st_mode & 0o022


def test_a_folder_of_somebody_else_is_not_used(
    own_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    own_cache.mkdir(parents=True, mode=0o700)
    # to root, who runs this in a container, every mode is writable; the owner is what tells
    monkeypatch.setattr(os, "getuid", lambda: own_cache.stat().st_uid + 1)
    assert c_kernel.cache_folder() != own_cache
    assert list(own_cache.iterdir()) == []


def test_where_nobody_owns_anything_the_folder_is_used(
    own_cache: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on Windows, which has neither owner nor mode to look at."""
    monkeypatch.delattr(os, "getuid")
    assert works()
    assert library(own_cache).is_file()


def test_a_planted_library_is_not_loaded(own_cache: Path, tmp_path: Path) -> None:
    """It would say so in a file as it is loaded."""
    assert works()
    path, told = library(own_cache), tmp_path / "loaded"
    source = tmp_path / "planted.c"
    source.write_text(
        "#include <stdio.h>\n__attribute__((constructor)) static void f(void)"
        f'{{ fclose(fopen("{told}", "w")); }}\nint march(void) {{ return 0; }}\n'
    )
    os.system(f"{c_kernel.compiler()} -shared -fPIC -o {path} {source}")
    c_kernel.forget()
    assert works()
    assert not told.exists()


def test_a_folder_that_others_can_write_to_is_not_used(own_cache: Path) -> None:
    own_cache.mkdir(parents=True)
    own_cache.chmod(0o777)
    assert works()
    assert list(own_cache.iterdir()) == []


def test_a_folder_that_is_a_link_is_not_used(own_cache: Path, tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    own_cache.parent.mkdir(parents=True)
    own_cache.symlink_to(tmp_path / "elsewhere")
    assert works()
    assert list((tmp_path / "elsewhere").iterdir()) == []


@pytest.mark.parametrize(
    "script",
    [
        "exit 1",
        "exit 0",
        'for a; do case "$a" in *.so) echo rubbish > "$a";; esac; done',
        "kill -9 $$",
    ],
    ids=["fails", "does nothing", "writes rubbish", "dies"],
)
def test_a_poor_compiler_costs_speed_alone(
    script: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake(tmp_path, monkeypatch, script)
    assert c_kernel.march(2, 1) is None
    # it is not held against another one
    monkeypatch.delenv("CC")
    assert works()


def test_a_compiler_that_lies_about_the_result(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    real = shutil.which("cc") or shutil.which("gcc") or c_kernel.compiler()
    fake(tmp_path, monkeypatch, f'exec {real} "$@" -D__lying -Dcos=sin')
    assert c_kernel.march(2, 1) is None


@pytest.mark.parametrize("part", ["P", "sensitivity", "growth", "rate"])
@pytest.mark.parametrize("share", [0.5, np.nan])
def test_each_part_of_the_result_is_tried(part: str, share: float) -> None:
    """P could be right and its error a half of what it is."""

    def lying(points: Points) -> Found:
        found = by_numpy(points)
        return replace(found, **{part: share * vars(found)[part]})

    assert c_kernel._tried(by_numpy, 2, 1) is by_numpy
    with pytest.raises(ValueError, match="something else"):
        c_kernel._tried(lying, 2, 1)


def test_a_library_without_the_function(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    real = shutil.which("cc") or shutil.which("gcc") or c_kernel.compiler()
    fake(tmp_path, monkeypatch, f'exec {real} "$@" -Dmarch=other')
    assert c_kernel.march(2, 1) is None


def test_a_library_that_reports_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its only failure is want of memory, which is no reason to give up on the points."""
    real = c_kernel.compiler()
    source = tmp_path / "failing.c"
    source.write_text("int march(void) { return 1; }\n")
    script = f"""[ "$1" = --version ] && exit 0
while [ $# -gt 0 ]; do [ "$1" = -o ] && out=$2; shift; done
exec {real} -shared -fPIC -o "$out" {source}"""
    fake(tmp_path, monkeypatch, script)
    assert c_kernel.march(2, 1) is None


def test_a_mended_compiler_is_asked_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In the same process, under the same name."""
    real = c_kernel.compiler()
    fake(tmp_path, monkeypatch, "exit 1")
    assert c_kernel.march(2, 1) is None
    fake(tmp_path, monkeypatch, f'exec {real} "$@"')
    os.utime(tmp_path / "fakecc", ns=(1, 1))
    assert works()


def test_a_failure_is_not_believed_for_ever(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same compiler, untouched: its disk was full, and is no longer."""
    real, full, asked = c_kernel.compiler(), tmp_path / "full", tmp_path / "asked"
    fake(tmp_path, monkeypatch, f'echo x >> {asked}; [ -e {full} ] && exit 1; exec {real} "$@"')
    full.touch()
    assert c_kernel.march(2, 1) is None
    times = len(asked.read_text())
    assert c_kernel.march(2, 1) is None
    full.unlink()
    assert c_kernel.march(2, 1) is None
    assert len(asked.read_text()) == times  # not asked again at once
    monkeypatch.setattr(c_kernel, "RETRY_AFTER", 0.0)
    assert works()


@pytest.mark.parametrize("n", [1, 2, 5])
def test_steps_are_as_long_in_c_as_in_python(n: int, tmp_path: Path) -> None:
    """The rule is written twice; in C the Perron root is a bound, so that no step is longer."""
    source = files("floquet").joinpath("batch", "kernel.c").read_text()
    source += (
        "\ndouble step(const double *worst, const int *phases, const double *radii,"
        " double tolerance, double *rate)"
        "\n{ return longest_step(worst, phases, radii, tolerance, rate); }\n"
    )
    (tmp_path / "step.c").write_text(source)
    options = [f"-D{name}={value}" for name, value in c_kernel.defines(n, 2).items()]
    words = [str(c_kernel.compiler()), *options, "-O1", "-shared", "-fPIC", "-o"]
    words += [str(tmp_path / "step.so"), str(tmp_path / "step.c"), "-lm"]
    subprocess.run(words, check=True, capture_output=True)
    step = ctypes.CDLL(str(tmp_path / "step.so")).step
    step.restype = ctypes.c_double
    rng = np.random.default_rng(n)
    for frequencies in ((1, 1), (1, 2), (3, 7)):
        worst = np.abs(rng.standard_normal((3, n, n))) * 10.0 ** rng.uniform(-1, 2)
        rate = ctypes.c_double()
        found = step(
            worst.ctypes.data_as(ctypes.c_void_p),
            (ctypes.c_int * 2)(*frequencies),
            RADII.ctypes.data_as(ctypes.c_void_p),
            ctypes.c_double(TOLERANCE),
            ctypes.byref(rate),
        )
        terms = list(zip(worst, (0.0, *map(float, frequencies)), strict=True))
        nothing = np.zeros((n, n))
        expected = longest_step(terms, nothing, ORDER, TOLERANCE)
        # with one coordinate the root is the element; of five the bound is 1.1 times the root
        shortest = 1.0 - (1e-13 if n == 1 else 0.06)
        assert shortest * expected <= found <= (1.0 + 1e-13) * expected
        fastest = fastest_rate(terms, nothing)
        assert fastest * (1.0 - 1e-13) <= rate.value <= fastest * (2.0 - shortest)


@pytest.mark.parametrize("stage", ["VERSION_TIMEOUT", "BUILD_TIMEOUT"])
def test_what_leaves_the_group_is_not_waited_for(
    stage: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A daemon that the compiler starts keeps its output open; it is not ours to end."""
    if shutil.which("setsid") is None:
        pytest.skip("no setsid")
    quick = '[ "$1" = --version ] && exit 0' if stage == "BUILD_TIMEOUT" else ":"
    fake(tmp_path, monkeypatch, f"{quick}\nsetsid sleep 30 & echo $! > {tmp_path}/child; sleep 30")
    monkeypatch.setattr(c_kernel, stage, 0.5)
    started = time.monotonic()
    try:
        assert c_kernel.march(2, 1) is None
        assert time.monotonic() - started < 10.0
    finally:
        with suppress(ProcessLookupError):
            os.kill(int((tmp_path / "child").read_text()), signal.SIGKILL)


def test_a_compiler_that_hangs_is_ended_with_its_children(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake(tmp_path, monkeypatch, f"sleep 300 & echo $! > {tmp_path}/child; sleep 300")
    monkeypatch.setattr(c_kernel, "VERSION_TIMEOUT", 1.0)
    started = time.monotonic()
    assert c_kernel.march(2, 1) is None
    assert time.monotonic() - started < 20.0
    child = int((tmp_path / "child").read_text())
    for _ in range(50):
        # a zombie waits for whoever adopts it
        status = Path(f"/proc/{child}/stat")
        if not status.exists() or status.read_text().split()[2] == "Z":
            break
        time.sleep(0.1)
    else:
        pytest.fail("the compiler's child is still running")
