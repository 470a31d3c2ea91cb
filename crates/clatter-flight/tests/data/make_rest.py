#!/usr/bin/env python3
"""Follows a drop to rest in 50 digits and prints the JSON that the tests read: `make_rest.py > rest.json` (mpmath 1.3).

Nothing here is shared with the library: the state is the height and angle of the center of mass and their rates; the next
touch is the first change of sign, or the first dip below zero, in a scan of both heights that starts far below the shortest bounce; an
end is held to the ground once its bounces are 1e-18 of the speed that the height of the other end is worth; then it is a constraint whose
motion is integrated by Taylor series (mpmath.odefun).
"""
import json
import math
from mpmath import mp, mpf, sin, cos, sqrt, odefun

mp.dps = 50
STILL = mpf(10) ** -24
SIDE = (-1, 1)


class Body:
    def __init__(self, scene, finite):
        self.arm = [mpf(x) for x in scene["arm_m"]]
        self.rho2 = mpf(scene["gyration_m"]) ** 2
        self.e, self.g, self.finite = mpf(scene["e"]), mpf(scene["gravity_m_s2"]), finite
        tilt = mpf(scene["tilt_rad"])
        self.phi = tilt if finite else sin(tilt)
        self.vy, self.w, self.t = -mpf(scene["speed_m_s"]), mpf(scene.get("spin_rad_s", 0)), mpf(0)
        self.y = self.arm[0] * self.sine(self.phi)
        self.v0 = -self.vy

    def sine(self, phi):
        return sin(phi) if self.finite else phi

    def lever(self, i, phi):
        return SIDE[i] * self.arm[i] * (cos(phi) if self.finite else 1)

    def height(self, i, t=0):
        return self.y + self.vy * t - self.g * t * t / 2 + SIDE[i] * self.arm[i] * self.sine(self.phi + self.w * t)

    def rate(self, i, t=0):
        return self.vy - self.g * t + self.lever(i, self.phi + self.w * t) * self.w

    def strike(self, i):
        x, u = self.lever(i, self.phi), self.rate(i)
        impulse = -(1 + self.e) * u / (1 + x * x / self.rho2)
        self.vy += impulse
        self.w += impulse * x / self.rho2
        return u

    def first_touch(self):
        """Time and end of the next touch; an end on the ground and not going down is let off it first."""
        gamma = self.g + max(self.arm) * self.w ** 2
        slow = [abs(self.rate(i)) for i in (0, 1) if self.height(i) < STILL ** 2] + [sqrt(2 * gamma * max(self.height(i), 0)) for i in (0, 1) if self.height(i) >= STILL ** 2]
        dt = min(x for x in slow if x > 0) / gamma / 500
        longest = min(1 / abs(self.w) if self.w else mpf(1), sqrt(sum(self.arm) / self.g)) / 60
        start, now = [self.height(i) for i in (0, 1)], [None, None]
        t = mpf(0)
        past = [(start[i], self.rate(i)) for i in (0, 1)]
        while True:
            step = min(dt, longest)
            dt *= mpf("1.08")
            here = [(self.height(i, t + step), self.rate(i, t + step)) for i in (0, 1)]
            hits = []
            for i in (0, 1):
                (h0, v0), (h1, v1) = past[i], here[i]
                if h1 <= 0:
                    hits.append((self.bisect(lambda s: self.height(i, s), t if h0 > STILL ** 3 or t > 0 else t + step * mpf("1e-9"), t + step), i))
                elif v0 < 0 < v1:
                    low = self.bisect(lambda s: -self.rate(i, s), t, t + step)
                    if self.height(i, low) <= 0:
                        hits.append((self.bisect(lambda s: self.height(i, s), t, low), i))
            if hits:
                return min(hits)
            t, past = t + step, here

    def bisect(self, f, lo, hi):
        """f > 0 at lo, f <= 0 at hi; Illinois steps, to the last digit."""
        flo, fhi = f(lo), f(hi)
        if flo <= 0:
            return lo
        for n in range(400):
            mid = (lo * fhi - hi * flo) / (fhi - flo) if n % 3 else (lo + hi) / 2
            if not lo < mid < hi:
                mid = (lo + hi) / 2
            fm = f(mid)
            if fm > 0:
                lo, flo = mid, fm
            else:
                hi, fhi = mid, fm
            if hi - lo < mpf(10) ** -47 * (1 + hi) or hi - lo < mpf(10) ** -40 * hi and abs(fm) < mpf(10) ** -60:
                break
        return hi

    def fly(self, t):
        self.y, self.vy = self.y + self.vy * t - self.g * t * t / 2, self.vy - self.g * t
        self.phi += self.w * t
        self.t += t

    def held(self, p, phi, w):
        """Angular acceleration with end p on the ground, and the force that holds it there."""
        x = self.lever(p, phi)
        bend = SIDE[p] * self.arm[p] * sin(phi) * w * w if self.finite else 0
        force = (self.g + bend) / (1 + x * x / self.rho2)
        return x * force / self.rho2, force

    def pivot(self, p):
        """Turns about end p until the other end lands (its index) or the force vanishes (None)."""
        j = 1 - p
        if not self.finite:
            a = self.held(p, self.phi, self.w)[0]
            h, v, ah = (SIDE[j] * sum(self.arm) * x for x in (self.phi, self.w, a))
            t = (v + sqrt(v * v - 2 * ah * h)) / -ah
            self.phi, self.w, self.t = mpf(0), self.w + a * t, self.t + t
            self.y, self.vy = mpf(0), -self.lever(p, 0) * self.w
            return j
        # In units of the time the motion takes at this height, so that late, small pivots are as smooth as early ones.
        unit = min(sqrt(sum(self.arm) / self.g), 2 * abs(self.w) / abs(self.held(p, self.phi, self.w)[0]) + sqrt(2 * abs(sin(self.phi)) * 1 / abs(self.held(p, self.phi, self.w)[0])))
        dps, mp.dps = mp.dps, 34
        scale = abs(sin(self.phi)) + abs(self.w) * unit
        base = self.phi
        run = odefun(lambda s, z: [z[1], unit * unit * self.held(p, base + scale * z[0], scale * z[1] / unit)[0] / scale], 0, [mpf(0), self.w * unit / scale])
        at = lambda s: (base + scale * run(s)[0], scale * run(s)[1] / unit)
        other = lambda s: SIDE[j] * sin(at(s)[0])
        force = lambda s: self.held(p, *at(s))[1]
        s, step = mpf(0), mpf(1) / 16
        while True:
            n = s + step
            if force(n) <= 0 or other(n) <= 0:
                break
            s = n
        end, what = (n, j) if other(n) <= 0 else (n, None)
        f = other if what == j else force
        lo, hi = s, end
        for _ in range(110):
            mid = (lo + hi) / 2
            if f(mid) > 0: lo = mid
            else: hi = mid
        self.phi, self.w = at(hi)
        mp.dps = dps
        self.t += hi * unit
        if what == j:
            # Level to the last digit: a multiple of pi.
            self.phi = mp.pi * mp.nint(self.phi / mp.pi)
        self.y, self.vy = -SIDE[p] * self.arm[p] * sin(self.phi), -self.lever(p, self.phi) * self.w
        return what


