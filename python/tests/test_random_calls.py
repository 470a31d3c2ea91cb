"""Laws of the wheel, over random calls of everything public: some thousand; as many as CLATTER_CALLS says, for once a week."""

import copy
import inspect
import os
import pickle
import random
import typing
import warnings

import clatter
import numpy as np
import pytest
from clatter import _bars, _drops, _products, _records

CALLS = int(os.environ.get("CLATTER_CALLS", "3000"))
#: Calls of one test.
PART = 500
K = 0.577350269

PULSE = clatter.Pulse("half-sine", amplitude_m_s2=5000, duration_s=0.5e-3)
WAVE = np.sin(np.arange(64.0) / 3)
RECORD = clatter.Record(np.array([WAVE, WAVE[::-1]]).T, sample_rate_hz=1e4)
PRODUCT = clatter.Product("p", length="150 mm", radius_of_gyration="45 mm", restitution=[0.3, 0.4], contact_time="0.4 ms")
PRODUCT.falls(height="1 m", tilt="3 deg").add("a", position="50 mm", mount="hard", acceleration_limit="900 gn")

#: Values as they are meant, of the arguments of these names.
MEANT = {
    "e": [0.3, 0.0, 1, [0.2, 0.5], np.array([[0.1], [0.9]]), (0.1, 0.6, 4)],
    "q": [0.5, 1.0, -0.2, [0.5, 0.73], np.linspace(0, 0.9, 4), (0, 0.9, 3), (0.1, 0.8)],
    "gyration_ratio": [0.5, (K, K), [0.6, 0.7], (0.2, 1, 3)],
    "gyration_ratio_x": [K, [0.5, 0.6]],
    "gyration_ratio_y": [K],
    "center_of_mass": [0.1, (0.1, -0.2), 0],
    "center_of_mass_x": [0.1, 0],
    "masses": [[(1, 0.5), (2, -1, 1)], np.array([[1, 0.5], [1, -0.5]])],
    "velocity": [(-1, -0.5), (-1, -1, -0.5)],
    "height_gap": [1, 2.5, (1, 2)],
    "height_gap_x": [1, [1.0, 2.0]],
    "height_gap_y": [1, 0.5],
    "at": [0.5, [0, 0.5], [(0.1, 0.2)], (0.4, 0.2), np.array([-1.0, 1])],
    "threshold": [1.0, [0.5, 1], np.array([0.5, 1.5])],
    "limit": [1, 3, 20, 4000.0, [(10, 50), (1000, 900)]],
    "first": ["a", "b"],
    "quantity": typing.get_args(_bars.Quantity) + typing.get_args(_records.Of),
    "interpolation": typing.get_args(_records.Between),
    "model": typing.get_args(_drops.Model),
    "contact_law": typing.get_args(_drops.Law),
    "length_m": [0.14, 0.15, [0.1, 0.2]],
    "width_m": [0.07],
    "thickness_m": [0.015],
    "gyration_m": [0.0404, (0.0433, 0.0202), (0.0207, 0.0435, 0.0478)],
    "speed_m_s": [4.43, [2.0, 4.0]],
    "height_m": [1.0],
    "tilt_deg": [5, 2.0],
    "direction_deg": [30],
    "gaps_m": [(0.002, 0.001)],
    "orientation": [(0.9238795325112867, 0.3826834323650898, 0, 0), np.array([1.0, 0, 0, 0])],
    "center_of_mass_m": [(0.01, -0.005, 0.002)],
    "spin_rad_s": [2.0, (3.0, -2.0, 1.0)],
    "contact_time_s": [5e-4, 1e-3, (2e-4, 2e-3)],
    "friction": [0.4, 0.0],
    "time_limit_s": [0.05],
    "impact_limit": [5],
    "history": [True, False],
    "flat": [True, False],
    "axis": ["x", "any"],
    "omega": [3.0, 900.0],
    "frequency_hz": [100, [20, 50.5], np.array([30.0])],
    "per_octave_hz": [(10, 100, 3)],
    "damping": [0.05, 0.0, (0.0, 0.5)],
    "q_factor": [10, [5, 25]],
    "stop": [(1e-3, 5e-4, 0.4)],
    "pulses": [PULSE, [PULSE, PULSE]],
    "shocks": [[(0, 2.5), (0.004, -1)], np.array([[0, 1.0], [0.1, -1]])],
    "excitation": [PULSE, RECORD, [RECORD, RECORD], [PULSE], None],
    "required": [5.0, [(10, 9), (80, 75)]],
    "tolerance_db": [(1.5, 6), (0, None)],
    "enveloping_pulse": ["rectangle"],
    "find": [True],
    "acceleration_m_s2": [WAVE, np.array([WAVE, 2 * WAVE]), [0.0, 1, 0]],
    "sample_rate_hz": [1e4, 500],
    "product": [PRODUCT, None],
    "samples": [5, 20],
    "seed": [1, 2**63],
    "target": [0.9],
    "margin": [0.1],
    "zones": [[(0.5, 0.1)], ()],
    "turn": [1.5],
    "tolerance": [0.01, 0.1],
    "merge_s": [1e-3],
    "confidence": [0.9],
    "reliability": [0.5],
    "bounces": [[0, 0.5, 0.7, 0.78], np.array([0, 0.5, 0.75])],
    "strikes": [[(0, "a"), (1.2e-3, "b"), (1.7e-3, None), (34e-3, "b")]],
    "accelerations": [[(clatter.Record(WAVE, sample_rate_hz=1e4), 0.03)]],
    "measured": [{"a": {"bounces": [0, 0.5, 0.7]}}, {}],
    "timing_s": [1e-5],
    "shape": ["half-sine", "trapezoid:0.2"],
    "amplitude_m_s2": [5000.0, 1],
    "duration_s": [1e-3],
    "start_s": [0.1],
    "data": [WAVE, np.array([WAVE, WAVE]).T, {"time [ms]": np.arange(64), "a [g]": WAVE}],
    "time_s": [np.arange(64) / 1e4, np.cumsum(np.linspace(1e-4, 2e-4, 64))],
    "acceleration": ["a", 1, ["a"]],
    "units": ["s,m/s2", "g"],
    "name": ["p", "data"],
    "length": ["1 m"],
    "restitution": [0.3, np.array([0.2, 0.3])],
    "radius_of_gyration": ["0.3 m"],
    "position": ["10 mm"],
}
#: Files are in tests of their own.
FILES = {"report", "report_date"}
DROP = {"model": "finite-tilt", "length_m": 0.14, "gyration_m": 0.0404, "e": 0.3, "speed_m_s": 4.43, "tilt_deg": 5}
PLATE = {"model": "map", "length_m": 0.15, "width_m": 0.07, "gyration_m": (0.0433, 0.0202), "e": 0.3, "speed_m_s": 4.43}
BOX = {"length_m": 0.15, "width_m": 0.07, "thickness_m": 0.015, "gyration_m": (0.0207, 0.0435, 0.0478), "e": 0.3}
BOX |= {"speed_m_s": 4.43, "contact_time_s": 5e-4, "orientation": (0.9238795325112867, 0.3826834323650898, 0, 0)}
#: Whole questions, of which arguments change.
BEGUN = {
    clatter.atlas: [{"e": 0.3, "gyration_ratio": (K, K), "limit": 6}],
    clatter.boxes: [BOX],
    clatter.fit: [{"product": PRODUCT, "bounces": [0, 0.5, 0.75]}],
    clatter.impacts: [{"q": 0.5, "e": 0.3}, {"gyration_ratio": (K, K), "e": 0.3, "height_gap": (2, 1)}],
    clatter.map: [{"quantity": "peak-end", "q": (0, 0.9, 3), "e": (0.1, 0.9, 3)}],
    clatter.plates: [{"e": 0.3, "gyration_ratio_x": K, "gyration_ratio_y": K, "height_gap_x": 1, "height_gap_y": 1}],
    clatter.respond: [{**DROP, "at": 0.4}, {"pulses": PULSE, "omega": 900.0}, {"q": 0.5, "e": 0.3, "at": 0.4, "omega": 3.0}],
    clatter.simulate: [DROP, {**PLATE, "gaps_m": (0.002, 0.001)}, {**BOX, "model": "compliant"}],
    clatter.spectrum: [{"excitation": PULSE}, {"excitation": RECORD, "per_octave_hz": (10, 100, 3)}],
    clatter.zone: [{"q": 0.5, "e": 0.3, "threshold": 1.0}, {"gyration_ratio": (K, K), "e": 0.3, "threshold": 0.5}],
}


