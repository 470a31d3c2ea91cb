"""Numbers as they are given: what is none is told by its name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any


def number(name: str, value: Any) -> float:
    """A float of a number of Python or numpy."""
    if not isinstance(value, (str, bytes, bool)) and getattr(value, "ndim", 0) == 0:
        try:
            return float(value)
        except (TypeError, ValueError):
            pass
    raise ValueError(f"{name} = {value!r} is not a number")


def optional(name: str, value: Any) -> float | None:
    """The same, or none."""
    return None if value is None else number(name, value)


def numbers(name: str, value: Any, *counts: int) -> list[float]:
    """A list of numbers, of one of these lengths where there are any; a number alone is a list of one."""
    if isinstance(value, (str, bytes)):
        raise ValueError(f"{name} = {value!r} is not a number")
    several = list(value) if hasattr(value, "__iter__") and getattr(value, "ndim", None) != 0 else [value]
    if counts and len(several) not in counts:
        allowed = " or ".join(f"{count} value{'s' * (count > 1)}" for count in counts)
        raise ValueError(f"{name} takes {allowed}, not {len(several)}")
    return [number(name, one) for one in several]


def ratio(name: str, value: Any) -> float | list[float] | None:
    """One number of a bar, two of a plate."""
    if value is None:
        return None
    values = numbers(name, value, 1, 2)
    return values if len(values) > 1 else values[0]


def whole(name: str, value: Any, least: int, most: int) -> int:
    """A whole number within bounds."""
    if isinstance(value, bool) or not hasattr(value, "__index__"):
        raise ValueError(f"{name} = {value!r} is not a whole number")
    if not least <= value.__index__() <= most:
        raise ValueError(f"{name} = {value!r} is not in {least} ..= {most}")
    index: int = value.__index__()
    return index


def rows(name: str, value: Any, *counts: int) -> list[tuple[float, ...]]:
    """A list of so many numbers each."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
        raise ValueError(f"{name} = {value!r} is not a list")
    return [tuple(numbers(f"{name}[{i}]", row, *counts)) for i, row in enumerate(value)]


def span(name: str, value: Any) -> tuple[float, float, int]:
    """From, to, and how many."""
    if isinstance(value, (str, bytes)) or not hasattr(value, "__len__") or len(value) != 3:
        raise ValueError(f"{name} = {value!r} is not (lo, hi, n)")
    return number(name, value[0]), number(name, value[1]), whole(f"n of {name}", value[2], 0, 2**53)


def positions(value: Sequence[Any] | None) -> list[float] | list[tuple[float, float]] | None:
    """Positions of a bar or places of a plate."""
    if value is None:
        return None
    several = [value] if not hasattr(value, "__iter__") else list(value)
    if several and all(hasattr(one, "__len__") and not isinstance(one, (str, bytes)) for one in several):
        return [(x, y) for x, y in rows("at", several, 2)]
    return numbers("at", several)
