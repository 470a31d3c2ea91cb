"""Each engine gives the answer of one process to the last byte; of Dask and Ray a worker is killed on the way."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import duckdb
import psutil
import pytest

HERE = Path(__file__).parent
CLATTER = os.environ.get("CLATTER_COMMAND") or shutil.which("clatter")
# A shard takes about half a second, which is long enough to find its worker.
SAMPLES, SHARDS = 40_000, 8
# Several times the duration of a study on these machines.
PATIENCE_S = 100


def clatter(*arguments):
    return subprocess.run([CLATTER, "study", *map(str, arguments)], check=True, capture_output=True).stdout


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    """Returns the plan of this folder with fewer drops."""
    folder = tmp_path_factory.mktemp("study")
    shutil.copy(HERE / "../../tests/cases/bar-terminal.toml", folder)
    text = (HERE / "plan.toml").read_text()
    text, changes = re.subn("samples = .*", f"samples = {SAMPLES}", text.replace("../../tests/cases/", ""))
    assert changes == 1
    (folder / "plan.toml").write_text(text)
    return folder / "plan.toml"


@pytest.fixture(scope="module")
def whole(plan):
    """Returns the answer without shards."""
    part = plan.parent / "whole.parquet"
    clatter(plan, "-o", part)
    return clatter("merge", part, "--format=json")


def killed_worker(script):
    """Kills the worker of the first process found to run a shard, and returns its number."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end and script.poll() is None:
        for process in psutil.Process(script.pid).children(recursive=True):
            try:
                worker = process.parent()
                if process.cmdline()[:2] == [CLATTER, "study"] and worker.pid != script.pid:
                    os.kill(worker.pid, signal.SIGKILL)
                    return worker.pid
            except (psutil.NoSuchProcess, AttributeError):
                pass  # it ended as it was looked at
        time.sleep(0.01)
    raise AssertionError(f"no worker was found at work: {script.communicate()}")


@pytest.mark.parametrize("script", ["with_dask.py", "with_ray.py"])
def test_a_killed_worker_changes_nothing(script, plan, whole, tmp_path):
    command = [sys.executable, HERE / script, plan, str(SHARDS), tmp_path / "parts"]
    # Ray reports its usage to its makers unless this is set.
    env = {**os.environ, "CLATTER_COMMAND": CLATTER, "RAY_USAGE_STATS_ENABLED": "0"}
    run = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=env)
    try:
        worker = killed_worker(run)
        done = len(list((tmp_path / "parts").glob("*.parquet")))
        stdout, stderr = run.communicate(timeout=PATIENCE_S)
    finally:
        run.kill()
    assert run.returncode == 0, stderr.decode()
    assert done < SHARDS, "it was killed on the way"
    assert not psutil.pid_exists(worker)
    assert stdout == whole


def test_gnu_parallel_or_xargs(plan, whole, tmp_path):
    command = [HERE / "parallel.sh", plan, str(SHARDS), tmp_path / "parts"]
    env = {**os.environ, "CLATTER_COMMAND": CLATTER}
    assert subprocess.run(command, check=True, stdout=subprocess.PIPE, env=env).stdout == whole


def test_the_tasks_of_slurm(plan, whole, tmp_path):
    """Runs the script as Slurm calls it, in another order."""
    for task in reversed(range(1, 4)):
        env = {**os.environ, "CLATTER_COMMAND": CLATTER, "SLURM_ARRAY_TASK_ID": str(task)}
        subprocess.run([HERE / "slurm.sh", plan, "3", tmp_path / "parts"], check=True, env=env)
    assert clatter("merge", *(tmp_path / "parts").iterdir(), "--format=json") == whole


def test_the_query_of_the_readme(plan, whole, tmp_path, monkeypatch):
    (tmp_path / "parts").mkdir()
    for i in (1, 2):
        clatter(plan, f"--shard={i}/2", "-o", tmp_path / "parts" / f"{i}.parquet")
    (query,) = re.findall("```sql\n(.*?)```", (HERE / "README.md").read_text(), re.S)
    monkeypatch.chdir(tmp_path)
    rows = duckdb.sql(query).fetchall()
    engine = json.loads(whole)["members"][0]["components"][0]
    assert engine["name"] == "scan engine" and engine["unanswered"] == 0
    assert sum(drops for _, drops, _ in rows) == SAMPLES
    assert round(sum(drops * fails for _, drops, fails in rows)) == engine["failed"] > 0
    assert [tilt for tilt, *_ in rows] == list(range(1, 13)), "the tilts of the product, in whole degrees"
