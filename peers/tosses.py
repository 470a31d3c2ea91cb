#!/usr/bin/env python3
"""Fits of real tosses: a square of 60 mm that slides as it lands, filmed at 250 Hz. A study, not a test.

    git clone https://github.com/DAIRLab/ImpactModeling
    cargo build --release
    python3 peers/tosses.py "ImpactModeling/IRB Bound/IRB Square"

Of the tosses that land within 8 degrees of flat, every third. What `clatter fit` makes of the heights of both lower corners, from
0.1 s before the first touch to 48 ms after it, or until another side comes to lie below. The model has no friction and no height of
the body over its ends, so that the scatter of e between tosses tells what that is worth.
"""

import csv
import json
import math
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

RATE_HZ, HALF_M = 250.0, 0.03
PRODUCT = """[product]
name = "square"
length = "60 mm"
radius_of_gyration = "24.495 mm" # side/sqrt(6)
restitution = [0.05, 0.95]
[drop]
speed = ["0.5 m/s", "5 m/s"]
tilt = ["0 deg", "30 deg"]
[[component]]
name = "none"
position = "0 mm"
mount = "hard"
velocity_change_limit = "3 m/s"
"""
CLATTER = Path(__file__).resolve().parent.parent / "target/release/clatter"


def corners(path):
    """Returns the angle of the lower side against the ground, and heights of its two corners, for each picture."""
    with open(path) as file:
        rows = [(float(row["z"]), float(row["th"])) for row in csv.DictReader(file)]
    turn = [(th + math.pi / 4) % (math.pi / 2) - math.pi / 4 for _, th in rows]
    heights = [[z - HALF_M * (math.cos(w) + side * math.sin(w)) for side in (1, -1)] for (z, _), w in zip(rows, turn)]
    ground = sorted(map(min, heights))[len(heights) // 50]
    return turn, [[h - ground for h in both] for both in heights]


def first_touch(heights):
    low = [min(both) for both in heights]
    near = (k for k in range(6, len(low) - 2) if low[k] < 0.004 and low[k - 1] >= low[k] < low[k + 1])
    return next(near, None)


def fitted(heights, begin, end, folder):
    rows = [f"{k / RATE_HZ!r},{a!r},{b!r}" for k, (a, b) in enumerate(heights[begin : end + 1])]
    (folder / "heights.csv").write_text("time_s,height_a_m,height_b_m\n" + "\n".join(rows) + "\n")
    command = [CLATTER, "fit", folder / "heights.csv", f"--product={folder / 'square.toml'}", "--known-gyration", "--format=json"]
    done = subprocess.run(command, capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else None


def main(data):
    tosses = []
    for path in sorted(Path(data).glob("traj_*.csv")):
        turn, heights = corners(path)
        touch = first_touch(heights)
        if touch is not None and abs(turn[touch - 1]) < math.radians(8):
            end = touch
            while end + 1 < min(len(turn), touch + 13) and abs(turn[end] - turn[end + 1]) < 0.6:
                end += 1
            tosses.append((heights, max(0, touch - 25), end))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "square.toml").write_text(PRODUCT)
        found = [fitted(*toss, folder) for toss in tosses[::3]]
    told = []
    for fit in filter(None, found):
        both = [estimate for estimate in fit["estimates"] if estimate["quantity"].startswith("restitution")]
        if both:
            told.append((statistics.mean(e["value"] for e in both), both, fit["records"][0]["scatter"]))
    values = sorted(e for e, _, _ in told)
    # For those with one restitution the interval gives its uncertainty.
    half = [0.5 * (both[0]["interval"][1] - both[0]["interval"][0]) for _, both, _ in told if len(both) == 1]
    print(f"{len(tosses)} tosses within 8 degrees, every third fitted: {len(found)}, of which {len(found) - len(told)} tell no e")
    print(f"e {statistics.median(values):.2f} at the median, from {values[0]:.2f} to {values[-1]:.2f}, deviation {statistics.stdev(values):.3f}")
    print(f"half of an interval of 95 %: {statistics.median(half):.3f} at the median")
    print(f"heights off by {1e3 * statistics.median(scatter for _, _, scatter in told):.1f} mm, root mean square, at the median")


main(sys.argv[1])
