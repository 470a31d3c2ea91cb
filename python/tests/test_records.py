"""Records of arrays and tables are those of files with the same columns."""

import json

import clatter
import numpy as np
import pandas
import polars
import pyarrow
import pyarrow.parquet
import pytest


def history(samples=4000, rate=20e3):
    """A shock on noise: time in ms and two accelerations in g."""
    t = np.arange(samples) / rate
    random = np.random.default_rng(5)
    shock = np.where((t > 0.05) & (t < 0.051), 300 * np.sin(np.pi * (t - 0.05) / 1e-3), 0)
    noise = random.normal(scale=0.5, size=(2, samples))
    return {"time [ms]": 1e3 * t, "a_x [g]": noise[0], "a_z [g]": shock + noise[1]}


@pytest.fixture
def parquet(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pyarrow.parquet.write_table(pyarrow.table(history()), "drop.parquet")
    return "drop.parquet"


def tables():
    data = history()
    return {
        "dict": data,
        "pandas": pandas.DataFrame(data),
        "pandas, times as index": pandas.DataFrame(data).set_index("time [ms]"),
        "pandas, nullable": pandas.DataFrame(data).astype("Float64"),
        "polars": polars.DataFrame(data),
        "pyarrow": pyarrow.table(data),
    }


@pytest.mark.parametrize("kind", tables())
def test_tables_have_the_spectra_of_the_command(kind, parquet, command):
    arguments = ["--frequency=20:2000:12", "--q-factor=10,25", "--resultant", "--format=json"]
    printed = command("spectrum", parquet, *arguments).stdout
    record = clatter.Record(tables()[kind], name=parquet)
    answer = clatter.spectrum(record, per_octave_hz=(20, 2000, 12), q_factor=[10, 25], resultant=True)
    if kind == "pandas, times as index":  # the index comes after the columns, and nothing else changes
        assert [part.maximax for part in answer.spectra] == [part["maximax"] for part in json.loads(printed)["spectra"]]
    else:
        assert answer.to_json() == printed.rstrip("\n")


def test_files_are_those_of_the_command(parquet, command, tmp_path):
    rows = np.transpose(list(history().values()))
    np.savetxt(tmp_path / "drop.csv", rows, delimiter=";", header="time [ms];a_x [g];a_z [g]", comments="", fmt="%.9g")
    for file in (parquet, "drop.csv"):
        record = clatter.Record.open(file)
        shown = ["--find", "--fit-pulse", "--integrate", "--acceleration=a_z", "--format=json"]
        one = clatter.Record.open(file, acceleration="a_z")
        described = one.describe(find=True, fit_pulse=True, integrate=True).to_json()
        assert described == command("record", file, *shown).stdout.rstrip("\n")
        spectrum = clatter.spectrum(record, interpolation="linear", envelope=True, mean_3db=True)
        arguments = ["--interpolation=linear", "--envelope", "--mean-3db", "--format=json"]
        assert spectrum.to_json() == command("spectrum", file, *arguments).stdout.rstrip("\n")
        found = clatter.spectrum(file, find=True, frequency_hz=100)
        assert found.to_json() == command("spectrum", file, "--find", "--frequency=100", "--format=json").stdout.rstrip("\n")
        spectrum.plot().save("ours.svg")
        command("spectrum", file, *arguments, "-o", "theirs.svg")
        assert tmp_path.joinpath("ours.svg").read_bytes() == tmp_path.joinpath("theirs.svg").read_bytes()


def test_conditioned_as_by_the_command(parquet, command):
    record = clatter.Record.open(parquet).window(0.04, 0.08).detrend("mean").high_pass(20).low_pass(2000)
    flags = ["--window=0.04:0.08", "--detrend=mean", "--high-pass=20", "--low-pass=2000"]
    printed = command("spectrum", parquet, *flags, "--format=json").stdout
    assert clatter.spectrum(record).to_json() == printed.rstrip("\n")


def test_arrays_are_in_si():
    data = history()
    table = clatter.Record({"time [s]": data["time [ms]"] / 1e3, "a [m/s2]": data["a_z [g]"]})
    timed = clatter.Record(data["a_z [g]"], time_s=data["time [ms]"] / 1e3)
    rated = clatter.Record(data["a_z [g]"], sample_rate_hz=20e3)
    expected = clatter.spectrum(table, frequency_hz=[100, 500]).maximax
    assert clatter.spectrum(timed, frequency_hz=[100, 500]).maximax == expected
    # A step that the times tell to some digits differs from 1/rate in the last ones.
    np.testing.assert_allclose(clatter.spectrum(rated, frequency_hz=[100, 500]).maximax, expected, rtol=1e-11)
    both = clatter.Record(np.transpose([data["a_x [g]"], data["a_z [g]"]]), sample_rate_hz=20e3)
    assert both.channels == ["a_1", "a_2"]
    np.testing.assert_array_equal(both.values_m_s2("a_2"), data["a_z [g]"])
    np.testing.assert_allclose(both.times_s(), data["time [ms]"] / 1e3, rtol=1e-14)


def test_times_of_dates_keep_their_nanoseconds():
    times = pandas.date_range("2026-03-31 12:00:00", periods=500, freq="50us")
    values = np.sin(np.arange(500) / 5)
    frames = [
        pandas.DataFrame({"time": times, "a [m/s2]": values}),
        pandas.DataFrame({"a [m/s2]": values}, index=times),
        polars.DataFrame({"time": times.to_numpy(), "a [m/s2]": values}),
        pandas.DataFrame({"time": times - times[0], "a [m/s2]": values}),
    ]
    for frame in frames:
        assert clatter.Record(frame).step_s == 50e-6


REFUSED = {
    "no column is a time: the columns are 1 (a [m/s2]); name one by its number, or give the sample rate": (
        ValueError,
        lambda: clatter.Record([1.0, 2.0, 3.0]),
    ),
    "data has shape (2, 1, 2); it is (samples,) or (samples, channels)": (
        ValueError,
        lambda: clatter.Record(np.ones((2, 1, 2)), sample_rate_hz=1e3),
    ),
    "data has shape ()": (ValueError, lambda: clatter.Record(1.0, sample_rate_hz=1e3)),
    "nan": (ValueError, lambda: clatter.Record([1.0, np.nan, 3.0, 4.0], sample_rate_hz=1e3)),
    "time_s has shape (2, 1); it is a list of numbers": (
        ValueError,
        lambda: clatter.Record([1.0, 2.0], time_s=[[0.0], [1.0]]),
    ),
    "a table has a column of numbers at least": (ValueError, lambda: clatter.Record({})),
    "shocks is empty": (ValueError, lambda: clatter.spectrum(shocks=[])),
    "channel = -1 is not in 0 ..= 0": (ValueError, lambda: clatter.Record([1.0, 2.0], sample_rate_hz=1).values_m_s2(-1)),
    "kg": (ValueError, lambda: clatter.Record([1.0, 2.0], sample_rate_hz=1e3, units="ms, kg")),
    "no column is an acceleration": (ValueError, lambda: clatter.Record({"time [s]": [0, 1], "a [g]": ["x", "y"]})),
    "time_s goes with arrays": (ValueError, lambda: clatter.Record({"a [g]": [0, 1]}, time_s=[0, 1])),
    "there is no channel 'b'; there are a": (
        ValueError,
        lambda: clatter.Record([1.0, 2.0], sample_rate_hz=1e3).values_m_s2("b"),
    ),
    "No such file": (FileNotFoundError, lambda: clatter.Record.open("nowhere.csv")),
    "a record, pulses or shocks": (ValueError, clatter.spectrum),
    "records or pulses, not float": (ValueError, lambda: clatter.spectrum(1.0)),
    "quantity = 'speed' is none: acceleration": (
        ValueError,
        lambda: clatter.spectrum(shocks=[(0, 1)], quantity="speed"),
    ),
    "'sine' is no shape; there are half-sine": (
        ValueError,
        lambda: clatter.Pulse("sine", amplitude_m_s2=1, duration_s=1),
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_refused_with_one_message(message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    kind, ask = REFUSED[message]
    with pytest.raises(kind) as refusal:
        ask()
    assert message.lower() in str(refusal.value).lower()


def test_text_in_a_table_is_left_out_and_told():
    record = clatter.Record({"time [s]": [0, 0.1, 0.2], "a [g]": [0, 1, 0], "note": ["", "drop", ""]})
    assert record.channels == ["a"]
    assert record.findings[0] == "nothing is made of column note, which is text"


def test_words_of_the_command(command, tmp_path):
    path = tmp_path / "torn.csv"
    path.write_text("time [s],a [kg]\n0,1\n1,2\n2,3\n")
    told = command("record", path, code=[2]).stderr
    with pytest.raises(ValueError) as refusal:
        clatter.Record.open(path)
    assert told.startswith(f"error: {refusal.value}")
