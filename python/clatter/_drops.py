"""Drops in time, in SI units: bars, plates and boxes; and what a part makes of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal

from . import _clatter
from ._answer import Answer, Rows, flat, told
from ._bars import End, Piece
from ._records import Pulse

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

Model = Literal["map", "ballistic", "finite-tilt", "compliant"]
Law = Literal["hysteretic", "dashpot"]
Triple = tuple[float, float, float]

#: Standard gravity, m/s².
STANDARD_GRAVITY = 9.80665


def _impacts(answer: Answer) -> Rows:
    points = {2: "ab", 4: "abcd"}.get(len(answer.largest_delta_v_m_s), "")
    return [flat(impact, points) for impact in answer.impacts]


def simulate(
    *,
    model: Model,
    length_m: float,
    gyration_m: float | Sequence[float],
    e: float,
    width_m: float | None = None,
    thickness_m: float | None = None,
    speed_m_s: float | None = None,
    height_m: float | None = None,
    tilt_deg: float | None = None,
    direction_deg: float | None = None,
    gaps_m: tuple[float, float] | None = None,
    orientation: tuple[float, float, float, float] | None = None,
    center_of_mass: float | tuple[float, float] | None = None,
    center_of_mass_m: Triple | None = None,
    spin_rad_s: float | Triple | None = None,
    gravity_m_s2: float = STANDARD_GRAVITY,
    contact_time_s: float | None = None,
    contact_law: Law | None = None,
    friction: float | None = None,
    time_limit_s: float | None = None,
    impact_limit: int | None = None,
    at: Sequence[float] | Sequence[tuple[float, float]] = (),
    history: bool = False,
) -> Answer:
    """One drop in time: gravity, real tilt, contacts that take time.

    A length makes a bar; with a width it is a plate at small tilt, with a thickness beside it a box in any orientation.

    Parameters
    ----------
    model : {'map', 'ballistic', 'finite-tilt', 'compliant'}
        What is kept of the drop. Plates are followed by map, ballistic and compliant, boxes by compliant.
    length_m, width_m, thickness_m : float
        Size of the body in m. The thickness of a bar is for finite-tilt.
    gyration_m : float, (float, float) or (float, float, float)
        Radius of gyration about the center of mass in m; of a plate along both sides, of a box about its axes.
    e : float
        Coefficient of restitution, in [0, 1].
    speed_m_s, height_m : float
        Speed at the first touch in m/s, or the height of the lower end before the drop in m.
    tilt_deg, direction_deg : float
        Tilt at the first touch in degrees; where a plate or box rises from corner a, 0 along its length.
    gaps_m : (float, float), optional
        Of a plate, instead of tilt and direction: heights of corners b and d as a touches, in m.
    orientation : (w, x, y, z), optional
        Of a box, instead of a tilt: the unit quaternion that turns its axes into those of the world, z upward.
    center_of_mass : float or (float, float), optional
        Of a bar or plate, in half-sides from the middle.
    center_of_mass_m : (float, float, float), optional
        Of a box, in m from the middle.
    spin_rad_s : float or (float, float, float), optional
        At the first touch in rad/s; of a box about its axes.
    gravity_m_s2 : float
        In m/s².
    contact_time_s : float, optional
        Of a lone contact, in s; for compliant.
    contact_law : {'hysteretic', 'dashpot'}, optional
        What the ground does meanwhile; hysteretic unless given.
    friction : float, optional
        Of a box: coefficient of friction of the ground; none unless given.
    time_limit_s : float, optional
        Time for which the motion is followed, in s.
    impact_limit : int, optional
        Strikes that are followed at most, up to a million: 100 000, of a plate by map 1000 unless given.
    at : list of float or of (float, float)
        Positions in [-1, 1] whose velocity shocks are asked for.
    history : bool
        Of a bar, also the rows of its whole motion, as ``history``.

    Returns
    -------
    Answer
        ``impacts`` and ``stop``, times in s and velocities in m/s, as ``clatter simulate`` has it. ``plot()`` of a bar is the
        picture.

    Examples
    --------
    >>> import clatter
    >>> drop = clatter.simulate(model="finite-tilt", length_m=0.14, gyration_m=0.0404, e=0.3, speed_m_s=4.43, tilt_deg=5)
    >>> drop.impacts[0].end, drop.impacts[0].approach_m_s, drop.stop.reason
    ('a', -4.43, 'at-rest')
    """
    return told(_clatter.simulate(locals()), _impacts)


def respond(
    *,
    pulses: Pulse | Sequence[Pulse] | None = None,
    shocks: Sequence[tuple[float, float]] | None = None,
    e: float | None = None,
    q: float | None = None,
    gyration_ratio: float | None = None,
    center_of_mass: float | Sequence[float] | None = None,
    masses: Sequence[Piece] | None = None,
    velocity: tuple[float, float] | None = None,
    height_gap: float | None = None,
    at: float | Sequence[float] | None = None,
    axis: Literal["x", "y", "z", "any"] | None = None,
    omega: float | None = None,
    frequency_hz: float | None = None,
    damping: float | None = None,
    q_factor: float | None = None,
    stop: Triple | None = None,
    model: Model | None = None,
    length_m: float | None = None,
    width_m: float | None = None,
    thickness_m: float | None = None,
    gyration_m: float | Sequence[float] | None = None,
    speed_m_s: float | None = None,
    height_m: float | None = None,
    tilt_deg: float | None = None,
    direction_deg: float | None = None,
    gaps_m: tuple[float, float] | None = None,
    orientation: tuple[float, float, float, float] | None = None,
    center_of_mass_m: Triple | None = None,
    spin_rad_s: float | Sequence[float] | None = None,
    gravity_m_s2: float = STANDARD_GRAVITY,
    contact_time_s: float | None = None,
    contact_law: Law | None = None,
    friction: float | None = None,
    first: End | None = None,
    flat: bool = False,
    tolerance: float = 0.01,
) -> Answer:
    """What a part on its mount makes of pulses, velocity shocks, the clatter of a bar, or a drop in time.

    Parameters
    ----------
    pulses : Pulse or list of Pulse, optional
        What shakes the part, in SI.
    shocks : list of (time_s, delta_v_m_s), optional
        Velocity shocks in the order of time.
    e, q, gyration_ratio, center_of_mass, masses, velocity, height_gap
        Else a bar as in :func:`impacts`, in v0 and h0 or all in SI.
    at : float, (float, float) or (float, float, float)
        Where the part is in half-sides from the middle, in [-1, 1]: one value of a bar, two of a plate, three of a box.
    axis : {'x', 'y', 'z', 'any'}, optional
        Of a box: the axis along which the part moves, z unless given; any is the magnitude, of a part that is mounted rigidly.
    omega, frequency_hz : float
        Natural angular frequency in v0/h0 or rad/s, or natural frequency in Hz.
    damping, q_factor : float
        Damping ratio, or 1/(2 damping); Q = 10 unless given.
    stop : (float, float, float), optional
        Stops on either side of the part: the gap [m], how long it presses one alone [s], and the restitution there; of pulses,
        shocks and drops.
    model, length_m, width_m, thickness_m, gyration_m, center_of_mass_m, speed_m_s, height_m, tilt_deg, direction_deg, gaps_m
    orientation, spin_rad_s, gravity_m_s2, contact_time_s, contact_law, friction
        Else a drop as in :func:`simulate`, with e and center_of_mass.
    first : {'a', 'b'}, optional
        Of a drop: the end that touches first.
    flat : bool
        Of a drop: whether both ends land as one, with instant impacts.
    tolerance : float
        Of a drop: how exact the answer is, as a share of it.

    Returns
    -------
    Answer
        Peaks of the part and what single shocks would do, as ``clatter respond`` has it.

    Examples
    --------
    >>> import clatter
    >>> pulse = clatter.Pulse("half-sine", amplitude_m_s2=9806.65, duration_s=1e-3)
    >>> part = clatter.respond(pulses=pulse, frequency_hz=100, damping=0.05)
    >>> round(part.peak_absolute_acceleration_over_omega * part.omega / 9.80665)  # gn
    369
    """
    return told(_clatter.respond(locals()))


def boxes(
    *,
    length_m: ArrayLike,
    width_m: ArrayLike,
    thickness_m: ArrayLike,
    e: ArrayLike,
    speed_m_s: ArrayLike,
    contact_time_s: ArrayLike,
    gravity_m_s2: ArrayLike = STANDARD_GRAVITY,
    gyration_m: tuple[ArrayLike, ArrayLike, ArrayLike],
    center_of_mass_m: tuple[ArrayLike, ArrayLike, ArrayLike] = (0.0, 0.0, 0.0),
    spin_rad_s: tuple[ArrayLike, ArrayLike, ArrayLike] = (0.0, 0.0, 0.0),
    friction: ArrayLike = 0.0,
    orientation: ArrayLike,
    contact_law: Law = "hysteretic",
) -> Answer:
    """Drops of many boxes, each as :func:`simulate` follows it.

    Parameters
    ----------
    length_m, width_m, thickness_m : array_like
        Size in m.
    gyration_m, center_of_mass_m, spin_rad_s : three array_like
        Along or about the three axes of the box; m, m, rad/s.
    orientation : array_like, shape (..., 4)
        Unit quaternions w, x, y, z that turn the axes of the box into those of the world, z upward.
    e, speed_m_s, contact_time_s, gravity_m_s2, friction : array_like
        As in :func:`simulate`.
    contact_law : {'hysteretic', 'dashpot'}
        Of all.

    Returns
    -------
    Answer
        Arrays of the broadcast shape: ``count`` of presses, ``largest_delta_v_m_s`` of a corner, ``stop_time_s``, ``at_rest``
        (1, or 0 where a limit or a rebound ended it) and ``energy_error``.

    Examples
    --------
    >>> import clatter
    >>> drops = clatter.boxes(
    ...     length_m=0.15, width_m=0.07, thickness_m=0.015, gyration_m=(0.0207, 0.0435, 0.0478),
    ...     orientation=[0.9238795325, 0.3826834324, 0, 0], e=0.3, speed_m_s=[2.0, 4.43], contact_time_s=1e-3,
    ... )
    >>> drops.at_rest
    array([1., 1.])
    """
    values = {**locals()}
    from ._arrays import each, floats

    quaternions = floats("orientation", values.pop("orientation"))
    if quaternions.ndim == 0 or quaternions.shape[-1] != 4:
        raise ValueError(f"orientation has shape {quaternions.shape}; its last axis is w, x, y, z")
    for name in ("gyration_m", "center_of_mass_m", "spin_rad_s"):
        triple = values.pop(name)
        if len(triple) != 3:
            raise ValueError(f"{name} takes three arrays, of x, y and z")
        values.update({f"{name}_{axis}": one for axis, one in zip("xyz", triple)})
    values.update({f"orientation_{part}": quaternions[..., i] for i, part in enumerate("wxyz")})
    return each(_clatter.boxes, values, "contact_law")
