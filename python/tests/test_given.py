"""Arguments reach the core by their names: one that it does not know is an error, and so is what is none of what is wanted."""

import re
import types
import typing

import clatter
import numpy as np
import pytest
from clatter import _bars, _clatter, _drops, _products, _records

K = 1 / 3**0.5
BAR = {"q": 0.5, "e": 0.3}
DROP = {"model": "finite-tilt", "length_m": 0.14, "gyration_m": 0.0404, "e": 0.3, "speed_m_s": 4.43, "tilt_deg": 5}
PLATE = {"gyration_ratio_x": K, "gyration_ratio_y": K, "height_gap_x": 1, "height_gap_y": 1, "e": 0.3}
BOX = {"length_m": 1, "width_m": 1, "thickness_m": 1, "gyration_m": (1, 1, 1), "orientation": [1, 0, 0, 0]}
PULSE = clatter.Pulse("half-sine", amplitude_m_s2=1, duration_s=1)
RECORD = clatter.Record([1.0, 2.0], sample_rate_hz=1)
PRODUCT = clatter.Product.example()

#: A question to each function of the core that takes arguments by their names.
CORE = {
    "PulseData": lambda: clatter.Pulse("half-sine", amplitude_m_s2=1, duration_s=1),
    "assess": lambda: clatter.assess(PRODUCT),
    "atlas": lambda: clatter.atlas(gyration_ratio=(K, K), e=0.3),
    "bars": lambda: clatter.bars(**BAR),
    "boxes": lambda: clatter.boxes(**BOX, e=0, speed_m_s=1, contact_time_s=1),
    "design": lambda: clatter.design(PRODUCT),
    "explain": lambda: clatter.explain(PRODUCT),
    "fit": lambda: clatter.fit(PRODUCT, bounces=[0, 0.5]),
    "impacts": lambda: clatter.impacts(**BAR),
    "map": lambda: clatter.map("impacts", q=(0, 1, 3), e=(0, 1, 3)),
    "merge": lambda: clatter.merge(["part.parquet"]),
    "plates": lambda: clatter.plates(**PLATE),
    "respond": lambda: clatter.respond(**BAR, at=0, omega=1),
    "scatter": lambda: clatter.scatter(PRODUCT),
    "shocks": lambda: clatter.shocks(**BAR, at=0),
    "simulate": lambda: clatter.simulate(**DROP),
    "spectra": lambda: clatter.spectra([1.0, 2.0], sample_rate_hz=1, frequency_hz=[1]),
    "spectrum": lambda: clatter.spectrum(PULSE),
    "study": lambda: clatter.study("plan.toml", "part.parquet"),
    "tradeoff": lambda: clatter.tradeoff(PRODUCT),
    "trains": lambda: clatter.trains(**BAR),
    "zone": lambda: clatter.zone(**BAR, threshold=1),
    "zones": lambda: clatter.zones(**BAR, threshold=1),
}
KNOWN_TO_RECORDS = {
    "of_columns": lambda: clatter.Record([1.0, 2.0], sample_rate_hz=1),
    "open": lambda: clatter.Record.open("nowhere.csv"),
    "describe": lambda: RECORD.describe(),
}


#: A question with one name in place of those that a signature has.
NAMED = [
    (_drops.Model, lambda name: clatter.simulate(**{**DROP, "model": name})),
    (_products.Model, lambda name: clatter.assess(PRODUCT, model=name)),
    (_drops.Law, lambda name: clatter.simulate(**DROP, contact_law=name)),
    (_bars.Quantity, lambda name: clatter.map(name, q=(0, 1, 3), e=(0, 1, 3))),
    (_records.Of, lambda name: clatter.spectrum(PULSE, quantity=name)),
    (_records.Between, lambda name: clatter.spectrum(PULSE, interpolation=name)),
    (_records.Baseline, RECORD.detrend),
]


@pytest.mark.parametrize(("names", "ask"), NAMED)
def test_signatures_have_the_names_of_the_core(names, ask):
    with pytest.raises(ValueError, match="none-such") as refused:
        ask("none-such")
    told = str(refused.value).split(": ", 1)[1]
    assert re.split(", | or ", told) == list(typing.get_args(names))


