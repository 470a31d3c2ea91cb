"""Answers as plain objects: attributes, rows for tables, pictures."""

from __future__ import annotations

import copy
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pyarrow

# Words of users, which no number is written as.
_NAMES = frozenset(("name", "component", "product", "file", "files", "drop", "reason", "note", "notes"))
_NUMBERS = {"infinite": float("inf"), "-infinite": float("-inf")}
# Of a table in a notebook: rows, columns and characters of a cell.
_SHOWN, _WIDE, _LONG = 20, 12, 40

Rows = Sequence[Mapping[str, Any]] | Mapping[str, Any]


def _number(value: Any) -> Any:
    """A number that JSON has a word for."""
    if isinstance(value, str):
        return _NUMBERS.get(value, value)
    return [_number(one) for one in value] if isinstance(value, list) else value


def ending(path: str | os.PathLike[str], suffix: str) -> str:
    """The path of a file to write."""
    name = os.fspath(path)
    if not name.endswith(suffix):
        raise ValueError(f"{name}: the file must end in {suffix}")
    return name


class Figure:
    """A picture, as the command writes it.

    A notebook shows it; ``str()`` of it is the SVG.
    """

    def __init__(self, svg: str) -> None:
        self.svg = svg

    def __str__(self) -> str:
        return self.svg

    def __repr__(self) -> str:
        return f"Figure({len(self.svg)} bytes of SVG)"

    def __eq__(self, other: object) -> bool:
        return self.svg == other.svg if isinstance(other, Figure) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.svg)

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the SVG to a file; what was there is replaced once the new file is whole.

        Parameters
        ----------
        path : path
            File to write, ending in ``.svg``.
        """
        import tempfile

        path = ending(path, ".svg")
        with tempfile.NamedTemporaryFile(
            "w", encoding="utf-8", dir=os.path.dirname(path) or ".", suffix=".svg", delete=False
        ) as beside:
            try:
                beside.write(self.svg)
                beside.close()
                os.replace(beside.name, path)
            except BaseException:
                os.unlink(beside.name)
                raise


class Answer:
    """What was asked for, by the names that the command's JSON has.

    Fields are attributes, and items for names that are no Python: ``answer.peak.end``, ``answer["peak"]["end"]``. Infinite
    numbers are floats; :meth:`to_json` has the text of the command. Answers of arrays have arrays.
    """

    __slots__ = ("__dict__", "_drawing", "_rows", "_text")

    _text: str | None
    _rows: Callable[[Answer], Rows] | None
    _drawing: Any

    def __init__(
        self,
        fields: Mapping[str, Any],
        text: str | None = None,
        rows: Callable[[Answer], Rows] | None = None,
        drawing: Any = None,
    ) -> None:
        self.__dict__.update(fields)
        self._text, self._rows, self._drawing = text, rows, drawing

    if TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any: ...

    def __getitem__(self, name: str) -> Any:
        return self.__dict__[name]

    def __contains__(self, name: object) -> bool:
        return name in self.__dict__

    def __iter__(self) -> Iterator[str]:
        return iter(self.__dict__)

    def __len__(self) -> int:
        return len(self.__dict__)

    def __eq__(self, other: object) -> bool:
        return _same(self.__dict__, other.__dict__) if isinstance(other, Answer) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        # A picture is drawn in the process that was asked.
        return Answer, (dict(self.__dict__), self._text, self._rows)

    def __copy__(self) -> Answer:
        return Answer(self.__dict__, self._text, self._rows, self._drawing)

    def __deepcopy__(self, memo: dict[int, Any]) -> Answer:
        return Answer(copy.deepcopy(self.__dict__, memo), self._text, self._rows, self._drawing)

    def __repr__(self) -> str:
        return f"Answer({', '.join(f'{name}={_short(value)}' for name, value in self.__dict__.items())})"

    def to_dict(self) -> dict[str, Any]:
        """The same as dicts and lists; arrays stay arrays."""
        return {name: _plain(value) for name, value in self.__dict__.items()}

    def to_json(self) -> str:
        """The text that ``clatter … --format json`` prints, to the last digit; not for answers of arrays."""
        if self._text is None:
            raise ValueError("an answer of arrays has no text: to_arrow() has its columns")
        return self._text

    def to_arrow(self) -> pyarrow.Table:
        """The rows as a table: impacts, zones, frequencies, limits of parts, elements of arrays.

        Returns
        -------
        pyarrow.Table
            Columns with the names of the fields; pandas and polars take it as it is.
        """
        import pyarrow

        rows = self._table()
        if isinstance(rows, Mapping):
            return pyarrow.table(dict(rows))
        return pyarrow.Table.from_pylist([{name: _plain(value) for name, value in row.items()} for row in rows])

    def plot(self) -> Figure:
        """The picture that the command writes of this answer."""
        if self._drawing is None:
            raise ValueError("there is no picture of this answer, or it is in the process that was asked")
        return Figure(self._drawing.svg())

    def _table(self) -> Rows:
        # The version is of the answer, and of no row.
        return self._rows(self) if self._rows else [{k: v for k, v in self.__dict__.items() if k != "clatter"}]

    def _repr_html_(self) -> str:
        told = [(name, value) for name, value in self.__dict__.items() if not isinstance(value, list)]
        told = [(name, value) for name, value in told if getattr(value, "ndim", 0) == 0]
        cells = "".join(f"<tr><th>{escape(name)}</th><td>{_cell(value)}</td></tr>" for name, value in told)
        return f"<table>{cells}</table>{_rows_html(self._table()) if self._rows else ''}"


def _same(one: Any, other: Any) -> bool:
    """Whether two values of answers are equal: arrays element by element, and nan is nan."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(value, other[name]) for name, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if getattr(one, "ndim", 0) or getattr(other, "ndim", 0):
        alike = getattr(one, "shape", None) == getattr(other, "shape", None)
        return alike and bool(((one == other) | ((one != one) & (other != other))).all())
    return bool(one == other or (one != one and other != other))


