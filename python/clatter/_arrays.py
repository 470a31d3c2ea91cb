"""The one way in for arrays: columns of numbers that have lost nothing, and no memory of others in an answer."""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _clatter
from ._answer import Answer, Rows

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float64]

_EXACT = 2**53
_INTEGERS = (int, np.integer)
_NUMBERS = (*_INTEGERS, float, np.floating, Decimal, Fraction)
#: What stands for a number that is not there: it is nan.
_NONE = ("NoneType", "NAType")


def floats(name: str, value: ArrayLike) -> Floats:
    """An array of float64 that has lost nothing; it may still be the memory of who gave it."""
    if isinstance(value, (list, tuple)):
        return _of_lists(name, value)
    array = plain(name, value)
    if array.dtype.kind == "O":
        return _of_numbers(name, array.ravel().tolist()).reshape(array.shape)
    if array.dtype.kind not in "iuf" or array.dtype.itemsize > 8:
        raise ValueError(f"{name} is of {array.dtype}; numbers are float64")
    # Tables whose integers lack some hand them over as floats.
    whole = array.dtype.kind in "iu" or "int" in str(getattr(value, "dtype", getattr(value, "type", ""))).lower()
    if whole and array.size and max(np.fmax.reduce(array, None), -float(np.fmin.reduce(array, None))) > _EXACT:
        raise ValueError(f"{name} has integers beyond 2**53, which float64 does not hold")
    return np.require(array, np.float64, "A")


def plain(name: str, value: Any) -> NDArray[Any]:
    """The array of numpy that a value is, of any type but for times; none with units or masked elements."""
    of_pandas = type(value).__module__.partition(".")[0] == "pandas"  # whose labels are attributes too
    owner = getattr(value, "dtype", None) if of_pandas else value
    for unit in (getattr(owner, "units", None), None if of_pandas else getattr(owner, "unit", None)):
        if unit is not None and not callable(unit):
            raise ValueError(
                f"{name} has the unit '{unit}' of another package: give numbers alone, in the unit that is asked for"
            )
    try:
        masked = np.ma.is_masked(value)
        array = np.asarray(value)
    except Exception as error:  # of whatever kind the package of the array has
        raise ValueError(f"{name} is no array: {error}") from None
    if masked:
        raise ValueError(f"{name} has masked elements")
    in_one_call(array.size, 10 * _clatter.MOST, f"elements of {name}")
    return array


def listed(name: str, value: Any) -> list[Any]:
    """The rows of an array as lists of what Python has for its elements."""
    array = plain(name, value)
    if array.ndim == 0:
        return [value]
    if array.dtype.kind not in "iufbcOU":
        raise ValueError(f"{name} is of {array.dtype}; it is a list of numbers")
    in_one_call(array.size, _clatter.LISTED, f"elements of {name}")
    return array.tolist()


def number(name: str, value: Any) -> float:
    """The one number that a value is."""
    array = floats(name, value)
    if array.ndim:
        raise ValueError(f"{name} = {value!r} is not a number")
    return float(array)


def _of_lists(name: str, value: Any) -> Floats:
    """The numbers of lists within lists, which are of one length at each depth."""
    shape, flat, seen = [len(value)], value, {id(value)}
    while flat and all(issubclass(kind, (list, tuple)) for kind in set(map(type, flat))):
        within, lengths = set(map(id, flat)), set(map(len, flat))
        if len(lengths) > 1:
            raise ValueError(f"{name} is ragged: it has rows of {min(lengths)} and of {max(lengths)}")
        if within & seen:
            raise ValueError(f"{name} is a list within itself")
        seen |= within
        shape.append(lengths.pop())
        in_one_call(len(flat) * shape[-1], _clatter.MOST, f"elements of {name}")
        flat = list(chain.from_iterable(flat))
    if any(isinstance(one, (list, tuple)) for one in flat):
        raise ValueError(f"{name} is ragged: it has lists beside what is none")
    if any(hasattr(one, "__array__") and not isinstance(one, np.generic) for one in flat):
        parts = [floats(f"{name}[{i}]", one) for i, one in enumerate(flat)]
        shapes = {part.shape for part in parts}
        if len(shapes) > 1:
            raise ValueError(f"{name} is ragged: it has rows of shape {min(shapes)} and of {max(shapes)}")
        return np.reshape(parts, (*shape, *parts[0].shape))
    return _of_numbers(name, flat).reshape(shape)


def _of_numbers(name: str, flat: list[Any]) -> Floats:
    """An array of numbers, each of a type of its own."""
    kinds = set(map(type, flat))
    for kind in kinds:
        wide = issubclass(kind, np.floating) and np.dtype(kind).itemsize > 8
        if kind.__name__ not in _NONE and (not issubclass(kind, _NUMBERS) or issubclass(kind, bool) or wide):
            raise ValueError(f"{name} is of {kind.__name__}; numbers are float64")
    if any(kind.__name__ in _NONE for kind in kinds):
        flat = [math.nan if type(one).__name__ in _NONE else one for one in flat]
    whole = any(issubclass(kind, _INTEGERS) for kind in kinds)
    if whole and any(abs(int(one)) > _EXACT for one in flat if isinstance(one, _INTEGERS)):
        raise ValueError(f"{name} has integers beyond 2**53, which float64 does not hold")
    try:
        array = np.fromiter(map(float, flat), np.float64, len(flat))
    except (ArithmeticError, ValueError) as error:
        raise ValueError(f"{name} has a number that float64 does not hold: {error}") from None
    if any(flat[i].is_finite() for i in np.flatnonzero(np.isinf(array)) if isinstance(flat[i], Decimal)):
        raise ValueError(f"{name} has a number that float64 does not hold")
    return array


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

    Values that are named in ``plain`` are of all elements. What is given is copied before it is worked on: the answer has that
    copy, which nobody writes to.
    """
    arrays = {name: value for name, value in values.items() if value is not None and name not in plain}
    _of_one_index(arrays)
    given = {name: floats(name, value) for name, value in arrays.items()}
    try:
        shape = np.broadcast_shapes(*(array.shape for array in given.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in given.items() if array.ndim)
        raise ValueError(f"shapes that do not go together: {shapes}") from None
    in_one_call(math.prod(shape), _clatter.MOST, "elements")
    given = {name: array.copy() for name, array in given.items()}
    columns = {name: np.ravel(one if one.size == 1 else np.broadcast_to(one, shape)) for name, one in given.items()}
    made = core(shape, {**values, **columns})
    fields: dict[str, Any] = {name: np.broadcast_to(array, shape)[()] for name, array in given.items()}
    fields.update({name: column.reshape(shape + column.shape[1:])[()] for name, column in made.items()})
    return Answer(fields, rows=elements)


def _of_one_index(values: Mapping[str, Any]) -> None:
    """Refuse columns of pandas whose rows have other names: they would be taken in the order that they have."""
    indexed = [(name, value.index) for name, value in values.items() if hasattr(getattr(value, "index", None), "equals")]
    for name, index in indexed:
        if not index.equals(indexed[0][1]):
            raise ValueError(f"{name} and {indexed[0][0]} have rows of other names: align them, or give their values alone")


def elements(answer: Answer) -> Rows:
    """The elements of arrays, one after the other; those with an axis of their own are lists."""
    arrays = {name: np.asarray(value) for name, value in answer.__dict__.items()}
    ndim = min((array.ndim for array in arrays.values()), default=0)
    columns: dict[str, Any] = {}
    for name, array in arrays.items():
        rows = array.reshape((-1,) + array.shape[ndim:])
        columns[name] = rows if rows.ndim == 1 else list(rows)
    return columns
