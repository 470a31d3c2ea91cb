"""What is asked is bounded before memory is taken, and opening anything stops no other thread."""

import itertools
import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import clatter
import numpy as np
import polars  # noqa: F401: with it, calls of the system go on after Ctrl-C
import pytest

TEXT = (Path(__file__).resolve().parents[2] / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")
BAR = {"q": 0.5, "e": 0.3}
PULSE = clatter.Pulse("half-sine", amplitude_m_s2=1, duration_s=1e-3)
DROP = {"model": "map", "length_m": 0.14, "gyration_m": 0.0404, "e": 0.3, "speed_m_s": 4.43, "tilt_deg": 5}


def many(count):
    """So many numbers that take no memory."""
    return np.broadcast_to(0.5, count)


LARGE = {
    "120000000 frequencies of all histories in one call; it takes 10000000: ask in pieces": lambda: clatter.spectra(
        np.broadcast_to(0.0, (40_000, 100)), sample_rate_hz=1e3, frequency_hz=np.arange(1, 3001)
    ),
    "200000000 elements of q in one call; it takes 100000000": lambda: clatter.bars(q=many(200_000_000), e=0.3),
    "90000000 elements in one call; it takes 10000000": lambda: clatter.bars(q=many(90_000_000), e=0.3),
    "1000000000000 elements of at in one call": lambda: clatter.shocks(**BAR, at=np.broadcast_to(0.5, (10**6, 10**6))),
    "40000000000 elements in one call": lambda: clatter.trains(q=many(10**7), e=0.3, limit=1000),
    "100000001 points are too many: a map has 67108864 at most": lambda: clatter.map(
        "impacts", q=(0, 1, 100_000_001), e=(0.3, 0.3, 1)
    ),
    "10000000 frequencies of all spectra in one call; it takes 1000000": lambda: clatter.spectrum(
        PULSE, per_octave_hz=(1, 1024, 1e6 - 0.1)
    ),
    "2000000 shocks at positions in one call; it takes 1000000": lambda: clatter.impacts(**BAR, at=[0.5] * 2, limit=10**6),
    "at has more than 1000000 elements: ask in pieces": lambda: clatter.impacts(**BAR, at=itertools.repeat(0.5)),
    "1000000000 elements of threshold in one call; it takes 100000000": lambda: clatter.zone(**BAR, threshold=many(10**9)),
    "the motion has more than a million rows": lambda: clatter.simulate(
        **{**DROP, "model": "finite-tilt", "e": 0.9999}, history=True, impact_limit=100_000
    ),
    "impact_limit = 100000000 is not in 1 ..= 1000000": lambda: clatter.simulate(**DROP, impact_limit=10**8),
    "16777216 elements of e in one call; it takes 10000000": lambda: clatter.bars(q=0.5, e=doubled(40)),
}


def doubled(deep):
    """A list that has itself twice as often at each depth."""
    one = [0.5]
    for _ in range(deep):
        one = [one, one]
    return one


@pytest.mark.parametrize("message", LARGE)
def test_what_takes_too_much_memory_is_refused_before_it_is_taken(message):
    with pytest.raises(ValueError) as refusal:
        LARGE[message]()
    assert message in str(refusal.value)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    if hasattr(os, "mkfifo"):
        os.mkfifo("pipe")
    tmp_path.joinpath("product.toml").write_text(TEXT)
    tmp_path.joinpath("measured.toml").write_text(TEXT + '[[record]]\nfile = "pipe"\ntiming = "1 us"\n')
    tmp_path.joinpath("plan.toml").write_text("product = 'product.toml'\nsamples = 10\n")
    tmp_path.joinpath("of-pipe.toml").write_text("product = 'pipe'\nsamples = 10\n")
    return tmp_path


#: What opens a file; of a pipe to which nobody writes it waits.
OPENS = {
    "record": lambda path: clatter.Record.open(path),
    "spectrum": lambda path: clatter.spectrum(path, frequency_hz=[10]),
    "product": lambda path: clatter.Product.open(path),
    "assess": lambda path: clatter.assess(path),
    "named record": lambda _: clatter.assess("measured.toml"),
    "plan": lambda path: clatter.study(path, "part.parquet"),
    "product of a plan": lambda _: clatter.study("of-pipe.toml", "part.parquet"),
}
UNIX = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names")


@UNIX
@pytest.mark.parametrize("name", OPENS)
def test_a_pipe_keeps_no_other_waiting(name, folder):
    """Twice as many wait as there are processors; the next question is answered all the same, and in the end they are as well."""
    told = []

    def wait():
        try:
            told.append(OPENS[name]("pipe"))
        except (ValueError, OSError) as refusal:
            told.append(refusal)

    waiting = [threading.Thread(target=wait) for _ in range(2 * (os.cpu_count() or 1))]
    for thread in waiting:
        thread.start()
    assert clatter.bars(q=[0.5] * 1000, e=0.3).count[0] == 4
    assert not told
    while any(thread.is_alive() for thread in waiting):
        try:
            os.close(os.open("pipe", os.O_WRONLY | os.O_NONBLOCK))  # someone writes, and that is nothing
        except OSError:
            pass  # nobody waits at this moment
        waiting[0].join(0.01)
    assert len(told) == len(waiting)


@UNIX
@pytest.mark.parametrize("name", OPENS)
def test_ctrl_c_is_heard_at_a_pipe(name, folder):
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a process in the background may have been started deaf
    timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        OPENS[name]("pipe")
    assert clatter.bars(q=[0.5] * 1000, e=0.3).count[0] == 4


@UNIX
def test_a_pipe_is_no_part_of_a_study(folder):
    with pytest.raises(OSError, match="it is no file on a disk"):
        clatter.merge(["pipe"])
    with pytest.raises(ValueError, match="pipe.parquet is there already"):
        os.rename("pipe", "pipe.parquet")
        clatter.study("plan.toml", "pipe.parquet")


@UNIX
def test_a_pipe_is_read_as_a_file(folder):
    def write():
        with open("pipe", "w") as pipe:
            pipe.write("time [s],a [m/s2]\n0,0\n1,5\n2,0\n")

    writing = threading.Thread(target=write)
    writing.start()
    record = clatter.Record.open("pipe")
    writing.join()
    assert record.values_m_s2().tolist() == [0, 5, 0]


ENDLESS = {
    "record": ("/dev/zero: the first line is longer than", lambda: clatter.Record.open("/dev/zero")),
    "product": ("/dev/zero: it is larger than a product file", lambda: clatter.Product.open("/dev/zero")),
    "plan": ("/dev/zero", lambda: clatter.study("/dev/zero", "part.parquet")),
    "part": ("it is no file on a disk", lambda: clatter.merge(["/dev/zero"])),
}


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="no such device")
@pytest.mark.parametrize("name", ENDLESS)
def test_what_has_no_end_is_refused(name, folder):
    message, ask = ENDLESS[name]
    with pytest.raises((ValueError, OSError)) as refusal:
        ask()
    assert message in str(refusal.value) and len(str(refusal.value)) < 2000


