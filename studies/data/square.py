#!/usr/bin/env python3
"""Measured tosses of a square, in the form of cube.csv: python3 square.py FOLDER > square.csv

FOLDER is "IRB Bound/IRB Square" of DAIRLab/ImpactModeling (BSD-3-Clause, LICENSE-square), traj_N.csv: x, z, angle of a square of 60 mm that
moves in a plane, 250 Hz. Kept is every fourth toss that flies for twelve samples at least, from there until 30 samples after a corner
is first near the ground, and its last pose; as whole numbers in 1e-5 and 1e-5 m, turned about the axis across the plane.
"""
import csv, math, sys
from pathlib import Path

HALF_M, NEAR_M, BEFORE, AFTER, EVERY = 0.03, 0.004, 12, 30, 4


def lowest(pose):
    return pose[1] - HALF_M * (abs(math.cos(pose[2])) + abs(math.sin(pose[2])))


print("toss,sample,qw,qx,qy,qz,x,y,z")
flown = 0
for number in range(1, 501):
    path = Path(sys.argv[1]) / f"traj_{number}.csv"
    with open(path) as file:
        poses = [[float(cell) for cell in row[:3]] for row in list(csv.reader(file))[1:]]
    near = next((k for k, pose in enumerate(poses) if lowest(pose) < NEAR_M), 0)
    flown += near >= BEFORE
    if near < BEFORE or flown % EVERY:
        continue
    kept = [*range(near - BEFORE, min(near + AFTER, len(poses) - 1)), len(poses) - 1]
    for sample, (x, z, angle) in zip([*range(len(kept) - 1), len(poses) - 1 - near + BEFORE], (poses[k] for k in kept)):
        turned = math.cos(angle / 2), 0, -math.sin(angle / 2), 0
        print(number, sample, *(round(1e5 * value) for value in (*turned, x, 0, z)), sep=",")
