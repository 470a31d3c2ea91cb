"""Shock spectra and a map by the wheel beside pyyeti, endaq and numpy, in one process of Python: times in ms.

    RAYON_NUM_THREADS=1 python peers/wheel.py      with the wheel, numpy, pyyeti and endaq installed

The record and the frequencies of `spectra.py`, the map of `maps.py`; one thread each, the best of nine rounds in which all take
turns. The wheel copies what it is given and hands arrays back.
"""
import time, warnings

import clatter
import numpy as np

import spectra
from spectra import FREQUENCIES_HZ, RATES_HZ, history

ROUNDS = 9


def peak():
    """Returns the map of a million bars, as in maps.py."""
    q, e = np.meshgrid(np.linspace(0, 1, 1000), np.linspace(0, 1, 1000), indexing="ij")
    d = q * (1 + e)
    a, w = 1 + d, (1 - q) * (1 + e)
    for _ in range(64):
        np.maximum(e * d - w * a, 0, out=d)
        if not d.any():
            break
        a += d
    return (1 + e) * a


def tasks():
    """Returns the timed tasks: the name of each, then its tools."""
    for rate in RATES_HZ:
        t, a = history(rate)
        frequencies = list(FREQUENCIES_HZ)
        settings = {"frequency_hz": list(FREQUENCIES_HZ), "q_factor": 10.0}
        ours = {
            "clatter": lambda a=a, s=settings, rate=rate: clatter.spectra(a, sample_rate_hz=rate, **s, interpolation="linear"),
            "clatter, band-limited": lambda a=a, s=settings, rate=rate: clatter.spectra(a, sample_rate_hz=rate, **s),
            "clatter, as an answer": lambda a=a, s=settings, rate=rate: clatter.spectrum(
                clatter.Record(a, sample_rate_hz=rate), **s, interpolation="linear"
            ),
        }
        others = {**spectra.pyyeti(t, a, rate), **spectra.endaq(t, a, rate)}
        yield f"200 spectra of {len(a)} samples", {**ours, **{name: lambda run=run: np.ravel(run()) for name, run in others.items()}}
    yield "map of 10⁶ bars", {"clatter": lambda: clatter.map("peak-end", q=(0, 1, 1000), e=(0, 1, 1000)).values, "numpy": peak}
    q, e = np.meshgrid(np.linspace(0, 1, 1000), np.linspace(0, 1, 1000), indexing="ij")
    yield "the same bars as arrays, all of each", {"clatter": lambda: clatter.bars(q=q, e=e).peak_end, "numpy, peaks alone": peak}


def main():
    warnings.filterwarnings("ignore")
    for name, tools in tasks():
        times = {tool: [] for tool in tools}
        for tool, run in tools.items():
            run()
        for _ in range(ROUNDS):
            for tool, run in tools.items():
                begin = time.perf_counter()
                run()
                times[tool].append(1e3 * (time.perf_counter() - begin))
        ours = min(times["clatter"])
        for tool, all_of in times.items():
            print(f"{name:40} {tool:36} {min(all_of):10.2f} ms {min(all_of) / ours:8.1f}")


if __name__ == "__main__":
    main()
