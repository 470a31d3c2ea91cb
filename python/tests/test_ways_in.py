"""An array of every kind, into every function that takes one: right, or refused; never another number, nor a view of it."""

import array
import decimal
import fractions
import sys

import clatter
import numpy as np
import pandas
import pint
import polars
import pyarrow
import pytest

K = 0.577350269
BAR = {"q": 0.5, "e": 0.3}
BOX = {"length_m": 0.15, "width_m": 0.07, "thickness_m": 0.015, "gyration_m": (0.0207, 0.0435, 0.0478)}
BOX |= {"orientation": [0.9238795325112867, 0.3826834323650898, 0, 0], "contact_time_s": 1e-3}
PLATE = {"gyration_ratio_x": K, "gyration_ratio_y": K, "height_gap_x": 1, "height_gap_y": 1}
PULSE = clatter.Pulse("half-sine", amplitude_m_s2=5000, duration_s=0.5e-3)
UNITS = pint.UnitRegistry()

#: Numbers that float16 holds, whole numbers, and what is asked with either.
ENTRIES = {
    "bars, e": ([0.25, 0.5, 0.75], [0, 1, 1], lambda x: clatter.bars(q=0.5, e=x)),
    "trains, e": ([0.25, 0.5, 0.75], [0, 1, 1], lambda x: clatter.trains(q=0.5, e=x, limit=5)),
    "zones, threshold": ([0.5, 1.0, 1.5], [1, 2, 3], lambda x: clatter.zones(**BAR, threshold=x)),
    "shocks, at": ([-0.5, 0.0, 0.75], [-1, 0, 1], lambda x: clatter.shocks(**BAR, at=x)),
    "plates, e": ([0.25, 0.5, 0.75], [0, 0, 0], lambda x: clatter.plates(**PLATE, e=x)),
    "boxes, speed": ([2.0, 2.5, 4.0], [2, 3, 4], lambda x: clatter.boxes(**BOX, e=0.3, speed_m_s=x)),
    "boxes, spin": ([0.25, 0.5], [2, 3], lambda x: clatter.boxes(**BOX, e=0.3, speed_m_s=2, spin_rad_s=(x, 0, 0))),
    "spectra": ([0.25, -0.5, 3.0], [1, 2, 3], lambda x: clatter.spectra(x, sample_rate_hz=1e3, frequency_hz=[10])),
    "spectra, frequencies": ([10, 20.5], [10, 20], lambda x: clatter.spectra([1.0, 2], sample_rate_hz=1e3, frequency_hz=x)),
    "spectrum, frequencies": ([10.0, 20.5], [10, 20], lambda x: clatter.spectrum(PULSE, frequency_hz=x)),
    "spectrum, Q": ([5.0, 10.5], [5, 10], lambda x: clatter.spectrum(PULSE, frequency_hz=[10], q_factor=x)),
    "record": ([0.25, -0.5, 3.0], [1, 2, 3], lambda x: clatter.Record(x, sample_rate_hz=1e3)),
    "record, times": ([0.25, 0.5, 0.75], [1, 2, 3], lambda x: clatter.Record([1.0, 2.0, 3.0], time_s=x)),
    "table, column": ([0.25, -0.5, 3.0], [1, 2, 3], lambda x: clatter.Record({"time [s]": [1, 2, 3], "a [m/s2]": x})),
    "table, times": ([0.25, 0.5, 0.75], [1, 2, 3], lambda x: clatter.Record({"time [s]": x, "a [m/s2]": [1, 2, 3]})),
    "impacts, at": ([-0.5, 0.0, 0.75], [-1, 0, 1], lambda x: clatter.impacts(**BAR, at=x)),
    "impacts, velocity": ([-1.0, -0.25], [-1, -2], lambda x: clatter.impacts(**BAR, velocity=x)),
    "impacts, mass": ([1.0, -0.25], [1, 1], lambda x: clatter.impacts(e=0.3, masses=[x, (1, 0.5)])),
    "zone, threshold": ([0.5, 1.0], [1, 2], lambda x: clatter.zone(**BAR, threshold=x)),
    "respond, shock": ([0.5, 1.0], [1, 2], lambda x: clatter.respond(shocks=[(0, 1), x], frequency_hz=10)),
    "fit, bounces": ([0.0, 0.5, 0.75], [0, 2, 3], lambda x: clatter.fit(clatter.Product.example(), bounces=x)),
    "design, zone": ([0.5, 0.125], [1, 1], lambda x: clatter.design(zones=[x])),
    "product": ([0.25, 0.5], [0, 1], lambda x: clatter.Product("p", length="1 m", restitution=x)),
}  # fmt: skip


