"""Products of files, texts, dicts and builders are one product; what is wrong with them is told in the words of the command."""

import copy
import json
import pickle
from pathlib import Path

import clatter
import numpy as np
import pytest
import tomllib

EXAMPLES = Path(__file__).resolve().parents[2] / "reports/examples"
BAR = (Path(__file__).resolve().parents[2] / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")
TABLES = {
    "product": {"name": "handheld", "length": "150 mm", "restitution": [0.25, 0.4], "radius_of_gyration": "45 mm"},
    "drop": {"height": "1 m", "tilt": ["1 deg", "6 deg"], "first": "either"},
    "component": [
        {
            "name": 'board "α"\n',
            "position": "50 mm",
            "natural_frequency": {"normal": ["40 Hz", "2 Hz"], "range": ["35 Hz", "45 Hz"]},
            "damping_ratio": 0.05,
            "acceleration_limit": "30 gn",
        },
        {
            "name": "crystal",
            "position": "-20 mm",
            "mount": "hard",
            "damage_boundary": {"velocity_change": "3 m/s", "acceleration": "5000 gn"},
        },
    ],
}


def built():
    product, drop, (board, crystal) = TABLES["product"], TABLES["drop"], TABLES["component"]
    return clatter.Product(**product).falls(**drop).add(**board).add(**crystal)


def test_builders_and_dicts_are_the_same_product():
    assert tomllib.loads(built().text) == TABLES
    assert clatter.Product.from_dict(TABLES).text == built().text
    answer = clatter.scatter(TABLES, samples=300)
    assert answer == clatter.scatter(built(), samples=300)
    assert [part.name for part in answer.components] == ['board "α"\n', "crystal"]


def test_files_texts_and_dicts_have_the_same_answer(tmp_path):
    text = BAR
    path = tmp_path / "handheld.toml"
    path.write_text(text)
    answers = [
        clatter.assess(given)
        for given in (path, str(path), clatter.Product.from_text(text), tomllib.loads(text), clatter.Product.open(path))
    ]
    assert len({answer.to_json() for answer in answers}) == 1


def test_numbers_of_numpy_are_numbers():
    tables = copy.deepcopy(TABLES)
    tables["product"]["restitution"] = np.array([0.25, 0.4])
    tables["component"][0]["damping_ratio"] = np.float64(0.05)
    assert tomllib.loads(clatter.Product.from_dict(tables).text) == TABLES


def test_builders_know_the_keys_of_files():
    """Keys that the schema has and a builder lacks go by their names all the same; a key that it lacks is a slip of ours."""
    known = clatter.schema()["properties"]
    tables = {
        clatter.Product.__init__: known["product"]["properties"],
        clatter.Product.falls: known["drop"]["anyOf"][0]["properties"],
        clatter.Product.add: known["component"]["items"]["properties"],
    }
    for builder, keys in tables.items():
        own = set(builder.__annotations__) - {"return", "more"}
        assert own <= set(keys), builder
        assert len(own) >= 5


def test_a_box_falls_in_one_drop_after_the_other(command, tmp_path):
    box = clatter.Product(
        name="box", length="150 mm", width="70 mm", thickness="14 mm", radius_of_gyration=["43 mm", "20 mm"],
        restitution=0.3, contact_time="0.4 ms",
    )
    box.falls(height="1 m", face="bottom").falls(height="2 m", corner="top back end-a")
    box.falls(speed="2 m/s", tilt="60 deg", direction="30 deg", attitude_tolerance="1 deg")
    box.add("chip", position=["10 mm", "5 mm"], mount="hard", acceleration_limit="9000 gn")
    answer = clatter.assess(box)
    assert [landing.landing for landing in answer.landings] == [
        "face bottom", "corner top back end-a", "tilt 60 deg towards 30 deg",
    ]
    file = tmp_path / "box.toml"
    file.write_text(box.text)
    assert command("assess", file, "--format=json", code=[0, 1]).stdout.count('"landing":"tilt 60 deg towards 30 deg"') >= 1


def test_further_keys_go_by_their_names():
    with pytest.raises(ValueError, match="unknown key|thicknes"):
        built().add("chip", position="0 mm", thicknes="1 mm").check()


def test_all_that_is_wrong_is_told_in_the_words_of_the_command(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = BAR.replace('"140 mm"', '"140 kg"').replace('"1.2 m"', '"-1 m"')
    tmp_path.joinpath("wrong.toml").write_text(text)
    told = command("assess", "wrong.toml", code=[2]).stderr
    for ask in (clatter.assess, clatter.scatter, clatter.design, clatter.explain):
        with pytest.raises(ValueError) as refusal:
            ask("wrong.toml")
        assert f"{refusal.value}\n" == told
    assert "140 kg" in told and "-1 m" in told


def test_slips_are_warned_of(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = BAR.replace('"1.2 m"', '"120 m"')
    tmp_path.joinpath("odd.toml").write_text(text)
    told = command("assess", "odd.toml", "--format=json").stderr
    with pytest.warns(UserWarning) as warned:
        clatter.assess("odd.toml")
    assert f"{warned[0].message}\n" == told


STRIKES = "time_s,end\n0,a\n1.2121e-3,b\n1.68285e-3,a\n34.386e-3,b\n"
NAMED = BAR.replace("contact_time =", "# contact_time =") + """
[[record]]
file = "strikes.csv"
timing = "1 us"
[[record]]
file = "sub/bounces.csv"
drop = "flat"
"""


@pytest.fixture
def measured(tmp_path, monkeypatch):
    """A product in a folder of its own that names two records."""
    folder = tmp_path / "product"
    folder.joinpath("sub").mkdir(parents=True)
    folder.joinpath("measured.toml").write_text(NAMED)
    folder.joinpath("strikes.csv").write_text(STRIKES)
    folder.joinpath("sub/bounces.csv").write_text("bounce_s\n0\n0.5\n0.75\n0.875\n0.9375\n")
    monkeypatch.chdir(tmp_path)
    return folder


def test_measured_drops_that_a_product_names_stand_beside_the_verdicts(measured, command):
    told = command("assess", "product/measured.toml", "--format=json")
    with pytest.warns(UserWarning) as warned:
        answer = clatter.assess("product/measured.toml")
    assert answer.to_json() == told.stdout.rstrip("\n")
    assert [drop.drop for drop in answer.measured] == ["strikes.csv", "flat"]
    assert [f"warning: {one.message}" for one in warned] == told.stderr.splitlines()
    assert "restitution was measured as 0.5" in told.stderr
    # A product that went to another process still knows its folder.
    product = pickle.loads(pickle.dumps(clatter.Product.open("product/measured.toml")))
    with pytest.warns(UserWarning):
        assert clatter.assess(product) == answer


@pytest.mark.filterwarnings("ignore")  # of other quantities than those that are looked for
def test_measured_drops_may_be_given(measured):
    product = clatter.Product.from_text(NAMED.split("[[record]]")[0], "measured.toml")
    strikes = [(0, "a"), (1.2121e-3, "b"), (1.68285e-3, "a"), (34.386e-3, "b")]
    with pytest.warns(UserWarning):
        named = clatter.assess("product/measured.toml").measured
    drops = {
        "strikes.csv": {"strikes": strikes, "timing_s": 1e-6},
        "flat": {"bounces": np.array([0, 0.5, 0.75, 0.875, 0.9375])},
    }
    with pytest.warns(UserWarning, match="restitution was measured"):
        given = clatter.assess(product, measured=drops).measured
    assert [drop.estimates for drop in given] == [drop.estimates for drop in named]
    values = np.zeros(400)
    values[50:100], values[200:250] = (size * np.sin(np.pi * np.arange(50) / 50) for size in (4000, -2000))
    places = [(clatter.Record(values, time_s=np.arange(400) * 2e-5, name="bench.csv"), 0.03)]
    with pytest.warns(UserWarning, match="bench: restitution was measured"):
        (bench,) = clatter.assess(product, measured={"bench": {"accelerations": places}}).measured
    fitted = clatter.fit(product, accelerations=places).estimates
    assert bench.files == ["bench.csv"]
    assert [(one.quantity, one.value) for one in bench.estimates] == [(one.quantity, one.value) for one in fitted]
    # What no fit takes is named.
    with pytest.raises(ValueError, match="strikes: 1 strikes; allowed: 2 to 4096"):
        clatter.assess(product, measured={"bench": {"strikes": strikes[:1]}})


def test_records_that_cannot_be_read_are_refused(measured, command):
    measured.joinpath("strikes.csv").write_text(STRIKES.replace("1.68285e-3", "x"))
    with pytest.raises(ValueError) as refusal:
        clatter.assess("product/measured.toml")
    assert command("assess", "product/measured.toml", code=[2]).stderr == f"error: {refusal.value}\n"
    measured.joinpath("strikes.csv").write_text("time [s],a [g]\n0,1\n1,2\n")
    with pytest.raises(ValueError, match="strikes.csv: .* needs its position"):
        clatter.assess("product/measured.toml")
    measured.joinpath("strikes.csv").unlink()
    with pytest.raises(FileNotFoundError, match=r"strikes\.csv"):
        clatter.assess("product/measured.toml")
    with pytest.raises(ValueError, match="measured 'a' has 'strike'"):
        clatter.assess(clatter.Product.from_text(BAR), measured={"a": {"strike": []}})


def test_the_printed_report_is_that_of_the_command(measured, command):
    measured.joinpath("plain.toml").write_text(BAR)
    command("assess", "product/plain.toml", "-o", "command.pdf", "--date=2026-03-31")
    clatter.assess("product/plain.toml", report="wheel.pdf", report_date="2026-03-31")
    wheel, printed = (measured.parent.joinpath(name).read_bytes() for name in ("wheel.pdf", "command.pdf"))
    assert wheel.startswith(b"%PDF") and wheel == printed
    for wrong in ({"report": "x.txt"}, {"report": "x.pdf", "report_date": "31.3.2026"}):
        with pytest.raises(ValueError):
            clatter.assess("product/plain.toml", **wrong)
    with pytest.raises(OSError):
        clatter.assess("product/plain.toml", report="nowhere/x.pdf")


def test_assessed_products_have_a_picture():
    bar = clatter.assess(clatter.Product.from_text(BAR))
    assert all(f">{part.name}<" in str(bar.plot()) for part in bar.components)
    plate = clatter.assess(EXAMPLES / "handheld-terminal.toml")
    drawn = str(plate.plot())
    assert "The plate from above" in drawn
    assert all(f">{part.name}<" in drawn for part in plate.components)


def test_tradeoff_is_that_of_the_command_but_for_its_times(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tmp_path.joinpath("handheld.toml").write_text(BAR)
    theirs = json.loads(command("tradeoff", "handheld.toml", "--tolerance=10%", "--format=json").stdout)
    ours = clatter.tradeoff("handheld.toml", tolerance=0.1)

    def timeless(limits):
        models = [[{k: v for k, v in model.items() if k != "seconds"} for model in limit["models"]] for limit in limits]
        return [limit["reference"] for limit in limits], models

    assert timeless(json.loads(ours.to_json())["limits"]) == timeless(theirs["limits"])
    assert (ours.product, ours.tolerance, ours.clatter) == (theirs["product"], 0.1, clatter.__version__)
    assert all(model.seconds > 0 for limit in ours.limits for model in limit.models)
    assert "<svg" in str(ours.plot()) and "finite tilt" in str(ours.plot())


REFUSED = {
    "tolerance": lambda: clatter.assess(built(), tolerance=0.9),
    "model = 'exact' is none: map, ballistic, finite-tilt, compliant": lambda: clatter.assess(built(), model="exact"),
    "samples = 0 is not in 1 ..= 1000000000000": lambda: clatter.scatter(built(), samples=0),
    "target 2.0 is not between 0 and 1": lambda: clatter.scatter(built(), target=2),
    "zones and turn are goals without a product": lambda: clatter.design(built(), turn=1),
    "component is a list of tables, not of str": lambda: clatter.Product.from_dict({"component": ["a"]}),
    "None is none of what a product file holds": lambda: clatter.Product.from_dict({"drop": {"tilt": None}}),
    "it is not text in UTF-8": lambda: clatter.Product.open("torn.toml"),
    "a product of a text is changed in the text": lambda: clatter.Product.example().falls(tilt="1 deg"),
    "first = 'c' is not an end, 'a' or 'b'": lambda: clatter.fit(built(), strikes=[(0, "c")]),
    "a record of bounces is of another drop: fit it alone": lambda: clatter.fit(
        built(), bounces=[0, 1, 1.5], strikes=[(0, "a"), (1e-3, "b"), (2e-3, "a")]
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_refused_with_one_message(message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tmp_path.joinpath("torn.toml").write_bytes(b"[product]\nname = '\xff'\n")
    with pytest.raises(ValueError) as refusal:
        REFUSED[message]()
    assert message in str(refusal.value)


def test_a_file_that_is_none_is_an_error_of_the_system():
    with pytest.raises(FileNotFoundError):
        clatter.assess("nowhere.toml")


def test_answers_and_products_go_to_other_processes():
    product = built()
    answer = clatter.scatter(product, samples=100)
    for thing in (answer, clatter.bars(q=[0.5, 0.6], e=0.3), clatter.Pulse("haversine", amplitude_m_s2=1, duration_s=2)):
        assert repr(pickle.loads(pickle.dumps(thing))) == repr(thing)
    assert pickle.loads(pickle.dumps(answer)).to_json() == answer.to_json()
    assert pickle.loads(pickle.dumps(product)).text == product.text