def with_wind(core):
    """Hands an argument on that nothing takes."""
    return lambda *arguments: core(*arguments[:-1], {**arguments[-1], "wind_m_s": 1.0})


def test_every_function_of_the_core_is_asked():
    assert set(CORE) == {name for name in dir(_clatter) if callable(getattr(_clatter, name))} - {
        "Drawing", "ProductText", "Record", "example", "schema", "text",
    }  # fmt: skip


@pytest.mark.parametrize("name", CORE)
def test_an_argument_that_the_core_does_not_know_is_an_error(name, monkeypatch):
    monkeypatch.setattr(_clatter, name, with_wind(getattr(_clatter, name)))
    with pytest.raises(TypeError, match="the core does not know the argument 'wind_m_s'"):
        CORE[name]()


def test_a_drop_that_a_part_responds_to_takes_no_unknown_argument(monkeypatch):
    monkeypatch.setattr(_clatter, "respond", with_wind(_clatter.respond))
    with pytest.raises(TypeError, match="'wind_m_s'"):
        clatter.respond(**DROP, at=0)


@pytest.mark.parametrize("name", KNOWN_TO_RECORDS)
def test_an_argument_that_records_do_not_know_is_an_error(name, monkeypatch):
    core = RECORD._data if name == "describe" else _clatter.Record
    other = types.SimpleNamespace(**{name: with_wind(getattr(core, name))})
    if name == "describe":
        monkeypatch.setattr(RECORD, "_data", other)
    else:
        monkeypatch.setattr(_clatter, "Record", other)
    with pytest.raises(TypeError, match="'wind_m_s'"):
        KNOWN_TO_RECORDS[name]()


