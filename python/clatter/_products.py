"""Products, their drops and their fragile parts: verdicts, probabilities, changes, fits."""

from __future__ import annotations

import copy
import datetime
import json
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from . import _clatter
from ._answer import Answer, Rows, ending, flat, told
from ._records import Record

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: A quantity: a number with its unit, a range of two, or a distribution.
Quantity = str | float | Sequence[str] | Sequence[float] | Mapping[str, Any]
Model = Literal["map", "ballistic", "finite-tilt", "compliant"]


class Product:
    """A product, how it falls, and its fragile parts.

    Quantities are as in a product file: a number with its unit (``"140 mm"``), a range (``["1 deg", "10 deg"]``) or a
    distribution (``{"normal": ["5 deg", "2 deg"], "range": ["0 deg", "10 deg"]}``); shares are numbers. They are copied. What is
    wrong is told when it is asked about, all at once and where it stands; what no file holds, at once.

    Parameters
    ----------
    name : str
        Name of the product.
    length : str
        From end a to end b.
    restitution : float or range
        Rebound over approach speed.
    radius_of_gyration, moment_of_inertia, mass, masses, center_of_mass, contact_time, contact_law, friction
        As in a product file, ``clatter init`` explains them.
    **more
        Further keys of the table ``[product]``.

    Examples
    --------
    >>> import clatter
    >>> handheld = clatter.Product("handheld", length="150 mm", radius_of_gyration="45 mm", restitution=0.3)
    >>> _ = handheld.falls(height="1 m", tilt=["1 deg", "6 deg"])
    >>> _ = handheld.add(
    ...     "board", position="50 mm", natural_frequency="40 Hz", damping_ratio=0.05, acceleration_limit="30 gn"
    ... )
    >>> clatter.assess(handheld).verdict
    'unsafe'
    """

    def __init__(
        self,
        name: str,
        *,
        length: Quantity,
        restitution: Quantity,
        radius_of_gyration: Quantity | None = None,
        moment_of_inertia: Quantity | None = None,
        mass: Quantity | None = None,
        masses: Sequence[Mapping[str, Any]] | None = None,
        center_of_mass: Quantity | None = None,
        contact_time: Quantity | None = None,
        contact_law: Literal["hysteretic", "dashpot"] | None = None,
        friction: Quantity | None = None,
        **more: Any,
    ) -> None:
        self._text: str | None = None
        self._origin = name
        self._tables: dict[str, Any] = {"product": _table(locals())}
        self._read: tuple[str, Any] | None = None
        self._folder = ""

    def falls(
        self,
        *,
        height: Quantity | None = None,
        speed: Quantity | None = None,
        tilt: Quantity | None = None,
        first: Literal["a", "b", "either"] | None = None,
        gravity: Quantity | None = None,
        **more: Any,
    ) -> Product:
        """Say how it falls; called again, of a box, in its next drop.

        Parameters
        ----------
        height, speed : quantity
            Height of the lower end before the drop, or the speed at the first touch.
        tilt : quantity, optional
            Angle to the ground at the first touch; a box may land on a ``face``, ``edge`` or ``corner`` instead.
        first : {'a', 'b', 'either'}, optional
            The end that touches first; either unless given.
        gravity : quantity, optional
            1 gn unless given.

        Returns
        -------
        Product
            Itself.
        """
        tables, drop = self._changed(), _table(locals())
        before = tables.get("drop")
        tables["drop"] = drop if before is None else [*(before if isinstance(before, list) else [before]), drop]
        return self

    def add(
        self,
        name: str,
        *,
        position: Quantity,
        extent: Quantity | None = None,
        mount: Literal["hard", "suspended"] | None = None,
        natural_frequency: Quantity | None = None,
        damping_ratio: Quantity | None = None,
        quality_factor: Quantity | None = None,
        stop: Mapping[str, Quantity] | None = None,
        acceleration_limit: Quantity | None = None,
        rattle_space: Quantity | None = None,
        velocity_change_limit: Quantity | None = None,
        angular_velocity_change_limit: Quantity | None = None,
        stop_speed_limit: Quantity | None = None,
        damage_boundary: Mapping[str, Quantity] | None = None,
        limit_source: str | None = None,
        **more: Any,
    ) -> Product:
        """Add a fragile part.

        Parameters
        ----------
        name : str
            Name of the part.
        position : quantity
            Where its middle is, from the middle of the product towards end b.
        extent : quantity, optional
            How far it extends along the product.
        mount : {'hard', 'suspended'}, optional
            Suspended unless given, with a natural frequency and a damping ratio or quality factor.
        stop : mapping, optional
            The stops of a suspended part, with ``gap``, ``contact_time`` and ``restitution``.
        acceleration_limit, rattle_space, velocity_change_limit, angular_velocity_change_limit, stop_speed_limit, damage_boundary
            What it stands; the damage boundary has ``velocity_change`` and ``acceleration``.

        Returns
        -------
        Product
            Itself.
        """
        self._changed().setdefault("component", []).append(_table(locals()))
        return self

    def _changed(self) -> dict[str, Any]:
        if self._text is not None:
            raise ValueError("a product of a text is changed in the text: Product.from_text()")
        return self._tables

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Product:
        """The product of a file; records that it names are looked for beside it."""
        name = os.fspath(path)
        return _product(_clatter.text(name), {}, name, os.path.dirname(name))

    @classmethod
    def from_text(cls, text: str, origin: str = "text") -> Product:
        """The product of the text of a file, which errors call ``origin``; records that it names are looked for in the present folder."""
        product = cls.__new__(cls)
        product._text, product._origin, product._tables, product._read = text, origin, {}, None
        product._folder = ""
        return product

    @classmethod
    def from_dict(cls, tables: Mapping[str, Any], origin: str = "dict") -> Product:
        """The product of a dict with the tables of a file, ``product``, ``drop``, ``component``."""
        return cls.from_text(_toml(tables), origin)

    @classmethod
    def example(cls) -> Product:
        """The product that ``clatter init`` writes."""
        return cls.from_text(_clatter.example(), "example.toml")

    @property
    def text(self) -> str:
        """The product file."""
        return _toml(self._tables) if self._text is None else self._text

    def __eq__(self, other: object) -> bool:
        return self._values() == other._values() if isinstance(other, Product) else NotImplemented

    __hash__ = None  # type: ignore[assignment]

    def _values(self) -> tuple[str, str, str]:
        return self.text, self._origin, self._folder

    def check(self) -> Product:
        """Raise a ValueError that tells all that is wrong; warn of what is likely a slip."""
        self._file()
        return self

    def _file(self, stacklevel: int = 3) -> Any:
        text = self.text
        if self._read is None or self._read[0] != text:
            read = _clatter.ProductText(text, self._origin, self._folder)
            if read.warnings:
                warnings.warn(read.warnings, stacklevel=stacklevel)
            self._read = (text, read)
        return self._read[1]

    def __reduce__(self) -> tuple[Any, ...]:
        return _product, (self._text, self._tables, self._origin, self._folder)

    def __repr__(self) -> str:
        return f"<Product {self._origin}>"