#: Values that nobody means.
def strange(dice):
    return dice.choice([
        None, True, "", "a", "1e3", b"x", 0, -1, 1.0, -0.0, 5e-324, 1e-300, 1e300, 1e308, float("inf"), float("-inf"), float("nan"),
        2**53 + 1, 10**400, -(2**63), 1j, (), [], {}, set(), object(), [None], [[]], [1, [2]], ["a"], [(1,)], [1e300, -1e300], range(3),
        np.float32(0.1), np.array(0.5), np.array([True]), np.array([1j]), np.array([2**64 - 1], np.uint64), np.array([0.5, np.nan]),
        np.zeros((2, 0)), np.ones((2, 2, 2)), np.array(["x"]), np.datetime64("2026-03-31"), np.timedelta64(5, "s"),
        np.ma.array([1.0, 2.0], mask=[0, 1]), np.array([1, "a", None], object), np.longdouble("0.1"), dice.random(), -dice.random(),
        10 ** dice.uniform(-12, 12), [dice.random() for _ in range(3)], np.array([dice.gauss(0, 1) for _ in range(4)]), PULSE, RECORD, "\0",
        "\ud800", "é" * 300, iter([0.5, 0.2]),
    ])  # fmt: skip


FUNCTIONS = [getattr(clatter, name) for name in sorted(clatter.__all__) if inspect.isfunction(getattr(clatter, name))]
CALLED = [one for one in FUNCTIONS if one not in (clatter.study, clatter.merge, clatter.schema)]
CALLED += [clatter.Pulse, clatter.Record, clatter.Product]
METHODS = {
    "window": lambda dice: (dice.choice([0.001, 0, strange(dice)]), dice.choice([0.005, 1, strange(dice)])),
    "detrend": lambda dice: (dice.choice([*typing.get_args(_records.Baseline), strange(dice)]),),
    "high_pass": lambda dice: (dice.choice([20, 1000, strange(dice)]),),
    "low_pass": lambda dice: (dice.choice([20, 1000, strange(dice)]),),
    "values_m_s2": lambda dice: (dice.choice([0, 1, "a_1", strange(dice)]),),
    "times_s": lambda dice: (dice.choice([0, 1, "a_1", strange(dice)]),),
}
#: What is refused, and an outside program that fails.
ALLOWED = (ValueError, TypeError, OSError)


