"""Every public object comes back as it was: pickled, copied, sent to other processes; and a copy is one's own."""

import copy
import multiprocessing
import pickle

import clatter
import joblib
import numpy as np
import pytest

K = 0.577350269
WAVE = np.sin(np.arange(200.0) / 5) * np.hanning(200)
UNEVEN = np.cumsum(np.linspace(1e-4, 2e-4, 200))
BAR = {"name": "bar", "length": "150 mm", "radius_of_gyration": "45 mm", "restitution": [0.25, 0.4], "contact_time": "0.4 ms"}
DROP = {"height": "1 m", "tilt": ["1 deg", "6 deg"]}
BOX = {"length_m": 0.15, "width_m": 0.07, "thickness_m": 0.015, "gyration_m": (0.0207, 0.0435, 0.0478)}
BOX |= {"orientation": [0.9238795325112867, 0.3826834323650898, 0, 0], "contact_time_s": 1e-3}


def pulse():
    return clatter.Pulse("trapezoid:0.2", amplitude_m_s2=1000, duration_s=1e-3, start_s=0.1)


def record(**more):
    return clatter.Record(WAVE, **{"sample_rate_hz": 1e4, **more})


def built():
    return clatter.Product(**BAR).falls(**DROP).add("part", position="50 mm", mount="hard", acceleration_limit="900 gn")


def fixed(name):
    """A study and its parts, in the present folder."""
    with open("example.toml", "w") as file:
        file.write(clatter.Product.example().text)
    with open("plan.toml", "w") as file:
        file.write("product = 'example.toml'\nsamples = 100\n")
    shard = clatter.study("plan.toml", "part.parquet", force=True)
    return shard if name == "study" else clatter.merge(["part.parquet"])


def file_of(times):
    np.savetxt("drop.csv", np.transpose([times, WAVE]), delimiter=",", header="time [s],a [m/s2]", comments="", fmt="%.9g")
    return clatter.Record.open("drop.csv", units="s,m/s2")


#: Public objects of every kind, by what makes them.
OBJECTS = {
    "Pulse": pulse,
    "Pulse of a standard": lambda: clatter.Pulse.of_standard("JESD22-B110/B"),
    "Record of an array": record,
    "Record of times that are not even": lambda: record(sample_rate_hz=None, time_s=UNEVEN),
    "Record of a table": lambda: clatter.Record({"time [ms]": np.arange(200), "a [g]": WAVE, "n": WAVE}, acceleration=("a",)),
    "Record, conditioned": lambda: record().window(0.001, 0.018).detrend("mean").high_pass(20).low_pass(3000),
    "Record of a file": lambda: file_of(np.arange(200) / 1e4),
    "Record of a file, not even": lambda: file_of(UNEVEN).window(0.001, 0.02),
    "Product": built,
    "Product of a text": clatter.Product.example,
    "Product of a dict": lambda: clatter.Product.from_dict({"product": BAR, "drop": DROP, "component": []}),
    "Figure": lambda: clatter.spectrum(pulse()).plot(),
    "assess": lambda: clatter.assess(built()),
    "atlas": lambda: clatter.atlas(gyration_ratio=(K, K), e=0.3, limit=4),
    "bars": lambda: clatter.bars(q=[0.5, 1], e=[[0.3], [1.0]]),
    "bars, one": lambda: clatter.bars(q=0.5, e=0.3),
    "bars, none": lambda: clatter.bars(q=[], e=0.3),
    "boxes": lambda: clatter.boxes(**BOX, e=0.3, speed_m_s=[2.0, 4.43]),
    "describe": lambda: record().describe(find=True, fit_pulse=True, integrate=True),
    "design": clatter.design,
    "design of a product": lambda: clatter.design(built()),
    "explain": lambda: clatter.explain(built()),
    "fit": lambda: clatter.fit(built(), bounces=[0, 0.5, 0.7, 0.78, 0.812]),
    "impacts": lambda: clatter.impacts(q=1, e=1, limit=3),
    "map": lambda: clatter.map("impacts", q=(0, 1, 4), e=(0, 1, 3)),
    "merge": lambda: fixed("merge"),
    "plates": lambda: clatter.plates(e=0.3, gyration_ratio_x=K, gyration_ratio_y=K, height_gap_x=[1, 2], height_gap_y=1),
    "respond": lambda: clatter.respond(pulses=pulse(), frequency_hz=100),
    "scatter": lambda: clatter.scatter(built(), samples=50),
    "schema": clatter.schema,
    "shocks": lambda: clatter.shocks(q=0.5, e=0.3, at=[0, 1]),
    "simulate": lambda: clatter.simulate(model="map", length_m=0.14, gyration_m=0.04, e=0.3, speed_m_s=4, tilt_deg=5),
    "spectra": lambda: clatter.spectra([WAVE, 2 * WAVE], sample_rate_hz=1e4, frequency_hz=[50, 100]),
    "spectrum": lambda: clatter.spectrum(record(), q_factor=[5, 10], frequency_hz=[50, 100]),
    "study": lambda: fixed("study"),
    "tradeoff": lambda: clatter.tradeoff(built()),
    "trains": lambda: clatter.trains(q=0.5, e=[0.3, 0.0], limit=6),
    "zone": lambda: clatter.zone(q=0.5, e=0.3, threshold=[0.5, 1]),
    "zones": lambda: clatter.zones(q=0.5, e=0.3, threshold=[0.1, 1]),
    "__version__": lambda: clatter.__version__,
}