def follow(scene, finite):
    """All strikes above 1e-3 of the drop speed, and when the body is at rest."""
    b = Body(scene, finite)
    strikes = []
    def note(i, u):
        if u < -b.v0 / 1000:
            strikes.append({"end": "ab"[i], "time_s": float(b.t), "approach_m_s": float(u)})
    i, down, run = 0, None, 0
    note(0, b.strike(0))
    for n in range(20000):
        if down is not None:
            j = b.pivot(down)
            if j is None:
                down = None
                continue
            i, down = j, None
        else:
            t, i = b.first_touch()
            b.fly(t)
            b.y = -SIDE[i] * b.arm[i] * b.sine(b.phi)
        u = b.strike(i)
        note(i, u)
        speed = max(abs(b.rate(k)) for k in (0, 1))
        if max(b.height(0), b.height(1)) < STILL ** 2 and speed < STILL * b.v0 or speed < STILL ** mpf("0.9") * b.v0 and max(b.height(0), b.height(1)) < STILL:
            return {"strikes": strikes, "at_rest_s": float(b.t)}
        if abs(b.rate(i)) < STILL * b.v0 * mpf("1e-4") or b.rate(i) ** 2 < mpf(10) ** -36 * b.g * b.height(1 - i):
            if b.held(i, b.phi, b.w)[1] > 0:
                down = i
                # Held: no velocity of its own.
                b.y, b.vy = -SIDE[i] * b.arm[i] * b.sine(b.phi), -b.lever(i, b.phi) * b.w
    raise RuntimeError("no rest")


def phone(q, e, tilt_deg, spin=0.0):
    rho = 0.07 * math.sqrt((1 - q) / (1 + q))
    return dict(arm_m=[0.07, 0.07], gyration_m=rho, e=e, speed_m_s=4.43, tilt_rad=math.radians(tilt_deg), gravity_m_s2=9.81, spin_rad_s=spin)


def off_center(a, b, rho, e, speed, tilt_deg, g, spin=0.0):
    return dict(arm_m=[a, b], gyration_m=rho, e=e, speed_m_s=speed, tilt_rad=math.radians(tilt_deg), gravity_m_s2=g, spin_rad_s=spin)


# The first all but stands on its end: 4e-5 more energy than it needs to topple.
STANDING = dict(arm_m=[0.08840672931874627, 0.09164687262265941], gyration_m=0.09756627088326136, e=0.10497159336613468,
                speed_m_s=1.5479480052048435, tilt_rad=0.036557119597522766, gravity_m_s2=22.0195167878645, spin_rad_s=41.10075013678629)
BALLISTIC, FINITE = [False], [True]
BOTH = BALLISTIC + FINITE
SCENES = [
    (STANDING, BOTH),
    (phone(0.73, 0.2, 5), BOTH),
    (phone(0.5, 0.3, 5), BOTH),
    (off_center(0.05, 0.09, 0.045, 0.4, 2.0, 10, 9.81), BOTH),
    (phone(-0.25, 0.3, 20), BOTH),
    (phone(0.5, 0.0, 30), BOTH),
    (off_center(0.12, 0.08, 0.06, 0.45, 1.5, 60, 1.62, 3.0), BALLISTIC),
    (phone(0.9, 0.1, 1), BALLISTIC),
    (phone(0.5, 0.5, 5), BALLISTIC),
]

if __name__ == "__main__":
    cases = [{**s, "model": "finite-tilt" if finite else "ballistic", **follow(s, finite)} for s, models in SCENES for finite in models]
    print('{"cases":[' + ",\n".join(map(json.dumps, cases)) + "]}")