def _product(text: str | None, tables: dict[str, Any], origin: str, folder: str) -> Product:
    product = Product.__new__(Product)
    # What is added to one of two copies is not in the other.
    product._text, product._tables, product._read = text, copy.deepcopy(tables), None
    product._origin, product._folder = origin, folder
    return product


#: A product, its file, or its tables.
Source = Product | Mapping[str, Any] | str | os.PathLike[str]


#: Lists and tables within each other, of a product.
_DEEPEST = 16


def _table(values: Mapping[str, Any]) -> dict[str, Any]:
    """The table of a file with a copy of what was given to a method; its ``more`` holds further keys."""
    keys = {**values, **values["more"]}
    given = {name: value for name, value in keys.items() if value is not None and name not in ("self", "more")}
    return {name: _frozen(name, value) for name, value in given.items()}


def _frozen(name: str, value: Any, deep: int = 0) -> Any:
    """A value of a product file as dicts, lists, text and numbers of Python."""
    if isinstance(value, (bool, str)):
        return value
    if isinstance(value, int):
        return int(value)
    if isinstance(value, float):
        return float(value)
    if deep > _DEEPEST:
        raise ValueError(f"{name} is within more than {_DEEPEST} lists and tables")
    if isinstance(value, Mapping):
        return {key: _frozen(f"{name}.{key}" if name else str(key), one, deep + 1) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [_frozen(f"{name}[{i}]", one, deep + 1) for i, one in enumerate(value)]
    if hasattr(value, "__array__"):
        from ._arrays import plain

        array = plain(name, value)
        if array.dtype.kind in "biuf" and array.dtype.itemsize <= 8 or array.dtype.kind in "UO":
            return _frozen(name, array.tolist(), deep)
    raise ValueError(f"{name} = {value!r} is none of what a product file holds: text, numbers, lists and tables")


def _toml(tables: Mapping[str, Any]) -> str:
    """The text of a product file with these tables."""
    lines: list[str] = []
    for name, table in _frozen("", tables).items():
        if isinstance(table, Mapping):
            lines += ["", f"[{_key(name)}]", *(f"{_key(key)} = {_value(value)}" for key, value in table.items())]
        elif isinstance(table, (list, tuple)):
            for one in table:
                if not isinstance(one, Mapping):
                    raise ValueError(f"{name} is a list of tables, not of {type(one).__name__}")
                lines += ["", f"[[{_key(name)}]]", *(f"{_key(key)} = {_value(value)}" for key, value in one.items())]
        else:
            lines.insert(0, f"{_key(name)} = {_value(table)}")
    return "\n".join(lines).lstrip("\n") + "\n"


def _key(name: object) -> str:
    return str(name) if re.fullmatch(r"[A-Za-z0-9_-]+", str(name)) else json.dumps(str(name))


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        # JSON escapes what TOML does, but for DEL.
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(one)}" for key, one in value.items()) + " }"
    return f"[{', '.join(map(_value, value))}]" if isinstance(value, list) else repr(value)


