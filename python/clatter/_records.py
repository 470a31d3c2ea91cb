"""Measured accelerations, pulses, and their shock response spectra."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from . import _clatter
from ._answer import Answer, Rows, flat, told

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ._arrays import Floats

Of = Literal["acceleration", "relative-displacement", "relative-velocity", "pseudo-velocity", "equivalent-static-acceleration"]
Between = Literal["band-limited", "linear"]
Baseline = Literal["mean", "linear", "pre-shock"]
Column = str | int


class Pulse:
    """A pulse of acceleration.

    Parameters
    ----------
    shape : str
        half-sine, haversine, triangle, initial-peak-sawtooth, terminal-peak-sawtooth, rectangle, trapezoid or trapezoid:RAMP.
    amplitude_m_s2 : float
        Largest acceleration, in m/s².
    duration_s : float
        In s.
    start_s : float
        When it begins, in s.

    Examples
    --------
    >>> import clatter
    >>> clatter.Pulse("half-sine", amplitude_m_s2=1000, duration_s=0.5e-3).velocity_change_m_s
    0.3183098861837907
    """

    __slots__ = ("_data",)

    def __init__(self, shape: str, *, amplitude_m_s2: float, duration_s: float, start_s: float = 0.0) -> None:
        self._data = _clatter.PulseData(locals())

    @classmethod
    def of_standard(cls, keyword: str) -> Pulse:
        """The pulse of a standard, such as ``JESD22-B110/B``."""
        pulse = cls.__new__(cls)
        pulse._data = _clatter.PulseData.of_standard(keyword)
        return pulse

    @property
    def shape(self) -> str:
        """Its name."""
        return self._data.shape

    @property
    def amplitude_m_s2(self) -> float:
        """Largest acceleration, in m/s²."""
        return self._data.amplitude_m_s2

    @property
    def duration_s(self) -> float:
        """In s."""
        return self._data.duration_s

    @property
    def start_s(self) -> float:
        """When it begins, in s."""
        return self._data.start_s

    @property
    def velocity_change_m_s(self) -> float:
        """Its area, in m/s."""
        return self._data.velocity_change_m_s

    def _values(self) -> tuple[str, float, float, float]:
        return self.shape, self.amplitude_m_s2, self.duration_s, self.start_s

    def __eq__(self, other: object) -> bool:
        return self._values() == other._values() if isinstance(other, Pulse) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._values())

    def __reduce__(self) -> tuple[Any, ...]:
        return _pulse, self._values()

    def __repr__(self) -> str:
        values = f"amplitude_m_s2={self.amplitude_m_s2!r}, duration_s={self.duration_s!r}, start_s={self.start_s!r}"
        return f"Pulse({self.shape!r}, {values})"


def _pulse(shape: str, amplitude_m_s2: float, duration_s: float, start_s: float) -> Pulse:
    return Pulse(shape, amplitude_m_s2=amplitude_m_s2, duration_s=duration_s, start_s=start_s)


class Record:
    """Measured accelerations, in s and m/s².

    :meth:`open` reads a file of any kind that ``clatter record`` reads; this takes a table or arrays. Columns of time and of
    acceleration are found by their names and units, such as ``time [ms]`` and ``a_x [g]``; arrays are in s and m/s². What is
    odd is warned of. Pickled, one of a file has the bytes of the file, which must be there as it was.

    Parameters
    ----------
    data : DataFrame of pandas or polars, Table of pyarrow, dict of arrays, or array
        Columns; or an array of shape (samples,) or (samples, channels), with times or a rate beside.
    time_s : array_like, shape (samples,), optional
        Times of an array, in s.
    sample_rate_hz : float, optional
        In place of times; where there are some as well and they tell another rate, it is warned of.
    time : str or int, optional
        The column of time, by name or number from 1.
    acceleration : list of str or int
        The columns of acceleration; all that are found unless given.
    units : str, optional
        Of time and acceleration where the names do not tell, such as ``"ms,g"``.
    full_scale_m_s2, sensitivity : float, str, optional
        For columns that count in shares of full scale, or in volts: ``"100mV/g"``.
    skip_bad : bool
        Leave rows out that cannot be used, such as with nan; else they are refused.
    name : str
        What it is called in answers, in place of a file.

    Examples
    --------
    >>> import clatter
    >>> record = clatter.Record({"time [ms]": [0, 0.1, 0.2, 0.3], "a_z [g]": [0, -40, 30, 0]})
    >>> record.channels, record.step_s
    (['a_z'], 0.0001)
    >>> record.values_m_s2()
    array([   0.    , -392.266 ,  294.1995,    0.    ])
    """

    __slots__ = ("_data", "_source", "_steps")

    _data: Any
    #: What it was made of: the arguments of the core, and what was done then, each step by its name.
    _source: dict[str, Any]
    _steps: tuple[tuple[Any, ...], ...]

    def __init__(
        self,
        data: Any,
        *,
        time_s: ArrayLike | None = None,
        sample_rate_hz: float | None = None,
        time: Column | None = None,
        acceleration: Column | Sequence[Column] = (),
        units: str | None = None,
        full_scale_m_s2: float | None = None,
        sensitivity: str | None = None,
        skip_bad: bool = False,
        name: str = "data",
    ) -> None:
        values = locals() | {"data": _columns(data, time_s), "acceleration": _picked(acceleration)}
        for other in ("self", "time_s"):
            del values[other]
        self._read(values, stacklevel=3)

    @classmethod
    def open(
        cls,
        path: str | os.PathLike[str],
        *,
        time: Column | None = None,
        acceleration: Column | Sequence[Column] = (),
        units: str | None = None,
        sample_rate_hz: float | None = None,
        full_scale_m_s2: float | None = None,
        sensitivity: str | None = None,
        sensor: str | None = None,
        record: int | None = None,
        skip_bad: bool = False,
    ) -> Record:
        """Read a file of measured accelerations.

        Parameters
        ----------
        path : path
            Text of any separator, LVM, UFF 58, NPY, WAV, MAT, HDF5, TDMS, Parquet, Arrow.
        sensor, record
            The sensor, or the record from 1, of a file that holds several.
        time, acceleration, units, sample_rate_hz, full_scale_m_s2, sensitivity, skip_bad
            As for :class:`Record`.
        """
        values = {**locals(), "path": os.fspath(path), "acceleration": _picked(acceleration)}
        del values["cls"]
        return cls.__new__(cls)._read(values, stacklevel=3)

    def _read(self, source: dict[str, Any], steps: tuple[tuple[Any, ...], ...] = (), stacklevel: int | None = None) -> Record:
        """Make it of its source, and warn of what is odd."""
        self._data = (_clatter.Record.open if "path" in source else _clatter.Record.of_columns)(source)
        self._source, self._steps = source, steps
        for name, *values in steps:
            self._data = getattr(self._data, name)(*values)
        if stacklevel is not None:
            for finding in self.findings:
                warnings.warn(f"{self._data.file}: {finding}", stacklevel=stacklevel)
        return self

    def _then(self, name: str, *values: Any) -> Record:
        record = self.__class__.__new__(self.__class__)
        record._data = getattr(self._data, name)(*values)
        record._source, record._steps = self._source, (*self._steps, (name, *values))
        return record

    def __reduce__(self) -> tuple[Any, ...]:
        source, path = self._source, self._source.get("path")
        if path is not None and "bytes" not in source:
            if not os.path.isfile(path):
                raise ValueError(f"{path} is no file any more: a record is sent with the bytes of its file")
            with open(path, "rb") as file:
                source = {**source, "bytes": file.read()}
            if _record(source, self._steps) != self:
                raise ValueError(f"{path} has changed since it was read: a record is sent with the bytes of its file")
        return _record, (source, self._steps)

    def __copy__(self) -> Record:
        return self  # nothing changes it

    def __deepcopy__(self, memo: dict[int, Any]) -> Record:
        return self

    def __eq__(self, other: object) -> bool:
        return bool(self._data == other._data) if isinstance(other, Record) else NotImplemented

    def __hash__(self) -> int:
        return hash((self._data.file, *self.channels))

    @property
    def channels(self) -> list[str]:
        """Names of the channels."""
        return self._data.channels

    @property
    def findings(self) -> list[str]:
        """What is odd about the record."""
        return self._data.findings

    @property
    def step_s(self) -> float | None:
        """Time between samples in s, where that is one for all."""
        return self._data.step_s

    def values_m_s2(self, channel: str | int = 0) -> Floats:
        """Accelerations of a channel by its name or its index from 0, in m/s², shape (samples,)."""
        return self._data.values_m_s2(channel)

    def times_s(self, channel: str | int = 0) -> Floats:
        """Times of a channel, in s, shape (samples,)."""
        return self._data.times_s(channel)

    def window(self, from_s: float, to_s: float) -> Record:
        """The part between two times of the file, in s."""
        return self._then("window", from_s, to_s)

    def detrend(self, baseline: Baseline) -> Record:
        """Without its offset: the mean, a line, or the mean before the shock."""
        return self._then("detrend", baseline)

    def high_pass(self, hz: float) -> Record:
        """Without what is below a frequency in Hz: Butterworth, two poles forward and backward."""
        return self._then("filter", True, hz)

    def low_pass(self, hz: float) -> Record:
        """Without what is above a frequency in Hz."""
        return self._then("filter", False, hz)

    def describe(
        self,
        *,
        find: bool = False,
        threshold_m_s2: float | None = None,
        quiet_s: float = 5e-3,
        fit_pulse: bool = False,
        nominal: Pulse | None = None,
        integrate: bool = False,
    ) -> Answer:
        """What the record holds and what is odd about it; its shocks, the pulse that fits, velocity and displacement.

        Parameters
        ----------
        find : bool
            Find the shocks beyond ``threshold_m_s2`` (else by the noise), ``quiet_s`` apart.
        fit_pulse : bool
            Fit pulses to the largest shock, held against the tolerances of standards about the best or ``nominal``.
        integrate : bool
            Velocity and displacement at the end, from rest.

        Returns
        -------
        Answer
            As ``clatter record`` has it.
        """
        return told(self._data.describe(locals()), _channels)

    def __repr__(self) -> str:
        return f"Record({self._data.file!r}, channels={self.channels}, step_s={self.step_s})"


def _record(source: dict[str, Any], steps: tuple[tuple[Any, ...], ...] = (), stacklevel: int | None = None) -> Record:
    return Record.__new__(Record)._read(source, steps, stacklevel)


def _picked(columns: Any) -> Any:
    return tuple(columns) if hasattr(columns, "__iter__") and not isinstance(columns, str) else columns


def _channels(answer: Answer) -> Rows:
    return [flat(channel, "") for channel in answer.channels]


_Columns = list[tuple[str, "str | None", "NDArray[Any]"]]


def _columns(data: Any, time_s: ArrayLike | None) -> tuple[_Columns, list[str]]:
    """Columns with their names and units, of a table or of arrays; of a table also what is no numbers."""
    from ._arrays import floats, one_dimensional

    names = getattr(data, "column_names", None) or getattr(data, "columns", None)
    if isinstance(data, Mapping):
        names = list(data)
    if names is not None:
        if time_s is not None:
            raise ValueError("time_s goes with arrays; a table has a column of time")
        texts = [str(name) for name in names if _is_text(str(name), data[name])]
        numbers = [(str(name), *_numbers(str(name), data[name])) for name in names if str(name) not in texts]
        return numbers + _index(data, [*names]), [f"column {name}, which is text" for name in texts]
    array = floats("data", data)
    if array.ndim not in (1, 2):
        raise ValueError(f"data has shape {array.shape}; it is (samples,) or (samples, channels)")
    channels = array.T if array.ndim == 2 else array[None]
    names = ["a"] if len(channels) == 1 else [f"a_{i + 1}" for i in range(len(channels))]
    columns: _Columns = []
    if time_s is not None:
        columns.append(("time", "s", one_dimensional("time_s", time_s).copy()))
    columns.extend((name, "m/s2", channel.copy()) for name, channel in zip(names, channels))
    return columns, []


def _is_text(name: str, column: Any) -> bool:
    from ._arrays import plain

    array = plain(name, column)
    return array.dtype.kind in "USb" or (array.dtype.kind == "O" and any(isinstance(one, str) for one in array.flat))


def _numbers(name: str, column: Any) -> tuple[str | None, NDArray[Any]]:
    """The numbers of a column, and their unit where the type tells it."""
    import numpy as np

    from ._arrays import one_dimensional, plain

    array = plain(name, column)
    if array.dtype.kind == "O" and str(getattr(column, "dtype", "")).startswith("datetime64["):  # with a time zone
        array = np.asarray(column, "datetime64[ns]")
    if array.dtype.kind in "mM":
        return "ns", _nanoseconds(name, array)
    listed = isinstance(column, (list, tuple)) and any(isinstance(one, (bool, np.bool_)) for one in column)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8 and array.ndim == 1 and not listed:
        if array.dtype.kind == "u" and array.size and array.max() > np.iinfo(np.int64).max:
            raise ValueError(f"{name} has integers beyond 2**63")
        return None, np.array(array, np.int64, order="C")
    return None, one_dimensional(name, column).copy()


def _nanoseconds(name: str, times: NDArray[Any]) -> NDArray[Any]:
    """Dates or durations as whole nanoseconds that have lost nothing."""
    import numpy as np

    if (none := np.flatnonzero(np.isnat(times))).size:
        raise ValueError(f"{name} has no time in row {none[0]}, from 0")
    unit = np.datetime_data(times.dtype)[0]
    fixed = unit not in ("generic", "Y", "M") if times.dtype.kind == "m" else unit != "generic"
    exact = times.astype(f"{times.dtype.kind}8[ns]") if fixed else times
    if not fixed or (exact.astype(times.dtype) != times).any():
        raise ValueError(f"{name} is of {times.dtype} and is not told in whole nanoseconds since 1677 to 2262")
    return exact.astype(np.int64)


def _index(data: Any, names: list[Any]) -> _Columns:
    """The index of a DataFrame of pandas, where it is one of times."""
    import numpy as np

    index = getattr(data, "index", None)
    values = getattr(index, "values", None)
    if values is None or (getattr(index, "name", None) is None and np.asarray(values).dtype.kind not in "mM"):
        return []
    name = str(getattr(index, "name", None) or "time")
    return [] if name in names else [(name, *_numbers(name, values))]


def _spectrum_rows(answer: Answer) -> Rows:
    parts = answer.spectra if "spectra" in answer else [answer]
    columns: dict[str, list[Any]] = {}
    for part in parts:
        count = len(part.frequency_hz)
        for name, value in part.__dict__.items():
            if isinstance(value, list) and len(value) == count and name not in ("spectra", "records"):
                columns.setdefault(name, []).extend(value)
        if len(parts) > 1:
            columns.setdefault("of", []).extend([part.of if "of" in part else None] * count)
            columns.setdefault("damping", []).extend([part.damping] * count)
    return columns


Limit = float | Sequence[tuple[float, float]]


def spectrum(
    excitation: Record | Pulse | Sequence[Record] | Sequence[Pulse] | str | os.PathLike[str] | None = None,
    *,
    shocks: Sequence[tuple[float, float]] | None = None,
    frequency_hz: float | ArrayLike | None = None,
    per_octave_hz: tuple[float, float, float] | None = None,
    damping: float | None = None,
    q_factor: ArrayLike | None = None,
    stop: tuple[float, float, float] | None = None,
    quantity: Of = "acceleration",
    interpolation: Between = "band-limited",
    limit: Limit | None = None,
    required: Limit | None = None,
    tolerance_db: tuple[float, float | None] = (0.0, None),
    enveloping_pulse: str | None = None,
    find: bool = False,
    threshold_m_s2: float | None = None,
    quiet_s: float = 5e-3,
    resultant: bool = False,
    envelope: bool = False,
    mean_3db: bool = False,
) -> Answer:
    """Shock response spectra: the peak of a part over its natural frequency.

    Parameters
    ----------
    excitation : Record, Pulse, lists of these, or path
        What shakes the part; the path of a file that :meth:`Record.open` reads.
    shocks : list of (time_s, delta_v_m_s), optional
        Or velocity shocks in the order of time.
    frequency_hz : array_like, optional
        Natural frequencies in Hz, shape (n,).
    per_octave_hz : (lo, hi, n), optional
        Or from lo to hi with n to the octave; (10, 10000, 12) unless given, of records up to a third of the sampling rate.
    damping, q_factor : float
        Damping ratio, or 1/(2 damping), of which several make several spectra; Q = 10 unless given.
    stop : (float, float, float), optional
        Stops on either side of every part: the gap [m], how long it presses one alone [s], and the restitution there. Records
        are then straight lines between their samples.
    quantity : str
        acceleration [m/s²], relative-displacement [m], relative-velocity, pseudo-velocity [m/s],
        equivalent-static-acceleration [m/s²].
    interpolation : {'band-limited', 'linear'}
        What a record is between its samples.
    limit, required : float or list of (hz, value), optional
        What the part stands, or what a test was to reach, in the unit of the quantity; points are straight on log-log paper.
    tolerance_db : (below, above)
        By how much it may be below the required one, and above it, in dB; None is any.
    enveloping_pulse : str, optional
        Also the pulse of this shape whose spectrum is nowhere below.
    find, threshold_m_s2, quiet_s
        A spectrum for each shock of a record, found as by :meth:`Record.describe`.
    resultant, envelope, mean_3db : bool
        Also what several channels make together.

    Returns
    -------
    Answer
        ``frequency_hz``, ``maximax``, ``primary``, ``residual``, ``positive``, ``negative``, …, each of n values; ``spectra``
        where there are several; as ``clatter spectrum`` has it. ``plot()`` is the picture.

    Examples
    --------
    >>> import clatter
    >>> pulse = clatter.Pulse("half-sine", amplitude_m_s2=1000, duration_s=1e-3)
    >>> round(clatter.spectrum(pulse, frequency_hz=[809.94], damping=0.0).maximax[0], 2)
    1768.46
    """
    values = locals() | {"excitation": None if excitation is None else _shaken(excitation)}
    if frequency_hz is not None:
        values["frequency_hz"] = _frequencies(frequency_hz)
    return told(_clatter.spectrum(values), _spectrum_rows)


def _shaken(excitation: Any) -> list[Any]:
    several = excitation if isinstance(excitation, (list, tuple)) else [excitation]
    opened = []
    for one in several:
        if isinstance(one, (str, os.PathLike)):
            one = _record({"path": os.fspath(one), "acceleration": (), "skip_bad": False}, stacklevel=5)
        opened.append(one)
    kinds = {type(one) for one in opened}
    if not kinds <= {Record} and not kinds <= {Pulse}:
        raise ValueError(f"records or pulses, not {', '.join(sorted(kind.__name__ for kind in kinds))}")
    return [one._data for one in opened]


def _frequencies(hz: float | ArrayLike) -> list[float]:
    from ._arrays import floats

    array = floats("frequency_hz", hz)
    if array.ndim > 1:
        raise ValueError(f"frequency_hz has shape {array.shape}; it is a list of numbers")
    return [float(one) for one in array.reshape(-1)]


def spectra(
    acceleration_m_s2: ArrayLike,
    *,
    sample_rate_hz: float,
    frequency_hz: ArrayLike,
    damping: float | None = None,
    q_factor: float | None = None,
    quantity: Of = "acceleration",
    interpolation: Between = "band-limited",
) -> Answer:
    """The spectra of many histories as arrays, without a record around them.

    Parameters
    ----------
    acceleration_m_s2 : array_like, shape (..., samples)
        Accelerations in m/s², from 0 s on.
    sample_rate_hz : float
        Samples a second.
    frequency_hz : array_like, shape (n,)
        Natural frequencies in Hz.
    damping, q_factor, quantity, interpolation
        As in :func:`spectrum`.

    Returns
    -------
    Answer
        Ten million values of each at most: ``frequency_hz``, shape (n,); ``maximax``, ``positive``, ``negative``, shape (..., n).

    Examples
    --------
    >>> import clatter, numpy
    >>> t = numpy.arange(1000) / 10e3
    >>> tones = numpy.sin(6.283 * 100 * t) * [[1.0], [2.0]]
    >>> clatter.spectra(tones, sample_rate_hz=10e3, frequency_hz=[50, 100]).maximax.shape
    (2, 2)
    """
    values = {**locals()}
    import numpy as np

    from ._arrays import floats, in_one_call

    histories = floats("acceleration_m_s2", acceleration_m_s2)
    if histories.ndim == 0 or histories.shape[-1] < 2:
        raise ValueError(f"acceleration_m_s2 has shape {histories.shape}; its last axis is time, of 2 samples at least")
    hz = _frequencies(frequency_hz)
    in_one_call(histories.size // histories.shape[-1] * len(hz), _clatter.MOST, "frequencies of all histories")
    values |= {"acceleration_m_s2": np.ravel(histories), "samples": histories.shape[-1], "frequency_hz": hz}
    columns = _clatter.spectra(values)
    shaped = {name: column.reshape(*histories.shape[:-1], len(hz)) for name, column in columns.items()}
    return Answer({"quantity": quantity, "frequency_hz": np.array(hz), **shaped}, rows=_spectra_rows)


def _spectra_rows(answer: Answer) -> Rows:
    import numpy as np

    columns: dict[str, Any] = {"frequency_hz": np.broadcast_to(answer.frequency_hz, answer.maximax.shape).reshape(-1)}
    return {**columns, **{name: answer[name].reshape(-1) for name in ("maximax", "positive", "negative")}}
