"""Shock response spectra of one record by pyyeti and endaq beside clatter: errors and times in ms as JSON.

    spectra.py pyyeti|endaq|clatter CARGO-ARGUMENT...   the arguments start the example `peers` of clatter-shock

The record: eight half-sines of 0.3 ms in 100 ms, sampled at 20, 100 and 500 kHz; 200 frequencies from 10 Hz to 10 kHz,
Q = 10, maximax absolute acceleration, one thread. Errors are against the exact response to the pulses themselves.
"""
import json, subprocess, sys, warnings

import numpy as np

from bars import best

RATES_HZ = [20_000, 100_000, 500_000]
FREQUENCIES_HZ = np.geomspace(10.0, 10_000.0, 200)
PULSES = [(1000.0 if i % 2 == 0 else -700.0, 3e-4, 0.002 + 0.0113 * i) for i in range(8)]


def history(rate):
    t = np.arange(int(round(0.1 * rate))) / rate
    a = np.zeros_like(t)
    for amplitude, duration, start in PULSES:
        inside = (t >= start) & (t < start + duration)
        a[inside] += amplitude * np.sin(np.pi * (t[inside] - start) / duration)
    return t, a


def pyyeti(t, a, rate):
    from pyyeti import srs

    def spectrum(**setting):
        return lambda: srs.srs(a, rate, FREQUENCIES_HZ, 10.0, time="total", parallel="no", **setting)

    return {"pyyeti": spectrum(), "pyyeti, no roll-off correction": spectrum(rolloff="none")}


def endaq(t, a, rate):
    import endaq.calc.shock, pandas

    frame = pandas.DataFrame({"a": a}, index=pandas.Index(t))
    return {"endaq": lambda: endaq.calc.shock.shock_spectrum(frame, freqs=FREQUENCIES_HZ, damp=0.05, mode="srs")["a"]}


def main(tool, command):
    warnings.filterwarnings("ignore")
    records = [history(rate) for rate in RATES_HZ]
    request = {"frequency_hz": list(FREQUENCIES_HZ), "q_factor": 10.0, "pulses": PULSES,
               "records": [{"dt": 1.0 / rate, "samples": list(a)} for rate, (_, a) in zip(RATES_HZ, records)]}
    run = subprocess.run(command, input=json.dumps(request), stdout=subprocess.PIPE, text=True, check=True)
    pulses, *sampled = json.loads(run.stdout)
    exact = np.array(pulses["maximax"])
    rows = []

    def row(name, rate, spectrum, ms):
        error = float(np.max(np.abs(np.ravel(spectrum) / exact - 1)))
        rows.append({"tool": name, "rate_hz": rate, "error": error, "ms": ms})

    if tool == "clatter":
        rows.append({"tool": "clatter, exact pulses", "rate_hz": None, "error": 0.0, "ms": pulses["ms"]})
        for rate, own in zip(RATES_HZ, sampled):
            row("clatter, record", rate, own["maximax"], own["ms"])
    else:
        for rate, (t, a) in zip(RATES_HZ, records):
            for name, run in {"pyyeti": pyyeti, "endaq": endaq}[tool](t, a, rate).items():
                row(name, rate, *best(run))
    print(json.dumps(rows))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
