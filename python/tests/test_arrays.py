"""Rows of arrays are single questions; arrays that are none are refused with one message, and nothing else happens to them."""

import threading
import time

import clatter
import numpy as np
import pytest

K = 1 / 3**0.5


def random_bars(count):
    random = np.random.default_rng(1)
    return {"q": random.uniform(-0.5, 1, count), "e": random.uniform(0, 1, count), "height_gap": random.uniform(0, 3, count)}


def number(value):
    return {"endless": np.inf, "limit": np.inf, None: np.nan}.get(value, value)


def test_bars_are_impacts():
    given = random_bars(200)
    given["q"][:2], given["e"][:2] = [1, 0.9], [1, 0]
    answer = clatter.bars(**given)
    for i in range(200):
        one = clatter.impacts(**{name: float(column[i]) for name, column in given.items()}, limit=0)
        final = one.final or [None, None]
        expected = {
            "count": one.count,
            "duration": one.duration,
            **{f"peak_{name}": one.peak[name] for name in ("end", "impact", "center", "angular")},
            **{f"net_{name}": one.net[name] for name in ("a", "b", "center", "angular")},
            "final_a": final[0],
            "final_b": final[1],
        }
        for name, value in expected.items():
            np.testing.assert_array_equal(answer[name][i], number(value), err_msg=f"{name} of row {i}")


def test_bars_off_center_are_impacts():
    answer = clatter.bars(gyration_ratio=[0.5, 0.7], center_of_mass=0.2, e=[[0.3], [0.5], [0.8]])
    assert answer.count.shape == (3, 2)
    for i, e in enumerate([0.3, 0.5, 0.8]):
        for j, k in enumerate([0.5, 0.7]):
            one = clatter.impacts(gyration_ratio=k, center_of_mass=0.2, e=e, limit=0)
            assert (answer.count[i, j], answer.peak_end[i, j]) == (one.count, one.peak.end)


def test_trains_are_impacts():
    given = random_bars(50)
    answer = clatter.trains(**given, limit=20)
    assert answer.time.shape == (50, 20)
    for i in range(50):
        impacts = clatter.impacts(**{name: float(column[i]) for name, column in given.items()}, limit=20).impacts
        rows = [[impact.time, impact.approach, *impact.delta_v] for impact in impacts]
        rows += [[np.nan] * 4] * (20 - len(rows))
        columns = [answer.time[i], answer.approach[i], answer.delta_v_a[i], answer.delta_v_b[i]]
        np.testing.assert_array_equal(np.transpose(columns), rows)


def test_zones_and_shocks_are_those_of_zone():
    q = np.linspace(-0.4, 0.9, 30)
    answer = clatter.zones(q=q, e=0.3, threshold=1.2)
    assert answer.s.tolist() == [clatter.zone(q=x, e=0.3, threshold=1.2).zones[0].s for x in q]
    part = (answer.s > 0) & (answer.s < 1)
    assert part.any()
    # Shocks at the bounds of a zone are its threshold.
    shock = clatter.shocks(q=q[part], e=0.3, at=answer.upper[part]).shock
    np.testing.assert_allclose(shock, 1.2, rtol=1e-13)  # a few roundings of numbers of size 1
    np.testing.assert_array_equal(answer.lower, -answer.upper)
    # A bar off its center is told whichever end strikes first.
    centers = [-0.3, 0.2]
    answer = clatter.zones(gyration_ratio=0.6, center_of_mass=centers, e=0.3, threshold=1.2)
    zones = [clatter.zone(gyration_ratio=0.6, center_of_mass=at, e=0.3, threshold=1.2).zones[0].zone for at in centers]
    assert [[low, high] for low, high in zip(answer.lower, answer.upper)] == zones
    assert abs(answer.lower[0]) != abs(answer.upper[0])


def test_plates_are_impacts():
    random = np.random.default_rng(2)
    x, y = random.uniform(0, 3, (2, 60))
    answer = clatter.plates(e=0.25, gyration_ratio_x=K, gyration_ratio_y=0.7, height_gap_x=x, height_gap_y=y)
    for i in range(60):
        one = clatter.impacts(gyration_ratio=(K, 0.7), e=0.25, height_gap=(x[i], y[i]), limit=0)
        assert (answer.count[i], answer.duration[i]) == (number(one.count), one.duration)
        assert [answer[f"peak_{name}"][i] for name in ("corner", "impact", "center", "later")] == [
            one.peak[name] for name in ("corner", "impact", "center", "later")
        ]
        assert [answer[f"final_{name}"][i] for name in "abcd"] == one.final


