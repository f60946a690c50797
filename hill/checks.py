"""Refusals: one clear line that names the parameter, its value and what would be right."""

import math
from collections.abc import Iterable
from numbers import Integral, Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def number(name: str, value: Any) -> float:
    """Return `value` as a float, or raise `ValueError` if it is not one finite real number."""
    if type(value) is float and math.isfinite(value):  # nearly all are; a chart asks ten thousand
        return value
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Real):
        raise ValueError(f"{name} = {value!r}: must be a real number")
    try:
        checked = float(value)
    except OverflowError:
        raise ValueError(f"{name}: is too large for a float") from None
    if not math.isfinite(checked):
        raise ValueError(f"{name} = {checked}: must be finite")
    return checked


def positive(name: str, value: Any, *, or_infinite: bool = False) -> float:
    """Return `value` as a float > 0; `or_infinite` admits `inf`."""
    if or_infinite and isinstance(value, Real) and value == math.inf:
        return math.inf
    checked = number(name, value)
    if checked <= 0.0:
        raise ValueError(f"{name} = {checked:g}: must be greater than 0")
    return checked


def between(name: str, value: Any, least: float, most: float) -> float:
    """Return `value` as a float, least <= value <= most."""
    checked = number(name, value)
    if not least <= checked <= most:
        raise ValueError(f"{name} = {checked:g}: must be between {least:g} and {most:g}")
    return checked


def station(name: str, value: Any) -> float:
    """Return `value` as a position on the beam, 0 <= xi <= 1."""
    return between(name, value, 0.0, 1.0)


def count(name: str, value: Any, *, least: int, most: int | None = None) -> int:
    """Return `value` as an int >= `least`, and <= `most` if there is one."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, Integral):
        raise ValueError(f"{name} = {value!r}: must be a whole number")
    if value < least:
        raise ValueError(f"{name} = {value}: must be at least {least}")
    if most is not None and int(value) > most:
        raise ValueError(f"{name} = {value}: must be at most {most:,}")
    return int(value)


def flag(name: str, value: Any) -> bool:
    """Return `value` as a bool, or raise `ValueError` if it is not one."""
    if not isinstance(value, (bool, np.bool_)):
        raise ValueError(f"{name} = {value!r}: must be True or False")
    return bool(value)


def square(
    name: str, value: ArrayLike, *, n: int | None = None, like: str = "F"
) -> NDArray[np.float64]:
    """Return `value` as a read-only finite n-by-n float array; `like` names what has that size."""
    try:
        raw = np.asarray(value)
        if np.ma.is_masked(value):
            raise ValueError(f"{name}: has masked elements; every one must be a number")
        if np.iscomplexobj(raw) or raw.dtype == bool:
            raise TypeError
        matrix = np.array(raw, dtype=np.float64)
    except (TypeError, ValueError) as error:
        if "masked" in str(error):
            raise
        raise ValueError(f"{name}: must be a matrix of real numbers") from None
    if matrix.ndim != 2 or matrix.shape[0] != matrix.shape[1] or matrix.size == 0:
        raise ValueError(f"{name} has shape {matrix.shape}: must be square and not empty")
    if n is not None and matrix.shape[0] != n:
        raise ValueError(f"{name} has shape {matrix.shape}: must be ({n}, {n}) like {like}")
    if not np.all(np.isfinite(matrix)):
        i, j = np.argwhere(~np.isfinite(matrix))[0]
        raise ValueError(f"{name}[{i}, {j}] = {matrix[i, j]}: every element must be finite")
    matrix.flags.writeable = False
    return matrix


def matrices(name: str, values: Iterable[ArrayLike], *, n: int) -> tuple[NDArray[np.float64], ...]:
    """Return `values` as a tuple of read-only finite n-by-n float arrays."""
    try:
        items = list(values)
    except TypeError:
        raise ValueError(f"{name}: must be a sequence of ({n}, {n}) matrices") from None
    return tuple(square(f"{name}[{s}]", value, n=n) for s, value in enumerate(items))


def store(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass to their checked values."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)
