"""Measured records: reading a file and its spectra, clatter beside polars, pyyeti and endaq, as JSON.

    records.py TOOL DIRECTORY COMMAND   TOOL: clatter, polars, pyyeti, endaq; COMMAND: the example `records` of clatter-record

1. A file of 10^6 rows (time, acceleration), read, and 200 spectra from 10 Hz to a third of the sampling rate, Q = 10.
2. Tones under a Gaussian bell at 20 to 2.5 samples a cycle, the spectrum at the tone, against the response to the bell
   itself: the history at 64 points a sample through the exact propagator of the oscillator, which no tool here shares.
"""
import json, os, subprocess, sys, time, warnings

import numpy as np

ROWS, RATE_HZ = 1_000_000, 100_000
FREQUENCIES = (10.0, RATE_HZ / 3.0, 200)
SAMPLES_A_CYCLE = [20.0, 10.0, 6.0, 5.0, 4.0, 3.0, 2.5]
TONE_HZ, Q, FINE = 1000.0, 10.0, 64
ROUNDS = 3


def write(path, t, a):
    if not os.path.exists(path):
        with open(path + ".part", "w") as file:
            file.write("time [s],acceleration [m/s2]\n")
            np.savetxt(file, np.column_stack([t, a]), fmt=["%.7f", "%.9g"], delimiter=",")
        os.replace(path + ".part", path)
    return path


def bursts():
    """Returns decaying tones up to a fifth of the sampling rate, and a little noise."""
    t = np.arange(ROWS) / RATE_HZ
    random = np.random.default_rng(1)
    a = random.normal(0.0, 0.5, ROWS)
    for start in np.arange(0.5, 10.0, 0.5):
        f = random.uniform(100.0, RATE_HZ / 5.0)
        after = np.clip(t - start, 0.0, None)
        a += 800.0 * np.sin(2 * np.pi * f * after) * np.exp(-after * f / 8.0) * (t >= start)
    return t, a


def bell(samples_a_cycle, fine=1):
    """Returns six cycles to the width of the bell: time and acceleration, so many points a sample."""
    rate = TONE_HZ * samples_a_cycle
    width = 6.0 / TONE_HZ
    count = int(10 * width * rate)
    t = np.arange(count * fine) / (rate * fine)
    middle = 5 * width
    return t, np.exp(-(((t - middle) / width) ** 2)) * np.sin(2 * np.pi * TONE_HZ * (t - middle) + 0.3)


def exact(samples_a_cycle):
    """Returns the largest absolute acceleration of the oscillator at the tone, step by step by a matrix exponential."""
    t, a = bell(samples_a_cycle, FINE)
    dt, w, z = t[1] - t[0], 2 * np.pi * TONE_HZ, 0.5 / Q
    m = np.zeros((4, 4))
    m[0, 1], m[1, :] = 1.0, [-w * w, -2 * z * w, -1.0, 0.0]
    m[2, 3] = 1.0
    step = np.eye(4)
    term = np.eye(4)
    for k in range(1, 30):
        term = term @ m * dt / k
        step = step + term
    x = v = largest = 0.0
    for now, following in zip(a[:-1], a[1:]):
        slope = (following - now) / dt
        x, v = (step[0] @ [x, v, now, slope], step[1] @ [x, v, now, slope])
        largest = max(largest, abs(w * w * x + 2 * z * w * v))
    return largest


def least(run):
    times = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        answer = run()
        times.append(1e3 * (time.perf_counter() - begin))
    return answer, min(times)


def peer(tool):
    """Returns a spectrum (t, a, rate, frequencies) by a tool at its defaults."""
    if tool == "pyyeti":
        from pyyeti import srs

        return lambda t, a, rate, f: srs.srs(a, rate, f, Q, time="total", parallel="no")
    import endaq.calc.shock, pandas

    def endaq_srs(t, a, rate, f):
        frame = pandas.DataFrame({"a": a}, index=pandas.Index(t))
        return endaq.calc.shock.shock_spectrum(frame, freqs=f, damp=0.5 / Q, mode="srs")["a"]

    return endaq_srs


def main(tool, directory, command):
    warnings.filterwarnings("ignore")
    os.makedirs(directory, exist_ok=True)
    file = lambda name, record: write(os.path.join(directory, name), *record)
    big = bursts()
    big_file = file("record.csv", big)
    bells = [(n, bell(n)) for n in SAMPLES_A_CYCLE]
    low, high, count = FREQUENCIES
    grid = low * (high / low) ** (np.arange(count) / (count - 1))
    answer = {"tool": tool}
    if tool == "polars":
        import polars

        answer["reading_ms"] = least(lambda: polars.read_csv(big_file))[1]
    elif tool == "clatter":
        run = lambda path, *f: json.loads(subprocess.run([command, path, *map(str, f), str(ROUNDS)], stdout=subprocess.PIPE, check=True).stdout)
        whole = run(big_file, *FREQUENCIES)
        answer.update(reading_ms=whole["reading_ms"], linear_ms=whole["linear"]["ms"], ms=whole["band_limited"]["ms"])
        answer["errors"], answer["linear_errors"] = [], []
        for n, record in bells:
            got, truth = run(file(f"bell-{n}.csv", record), TONE_HZ, TONE_HZ, 1), exact(n)
            answer["errors"].append(got["band_limited"]["maximax"][0] / truth - 1)
            answer["linear_errors"].append(got["linear"]["maximax"][0] / truth - 1)
    else:
        spectrum = peer(tool)
        answer["ms"] = least(lambda: spectrum(*big, RATE_HZ, grid))[1]
        tone = np.array([TONE_HZ])
        answer["errors"] = [float(np.ravel(spectrum(*record, TONE_HZ * n, tone))[0] / exact(n) - 1) for n, record in bells]
    print(json.dumps(answer))


if __name__ == "__main__":
    main(*sys.argv[1:4])
