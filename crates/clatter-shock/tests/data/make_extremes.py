#!/usr/bin/env python3
"""Makes extremes.json: free motion and pulse responses at extremes, with mpmath at 100 digits.

Run: python3 make_extremes.py > extremes.json (needs mpmath 1.3 or later). Every input is the exact value of the double printed.
"""
import json
from mpmath import mp, mpf, sqrt, exp, cos, sin, pi, nstr, findroot

mp.dps = 100

def basis(zeta, tau):
    """h (impulse response) and g = h' of x'' + 2 zeta x' + x."""
    if zeta < 1:
        b = sqrt(1 - zeta**2); E = exp(-zeta * tau)
        return E * sin(b * tau) / b, E * (cos(b * tau) - zeta * sin(b * tau) / b)
    if zeta == 1:
        return tau * exp(-tau), (1 - tau) * exp(-tau)
    n = sqrt(zeta**2 - 1); s1, s2 = 1 / (zeta + n), zeta + n
    a, c = exp(-s1 * tau), exp(-s2 * tau)
    return (a - c) / (2 * n), (s2 * c - s1 * a) / (2 * n)

free = []
for zeta in [0.0, 1e-13, 1e-9, 0.05, 0.9, 1 - 2.0**-40, 1 - 2.0**-53, 1.0, 1 + 2.0**-52, 1 + 2.0**-40, 1.5, 50.0, 1e8]:
    for omega, t in [(1e-6, 1e-6), (2.5e-7, 0.3), (1.0, 1e-3), (3.0, 0.7), (17.0, 1.3), (1e3, 0.25), (377.0, 2.0), (1e5, 1.2345), (1.1e9, 997.0)]:
        z0, v0 = 0.3, -1.7
        tau = mpf(omega) * mpf(t); x0 = mpf(omega) * mpf(z0); Z = mpf(zeta)
        h, g = basis(Z, tau)
        x = x0 * (g + 2 * Z * h) + mpf(v0) * h
        y = mpf(v0) * g - x0 * h
        free.append(dict(zeta=zeta, omega=omega, t=t, displacement=z0, velocity=v0, x=nstr(x, 30), y=nstr(y, 30),
                         slow_decay=nstr(exp(-(Z if Z <= 1 else 1 / (Z + sqrt(Z**2 - 1))) * tau), 30)))

def half_sine(zeta, wt):
    """omega z and z' at the end of a half-sine of unit amplitude and duration D = 1, omega = wt: steady plus free motion."""
    w, Z, O = mpf(wt), mpf(zeta), pi
    steady = lambda t: -exp(1j * O * t) / (w**2 - O**2 + 2j * Z * w * O)
    z0, v0 = -steady(mpf(0)).imag, -(1j * O * steady(mpf(0))).imag
    h, g = basis(Z, w)
    x = w * z0 * (g + 2 * Z * h) + v0 * h + w * steady(mpf(1)).imag
    y = v0 * g - w * z0 * h + (1j * O * steady(mpf(1))).imag
    return nstr(x, 30), nstr(y, 30)

pulse = []
from math import pi as fpi
for zeta in [0.0, 1e-9, 0.05, 1 - 1e-9, 1.0, 1 + 1e-9, 3.0, 50.0]:
    for wt in [1e-9, 1e-4, 0.01, 0.5, 1.9, fpi * (1 - 1e-3), fpi * (1 - 1e-9), fpi, fpi * (1 + 1e-9), 4.0, 30.0, 200.0]:
        x, y = half_sine(zeta, wt)
        pulse.append(dict(zeta=zeta, omega=wt, x=x, y=y))

# Peaks of pulses of unit amplitude and duration 1: pieces (length, level, slope, cosine, sine, rate) of base acceleration
# level + slope t + cosine cos(rate t) + sine sin(rate t).
SHAPES = {
    "half-sine": [(1, 0, 0, 0, 1, pi)],
    "haversine": [(1, mpf(1) / 2, 0, -mpf(1) / 2, 0, 2 * pi)],
    "triangle": [(mpf(1) / 2, 0, 2, 0, 0, 0), (mpf(1) / 2, 1, -2, 0, 0, 0)],
    "trapezoid": [(mpf(1) / 4, 0, 4, 0, 0, 0), (mpf(1) / 2, 1, 0, 0, 0, 0), (mpf(1) / 4, 1, -4, 0, 0, 0)],
}

def pieces(shape, zeta, w):
    """Each piece as its phase length and its motion (x, y) over phase, the ring-down last; x = omega z, y = z'."""
    Z, W, state, list = mpf(zeta), mpf(w), (mpf(0), mpf(0)), []
    ring = 2.1 * pi / sqrt(1 - Z**2) if Z < 1 else 30 * (Z + 1)
    for length, level, slope, cosine, sine, rate in SHAPES[shape] + [(ring / W, 0, 0, 0, 0, 0)]:
        c0, c1, nu = -level / W, -slope / W**2, rate / W
        F = -(cosine - 1j * sine) / W / (1 - nu**2 + 2j * Z * nu)
        steady = lambda s, c0=c0, c1=c1, nu=nu, F=F: (
            c0 + c1 * (s - 2 * Z) + (F * exp(1j * nu * s)).real, c1 + (1j * nu * F * exp(1j * nu * s)).real)
        x0, y0 = (a - b for a, b in zip(state, steady(mpf(0))))
        def motion(s, x0=x0, y0=y0, steady=steady):
            (h, g), (xs, ys) = basis(Z, s), steady(s)
            return xs + x0 * (g + 2 * Z * h) + y0 * h, ys + y0 * g - x0 * h
        list.append((length * W, motion))
        state = motion(length * W)
    return list

def peaks(shape, zeta, w):
    """Largest and smallest omega z and A/omega: turning points bracketed on a grid, then by bisection and secant."""
    Z, extremes = mpf(zeta), [[mpf(0)] * 2, [mpf(0)] * 2]
    for span, motion in pieces(shape, zeta, w):
        for q, value in enumerate([lambda s: motion(s)[0], lambda s: -motion(s)[0] - 2 * Z * motion(s)[1]]):
            steps = int(max(60, 8 * span))
            # The value at a turning point is known to twice the digits of its place.
            slope = lambda s: value(s + mpf(10)**-40) - value(s - mpf(10)**-40)
            grid = [slope(span * i / steps) for i in range(steps + 1)]
            found = [value(mpf(0)), value(span)]
            for i in range(steps):
                if grid[i] * grid[i + 1] < 0:
                    cell = (span * i / steps, span * (i + 1) / steps)
                    found.append(value(findroot(slope, cell, solver="anderson", tol=mpf(10)**-120, verify=False)))
            extremes[q] = [max(extremes[q][0], *found), min(extremes[q][1], *found)]
    return [[nstr(v, 30) for v in pair] for pair in extremes]

peak = []
for shape in SHAPES:
    for zeta in [0.0, 0.05, 0.7, 1.0, 3.0]:
        for w in [0.01, 0.5, 2.5, fpi, 5.0, 12.0, 90.0]:
            (xh, xl), (ah, al) = peaks(shape, zeta, w)
            peak.append(dict(shape=shape, zeta=zeta, omega=w, x_high=xh, x_low=xl, a_high=ah, a_low=al))
print(json.dumps({"origin": "make_extremes.py, mpmath, 100 digits", "free": free, "half_sine_end": pulse, "pulse_peaks": peak}, indent=0))
