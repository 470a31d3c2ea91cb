"""Arrays as they are given, made into columns of numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _clatter
from ._answer import Answer, Rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

_EXACT = 2**53


def floats(name: str, value: ArrayLike) -> Floats:
    """An array of float64 that has lost nothing."""
    if np.ma.is_masked(value):
        raise ValueError(f"{name} has masked elements")
    try:
        array = np.asarray(value)
    except ValueError as error:
        raise ValueError(f"{name} is no array: {error}") from None
    if array.dtype.kind == "O":
        array = _of_objects(name, array)
    if array.dtype.kind not in "iuf" or array.dtype.itemsize > 8:
        raise ValueError(f"{name} is of {array.dtype}; numbers are float64")
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.size and np.abs(array).max() > _EXACT:
        raise ValueError(f"{name} has integers beyond 2**53, which float64 does not hold")
    return array.astype(np.float64, copy=False)


def _of_objects(name: str, array: NDArray[Any]) -> Floats:
    if any(isinstance(one, (str, bytes)) for one in array.flat):
        raise ValueError(f"{name} has text; numbers are float64")
    try:
        return array.astype(np.float64)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} is no array of numbers: {error}") from None


def one_dimensional(name: str, value: ArrayLike) -> Floats:
    """A list of numbers."""
    array = floats(name, value)
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}; it is a list of numbers")
    return np.ascontiguousarray(array)


def in_one_call(size: int, most: int, what: str) -> None:
    """Refuse more than one call takes."""
    if size > most:
        raise ValueError(f"{size} {what} in one call; it takes {most}: ask in pieces")


def each(core: Any, values: Mapping[str, Any], *plain: str) -> Answer:
    """What was given and what the core makes of each element of the arrays, which broadcast against each other.

    Values that are named in ``plain`` are of all elements.
    """
    given = {name: floats(name, value) for name, value in values.items() if value is not None and name not in plain}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in given.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items() if array.ndim)
        raise ValueError(f"shapes that do not go together: {shapes}") from None
    in_one_call(math.prod(shape), _clatter.MOST, "elements")
    columns = {name: np.ravel(one if one.size == 1 else np.broadcast_to(one, shape)) for name, one in given.items()}
    made = core(shape, {**values, **columns})
    fields: dict[str, Any] = {name: np.broadcast_to(array, shape)[()] for name, array in given.items()}
    fields.update({name: column.reshape(shape + column.shape[1:])[()] for name, column in made.items()})
    return Answer(fields, rows=elements)


def elements(answer: Answer) -> Rows:
    """The elements of arrays, one after the other; those with an axis of their own are lists."""
    arrays = {name: np.asarray(value) for name, value in answer.__dict__.items()}
    ndim = min((array.ndim for array in arrays.values()), default=0)
    columns: dict[str, Any] = {}
    for name, array in arrays.items():
        rows = array.reshape((-1,) + array.shape[ndim:])
        columns[name] = rows if rows.ndim == 1 else list(rows)
    return columns
