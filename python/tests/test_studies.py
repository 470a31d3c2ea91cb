"""Shards of studies are files of the command, and merge to its answer."""

from pathlib import Path

import clatter
import pytest

BAR = (Path(__file__).resolve().parents[2] / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")

PLAN = "product = 'handheld.toml'\nsamples = 500\nseed = 7\n"
PLANS = {
    "drawn": PLAN,
    "of a grid": PLAN + "[grid]\nproduct.restitution = [0.2, [0.3, 0.4]]\n",
    "of a search": "product = 'handheld.toml'\nsearch = true\n[grid]\nproduct.restitution = [0.2, 0.3]\n",
}


@pytest.fixture
def plan(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tmp_path.joinpath("handheld.toml").write_text(BAR)
    tmp_path.joinpath("plan.toml").write_text(PLAN)
    return tmp_path


@pytest.mark.parametrize("name", PLANS)
def test_shards_are_those_of_the_command(name, plan, command):
    plan.joinpath("plan.toml").write_text(PLANS[name])
    for i in (1, 2):
        told = command("study", "plan.toml", f"--shard={i}/2", "-o", f"of-command{i}.parquet", "--format=json").stdout
        answer = clatter.study("plan.toml", f"of-wheel{i}.parquet", shard=(i, 2))
        assert answer.to_json() == told.rstrip("\n").replace("of-command", "of-wheel")
        files = [plan.joinpath(f"{of}{i}.parquet").read_bytes() for of in ("of-command", "of-wheel")]
        assert files[0] == files[1]
    parts = ["of-wheel2.parquet", plan / "of-wheel1.parquet"]
    target = () if "search" in name else ("--target=99%",)
    told = command("study", "merge", *parts, "--confidence=0.9", *target, "--format=json").stdout
    answer = clatter.merge(parts, confidence=0.9, target=0.99 if target else None)
    assert answer.to_json() == told.rstrip("\n")
    rows = answer.to_arrow()
    several = 1 if name == "drawn" else 2
    assert (rows.num_rows, rows["member"].to_pylist()[-1]) == ((5 if "search" in name else 3) * several, several - 1)
    if several == 2:
        assert rows["product.restitution"].to_pylist()[0] == "0.2"


def test_a_shard_that_is_there_is_left_as_it_is(plan):
    first = clatter.study("plan.toml", "part.parquet")
    assert (first.rows, first.of, first.skipped) == ([0, 500], 500, False)
    again = clatter.study("plan.toml", "part.parquet")
    assert again.skipped
    with pytest.raises(ValueError, match="is there already, and is not this shard"):
        clatter.study("plan.toml", "part.parquet", shard=(1, 2))
    assert not clatter.study("plan.toml", "part.parquet", shard=(1, 2), force=True).skipped
    with pytest.raises(ValueError, match="no part has rows 250 to 499 of 500: make shard 2/2"):
        clatter.merge(["part.parquet"])


REFUSED = {
    "must end in .parquet": lambda: clatter.study("plan.toml", "part.csv"),
    r"shard 3/2 is none": lambda: clatter.study("plan.toml", "part.parquet", shard=(3, 2)),
    r"shard = 1 is not": lambda: clatter.study("plan.toml", "part.parquet", shard=1),
    "target 2.0 is not between 0 and 1": lambda: clatter.merge(["part.parquet"], target=2),
    "handheld.toml: ": lambda: clatter.merge(["handheld.toml"]),
}


@pytest.mark.parametrize("message", REFUSED)
def test_refused(message, plan):
    with pytest.raises(ValueError, match=message):
        REFUSED[message]()
    assert not plan.joinpath("part.parquet").exists()


def test_a_plan_that_is_none_is_an_error_of_the_system(plan):
    with pytest.raises(FileNotFoundError):
        clatter.study("nowhere.toml", "part.parquet")
