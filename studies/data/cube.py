#!/usr/bin/env python3
"""Measured tosses of a cube, trimmed to what the study reads: python3 cube.py FOLDER > cube.csv

FOLDER holds tosses of DAIRLab/dair_pll (assets/contactnets_cube, first published with DAIRLab/contact-nets; BSD-3-Clause, LICENSE-cube)
as N.csv: time, quaternion w x y z that turns body axes into the world, place of the center in m, spin, velocity; 148 Hz.
Kept are the poses until 30 samples after a corner is first down, and the last one; as whole numbers in 1e-5 and 1e-5 m. Toss 80 is
left out: it is toss 55 seen in other axes.
"""
import csv, sys
from pathlib import Path

HALF_M, DOWN_M, AFTER, TWICE = 0.0524, 0.002, 30, {80}


def lowest(pose):
    w, x, y, z = pose[:4]
    vertical = 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)
    return pose[6] - HALF_M * sum(map(abs, vertical))


print("toss,sample,qw,qx,qy,qz,x,y,z")
for path in sorted(Path(sys.argv[1]).glob("*.csv"), key=lambda path: int(path.stem)):
    if int(path.stem) in TWICE:
        continue
    with open(path) as file:
        poses = [[float(cell) for cell in row[1:8]] for row in list(csv.reader(file))[1:]]
    down = next(k for k, pose in enumerate(poses) if lowest(pose) < DOWN_M)
    for sample in [*range(min(down + AFTER, len(poses) - 1)), len(poses) - 1]:
        print(path.stem, sample, *(round(1e5 * value) for value in poses[sample]), sep=",")