def call(dice):
    """A function with arguments: most as they are meant, and now and then one that nobody means."""
    if dice.random() < 0.05:
        name = dice.choice(sorted(METHODS))
        return getattr(RECORD, name), {}, METHODS[name](dice)
    function = dice.choice(CALLED)
    begun = function in BEGUN and dice.random() < 0.8
    arguments = dict(dice.choice(BEGUN[function])) if begun else {}
    for name, parameter in inspect.signature(function).parameters.items():
        if name in FILES or parameter.kind is parameter.VAR_KEYWORD:
            continue
        needed = parameter.default is parameter.empty and not begun
        if needed or dice.random() < dice.choice([0.02, 0.05, 0.3]):
            arguments[name] = dice.choice(MEANT[name]) if name in MEANT and dice.random() < 0.9 else strange(dice)
    if function in (clatter.bars, clatter.zones, clatter.trains, clatter.shocks, clatter.impacts, clatter.zone, clatter.map):
        inertia = arguments.keys() & {"q", "gyration_ratio", "masses"}
        arguments.update({} if inertia or dice.random() < 0.2 else {"q": dice.choice(MEANT["q"])})
    if function is clatter.scatter and not isinstance(arguments.get("samples"), (str, bytes)):
        arguments["samples"] = dice.choice([1, 5, 20])
    if "tolerance" in arguments and isinstance(arguments["tolerance"], float) and arguments["tolerance"] < 1e-4:
        arguments["tolerance"] = 1e-4  # what is finer takes as long as it says
    return function, arguments, ()