class Held:
    """Nothing but an array behind ``__array__``, as what other packages have."""

    def __init__(self, values):
        self.values = np.array(values)

    def __array__(self, dtype=None, copy=None):
        return np.asarray(self.values, dtype)


class Plain(np.ndarray):
    """An array of a package that adds no unit."""


class InGrams(np.ndarray):
    """An array with a unit, as those of astropy and unyt are."""

    unit = "g"


def misaligned(x):
    return np.frombuffer(bytearray(b"\0" + np.array(x, float).tobytes()), np.uint8)[1:].view(float)


def read_only(x):
    array = np.array(x, float)
    array.setflags(write=False)
    return array


#: Kinds that have the numbers of the list.
RIGHT = {
    "tuple": tuple,
    "array": lambda x: np.array(x, float),
    "strided": lambda x: np.repeat(np.array(x, float), 3)[::3],
    "reversed": lambda x: np.array(x[::-1], float)[::-1],
    "column of rows": lambda x: np.array([x, x], float).T[:, 1],
    "read-only": read_only,
    "byte-swapped": lambda x: np.array(x, ">f8" if sys.byteorder == "little" else "<f8"),
    "float16": lambda x: np.array(x, np.float16),
    "float32": lambda x: np.array(x, np.float32),
    "misaligned": misaligned,
    "objects": lambda x: np.array(x, object),
    "decimals": lambda x: [decimal.Decimal(one) for one in x],
    "fractions": lambda x: [fractions.Fraction(one) for one in x],
    "numbers of numpy": lambda x: [np.float32(one) for one in x],
    "arrays without axis": lambda x: [np.array(one, float) for one in x],
    "buffer": lambda x: array.array("d", x),
    "view of memory": lambda x: memoryview(array.array("d", x)),
    "__array__": Held,
    "subclass": lambda x: np.array(x, float).view(Plain),
    "mask of nothing": lambda x: np.ma.array(x, float),
    "pandas": lambda x: pandas.Series(x, dtype=float, index=range(len(x), 0, -1)),
    "pandas, label unit": lambda x: pandas.Series(x, dtype=float, index=["unit", "units", "index"][: len(x)]),
    "pandas, nullable": lambda x: pandas.Series(x, dtype="Float64"),
    "polars": lambda x: polars.Series(x, dtype=polars.Float64),
    "pyarrow": lambda x: pyarrow.array(x, pyarrow.float64()),
    "pyarrow, chunked": lambda x: pyarrow.chunked_array([pyarrow.array(x[:1], "float64"), pyarrow.array(x[1:], "float64")]),
}
#: The same of whole numbers.
WHOLE = {
    **{kind: lambda x, kind=kind: np.array(x, kind) for kind in ("i1", "i2", ">i4", "i8", "u1", "u2", "u4", ">u8")},
    "list": list,
    "numbers of numpy": lambda x: [np.int16(one) for one in x],
    "objects": lambda x: np.array(x, object),
    "pandas, nullable": lambda x: pandas.Series(x, dtype="Int64"),
    "polars": lambda x: polars.Series(x, dtype=polars.Int32),
    "pyarrow": lambda x: pyarrow.array(x, pyarrow.int8()),
}


def within_itself(x):
    whole = [*x]
    whole[0] = whole
    return whole


