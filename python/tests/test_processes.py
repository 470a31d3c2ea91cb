"""Ctrl-C ends long work, forked processes have their own threads, importing takes no time."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import clatter
import numpy as np
import pytest

BAR = (Path(__file__).resolve().parents[2] / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")


def crowded():
    """A product of so many parts that to search it takes some ten seconds."""
    head, display, camera, *_ = BAR.split("[[component]]\n")
    parts = [
        camera.replace('"camera"', f'"camera {i}"').replace('"90 Hz", "110 Hz"', f'"{90 + i} Hz", "2 kHz"') for i in range(300)
    ]
    return clatter.Product.from_text("[[component]]\n".join([head, display, *parts]))


def bars():
    wave = {"gyration_ratio": np.full(10**7, 1e-8), "e": np.ones(10**7)}
    return lambda: [clatter.bars(**wave) for _ in range(20)]


def boxes():
    body = {"length_m": 0.15, "width_m": 0.07, "thickness_m": 0.015, "gyration_m": (0.0207, 0.0435, 0.0478)}
    turn, speeds = [0.9238795325112867, 0.3826834323650898, 0, 0], np.linspace(1, 5, 10**6)
    return lambda: clatter.boxes(**body, orientation=turn, e=0.3, speed_m_s=speeds, contact_time_s=5e-4)


def spectra():
    histories, hz = np.ones((10, 10**6)), np.linspace(10, 1e4, 2000)
    return lambda: clatter.spectra(histories, sample_rate_hz=1e5, frequency_hz=hz)


LONG = {
    "scatter": lambda: lambda: clatter.scatter(clatter.Product.from_text(BAR), samples=10**12),
    "assess": lambda: lambda: clatter.assess(crowded(), tolerance=1e-4),
    "design": lambda: lambda: clatter.design(crowded(), margin=50),
    "bars": bars,
    "boxes": boxes,
    "spectra": spectra,
}


@pytest.mark.parametrize("work", LONG)
def test_ctrl_c_ends_long_work(work):
    ask, sent = LONG[work](), []

    def interrupt():
        sent.append(time.monotonic())
        os.kill(os.getpid(), signal.SIGINT)

    timer = threading.Timer(0.3, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        ask()
        timer.cancel()
    assert time.monotonic() - sent[0] < 5  # a twentieth of a second, on a machine with nothing else to do
    assert clatter.bars(q=0.5, e=0.3).count == 4  # and the next question is answered


def counts(q):
    return clatter.bars(q=[q] * 1000, e=0.3).count.tolist()


def test_forked_processes_answer():
    assert counts(0.5)[0] == 4  # the threads of this process are there
    with multiprocessing.get_context("fork").Pool(2) as pool:
        assert pool.map_async(counts, [0.5, 0.6]).get(timeout=20) == [counts(0.5), counts(0.6)]


def test_importing_loads_no_numpy_and_takes_no_time():
    code = (
        "import sys, time; t = time.process_time(); import clatter; t = time.process_time() - t; "
        "clatter.impacts(q=1, e=0.3, at=[0, 0.5]); print(t, 'numpy' in sys.modules)"
    )
    runs = [subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True) for _ in range(3)]
    seconds, numpy = zip(*(run.stdout.split() for run in runs))
    assert set(numpy) == {"False"}
    assert min(map(float, seconds)) < 0.1  # of a processor; 0.02 to 0.03 where nothing else is done


@pytest.mark.skipif(os.name != "posix", reason="a program of a shell")
def test_pytest_says_what_it_builds(tmp_path):
    cargo = tmp_path / "cargo"
    cargo.write_text('#!/bin/sh\necho compiles >&2\necho \'{"executable": "/bin/false"}\'\n')
    cargo.chmod(0o755)
    environment = {name: value for name, value in os.environ.items() if name != "CLATTER_COMMAND"}
    environment["PATH"] = f"{tmp_path}{os.pathsep}{environment['PATH']}"
    test = f"{Path(__file__).parent / 'test_records.py'}::test_words_of_the_command"
    run = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", test]
    done = subprocess.run(run, env=environment, capture_output=True, text=True)
    assert "builds the command clatter to hold the wheel against it" in done.stdout
    assert "cargo build --release --locked --package=clatter-cli" in done.stdout
    assert "compiles" in done.stderr  # and what cargo says itself
