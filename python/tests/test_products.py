"""Products of files, texts, dicts and builders are one product; what is wrong with them is told in the words of the command."""

import copy
import pickle

import clatter
import numpy as np
import pytest
import tomllib

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
    text = clatter.Product.example().text
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
        clatter.Product.falls: known["drop"]["properties"],
        clatter.Product.add: known["component"]["items"]["properties"],
    }
    for builder, keys in tables.items():
        own = set(builder.__annotations__) - {"return", "more"}
        assert own <= set(keys), builder
        assert len(own) >= 5


def test_further_keys_go_by_their_names():
    with pytest.raises(ValueError, match="unknown key|thicknes"):
        built().add("chip", position="0 mm", thicknes="1 mm").check()


def test_all_that_is_wrong_is_told_in_the_words_of_the_command(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = clatter.Product.example().text.replace('"140 mm"', '"140 kg"').replace('"1.2 m"', '"-1 m"')
    tmp_path.joinpath("wrong.toml").write_text(text)
    told = command("assess", "wrong.toml", code=[2]).stderr
    for ask in (clatter.assess, clatter.scatter, clatter.design, clatter.explain):
        with pytest.raises(ValueError) as refusal:
            ask("wrong.toml")
        assert f"{refusal.value}\n" == told
    assert "140 kg" in told and "-1 m" in told


def test_slips_are_warned_of(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = clatter.Product.example().text.replace('"1.2 m"', '"120 m"')
    tmp_path.joinpath("odd.toml").write_text(text)
    told = command("assess", "odd.toml", "--format=json").stderr
    with pytest.warns(UserWarning) as warned:
        clatter.assess("odd.toml")
    assert f"{warned[0].message}\n" == told


def test_records_of_a_product_are_not_read_in_silence():
    text = clatter.Product.example().text + '[[record]]\nfile = "strikes.csv"\n'
    with pytest.warns(UserWarning, match="the records that the product file names are not read"):
        answer = clatter.assess(clatter.Product.from_text(text))
    assert answer == clatter.assess(clatter.Product.example())


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
