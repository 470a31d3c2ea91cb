#!/usr/bin/env python3
"""Makes filters.json: Butterworth filters forward and backward, by difference equations with mpmath at 60 digits.

Run: python3 make_filters.py > filters.json (needs mpmath 1.3, scipy 1.11 or later). The record is continued at both
ends, turned about its end samples, by 7 time constants of the slowest pole and 10 samples more, or by its own length
less one. Where the double precision of scipy suffices, scipy.signal.sosfiltfilt has to agree.
"""
import json
import math

import numpy
from mpmath import mp, mpf, mpc, nstr, pi, sqrt, tan, exp
from scipy import signal

mp.dps = 60
N, EVERY = 240, 8


def record():
    seed, samples = 1, []
    for i in range(N):
        seed = (seed * 1103515245 + 12345) % 2**31
        pulse = 100 * math.sin(math.pi * (i - 60) / 50) if 60 <= i <= 110 else 0.0
        samples.append(round(7.5 + pulse + 8 * (seed / 2**31 - 0.5), 6))
    return samples


def coefficients(kind, relative, order):
    """b and a of one pass: poles of the analog filter, the bilinear transform, products expanded."""
    shift = (sqrt(mpf(2)) - 1) ** (mpf(1) / (2 * order))
    at = tan(pi * mpf(relative))
    g = at / shift if kind == "low" else at * shift
    a, b = [mpf(1)], [mpf(1)]
    for k in range(order):
        pole = g * exp(mpc(0, 1) * pi * (2 * k + order + 1) / (2 * order))
        # s = (z - 1)/(z + 1); the high-pass has its poles at g²/pole, which are the same ones.
        z = (1 + pole) / (1 - pole)
        a = [x - z * y for x, y in zip(a + [mpf(0)], [mpf(0)] + a)]
        zero = -1 if kind == "low" else 1
        b = [x - zero * y for x, y in zip(b + [mpf(0)], [mpf(0)] + b)]
    a = [x.real if isinstance(x, mpc) else x for x in a]
    side = 1 if kind == "low" else -1  # gain 1 at z = 1 or −1
    gain = sum(x * side**i for i, x in enumerate(a)) / sum(x * side**i for i, x in enumerate(b))
    return [gain * x for x in b], a, g


def one_pass(b, a, kind, samples):
    """Difference equation, begun as if the first sample had always been."""
    order, out = len(a) - 1, []
    rest = samples[0] if kind == "low" else mpf(0)
    for i, _ in enumerate(samples):
        x = lambda k: samples[k] if k >= 0 else samples[0]
        y = lambda k: out[k] if k >= 0 else rest
        out.append(sum(b[k] * x(i - k) for k in range(order + 1)) - sum(a[k] * y(i - k) for k in range(1, order + 1)))
    return out


cases = []
for kind, relative, order in [
    ("low", 1e-6, 2), ("low", 1e-6, 4), ("high", 1e-6, 2), ("high", 1e-6, 8), ("low", 1e-3, 3), ("high", 1e-3, 4),
    ("low", 0.02, 2), ("high", 0.02, 1), ("low", 0.1, 8), ("high", 0.1, 5), ("low", 0.4, 2), ("high", 0.45, 3),
]:
    x = [mpf(v) for v in record()]
    b, a, g = coefficients(kind, relative, order)
    edge = min(N - 1, math.ceil(7 * max(g, 1 / g) / (2 * math.sin(math.pi / 2 / order))) + 10)
    wide = [2 * x[0] - v for v in x[edge:0:-1]] + x + [2 * x[-1] - v for v in x[-2:-2 - edge:-1]]
    y = one_pass(b, a, kind, one_pass(b, a, kind, wide)[::-1])[::-1][edge:edge + N]
    if relative >= 1e-3:
        cutoff = math.atan(float(g)) / math.pi
        sos = signal.butter(order, 2 * cutoff, kind, output="sos")
        other = signal.sosfiltfilt(sos, numpy.array(record()), padtype="odd", padlen=edge)
        assert max(abs(float(p) - q) for p, q in zip(y, other)) < 1e-7, (kind, relative, order)
    cases.append(dict(kind=kind, relative=relative, order=order, y=[float(nstr(v, 20)) for v in y[::EVERY]]))
print(json.dumps({"origin": "make_filters.py, mpmath, 60 digits", "every": EVERY, "record": record(), "cases": cases}))