def _plain(value: Any) -> Any:
    if isinstance(value, Answer):
        return value.to_dict()
    return [_plain(one) for one in value] if isinstance(value, list) else value


def _short(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list) and len(value) > 4:
        return f"[… {len(value)}]"
    if isinstance(value, list):
        return f"[{', '.join(_short(one) for one in value)}]"
    if getattr(value, "ndim", 0):
        return f"array{value.shape}"
    return repr(value) if isinstance(value, (str, Answer)) else str(value)


def _cell(value: Any) -> str:
    text = value if isinstance(value, str) else _short(value)
    return escape(text if len(text) <= _LONG else f"{text[: _LONG - 1]}…")


def _rows_html(rows: Rows) -> str:
    if isinstance(rows, Mapping):
        names, count = list(rows), max((len(column) for column in rows.values()), default=0)
        cells = [[column[i] for column in rows.values()] for i in range(min(count, _SHOWN))]
    else:
        names, count = list(dict.fromkeys(name for row in rows for name in row)), len(rows)
        cells = [[row.get(name) for name in names] for row in rows[:_SHOWN]]
    names = names[:_WIDE]
    head = "".join(f"<th>{escape(name)}</th>" for name in names)
    body = "".join(f"<tr>{''.join(f'<td>{_cell(cell)}</td>' for cell in row[:_WIDE])}</tr>" for row in cells)
    more = f"<p>{count - _SHOWN} more rows</p>" if count > _SHOWN else ""
    return f"<table><tr>{head}</tr>{body}</table>{more}"


def told(answered: tuple[str, Any], rows: Callable[[Answer], Rows] | None = None, **more: Any) -> Answer:
    """An answer of the JSON of the command."""
    text, drawing = answered

    def fields(one: dict[str, Any]) -> dict[str, Any]:
        return {name: value if name in _NAMES else _number(value) for name, value in one.items()}

    whole = json.loads(text, object_hook=lambda one: Answer(fields(one)))
    return Answer({**whole.__dict__, **more}, text, rows, drawing)


def flat(row: Answer, points: str) -> dict[str, Any]:
    """A row with a column for each end or corner, as in the CSV of the command."""
    columns: dict[str, Any] = {}
    for name, value in row.__dict__.items():
        if isinstance(value, list) and points and len(value) == len(points):
            columns.update({f"{name}_{point}": one for point, one in zip(points, value)})
        elif isinstance(value, Answer):
            columns.update({f"{name}_{inner}": one for inner, one in value.__dict__.items()})
        else:
            columns[name] = value
    return columns
