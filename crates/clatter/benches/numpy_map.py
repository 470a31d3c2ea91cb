#!/usr/bin/env python3
"""The 1000 x 1000 map of the peak by numpy, beside `clatter map`: python3 crates/clatter/benches/numpy_map.py

Makes its own environment in target/numpy (needs PyPI). numpy gets its best way: the recurrence of the differences on
whole arrays, in place, until the last point stands still or 64 steps are done (which leaves the corner at q = 1 undone).
"""
import os, statistics, subprocess, sys, time, venv

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..")
HOME = os.path.join(ROOT, "target", "numpy")
PYTHON = os.path.join(HOME, "bin", "python")

def inside():
    import numpy as np
    q, e = np.meshgrid(np.linspace(0, 1, 1000), np.linspace(0, 1, 1000), indexing="ij")
    def peak():
        d = q * (1 + e); a = 1 + d; w = (1 - q) * (1 + e)
        for _ in range(64):
            np.maximum(e * d - w * a, 0, out=d)
            if not d.any(): break
            a += d
        return (1 + e) * a
    clatter = os.path.join(ROOT, "target", "release", "clatter")
    file, other = os.path.join(HOME, "ours.npy"), os.path.join(HOME, "numpy.npy")
    ours = [clatter, "map", "peak-end", "--q=0:1:1000", "--e=0:1:1000", "-o", file]
    def timed(work):
        start = time.perf_counter(); result = work(); return time.perf_counter() - start, result
    rows = {"numpy computes": [], "numpy saves": [], "clatter, whole process with file": [], "a process that does nothing": []}
    for _ in range(11):
        t, values = timed(peak); rows["numpy computes"].append(t)
        rows["numpy saves"].append(timed(lambda: np.save(other, values))[0])
        rows["clatter, whole process with file"].append(timed(lambda: subprocess.run(ours, check=True, stdout=subprocess.DEVNULL))[0])
        rows["a process that does nothing"].append(timed(lambda: subprocess.run([clatter, "--version"], check=True, stdout=subprocess.DEVNULL))[0])
    for name, times in rows.items(): print(f"{name:34} {statistics.median(times) * 1e3:8.2f} ms")
    mine = np.load(file)
    still = np.isfinite(mine) & (q < 0.99)
    print(f"largest difference, q < 0.99: {np.max(np.abs(mine[still] / values[still] - 1)):.1e}")

if __name__ == "__main__":
    if sys.argv[1:] == ["inside"]: sys.exit(inside())
    subprocess.run(["cargo", "build", "--release", "-q"], cwd=ROOT, check=True)
    if not os.path.exists(PYTHON): venv.create(HOME, with_pip=True)
    subprocess.run([PYTHON, "-m", "pip", "install", "-q", "numpy"], check=True)
    sys.exit(subprocess.run([PYTHON, __file__, "inside"]).returncode)