#: Kinds that are refused.
REFUSED = {
    "complex": lambda x: np.array(x, complex),
    "complex, listed": lambda x: [complex(one) for one in x],
    "bool": lambda x: np.array(x, bool),
    "bool, listed": lambda x: [True, *x[1:]],
    "text": lambda x: [str(one) for one in x],
    "text of numpy": lambda x: np.array(x).astype(str),
    "bytes": lambda x: np.array(x).astype(bytes),
    "one text": lambda x: str(x),
    "masked": lambda x: np.ma.array(x, float, mask=[1] + [0] * (len(x) - 1)),
    "masked element": lambda x: [*x[:-1], np.ma.masked],
    "nothing within": lambda x: [*x[:-1], None],
    "pandas, NA": lambda x: pandas.Series([*x[:-1], None], dtype="Float64"),
    "polars, null": lambda x: polars.Series([*x[:-1], None], dtype=polars.Float64),
    "pyarrow, null": lambda x: pyarrow.array([*x[:-1], None], pyarrow.float64()),
    "nan": lambda x: np.array([*x[:-1], np.nan]),
    "ragged": lambda x: [x, x[:-1]],
    "ragged within": lambda x: [x[0], x],
    "within itself": within_itself,
    "units of pint": lambda x: UNITS.Quantity(np.array(x, float), "standard_gravity"),
    "units of pint, listed": lambda x: [UNITS.Quantity(float(one), "standard_gravity") for one in x],
    "no unit of pint": lambda x: UNITS.Quantity(np.array(x, float), "percent"),
    "units of a subclass": lambda x: np.array(x, float).view(InGrams),
    "uint64 beyond 2**53": lambda x: np.array([2**53 + 1] * len(x), np.uint64),
    "least of int64": lambda x: np.array([-(2**63)] * len(x), np.int64),
    "beyond 2**53, listed": lambda x: [2**53 + 1, *x[1:]],
    "beyond 2**53, of numpy": lambda x: [np.int64(2**53 + 1), *x[1:]],
    "beyond 2**53, with a hole": lambda x: polars.Series([2**53 + 1] * (len(x) - 1) + [None], dtype=polars.Int64),
    "huge": lambda x: [10**400, *x[1:]],
    "huge number": lambda x: 10**400,
    "huge decimal": lambda x: [decimal.Decimal("1e999"), *x[1:]],
    "fields": lambda x: np.array([(one, 1) for one in x], [("a", float), ("b", float)]),
    "set": lambda x: {*x, 7.5},
    "keys": lambda x: dict.fromkeys(x),
    "object": lambda x: object(),
    **({"longdouble": lambda x: np.array(x, np.longdouble)} if np.dtype(np.longdouble).itemsize > 8 else {}),
}
# A column of a table may hold times: they have a test of their own.
TIMES = {
    f"{kind}[{unit}]": lambda x, kind=kind, unit=unit: np.arange(len(x)).astype(f"{kind}8[{unit}]")
    for kind in "mM"
    for unit in ("Y", "M", "W", "D", "h", "m", "s", "ms", "us", "ns", "ps", "fs", "as")
}
#: Kinds of which some functions make something, and others nothing.
EITHER = {
    "no axis": lambda x: np.array(x[0]),
    "no element": lambda x: [],
    "no element of numpy": lambda x: np.empty((0, 3)),
    "three axes": lambda x: np.array([[x]], float),
    "table": lambda x: pandas.DataFrame([x]),
    "generator": lambda x: (one for one in x),
    "iterator": iter,
    "lists in lists": lambda x: [[[]]] * len(x),
}


def numbers(of):
    """What can be compared to the last bit."""
    if isinstance(of, clatter.Answer):
        return {name: numbers(of[name]) for name in of}
    if isinstance(of, clatter.Record):
        return [(of.times_s(name).tobytes(), of.values_m_s2(name).tobytes()) for name in of.channels]
    if isinstance(of, clatter.Product):
        return of.text
    if isinstance(of, list):
        return [numbers(one) for one in of]
    return (of.dtype.str, of.shape, of.tobytes()) if isinstance(of, (np.ndarray, np.generic)) else repr(of)