def _whole(product: Source) -> Product:
    if isinstance(product, Mapping):
        return Product.from_dict(product)
    return product if isinstance(product, Product) else Product.open(product)


def _with_file(values: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a question with the file of its product."""
    return {**values, "product": _whole(values["product"])._file(stacklevel=4)}


def schema() -> dict[str, Any]:
    """The JSON Schema of product files, as ``clatter schema`` prints it."""
    found: dict[str, Any] = json.loads(_clatter.schema())
    return found


def _limits(answer: Answer) -> Rows:
    limits = []
    for part in answer.components:
        for limit in part.limits:
            told_of = {name: value for name, value in flat(limit, "").items() if not isinstance(value, (list, Answer))}
            limits.append({"component": part.name, "position_m": part.position_m, **told_of})
    return limits


def assess(
    product: Source,
    *,
    tolerance: float = 0.01,
    model: Model | None = None,
    merge_s: float = 1e-3,
    measured: Mapping[str, Mapping[str, Any]] | None = None,
    reliability: float | None = None,
    confidence: float | None = None,
    report: str | os.PathLike[str] | None = None,
    report_date: str | None = None,
) -> Answer:
    """Which part of a product fails, in which drop, by how much.

    Records that a product file names are read, from where the file is. What each measured drop tells stands beside what the file
    states; that they differ is warned of.

    Parameters
    ----------
    product : Product, path, or dict
        The product; a text is :meth:`Product.from_text`.
    tolerance : float
        How exact the answer to each drop is, as a share of it.
    model : {'map', 'ballistic', 'finite-tilt', 'compliant'}, optional
        Follow drops by this model rather than by the one with the most physics.
    merge_s : float
        Instant impacts closer than this are one, in s.
    measured : dict of dicts, optional
        Further measured drops, by their names: of each what :func:`fit` takes, ``strikes``, ``heights``, ``bounces``,
        ``accelerations`` and ``timing_s``.
    reliability : float, optional
        Draw products for each limit that is undecided, until so many hold in a row that this share of all survives, such as 0.99; in place
        of ``[verdict] reliability`` of the product.
    confidence : float, optional
        How sure that is to be; 0.95 unless given.
    report : path, optional
        Write the printed report there too, a file ending in ``.pdf``; typst sets it, as for the command.
    report_date : str, optional
        The day that the report tells, ``2026-03-31``; none unless given.

    Returns
    -------
    Answer
        ``verdict`` (safe, reliable, undecided or unsafe) and ``components`` with their ``limits``: ``allowed``, ``demand``, ``margin`` in
        SI; ``measured`` with the ``estimates`` of each drop, where there are any; as ``clatter assess`` has it.
        ``plot()`` is the product with its parts, as the report shows it.

    Examples
    --------
    >>> import clatter
    >>> answer = clatter.assess(clatter.Product.example())
    >>> answer.verdict, [part.name for part in answer.components]
    ('safe', ['display', 'camera', 'crystal'])
    """
    answered, odd = _clatter.assess(_with_file(locals()) | {"report": _pdf(report, report_date)})
    for one in odd:
        warnings.warn(one, stacklevel=2)
    return told(answered, _limits)


def _pdf(report: str | os.PathLike[str] | None, date: str | None) -> str | None:
    if report is not None and date is not None:
        datetime.date.fromisoformat(date)
    return None if report is None else ending(report, ".pdf")


def scatter(
    product: Source,
    *,
    samples: int | None = None,
    seed: int = 1,
    confidence: float = 0.95,
    merge_s: float = 1e-3,
    target: float | None = None,
) -> Answer:
    """How likely each part survives, and what that depends on.

    Parameters
    ----------
    product : Product, path, or dict
        The product, with distributions or ranges.
    samples : int, optional
        How many drops, 100 000 unless given; of a box how many products, each of which goes through all of its drops, 1000 unless given.
    seed : int
        Which.
    confidence : float
        Of the intervals, in (0, 1).
    merge_s : float
        Instant impacts closer than this are one, in s.
    target : float, optional
        Survival of all parts that is to be sure, in (0, 1).

    Returns
    -------
    Answer
        ``survival`` and ``components`` with their ``drivers``, of a box ``landings`` too, as ``clatter scatter`` has it.

    Examples
    --------
    >>> import clatter
    >>> clatter.scatter(clatter.Product.example(), samples=200).survival.probability
    1.0
    """
    return told(_clatter.scatter(_with_file(locals())), survivals)


def survivals(answer: Answer) -> list[dict[str, Any]]:
    """A row for each part: how likely it survives."""
    return [
        {"component": part.name, "failed": part.failed, "survival": part.survival.probability,
         "from": part.survival.interval[0], "to": part.survival.interval[1]}
        for part in answer.components
    ]  # fmt: skip


def design(
    product: Source | None = None,
    *,
    margin: float = 0.1,
    q: tuple[float, float] = (0.0, 0.9),
    e: tuple[float, float] = (0.05, 0.9),
    frequency_factor: float = 4.0,
    damping: tuple[float, float] = (0.0, 0.5),
    contact_time_s: tuple[float, float] = (0.2e-3, 2e-3),
    limit_factor: float = 4.0,
    zones: Sequence[tuple[float, float]] = (),
    turn: float | None = None,
) -> Answer:
    """The smallest change that makes each failing part safe; without a product, which q and e meet goals.

    Parameters
    ----------
    product : Product, path, or dict, optional
        The product.
    margin : float
        Margin allowed/demand - 1 that every limit is to have. By both contact laws where contacts take time and the file names none.
    q, e, damping, contact_time_s : (lo, hi)
        Inertia ratios, restitutions, damping ratios and contact times [s] that can be had.
    frequency_factor, limit_factor : float
        Largest factor on a natural frequency, up or down; on what a part stands, up.
    zones : list of (threshold, s), optional
        Without a product: shocks up to a threshold in v0 within s of the bar.
    turn : float, optional
        Without a product: changes of angular velocity up to this, in v0/L.

    Returns
    -------
    Answer
        ``components`` with their ``remedies``, or what the goals come to; as ``clatter design`` has it.

    Examples
    --------
    >>> import clatter
    >>> len(clatter.design(clatter.Product.example()).components)
    3
    """
    if product is None:
        return told(_clatter.design(locals()))
    return told(_clatter.design(_with_file(locals())), _remedies)


def _remedies(answer: Answer) -> Rows:
    return [{"component": part.name, **flat(remedy, "")} for part in answer.components for remedy in part.remedies]


def explain(product: Source, *, tolerance: float = 0.01) -> Answer:
    """Which model the worst drops of a product need, and why.

    Parameters
    ----------
    product : Product, path, or dict
        The product.
    tolerance : float
        What a model may get wrong, as a share of the demand.

    Returns
    -------
    Answer
        ``limits``, each with the value and error of every ``models``; as ``clatter explain`` has it.

    Examples
    --------
    >>> import clatter
    >>> clatter.explain(clatter.Product.example()).limits[0].component
    'display'
    """
    return told(_clatter.explain(_with_file(locals())), _models)


def tradeoff(product: Source, *, tolerance: float = 0.01) -> Answer:
    """What every model gets wrong in the worst drops of a product, and what it costs on this machine.

    Parameters
    ----------
    product : Product, path, or dict
        The product.
    tolerance : float
        What a model may get wrong, as a share of the demand.

    Returns
    -------
    Answer
        ``limits``, each with the ``value``, ``error`` and ``seconds`` of every ``models`` and which is the ``cheapest``; as
        ``clatter tradeoff`` has it. ``plot()`` is error over cost.

    Examples
    --------
    >>> import clatter
    >>> [limit.component for limit in clatter.tradeoff(clatter.Product.example()).limits][:2]
    ['display', 'display']
    """
    return told(_clatter.tradeoff(_with_file(locals())), _models)


def _models(answer: Answer) -> Rows:
    return [
        {"component": limit.component, "limit": limit.limit, **flat(model, "")}
        for limit in answer.limits
        for model in limit.models
    ]


def fit(
    product: Source,
    *,
    strikes: Sequence[tuple[float, Literal["a", "b"] | None]] | None = None,
    heights: Sequence[tuple[float, float, float]] | None = None,
    bounces: ArrayLike | None = None,
    accelerations: Sequence[tuple[Record, float]] = (),
    timing_s: float | None = None,
    known_gyration: bool = False,
) -> Answer:
    """From a measured drop to the data of the product: restitution, radius of gyration, contact time, tilt and speed.

    Parameters
    ----------
    product : Product, path, or dict
        Length, center of mass, gravity, and where the search begins.
    strikes : list of (time_s, end), optional
        Times of strikes in s, end a, b or None where it is not known.
    heights : list of (time_s, height_a_m, height_b_m), optional
        Heights of both ends over the ground, from a video.
    bounces : list of float, optional
        Times in s at which a flat product bounces; alone.
    accelerations : list of (Record, position_m), optional
        Accelerations of one channel, and where they were measured from the middle towards end b.
    timing_s : float, optional
        Standard deviation of the times of strikes and bounces, in s.
    known_gyration : bool
        Take the radius of gyration of the product as known.

    Returns
    -------
    Answer
        ``estimates`` with intervals of 95 %, as ``clatter fit`` has it; ``fitted``, the :class:`Product` with these ranges, and
        ``notes`` on what that does not hold. ``plot()`` is the picture.

    Examples
    --------
    >>> import clatter
    >>> answer = clatter.fit(clatter.Product.example(), bounces=[0, 0.5, 0.7, 0.78, 0.812])
    >>> [round(estimate.value, 6) for estimate in answer.estimates if estimate.quantity == "restitution"]
    [0.4]
    """
    text, drawing, copy, notes = _clatter.fit(_with_file(locals()))
    fitted = None if copy is None else Product.from_text(copy, "fitted")
    return told((text, drawing), _estimates, fitted=fitted, notes=notes)


def _estimates(answer: Answer) -> Rows:
    return [flat(estimate, "") for estimate in answer.estimates]