def test_boxes_are_simulate():
    turns = [[0.9238795325112867, 0.3826834323650898, 0, 0], [0.9914448613738104, 0, 0.13052619222005157, 0]]
    body = {"length_m": 0.15, "width_m": 0.07, "thickness_m": 0.015, "e": 0.3, "contact_time_s": 5e-4}
    body |= {"center_of_mass_m": (0.01, -0.005, 0.002), "spin_rad_s": (3.0, -2.0, 1.0)}
    answer = clatter.boxes(**body, gyration_m=(0.0207, 0.0435, 0.0478), orientation=turns, speed_m_s=[[2.0], [4.43]])
    assert answer.count.shape == (2, 2)
    for i, speed in enumerate([2.0, 4.43]):
        for j, turn in enumerate(turns):
            drop = clatter.simulate(
                model="compliant", **body, gyration_m=(0.0207, 0.0435, 0.0478), orientation=turn, speed_m_s=speed
            )
            largest = max(abs(v) for impact in drop.impacts for v in impact.delta_v_m_s)
            assert (answer.count[i, j], answer.largest_delta_v_m_s[i, j]) == (len(drop.impacts), largest)
            assert answer.stop_time_s[i, j] == drop.stop.time_s


def test_spectra_are_spectrum():
    random = np.random.default_rng(3)
    histories = random.normal(size=(2, 3, 500))
    answer = clatter.spectra(histories, sample_rate_hz=10e3, frequency_hz=[50, 400], q_factor=20)
    assert answer.maximax.shape == (2, 3, 2)
    for i in range(2):
        for j in range(3):
            record = clatter.Record(histories[i, j], sample_rate_hz=10e3)
            one = clatter.spectrum(record, frequency_hz=[50, 400], q_factor=20)
            assert answer.maximax[i, j].tolist() == one.maximax
            assert answer.negative[i, j].tolist() == one.negative


def test_what_is_given_does_not_change_the_answer():
    plain = random_bars(64)
    expected = clatter.bars(**plain)
    read_only = {name: column.copy() for name, column in plain.items()}
    for column in read_only.values():
        column.setflags(write=False)
    strided = {name: np.repeat(column, 3)[::3] for name, column in plain.items()}
    reversed_twice = {name: column[::-1].copy()[::-1] for name, column in plain.items()}
    swapped = {name: column.astype(">f8") for name, column in plain.items()}
    lists = {name: column.tolist() for name, column in plain.items()}
    objects = {name: column.astype(object) for name, column in plain.items()}
    for given in (read_only, strided, reversed_twice, swapped, lists, objects):
        assert clatter.bars(**given).count.tobytes() == expected.count.tobytes()
        assert clatter.bars(**given).peak_end.tobytes() == expected.peak_end.tobytes()
    fortran = {name: np.asfortranarray(column.reshape(8, 8)) for name, column in plain.items()}
    assert clatter.bars(**fortran).duration.tobytes() == expected.duration.reshape(8, 8).tobytes()


def test_no_axis_is_a_number_and_no_element_no_answer():
    assert clatter.bars(q=np.array(0.5), e=0.3).count == 4
    assert clatter.bars(q=[], e=0.3).count.shape == (0,)
    assert clatter.bars(q=np.empty((0, 3)), e=[0.1, 0.2, 0.3]).count.shape == (0, 3)
    assert clatter.bars(q=[0.5], e=0.3).count.shape == (1,)