@pytest.fixture(scope="module")
def expected():
    """What the lists are answered."""
    return {name: [numbers(ask(list(x))) for x in (values, whole)] for name, (values, whole, ask) in ENTRIES.items()}


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("kind", RIGHT)
def test_kinds_of_arrays_are_lists(kind, entry, expected):
    values, _, ask = ENTRIES[entry]
    if entry == "product" and kind in ("buffer", "view of memory", "decimals", "fractions"):
        pytest.skip("no kind of a product file")
    given = RIGHT[kind](list(map(float, values)))
    before = np.array(given, float)
    answer = ask(given)
    assert numbers(answer) == expected[entry][0] or entry == "product"
    np.testing.assert_array_equal(np.array(given, float), before, "what is given stays")
    if isinstance(given, np.ndarray) and given.flags.writeable:
        given[...] = 0.125
        assert numbers(answer) == expected[entry][0] or entry == "product", "the answer has memory of who asked"


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("kind", WHOLE)
def test_whole_numbers_are_lists(kind, entry, expected):
    _, whole, ask = ENTRIES[entry]
    if min(whole) < 0 and "u" in kind:
        pytest.skip("below zero")
    assert numbers(ask(WHOLE[kind](whole))) == expected[entry][1]


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("kind", REFUSED)
def test_other_kinds_are_refused(kind, entry):
    values, _, ask = ENTRIES[entry]
    if entry == "table, column" and kind in ("uint64 beyond 2**53", "least of int64"):
        pytest.skip("64-bit integers of a table are of a file, whose times are such")
    with pytest.raises((ValueError, TypeError)) as refusal:
        answer = ask(REFUSED[kind](list(map(float, values))))
        answer = answer.check() if entry == "product" else answer
        pytest.fail(repr(answer))
    assert 0 < len(str(refusal.value)) < 2000


@pytest.mark.parametrize("entry", [entry for entry in ENTRIES if entry != "table, times"])
@pytest.mark.parametrize("kind", TIMES)
def test_times_are_no_numbers(kind, entry):
    values, _, ask = ENTRIES[entry]
    with pytest.raises((ValueError, TypeError)):
        pytest.fail(repr(ask(TIMES[kind](values))))


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("kind", EITHER)
def test_what_has_no_such_shape_is_refused_or_broadcast(kind, entry, expected):
    values, _, ask = ENTRIES[entry]
    try:
        answer = ask(EITHER[kind](list(map(float, values))))
    except (ValueError, TypeError):
        return
    if kind in ("generator", "iterator"):
        assert numbers(answer) == expected[entry][0]


def test_two_axes_of_every_order(tmp_path):
    rows = np.arange(1, 13, dtype=float).reshape(3, 4) / 16
    memory = np.memmap(tmp_path / "rows", np.float64, "w+", shape=rows.shape)
    memory[...] = rows
    expected = [numbers(ask(rows.tolist())) for ask in BY_ROWS.values()]
    for given in (
        rows,
        np.asfortranarray(rows),
        rows[::-1].copy()[::-1],
        np.repeat(rows, 2, axis=1)[:, ::2],
        [*rows],
        [list(map(np.float64, row)) for row in rows],
        pandas.DataFrame(rows),
        polars.DataFrame(rows),
        np.matrix(rows),
        memory,
    ):
        tables = (pandas.DataFrame, polars.DataFrame)
        asked = {name: ask for name, ask in BY_ROWS.items() if name != "record" or not isinstance(given, tables)}
        assert [numbers(ask(given)) for ask in asked.values()] == expected[: len(asked)], type(given)


BY_ROWS = {
    "bars": lambda x: clatter.bars(q=0.5, e=x),
    "spectra": lambda x: clatter.spectra(x, sample_rate_hz=1e3, frequency_hz=[10, 20]),
    "record": lambda x: clatter.Record(x, sample_rate_hz=1e3),
}


