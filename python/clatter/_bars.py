"""Bars and plates without gravity: impacts, safe zones, maps; one at a time, or arrays of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from . import _clatter
from ._answer import Answer, Rows, flat, told
from ._given import number, numbers, optional, positions, ratio, rows, span, whole

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Ratio = float | tuple[float, float] | Sequence[float]
Piece = tuple[float, float] | tuple[float, float, float]
Quantity = Literal["impacts", "peak-end", "peak-center", "peak-angular", "net-center", "duration", "zone"]
End = Literal["a", "b"]

# Impacts that an answer lists: as objects they take a kilobyte each.
_LISTED = 1_000_000


def _impacts(answer: Answer) -> Rows:
    points = "ab" if len(answer.velocity) == 2 else "abcd"
    return [flat(impact, points) for impact in answer.impacts]


def _zones(answer: Answer) -> Rows:
    return [flat(zone, "") for zone in answer.zones]


def _words(answer: Answer) -> Rows:
    return [flat(word, "") for word in answer.words]


def _map(answer: Answer) -> Rows:
    import numpy as np

    inertia = "q" if "q" in answer else "gyration_ratio"
    grid = np.meshgrid(answer[inertia], answer.e, indexing="ij")
    return {inertia: grid[0].ravel(), "e": grid[1].ravel(), answer.quantity: answer.values.ravel()}


def impacts(
    *,
    e: float,
    q: float | None = None,
    gyration_ratio: Ratio | None = None,
    center_of_mass: Ratio | None = None,
    masses: Sequence[Piece] | None = None,
    velocity: Sequence[float] | None = None,
    height_gap: Ratio | None = None,
    at: Sequence[float] | Sequence[tuple[float, float]] | None = None,
    limit: int = 1000,
) -> Answer:
    """How many impacts one drop has, how hard, when, and what each position feels.

    Parameters
    ----------
    e : float
        Coefficient of restitution, in [0, 1].
    q : float, optional
        Inertia ratio (L² - ρ²)/(L² + ρ²), in (-1, 1]. One of q, gyration_ratio and masses is given.
    gyration_ratio : float or (float, float), optional
        Radius of gyration over half-length; two values, over half the length and half the width, make a plate.
    center_of_mass : float or (float, float), optional
        In half-lengths from the middle, towards end b; goes with gyration_ratio.
    masses : list of (mass, s) or (mass, from, to), optional
        Masses at a position or spread evenly between two, in half-lengths from the middle.
    velocity : (float, float) or (float, float, float), optional
        Of ends a and b, or corners a, b and d, at the first touch, in v0, upward positive. -1 unless given.
    height_gap : float or (float, float), optional
        Height of end b as a touches, in h0; 1 unless given. Of a plate those of corners b and d.
    at : list of float or of (float, float), optional
        Positions whose velocity shocks are asked for, in [-1, 1].
    limit : int
        Impacts listed at most, a million; :func:`trains` has arrays.

    Returns
    -------
    Answer
        ``count``, ``duration`` [h0/v0], ``peak`` [v0; angular v0/L], ``net``, ``final`` [v0] and ``impacts``; as
        ``clatter impacts`` has it.

    Examples
    --------
    >>> import clatter
    >>> answer = clatter.impacts(q=0.5, e=0.3)
    >>> answer.count, answer.peak.end, answer.impacts[1].end
    (4, 2.145, 'b')
    """
    start = (None if velocity is None else numbers("velocity", velocity), ratio("height_gap", height_gap))
    rest = (*start, positions(at), whole("limit", limit, 0, _LISTED))
    return told(_clatter.impacts(*_body(e, q, gyration_ratio, center_of_mass, masses), *rest), _impacts)


_Body = tuple[float, float | None, float | list[float] | None, float | list[float] | None, list[tuple[float, ...]] | None]


def _body(e: Any, q: Any, gyration_ratio: Any, center_of_mass: Any, masses: Any) -> _Body:
    inertia = (optional("q", q), ratio("gyration_ratio", gyration_ratio), ratio("center_of_mass", center_of_mass))
    return number("e", e), *inertia, None if masses is None else rows("masses", masses, 2, 3)


def zone(
    *,
    e: float,
    threshold: float | Sequence[float],
    q: float | None = None,
    gyration_ratio: Ratio | None = None,
    center_of_mass: Ratio | None = None,
    masses: Sequence[Piece] | None = None,
    first: End | None = None,
    height_gap: tuple[float, float] | None = None,
) -> Answer:
    """Where on a product no velocity shock exceeds a threshold.

    Parameters
    ----------
    e, q, gyration_ratio, center_of_mass, masses
        As in :func:`impacts`.
    threshold : float or list of float
        Velocity shocks that a part survives, in v0.
    first : {'a', 'b'}, optional
        Also the safe interval where this end of a bar strikes first.
    height_gap : (float, float), optional
        Of a plate: of this one drop alone, heights of corners b and d in h0.

    Returns
    -------
    Answer
        ``zones``: of a bar ``s``, half the width in half-lengths, not clipped; of a plate a ``polygon``.

    Examples
    --------
    >>> import clatter
    >>> [zone.extent for zone in clatter.zone(q=0.5, e=0.3, threshold=[0.5, 1]).zones]
    ['none', 'part']
    """
    restitution, *inertia = _body(e, q, gyration_ratio, center_of_mass, masses)
    gaps = None if height_gap is None else numbers("height_gap", height_gap, 2)
    asked: list[Any] = [restitution, numbers("threshold", threshold), *inertia, first, gaps]
    return told(_clatter.zone(*asked), _zones)


def atlas(
    *, e: float, gyration_ratio: tuple[float, float], center_of_mass: tuple[float, float] | None = None, limit: int = 40
) -> Answer:
    """Which order of corners each direction of tilt of a plate leads to, and the worst of all directions.

    Parameters
    ----------
    e, gyration_ratio, center_of_mass
        As in :func:`impacts`, of a plate.
    limit : int
        Strikes followed in each direction, 1 to 100.

    Returns
    -------
    Answer
        ``words``, each from a direction r = HY/(HX + HY) to another, and ``peak`` [v0].

    Examples
    --------
    >>> import clatter
    >>> words = clatter.atlas(e=0.3, gyration_ratio=(0.577350269, 0.577350269)).words
    >>> words[0]["from"], words[-1].to
    (0.0, 1.0)
    """
    body = (number("e", e), ratio("gyration_ratio", gyration_ratio), ratio("center_of_mass", center_of_mass))
    return told(_clatter.atlas(*body, whole("limit", limit, 1, 100)), _words)


def map(
    quantity: Quantity,
    *,
    e: tuple[float, float, int],
    q: tuple[float, float, int] | None = None,
    gyration_ratio: tuple[float, float, int] | None = None,
    threshold: float | None = None,
) -> Answer:
    """One quantity over a grid of bars that fall without spin.

    Parameters
    ----------
    quantity : {'impacts', 'peak-end', 'peak-center', 'peak-angular', 'net-center', 'duration', 'zone'}
        Impacts; shocks in v0, angular in v0/L; duration in h0/v0; the zone of a threshold in half-lengths, not clipped.
    e, q, gyration_ratio : (lo, hi, n)
        n values from lo to hi, both included; q or gyration_ratio.
    threshold : float, optional
        Of the quantity zone, in v0.

    Returns
    -------
    Answer
        ``q`` or ``gyration_ratio``, shape (n,); ``e``, shape (m,); ``values``, shape (n, m), endless is inf.
        ``plot()`` is the picture.

    Examples
    --------
    >>> import clatter
    >>> int(clatter.map("impacts", q=(0, 1, 3), e=(0, 0.6, 3)).values[1, 1])
    4
    """
    spans = [None if value is None else span(name, value) for name, value in (("q", q), ("gyration_ratio", gyration_ratio))]
    made = _clatter.map(quantity, span("e", e), spans[0], spans[1], optional("threshold", threshold))
    inertia, restitution, values, drawing = made
    fields = {"quantity": quantity, "q" if q is not None else "gyration_ratio": inertia, "e": restitution, "values": values}
    return Answer(fields, rows=_map, drawing=drawing)


def bars(
    *,
    e: ArrayLike,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    height_gap: ArrayLike = 1.0,
) -> Answer:
    """The same as :func:`impacts` for many bars at once, without their lists.

    All arguments are arrays that broadcast against each other; the work is shared by all processors, without the lock of the
    interpreter.

    Parameters
    ----------
    e, q, gyration_ratio, center_of_mass, height_gap : array_like
        As in :func:`impacts`; q or gyration_ratio.
    velocity_a, velocity_b : array_like
        Of the ends at the first touch, in v0.

    Returns
    -------
    Answer
        Arrays of the broadcast shape: ``count`` (endless is inf, beyond 2⁵³ the nearest float), ``duration`` [h0/v0],
        ``peak_end``, ``peak_center`` [v0], ``peak_angular`` [v0/L], ``peak_impact`` (inf where the shocks tend to it),
        ``net_a``, ``net_b``, ``net_center``, ``net_angular``, ``final_a``, ``final_b`` (nan where velocities do not settle).

    Examples
    --------
    >>> import clatter
    >>> clatter.bars(q=[0.5, 0.73], e=[[0.3], [0.2]]).count
    array([[ 4.,  6.],
           [ 4., 16.]])
    """
    given = _columns(
        q=q,
        gyration_ratio=gyration_ratio,
        center_of_mass=center_of_mass,
        e=e,
        velocity_a=velocity_a,
        velocity_b=velocity_b,
        height_gap=height_gap,
    )
    return given.answer(_clatter.bars(list(given.shape), *_bar_columns(given)))


def _columns(times: int = 1, **given: ArrayLike | None) -> Columns:
    """The columns of bars or plates, with the inertia of bars given in one way."""
    from ._arrays import Columns

    if "q" in given and (given["q"] is None) == (given["gyration_ratio"] is None):
        raise ValueError("one of q and gyration_ratio says how the mass lies")
    if given.get("q") is not None and given["center_of_mass"] is not None:
        raise ValueError("center_of_mass goes with gyration_ratio")
    return Columns(given, times)


def _bar_columns(given: Columns) -> tuple[Floats | None, Floats | None, Floats | None, Floats, list[Floats], Floats]:
    velocity = [given["velocity_a"], given["velocity_b"]]
    inertia = (given.get("q"), given.get("gyration_ratio"), given.get("center_of_mass"))
    return (*inertia, given["e"], velocity, given["height_gap"])


def trains(
    *,
    e: ArrayLike,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    height_gap: ArrayLike = 1.0,
    limit: int = 100,
) -> Answer:
    """The impacts of many bars, end a first; ends strike in turns.

    Parameters
    ----------
    e, q, gyration_ratio, center_of_mass, velocity_a, velocity_b, height_gap : array_like
        As in :func:`bars`.
    limit : int
        Impacts of each bar, the length N of the last axis.

    Returns
    -------
    Answer
        Arrays of the broadcast shape and N, nan after the last impact: ``time`` [h0/v0], ``approach``, ``delta_v_a``,
        ``delta_v_b`` [v0].

    Examples
    --------
    >>> import clatter
    >>> clatter.trains(q=0.5, e=[0.3, 0.2], limit=2).delta_v_a
    array([[ 1.3   , -1.0725],
           [ 1.2   , -0.96  ]])
    """
    whole("limit", limit, 1, 2**31)
    given = _columns(
        q=q,
        gyration_ratio=gyration_ratio,
        center_of_mass=center_of_mass,
        e=e,
        velocity_a=velocity_a,
        velocity_b=velocity_b,
        height_gap=height_gap,
        times=4 * limit,
    )
    columns = _clatter.trains(list(given.shape), *_bar_columns(given), limit)
    return given.answer({name: column.reshape(-1, limit) for name, column in columns.items()})


def zones(
    *,
    e: ArrayLike,
    threshold: ArrayLike,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
) -> Answer:
    """The safe zones of many bars, whichever end strikes first.

    Parameters
    ----------
    e, q, gyration_ratio, center_of_mass : array_like
        As in :func:`bars`.
    threshold : array_like
        Velocity shocks that a part survives, in v0.

    Returns
    -------
    Answer
        Arrays of the broadcast shape: ``s``, half the width in half-lengths, not clipped, and the zone from ``lower`` to
        ``upper`` in [-1, 1], nan where nothing is safe.

    Examples
    --------
    >>> import clatter
    >>> clatter.zones(q=0.5, e=0.3, threshold=[0.5, 1.0]).lower.round(3)
    array([   nan, -0.288])
    """
    given = _columns(q=q, gyration_ratio=gyration_ratio, center_of_mass=center_of_mass, e=e, threshold=threshold)
    inertia = (given.get("q"), given.get("gyration_ratio"), given.get("center_of_mass"))
    return given.answer(_clatter.zones(list(given.shape), *inertia, given["e"], given["threshold"]))


def shocks(
    *,
    e: ArrayLike,
    at: ArrayLike,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    height_gap: ArrayLike = 1.0,
    first: End | None = None,
) -> Answer:
    """The largest velocity shock at positions of many bars.

    Parameters
    ----------
    e, q, gyration_ratio, center_of_mass, velocity_a, velocity_b, height_gap : array_like
        As in :func:`bars`.
    at : array_like
        Positions in [-1, 1].
    first : {'a', 'b'}, optional
        The end that strikes first; else the worse of both.

    Returns
    -------
    Answer
        ``shock`` [v0], an array of the broadcast shape.

    Examples
    --------
    >>> import clatter
    >>> clatter.shocks(q=0.5, e=0.3, at=[-1, 0, 1]).shock
    array([2.145  , 0.53625, 2.145  ])
    """
    given = _columns(
        q=q,
        gyration_ratio=gyration_ratio,
        center_of_mass=center_of_mass,
        e=e,
        velocity_a=velocity_a,
        velocity_b=velocity_b,
        height_gap=height_gap,
        at=at,
    )
    column = _clatter.shocks(list(given.shape), *_bar_columns(given), given["at"], first)
    return given.answer({"shock": column})


def plates(
    *,
    e: ArrayLike,
    gyration_ratio_x: ArrayLike,
    gyration_ratio_y: ArrayLike,
    height_gap_x: ArrayLike,
    height_gap_y: ArrayLike,
    center_of_mass_x: ArrayLike = 0.0,
    center_of_mass_y: ArrayLike = 0.0,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    velocity_d: ArrayLike = -1.0,
    limit: int = 1000,
) -> Answer:
    """The same as :func:`impacts` for many plates at once, without their lists.

    Parameters
    ----------
    e : array_like
        Coefficient of restitution, in [0, 1].
    gyration_ratio_x, gyration_ratio_y : array_like
        Radii of gyration over half the length and half the width.
    height_gap_x, height_gap_y : array_like
        Heights of corners b and d as a touches, in h0.
    center_of_mass_x, center_of_mass_y : array_like
        In half-lengths and half-widths from the middle.
    velocity_a, velocity_b, velocity_d : array_like
        Of the corners at the first touch, in v0.
    limit : int
        Impacts followed at most.

    Returns
    -------
    Answer
        Arrays of the broadcast shape: ``count`` (endless is inf), ``count_exact`` (0 where the limit cut it), ``duration``
        [h0/v0], ``peak_corner``, ``peak_center``, ``peak_later`` [v0], ``peak_impact``, ``final_a`` … ``final_d`` [v0].

    Examples
    --------
    >>> import clatter
    >>> k = 1 / 3**0.5
    >>> clatter.plates(e=[0.3, 0.1], gyration_ratio_x=k, gyration_ratio_y=k, height_gap_x=1, height_gap_y=1).count
    array([ 6., inf])
    """
    given = _columns(
        gyration_ratio_x=gyration_ratio_x,
        gyration_ratio_y=gyration_ratio_y,
        center_of_mass_x=center_of_mass_x,
        center_of_mass_y=center_of_mass_y,
        e=e,
        velocity_a=velocity_a,
        velocity_b=velocity_b,
        velocity_d=velocity_d,
        height_gap_x=height_gap_x,
        height_gap_y=height_gap_y,
    )
    whole("limit", limit, 1, 2**31)

    def pair(name: str) -> list[Floats]:
        return [given[f"{name}_x"], given[f"{name}_y"]]

    velocity = [given["velocity_a"], given["velocity_b"], given["velocity_d"]]
    inertia = (pair("gyration_ratio"), pair("center_of_mass"), given["e"])
    return given.answer(_clatter.plates(list(given.shape), *inertia, velocity, pair("height_gap"), limit))


if TYPE_CHECKING:
    from ._arrays import Columns, Floats