def numbers(of):
    """What can be compared to the last bit."""
    if isinstance(of, clatter.Answer):
        return {name: numbers(of[name]) for name in of if name != "seconds"}
    if isinstance(of, clatter.Record):
        return [numbers(of.values_m_s2(i)) + numbers(of.times_s(i)) for i in range(len(of.channels))] + of.findings
    if isinstance(of, clatter.Product):
        return of.text
    if isinstance(of, (list, tuple)):
        return [numbers(one) for one in of]
    if isinstance(of, dict):
        return {name: numbers(one) for name, one in of.items()}
    if isinstance(of, np.ndarray) and of.dtype != object:
        return of.dtype.str, of.shape, of.tobytes()
    return repr(of)


def ask(function, arguments, values):
    """The answer, or how it was refused."""
    try:
        return function(*values, **arguments), None
    except ALLOWED as refusal:
        assert 0 < len(str(refusal)) < 4000, refusal
        return None, f"{type(refusal).__name__}: {refusal}"


def arrays(of):
    """Arrays within what is given."""
    if isinstance(of, np.ndarray):
        return [of]
    several = of.values() if isinstance(of, dict) else of if isinstance(of, (list, tuple)) else ()
    return [array for one in several for array in arrays(one)]


def once_only(value):
    return type(value).__name__ in ("list_iterator", "generator", "object")


@pytest.mark.parametrize("part", range(-(-CALLS // PART)))
@pytest.mark.filterwarnings("ignore")
def test_laws(part, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    dice, answered = random.Random(f"calls {part}"), 0
    for n in range(min(PART, CALLS - part * PART)):
        function, arguments, values = call(dice)
        arguments = {name: value if once_only(value) else copy.deepcopy(value) for name, value in arguments.items()}
        shown = f"call {n} of {part}: {function.__name__}(*{values!r}, **{arguments!r})"
        single = not any(map(once_only, [*arguments.values(), *values]))
        before = numbers(arguments)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            answer, refusal = ask(function, arguments, values)
            assert numbers(arguments) == before, f"what was given has changed: {shown}"
            if single:
                again, refused = ask(function, copy.deepcopy(arguments), values)
                assert refusal == refused and numbers(again) == numbers(answer), f"asked twice: {shown}"
            if refusal:
                continue
            answered += 1
            kept = numbers(answer)
            for array in arrays(list(arguments.values())):
                if array.flags.writeable and array.dtype.kind in "fiu":
                    array[...] = 1
            assert numbers(answer) == kept, f"the answer has memory of who asked: {shown}"
            assert single is False or numbers(pickle.loads(pickle.dumps(answer))) == kept, f"pickled: {shown}"
    assert answered > PART / 10


def test_the_arguments_of_all_are_meant_somewhere():
    known = set(MEANT) | FILES
    rare = set(
        "more quiet_s threshold_m_s2 resultant envelope mean_3db gravity_m_s2 velocity_a velocity_b velocity_d center_of_mass_y mass "
        "frequency_factor limit_factor known_gyration heights time full_scale_m_s2 sensitivity skip_bad moment_of_inertia contact_time".split()
    )
    for function in CALLED:
        unknown = set(inspect.signature(function).parameters) - known - rare
        assert not unknown, (function, unknown)
    assert {one for one in typing.get_args(_products.Model)} == set(MEANT["model"])