def test_columns_of_pandas_go_by_their_order_where_their_rows_have_one_name():
    q, e = pandas.Series([0.1, 0.9], index=[3, 4]), pandas.Series([0.3, 0.2], index=[3, 4])
    assert clatter.bars(q=q, e=e) == clatter.bars(q=q.tolist(), e=e.tolist())
    with pytest.raises(ValueError, match="e and q have rows of other names: align them"):
        clatter.bars(q=q, e=e[::-1])


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns", "ps"])
def test_times_of_a_table_keep_their_nanoseconds_or_are_refused(unit):
    count = {"ns": 1000, "ps": 1000_000}.get(unit, 1)  # steps of one nanosecond may be rounded ones
    step = {"s": 1, "ms": 1e-3, "us": 1e-6, "ns": 1e-6, "ps": 1e-6}[unit]
    steps = np.array([0, 1, 2, 3]) * count
    for begin in ("2026-03-31T12:00:00", "1969-12-31T23:59:59"):
        if unit == "ps":
            begin = "1970-01-01T00:00:00"  # of picoseconds 2**63 are some months
        times = np.datetime64(begin, unit) + steps.astype(f"m8[{unit}]")
        for given in (times, times - times[0], pandas.Series(times) if unit != "ps" else times):
            record = clatter.Record({"time": given, "a [m/s2]": [1.0, 2.0, 3.0, 4.0]})
            assert record.step_s == pytest.approx(step, rel=1e-12)
    if unit != "ps":
        aware = pandas.Series(times).dt.tz_localize("Europe/Berlin")
        assert clatter.Record({"time": aware, "a [m/s2]": [1.0, 2.0, 3.0, 4.0]}).step_s == pytest.approx(step, rel=1e-12)


WRONG_TIMES = {
    "has no time in row 1, from 0": np.array(["2026-03-31", "NaT", "2026-04-02"], "M8[ns]"),
    "is of datetime64[s] and is not told in whole nanoseconds since 1677 to 2262": np.array(
        ["3000-01-01T00:00:00", "3000-01-01T00:00:01", "3000-01-01T00:00:02"], "M8[s]"
    ),
    "is of timedelta64[ps] and is not told": np.array([0, 1500, 3000], "m8[ps]"),
    "is of timedelta64[M] and is not told": np.array([0, 1, 2], "m8[M]"),
    "is of timedelta64 and is not told": np.array([0, 1, 2], "m8"),
}


@pytest.mark.parametrize("message", WRONG_TIMES)
def test_times_that_are_not_told_in_nanoseconds_are_refused(message):
    with pytest.raises(ValueError) as refusal:
        clatter.Record({"time": WRONG_TIMES[message], "a [m/s2]": [1.0, 2.0, 3.0]})
    assert message in str(refusal.value)


def test_a_rate_is_held_against_the_times_of_a_table():
    frame = {"time [s]": [0, 0.001, 0.002, 0.003], "a [m/s2]": [0.0, 1.0, 2.0, 0.0]}
    told = "the rate that is given, 20000 Hz, is not that of the times, 1000 Hz"
    with pytest.warns(UserWarning, match=told):
        record = clatter.Record(frame, sample_rate_hz=20000)
    assert record.findings[0] == told and record.step_s == 50e-6
    with pytest.warns(UserWarning, match=told):
        clatter.Record(frame["a [m/s2]"], time_s=frame["time [s]"], sample_rate_hz=20000)
    assert clatter.Record(frame, sample_rate_hz=1001).findings == []
    assert clatter.Record({"a [m/s2]": frame["a [m/s2]"]}, sample_rate_hz=20000).findings == []


def test_findings_are_warnings_where_a_record_is_made(tmp_path):
    path = tmp_path / "drop.csv"
    path.write_text("time [s],a [m/s2],b\n0,0,1\n1,5,1\n2,0,1\n")
    for ask in (
        lambda: clatter.Record.open(path),
        lambda: clatter.spectrum(path, frequency_hz=[1]),
        lambda: clatter.Record({"time [s]": [0, 1, 2], "a [m/s2]": [0, 5, 0], "b": [1, 1, 1]}, name="drop.csv"),
    ):
        with pytest.warns(UserWarning, match=r"drop\.csv: nothing is made of column 3 \(b\)") as warned:
            ask()
        assert {one.filename for one in warned} == {__file__}
