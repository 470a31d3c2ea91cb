"""Arrays as they are given, made into columns of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ._answer import Answer, Rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

#: Elements of one call: more are to be asked in pieces.
MOST = 10_000_000
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


class Columns:
    """Arrays of one call, broadcast against each other."""

    def __init__(self, given: Mapping[str, ArrayLike | None], times: int = 1) -> None:
        self.given = {name: floats(name, value) for name, value in given.items() if value is not None}
        try:
            self.shape = np.broadcast_shapes(*(array.shape for array in self.given.values()))
        except ValueError:
            shapes = ", ".join(f"{name} {array.shape}" for name, array in self.given.items() if array.ndim)
            raise ValueError(f"shapes that do not go together: {shapes}") from None
        size = times
        for length in self.shape:
            size *= length
        if size > MOST:
            raise ValueError(f"{size} elements in one call; it takes {MOST}: ask in pieces")

    def __getitem__(self, name: str) -> Floats:
        if name not in self.given:
            raise ValueError(f"{name} is not given")
        array = self.given[name]
        if array.size == 1:
            return array.reshape(1)
        return np.ascontiguousarray(np.broadcast_to(array, self.shape)).reshape(-1)

    def get(self, name: str) -> Floats | None:
        return self[name] if name in self.given else None

    def answer(self, columns: Mapping[str, Floats]) -> Answer:
        """What was given and what came of it, in the shape of all."""
        fields: dict[str, Any] = {name: np.broadcast_to(array, self.shape)[()] for name, array in self.given.items()}
        for name, column in columns.items():
            fields[name] = column.reshape(self.shape + column.shape[1:])[()]
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