def test_a_large_file_that_is_no_text_is_refused_before_it_is_read(folder):
    with open("large.npy", "wb") as file:
        np.lib.format.write_array_header_1_0(file, {"descr": "<f8", "fortran_order": False, "shape": (3 * 2**27,)})
        file.truncate(3 << 30)  # holes, which take no room
    with pytest.raises(ValueError, match=r"large\.npy: it is larger than 1 GiB"):
        clatter.Record.open("large.npy")
    with open("large.toml", "wb") as file:
        file.truncate(3 << 30)
    with pytest.raises(ValueError, match=r"large\.toml: it is larger than a product file, of 1048576 bytes at most"):
        clatter.Product.open("large.toml")


@pytest.mark.skipif(sys.platform != "linux", reason="the memory of a process is bounded otherwise")
def test_refusals_take_no_memory():
    """Within a gigabyte of addresses, most of which numpy and the threads have."""
    code = (
        "import resource, clatter, numpy as np\n"
        "clatter.bars(q=[0.5] * 1000, e=0.3)\n"
        "size = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (size + (64 << 20),) * 2)\n"
        "for ask in (lambda: clatter.spectra(np.broadcast_to(0.0, (40_000, 100)), sample_rate_hz=1e3, frequency_hz=np.arange(1, 3001)),\n"
        "            lambda: clatter.bars(q=np.broadcast_to(0.5, 200_000_000), e=0.3),\n"
        "            lambda: clatter.map('impacts', q=(0, 1, 100_000_000), e=(0, 1, 2))):\n"
        "    try:\n"
        "        ask()\n"
        "    except ValueError as refusal:\n"
        "        print(refusal)\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0 and len(done.stdout.splitlines()) == 3, done.stderr
