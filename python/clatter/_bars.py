"""Bars and plates without gravity: impacts, safe zones, maps; one at a time, or arrays of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from . import _clatter
from ._answer import Answer, Rows, flat, told

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Ratio = float | tuple[float, float] | Sequence[float]
Piece = tuple[float, float] | tuple[float, float, float]
Quantity = Literal["impacts", "peak-end", "peak-center", "peak-angular", "net-center", "duration", "zone"]
End = Literal["a", "b"]


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
    velocity: ArrayLike | None = None,
    height_gap: Ratio | None = None,
    at: ArrayLike | None = None,
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
    return told(_clatter.impacts(locals()), _impacts)


def zone(
    *,
    e: float,
    threshold: ArrayLike,
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
    return told(_clatter.zone(locals()), _zones)


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
    return told(_clatter.atlas(locals()), _words)


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
    fields, drawing = _clatter.map(locals())
    return Answer({"quantity": quantity, **fields}, rows=_map, drawing=drawing)


def _each(core: Any, values: dict[str, Any], *plain: str) -> Answer:
    from ._arrays import each  # with numpy, which takes time to import

    return each(core, values, *plain)


def bars(
    *,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    e: ArrayLike,
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
    return _each(_clatter.bars, locals())


def trains(
    *,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    e: ArrayLike,
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
    return _each(_clatter.trains, locals(), "limit")


def zones(
    *,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    e: ArrayLike,
    threshold: ArrayLike,
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
    return _each(_clatter.zones, locals())


def shocks(
    *,
    q: ArrayLike | None = None,
    gyration_ratio: ArrayLike | None = None,
    center_of_mass: ArrayLike | None = None,
    e: ArrayLike,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    height_gap: ArrayLike = 1.0,
    at: ArrayLike,
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
    return _each(_clatter.shocks, locals(), "first")


def plates(
    *,
    gyration_ratio_x: ArrayLike,
    gyration_ratio_y: ArrayLike,
    center_of_mass_x: ArrayLike = 0.0,
    center_of_mass_y: ArrayLike = 0.0,
    e: ArrayLike,
    velocity_a: ArrayLike = -1.0,
    velocity_b: ArrayLike = -1.0,
    velocity_d: ArrayLike = -1.0,
    height_gap_x: ArrayLike,
    height_gap_y: ArrayLike,
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
    return _each(_clatter.plates, locals(), "limit")
