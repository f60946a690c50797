"""Matrices given row by row, or by the name of a file that holds them."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hill import Fourier, checks
from hill.toml import one_of, only, table, unreadable

Float = NDArray[np.float64]

MAX_ROWS = 5000
"""Of a matrix: a full one takes 200 MB, and no route ends with it."""


def matrix(name: str, value: Any, folder: Path) -> Float:
    """A matrix given row by row, or as "file.npz:array", "file.mat:array" or "file.mtx".

    Raises
    ------
    ValueError
        It is not one, or the file is not there or does not have it.
    """
    if not isinstance(value, str):
        return checks.square(name, value)
    file, _, array = value.partition(":")
    path = folder / file
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ValueError(
            f"{name} = {value!r}: must be rows of numbers or a file's name, {', '.join(READERS)}"
        )
    if path.suffix.lower() != ".mtx" and not array:
        raise ValueError(f'{name} = {value!r}: must name the array too, as "{file}:F"')
    try:
        found = reader(path, array)
    except OSError as error:
        raise ValueError(f"{name} = {value!r}: {unreadable(error)}") from None
    return checks.square(name, found)


def _named(available: Mapping[str, Any], array: str, path: Path) -> Any:
    if array not in available:
        names = [name for name in available if not name.startswith("__")]
        raise ValueError(f"{path.name} has no array {array!r}: {one_of(array, names)}")
    return available[array]


def _npz(path: Path, array: str) -> Any:
    from zipfile import BadZipFile

    # opened here: numpy leaves a file open that it cannot read
    with path.open("rb") as file:
        try:
            archive = np.load(file, allow_pickle=False)
        except (BadZipFile, EOFError, ValueError):
            archive = None
        if not hasattr(archive, "files"):
            raise ValueError(f"{path.name}: is not an .npz archive")
        # of the others nothing is read
        name = _named({name: name for name in archive.files}, array, path)
        try:
            return archive[name]
        except ValueError:
            raise ValueError(f"{path.name}: {array} is no array of numbers") from None
        except (BadZipFile, EOFError):
            raise ValueError(f"{path.name}: {array} cannot be read, the file is damaged") from None


def _mat(path: Path, array: str) -> Any:
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    try:
        return _dense(_named(loadmat(str(path)), array, path), path)
    except NotImplementedError:
        raise ValueError(
            f"{path.name}: is a .mat file of version 7.3; save it as version 7 (save -v7)"
        ) from None
    except (MatReadError, IndexError) as error:
        # what is shorter than a header some versions of scipy index beyond
        raise ValueError(f"{path.name}: is not a .mat file ({error})") from None


def _mtx(path: Path, _: str) -> Any:
    from scipy.io import mminfo, mmread

    if not path.is_file():
        raise FileNotFoundError(2, "no such file or directory")
    try:
        _check_size(mminfo(str(path))[:2], path)
        return _dense(mmread(str(path)), path)
    except ValueError as error:
        words = str(error).removeprefix(f"{path.name}: ")
        raise ValueError(f"{path.name}: {words}") from None


def _dense(found: Any, path: Path) -> Any:
    if not hasattr(found, "toarray"):
        return found
    _check_size(found.shape, path)
    return found.toarray()


def _check_size(shape: Sequence[int], path: Path) -> None:
    """Refuse before it is written out what would not fit."""
    if max(shape) > MAX_ROWS:
        size = " x ".join(f"{count:,}" for count in shape)
        raise ValueError(f"{path.name}: is {size}, must have at most {MAX_ROWS:,} rows")


def periodic(name: str, value: Any, folder: Path) -> Float | Fourier:
    """A matrix, or a table of its mean, cos.1, cos.2, ... and sin.1, sin.2, ...

    Raises
    ------
    ValueError
        A key that is none of these; an index that is not a whole number >= 1; as `matrix`.
    """
    if not isinstance(value, dict):
        return matrix(name, value, folder)
    only(value, ("mean", "cos", "sin"), f"{name}.")
    if "mean" not in value:
        raise ValueError(f"{name}.mean: has no value")
    terms = {
        which: {
            _index(f"{name}.{which}", k): matrix(f"{name}.{which}.{k}", term, folder)
            for k, term in table(value, which).items()
        }
        for which in ("cos", "sin")
    }
    mean = matrix(f"{name}.mean", value["mean"], folder)
    return Fourier(mean, terms["cos"], terms["sin"], name=name)


def _index(name: str, word: str) -> int:
    if not word.isascii() or not word.isdigit() or int(word) < 1:
        raise ValueError(f"{name}.{word}: the index must be a whole number >= 1")
    return int(word)


READERS: dict[str, Callable[[Path, str], Any]] = {".npz": _npz, ".mat": _mat, ".mtx": _mtx}