def test_every_public_name_is_among_them():
    made = {name.partition(",")[0].partition(" of ")[0] for name in OBJECTS}
    assert set(clatter.__all__) - {"Answer"} <= made


def itself(thing):
    """What another process is sent, and sends back."""
    return thing


@pytest.fixture(scope="module")
def processes():
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        yield pool


WAYS = {
    "pickle": lambda thing, _: pickle.loads(pickle.dumps(thing)),
    "pickle, oldest": lambda thing, _: pickle.loads(pickle.dumps(thing, protocol=2)),
    "twice": lambda thing, _: pickle.loads(pickle.dumps(pickle.loads(pickle.dumps(thing)))),
    "copy": lambda thing, _: copy.copy(thing),
    "deepcopy": lambda thing, _: copy.deepcopy(thing),
    "multiprocessing": lambda thing, pool: pool.apply(itself, (thing,)),
    "joblib": lambda thing, _: joblib.Parallel(n_jobs=2)(joblib.delayed(itself)(one) for one in (thing, thing))[1],
}


def told(thing):
    """All that an object tells by itself."""
    asked = {"repr": repr(thing), "text": str(thing)}
    if isinstance(thing, clatter.Record):
        values = [(name, thing.times_s(name).tolist(), thing.values_m_s2(name).tolist()) for name in thing.channels]
        asked |= {"values": values, "findings": thing.findings, "described": thing.describe().to_json()}
    if isinstance(thing, clatter.Pulse):
        asked |= {"response": clatter.respond(pulses=thing, frequency_hz=100).to_json(), "hash": hash(thing)}
    if isinstance(thing, clatter.Product):
        asked |= {
            "file": thing.text,
            "drawn": clatter.scatter(thing, samples=20).to_json() if "component" in thing.text else None,
        }
    if isinstance(thing, clatter.Answer):
        asked |= {"html": thing._repr_html_(), "json": thing.to_json() if thing._text else None, "names": list(thing)}
        asked |= {"rows": thing.to_arrow().to_pylist() and str(thing.to_arrow())}
    return asked


@pytest.mark.parametrize("name", OBJECTS)
def test_objects_come_back(name, processes, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    thing = OBJECTS[name]()
    before = told(thing)
    for way, go in WAYS.items():
        other = go(thing, processes)
        assert type(other) is type(thing), way
        assert other == thing and not other != thing, way
        assert told(other) == before, way
    assert told(thing) == before
    if isinstance(thing, clatter.Answer) and thing._drawing:
        assert copy.copy(thing).plot() == copy.deepcopy(thing).plot() == thing.plot()
        with pytest.raises(ValueError, match="in the process that was asked"):
            pickle.loads(pickle.dumps(thing)).plot()


def test_what_differs_is_not_equal():
    kinds = [OBJECTS[name]() for name in ("Pulse", "Pulse of a standard", "Record of an array", "Record, conditioned")]
    kinds += [OBJECTS[name]() for name in ("Product", "Product of a text", "Figure", "bars", "bars, one", "impacts", "zones")]
    kinds += [clatter.bars(q=[0.5, 1], e=[[0.3], [0.9]]), record(name="other"), clatter.impacts(q=1, e=1, limit=2), 1, None]
    for i, one in enumerate(kinds):
        assert [one == other for other in kinds] == [i == j for j in range(len(kinds))]


def test_a_copy_of_a_product_is_extended_alone():
    for way in (copy.copy, copy.deepcopy, lambda product: pickle.loads(pickle.dumps(product))):
        first = built()
        other = way(first)
        other.add("second", position="10 mm", mount="hard", acceleration_limit="10 gn").falls(height="2 m")
        assert first.text == built().text and "second" in other.text
        first.add("third", position="10 mm")
        assert "third" not in other.text


def test_a_product_keeps_what_it_was_given():
    masses, tilt = [{"mass": "1 kg", "position": "0 mm"}], np.array([0.1, 0.2])
    product = clatter.Product("p", length="1 m", restitution=tilt, masses=masses)
    text = product.text
    masses[0]["mass"], tilt[0] = "2 kg", 0.9
    masses.append(masses[0])
    assert product.text == text


def test_an_answer_that_is_changed_changes_no_other():
    first = clatter.bars(q=[0.5, 0.6], e=0.3)
    other, deep = copy.copy(first), copy.deepcopy(first)
    deep.count[0] = 7
    other.more = 1
    assert first == clatter.bars(q=[0.5, 0.6], e=0.3) and "more" not in first and deep != first


def test_a_file_that_has_changed_is_not_sent_as_it_was(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    read = OBJECTS["Record of a file"]()
    path = tmp_path / "drop.csv"
    path.write_text(path.read_text().replace("time", "t", 1) + "0.02,1\n")
    with pytest.raises(ValueError, match=r"drop\.csv has changed since it was read"):
        pickle.dumps(read)
    path.unlink()
    with pytest.raises(ValueError, match=r"drop\.csv is no file any more"):
        pickle.dumps(read)
    assert copy.deepcopy(read) == read
