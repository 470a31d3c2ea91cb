#!/usr/bin/env python3
"""clatter-shock beside pyyeti and endaq: error and time on one record, in one run on one thread.

    python3 crates/clatter-shock/benches/peers.py [ENVIRONMENT]

Makes its own virtual environment (default: target/peers) with the versions below, builds the Rust side (example `peers`) and
prints a table. The record: eight half-sines of 0.3 ms in 100 ms, sampled at 20, 100 and 500 kHz; 200 frequencies from 10 Hz
to 10 kHz, Q = 10, maximax absolute acceleration. Errors are against the exact response to the pulses themselves.
"""
import json, os, subprocess, sys, venv

ROOT = os.path.abspath(os.path.join(os.path.dirname(__file__), "..", "..", ".."))
PACKAGES = ["pyyeti==1.4.7", "endaq==1.5.3"]

def environment(path):
    python = os.path.join(path, "bin", "python")
    if not os.path.exists(os.path.join(path, "ready")):
        venv.create(path, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "--quiet", *PACKAGES], check=True)
        open(os.path.join(path, "ready"), "w").close()
    return python

def main():
    import time, warnings
    warnings.filterwarnings("ignore")
    import numpy as np, pandas as pd
    from pyyeti import srs
    import endaq.calc.shock

    frequencies = np.geomspace(10.0, 10_000.0, 200)
    pulses = [(1000.0 if i % 2 == 0 else -700.0, 3e-4, 0.002 + 0.0113 * i) for i in range(8)]

    def history(fs):
        t = np.arange(int(round(0.1 * fs))) / fs
        a = np.zeros_like(t)
        for amplitude, duration, start in pulses:
            inside = (t >= start) & (t < start + duration)
            a[inside] += amplitude * np.sin(np.pi * (t[inside] - start) / duration)
        return t, a

    def smallest(run, repeats=5):
        best = float("inf")
        for _ in range(repeats):
            begin = time.perf_counter()
            result = run()
            best = min(best, time.perf_counter() - begin)
        return np.asarray(result), 1e3 * best

    rates = [20_000, 100_000, 500_000]
    records = [history(fs) for fs in rates]
    request = dict(frequency_hz=list(frequencies), q_factor=10.0, pulses=pulses,
                   records=[dict(dt=1.0 / fs, samples=list(a)) for fs, (_, a) in zip(rates, records)])
    cargo = subprocess.run(["cargo", "run", "--release", "--quiet", "-p", "clatter-shock", "--example", "peers"],
                           input=json.dumps(request), capture_output=True, text=True, cwd=ROOT)
    if cargo.returncode:
        sys.exit(cargo.stderr)
    own = json.loads(cargo.stdout)
    exact = np.array(own[0]["maximax"])
    print(f"{'':>9}  {'clatter-shock':>24}  {'pyyeti default':>24}  {'pyyeti no roll-off':>24}  {'endaq':>24}")
    print(f"{'pulses':>9}  {'exact':>14} {own[0]['ms']:>6.2f} ms")
    for fs, (t, a), mine in zip(rates, records, own[1:]):
        columns = [(np.array(mine["maximax"]), mine["ms"])]
        columns.append(smallest(lambda: srs.srs(a, fs, frequencies, 10.0, time="total", parallel="no")))
        columns.append(smallest(lambda: srs.srs(a, fs, frequencies, 10.0, time="total", rolloff="none", parallel="no")))
        frame = pd.DataFrame({"a": a}, index=pd.Index(t))
        columns.append(smallest(lambda: endaq.calc.shock.shock_spectrum(frame, freqs=frequencies, damp=0.05, mode="srs")["a"]))
        cells = [f"{100 * np.max(np.abs(np.ravel(v) / exact - 1)):>8.3f} % {ms:>10.2f} ms" for v, ms in columns]
        print(f"{fs // 1000:>5} kHz  " + "  ".join(f"{c:>24}" for c in cells))

if __name__ == "__main__":
    if os.environ.get("CLATTER_PEERS") == "1":
        main()
    else:
        path = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else os.path.join(ROOT, "target", "peers"))
        variables = dict(os.environ, CLATTER_PEERS="1", OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
        sys.exit(subprocess.run([environment(path), os.path.abspath(__file__)], env=variables).returncode)
