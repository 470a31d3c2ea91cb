"""The command that the wheel is held against."""

import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def command(pytestconfig):
    """Runs the command of this source: that of CLATTER_COMMAND, else it is built."""
    path = os.environ.get("CLATTER_COMMAND")
    if path is None:
        build = ["cargo", "build", "--release", "--locked", "--package=clatter-cli", "--message-format=json"]
        manager = pytestconfig.pluginmanager
        with manager.getplugin("capturemanager").global_and_fixture_disabled():
            said = "builds the command clatter to hold the wheel against it, some minutes the first time; CLATTER_COMMAND names one"
            manager.getplugin("terminalreporter").write_line(f"\n{said}\n{' '.join(build)}")
            lines = subprocess.run(build, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
        path = next(made for line in lines if (made := json.loads(line).get("executable")))

    def run(*args, code=(0, 1)):
        done = subprocess.run([path, *map(str, args)], capture_output=True, text=True)
        assert done.returncode in code, done.stderr
        return done

    return run