REFUSED = {
    "at [1]: inertia ratio q = NaN is not in (-1, 1]": lambda: clatter.bars(q=[0.5, np.nan], e=0.3),
    "at [1, 0]: restitution e = 1.5 is not in [0, 1]": lambda: clatter.bars(q=[0.5, 0.6], e=[[0.3], [1.5]]),
    "inertia ratio q = 2.0 is not in (-1, 1]": lambda: clatter.bars(q=2, e=0.3),
    "at [20000]: restitution e = inf is not in [0, 1]": lambda: clatter.bars(q=0.5, e=[0.5] * 20000 + [np.inf]),
    "shapes that do not go together: q (3,), e (2,)": lambda: clatter.bars(q=[0.1, 0.2, 0.3], e=[0.1, 0.2]),
    "e is of complex; numbers are float64": lambda: clatter.bars(q=0.5, e=[0.3 + 0j]),
    "e is of bool; numbers are float64": lambda: clatter.bars(q=0.5, e=[True]),
    "e is of str; numbers are float64": lambda: clatter.bars(q=0.5, e=["0.3"]),
    "q has masked elements": lambda: clatter.bars(q=np.ma.array([0.5, 0.6], mask=[0, 1]), e=0.3),
    "q has integers beyond 2**53, which float64 does not hold": lambda: clatter.bars(q=[2**60], e=0.3),
    "q is ragged: it has rows of 1 and of 2": lambda: clatter.bars(q=[[0.1], [0.2, 0.3]], e=0.3),
    "1000000000000 elements in one call; it takes 10000000: ask in pieces": lambda: clatter.bars(
        q=np.broadcast_to(0.5, (10**6, 1)), e=np.broadcast_to(0.3, (1, 10**6))
    ),
    "4000000000 elements in one call; it takes 10000000: ask in pieces": lambda: clatter.trains(q=0.5, e=0.3, limit=10**9),
    "one of q and gyration_ratio says how the mass lies": lambda: clatter.bars(q=0.5, gyration_ratio=0.5, e=0.3),
    "center_of_mass goes with gyration_ratio": lambda: clatter.bars(q=0.5, center_of_mass=0.1, e=0.3),
    "at [0]: position = 1.5 is not in [-1, 1]": lambda: clatter.shocks(q=0.5, e=0.3, at=[1.5]),
    "at [0]: threshold = 0.0 is not in [1e-150, 1e150], in v0": lambda: clatter.zones(q=0.5, e=0.3, threshold=[0]),
    "orientation has shape (3,); its last axis is w, x, y, z": lambda: clatter.boxes(
        length_m=1, width_m=1, thickness_m=1, gyration_m=(1, 1, 1), orientation=[1, 0, 0], e=0, speed_m_s=1, contact_time_s=1
    ),
    "acceleration_m_s2 has shape (); its last axis is time": lambda: clatter.spectra(
        1.0, sample_rate_hz=1e3, frequency_hz=[10]
    ),
    "frequency_hz has shape (1, 1); it is a list of numbers": lambda: clatter.spectra(
        [1.0, 2.0], sample_rate_hz=1e3, frequency_hz=[[10]]
    ),
    "history 1: sample 2: acceleration (m/s²) = NaN is not finite": lambda: clatter.spectra(
        [[1.0, 2.0], [1.0, np.nan]], sample_rate_hz=1e3, frequency_hz=[10]
    ),
    "e is not given": lambda: clatter.bars(q=0.5, e=None),
    "q = array([0.5]) is not a number": lambda: clatter.impacts(q=np.array([0.5]), e=0.3),
    "gyration_ratio takes 1 value or 2 values, not 3": lambda: clatter.impacts(gyration_ratio=(1, 2, 3), e=0.3),
    "length_m = '1 m' is not a number": lambda: clatter.simulate(
        model="map", length_m="1 m", gyration_m=0.3, e=0.3, speed_m_s=1, tilt_deg=1
    ),
    "n of q = 2.5 is not a whole number": lambda: clatter.map("impacts", q=(0, 1, 2.5), e=(0, 1, 3)),
    "sample_rate_hz = NaN is not finite and > 0": lambda: clatter.spectra(
        [1.0, 2.0], sample_rate_hz=float("nan"), frequency_hz=[10]
    ),
    "200000000 elements of acceleration_m_s2 in one call; it takes 100000000: ask in pieces": lambda: clatter.spectra(
        np.broadcast_to(1.0, (2, 10**8)), sample_rate_hz=1e3, frequency_hz=[10]
    ),
    "points are too many: a map has": lambda: clatter.map("impacts", q=(0, 1, 10**9), e=(0, 1, 10**9)),
    "axis e = 0.5:0.1:3: the first bound must not exceed the last": lambda: clatter.map(
        "impacts", q=(0, 1, 3), e=(0.5, 0.1, 3)
    ),
    "limit = 1000000000 is not in 0 ..= 1000000": lambda: clatter.impacts(q=0.5, e=0.3, limit=10**9),
    "zone needs a threshold, in v0": lambda: clatter.map("zone", q=(0, 1, 3), e=(0, 1, 3)),
}


@pytest.mark.parametrize("message", REFUSED)
def test_refused_with_one_message(message):
    with pytest.raises(ValueError) as refusal:
        REFUSED[message]()
    assert message in str(refusal.value)


def test_arrays_that_were_given_stay_as_they_are():
    q, e = np.array([0.5, np.nan]), np.array([0.3, 0.4])
    with pytest.raises(ValueError):
        clatter.bars(q=q, e=e)
    np.testing.assert_array_equal(q, [0.5, np.nan])
    answer = clatter.bars(q=q[:1], e=e)
    answer.count[0] = 7
    np.testing.assert_array_equal(e, [0.3, 0.4])
    with pytest.raises(ValueError, match="read-only"):
        answer.e[0] = 7  # a view of what was given


def test_others_run_meanwhile():
    """While an array is worked on, a thread of Python goes on; with the lock held it could not take a step."""
    steps, done = [], threading.Event()

    def count():
        while not done.wait(1e-3):
            steps.append(time.monotonic())

    counting = threading.Thread(target=count)
    counting.start()
    begin = time.monotonic()
    clatter.trains(q=0.999, e=0.999 * np.ones(1000), limit=2000)
    end = time.monotonic()
    done.set()
    counting.join()
    assert sum(begin < step < end for step in steps) >= 3


def test_threads_have_the_same_answers():
    expected = clatter.bars(**random_bars(5000)).peak_end.tobytes()
    answers = []
    threads = [threading.Thread(target=lambda: answers.append(clatter.bars(**random_bars(5000)))) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [answer.peak_end.tobytes() for answer in answers] == [expected] * 6