REFUSED = {
    "e = True is not a number": lambda: clatter.impacts(q=0.5, e=True),
    "e = None is not a number": lambda: clatter.impacts(q=0.5, e=None),
    "limit = True is not a whole number": lambda: clatter.impacts(**BAR, limit=True),
    "limit = -1 is not in 0 ..= 1000000": lambda: clatter.impacts(**BAR, limit=-1),
    "limit = 0 is not in 1 ..= 100": lambda: clatter.atlas(gyration_ratio=(K, K), e=0.3, limit=0),
    "impact_limit = 0 is not in 1 ..= 1000000": lambda: clatter.simulate(**DROP, impact_limit=0),
    "masses = 3 is not a list": lambda: clatter.impacts(masses=3, e=0.3),
    "masses[0] takes 2 values or 3 values, not 1": lambda: clatter.impacts(masses=[(1,)], e=0.3),
    "velocity takes 2 values for a bar, not 3": lambda: clatter.impacts(**BAR, velocity=(-1, -1, -1)),
    "height_gap takes two values for a plate": lambda: clatter.impacts(gyration_ratio=(K, K), e=0.3),
    "at = 'a' is not a number": lambda: clatter.impacts(**BAR, at="a"),
    "at[1] takes 2 values, not 3": lambda: clatter.impacts(gyration_ratio=(K, K), e=0.3, at=[(0, 0), (0, 0, 0)]),
    "at takes positions in [-1, 1] for a bar": lambda: clatter.impacts(**BAR, at=[(0, 0)]),
    "first = 'c' is not an end, 'a' or 'b'": lambda: clatter.zone(**BAR, threshold=1, first="c"),
    "q = (0, 1) is not (lo, hi, n)": lambda: clatter.map("impacts", q=(0, 1), e=(0, 1, 3)),
    "quantity = 'speed' is none: impacts, peak-end, peak-center, peak-angular, net-center, duration, zone": lambda: clatter.map(
        "speed", q=(0, 1, 3), e=(0, 1, 3)
    ),
    "threshold goes with the quantity zone alone": lambda: clatter.map("impacts", q=(0, 1, 3), e=(0, 1, 3), threshold=1),
    "velocity_a is not given": lambda: clatter.bars(**BAR, velocity_a=None),
    "model = 'exact' is none: map, ballistic, finite-tilt, compliant": lambda: clatter.simulate(**{**DROP, "model": "exact"}),
    "model = 3 is not text": lambda: clatter.simulate(**{**DROP, "model": 3}),
    "history = 'no' is not True or False": lambda: clatter.simulate(**DROP, history="no"),
    "contact_law = 'glue' is none: hysteretic or dashpot": lambda: clatter.simulate(**DROP, contact_law="glue"),
    "orientation takes 4 values, not 3": lambda: clatter.simulate(**DROP, orientation=(1, 0, 0)),
    "pulses is a Pulse or a list of them": lambda: clatter.respond(pulses=[PULSE, 1], omega=1),
    "pulses does not go with length_m, which makes a drop in SI units": lambda: clatter.respond(**DROP, at=0, pulses=PULSE),
    "the drop is not whole: give at": lambda: clatter.respond(**DROP),
    "axis = 'Y' is none: x, y, z or any": lambda: clatter.respond(**DROP, at=0, axis="Y"),
    "it is that of a box: parts of bars and plates": lambda: clatter.respond(**DROP, at=0, axis="x"),
    "axis goes with length_m alone": lambda: clatter.respond(pulses=PULSE, omega=1, axis="x"),
    "omega and frequency_hz say both how the part swings": lambda: clatter.respond(**DROP, at=0, omega=1, frequency_hz=1),
    "damping, q_factor and stop go with omega or frequency_hz": lambda: clatter.respond(**DROP, at=0, damping=0.1),
    "one of omega and frequency_hz says how the part swings": lambda: clatter.respond(pulses=PULSE),
    "pulses, shocks, or e and at of a bar say what shakes the part": lambda: clatter.respond(omega=1),
    "flat goes with instant impacts": lambda: clatter.respond(**{**DROP, "model": "compliant"}, at=0, flat=True),
    "damping or q_factor, not both": lambda: clatter.respond(pulses=PULSE, omega=1, damping=0.1, q_factor=5),
    "a limit = 'a' is not a list": lambda: clatter.spectrum(PULSE, limit="a"),
    "per_octave_hz takes 3 values, not 2": lambda: clatter.spectrum(PULSE, per_octave_hz=(1, 2)),
    "q_factor is empty": lambda: clatter.spectrum(PULSE, q_factor=[]),
    "interpolation = 'cubic' is none: band-limited or linear": lambda: clatter.spectrum(PULSE, interpolation="cubic"),
    "from_s has integers beyond 2**53": lambda: RECORD.window(10**400, 1),
    "hz = True is not a number": lambda: RECORD.low_pass(True),
    "baseline = 'median' is none: mean, linear or pre-shock": lambda: RECORD.detrend("median"),
    "time = 1.5 is not the number or the name of a column": lambda: clatter.Record([1.0, 2.0], time=1.5),
    "seed = -1 is not in 0 ..= 18446744073709551615": lambda: clatter.scatter(PRODUCT, seed=-1),
    "strikes[0] = 1 is not (time_s, end)": lambda: clatter.fit(PRODUCT, strikes=[1]),
    "time of strikes[0] = 'a' is not a number": lambda: clatter.fit(PRODUCT, strikes=[("a", 1)]),
    "heights[0] takes 3 values, not 2": lambda: clatter.fit(PRODUCT, heights=[(0, 1)]),
    "accelerations[0] is not (Record, position_m)": lambda: clatter.fit(PRODUCT, accelerations=[(1, 0.1)]),
    "position of accelerations[0] = 'a' is not a number": lambda: clatter.fit(PRODUCT, accelerations=[(RECORD, "a")]),
    "zones[0] takes 2 values, not 1": lambda: clatter.design(zones=[(1,)]),
}


@pytest.mark.parametrize("message", REFUSED)
def test_refused_with_one_message(message):
    with pytest.raises(ValueError) as refusal:
        REFUSED[message]()
    assert message in str(refusal.value)


def test_numbers_are_those_of_python_and_numpy():
    plain = clatter.impacts(q=0.5, e=0.25, at=[0.5], velocity=(-1, -0.5), limit=3)
    assert plain == clatter.impacts(
        q=np.array(0.5), e=np.float32(0.25), at=np.array([0.5]), velocity=np.array([-1, -0.5]), limit=np.int64(3)
    )
    assert plain == clatter.impacts(q=np.float64(0.5), e=0.25, at=iter([0.5]), velocity=[-1, -0.5], limit=3)
