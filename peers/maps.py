"""The map of the peak shock over a million bars by numpy, beside the command `clatter map`: times in ms as JSON.

    maps.py CLATTER DIRECTORY      the command, and where the maps may be written

numpy gets its best way: the recurrence of the differences on whole arrays, in place, until the last point stands still or
64 steps are done (which leaves the corner at q = 1 undone).
"""
import json, os, subprocess, sys

import numpy as np

from bars import best


def main(clatter, directory):
    q, e = np.meshgrid(np.linspace(0, 1, 1000), np.linspace(0, 1, 1000), indexing="ij")

    def peak():
        d = q * (1 + e)
        a, w = 1 + d, (1 - q) * (1 + e)
        for _ in range(64):
            np.maximum(e * d - w * a, 0, out=d)
            if not d.any():
                break
            a += d
        return (1 + e) * a

    ours, theirs = (os.path.join(directory, name) for name in ("clatter.npy", "numpy.npy"))
    command = [clatter, "map", "peak-end", "--q=0:1:1000", "--e=0:1:1000", "-o", ours]
    values, computed = best(peak)
    _, saved = best(lambda: np.save(theirs, values))
    _, process = best(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL))
    mine = np.load(ours)
    shown = np.isfinite(mine) & (q < 0.99)
    print(json.dumps({
        "version": np.__version__, "numpy_ms": computed, "numpy_saved_ms": computed + saved, "process_ms": process,
        "largest_difference": float(np.max(np.abs(mine[shown] / values[shown] - 1))),
    }))


if __name__ == "__main__":
    main(*sys.argv[1:])
