#!/usr/bin/env python3
"""Other tools on plates and boxes: python3 peers/solids.py (network the first time, half an hour)
or python3 peers/solids.py mujoco rapier: those alone, the rest of peers/solids.json stays; CLATTER=FILE is a command that is built

A uniform plate and a long one at small tilt, three directions each, without gravity; a box that lands next to an edge and on a corner,
with gravity. Restitution 0.3 and 0.5, no friction. Compared are the order of corners, the largest change of vertical velocity of each
corner over the largest of all, and the times of the second and third touch after the first: of a plate's whole train with
`clatter impacts`, of a box's first three touches with `clatter simulate --model=compliant` at a contact time of 1 µs. Every tool starts
from the first touch and from heights that differ by parts of a step's travel; the largest error of all starts counts. Settings are
searched one after the other, plates and boxes apart; the best has the most orders right, then the least error of the median drop.
Siconos has plates alone, at small tilt, as a linear system; it has no steps, and one start.

Writes peers/solids.json: each drop by the best setting, and what every setting that was tried makes of them all. Times are those of a
processor, of clatter the whole command. Siconos is Debian's package (apt install python3-siconos).
"""
import itertools, json, math, os, resource, statistics, subprocess, sys, time

HERE = os.path.dirname(os.path.abspath(__file__))
LIFTED_STEPS = [0.0, 0.25, 0.5, 0.75]
SPEED_M_S, GRAVITY_M_S2 = 2.0, 9.80665
REFERENCE_CONTACT_S = 1e-6
BALL_M = 0.001
# Length, width, thickness, and the heights of corners b and d as a touches, in mm.
PLATES = {
    "uniform plate": ((150, 70, 0), [(0.675, 0.075), (0.5, 0.25), (0.3, 0.45)]),
    "long plate": ((160, 20, 12), [(0.7, 0.05), (0.6, 0.15), (0.3, 0.45)]),
}
# Rotation of the box: about its length, then about the horizontal across it, in degrees.
BOX_MM = (100, 60, 40)
LANDINGS = {"box, edge": (30, 3), "box, corner": (35, 25)}
RESTITUTIONS = [0.3, 0.5]
TOUCHES = 3

# The search begins with the first of each list.
SETTINGS = {
    "mujoco": {
        # Time of a contact's undamped spring for one radian: a touch takes three times that.
        "time_s": [1e-6, 5e-7, 2e-6, 4e-6],
        "impedance": [0.9999, 0.9],
        "shape": ["balls", "box"],
        "step_s": [2e-7, 5e-8, 1e-6],
    },
    "rapier": {
        "iterations": [1, 4, 16],
        "prediction_m": [1e-5, 0.02],
        "recycling": [False, True],
        "gyroscopic": [True, False],
        "balls": [True, False],
        "step_s": [1e-6, 1e-5, 1e-7],
    },
    "siconos": {},
}
# A plate without thickness is no box; the drop of a box takes ten times as long as the train of a plate.
ALONE = {"plate": {"shape": ["balls"], "balls": [True]}, "box": {"step_s": [1e-6, 1e-5, 2e-7], "time_s": [2e-5, 5e-6, 5e-5]}}
NAMES = {"siconos": "Siconos", "rapier": "Rapier3D f64", "mujoco": "MuJoCo"}


def names(kind):
    """Returns the signs of corners in the order of clatter along length, width, thickness."""
    if kind == "plate":
        return {"a": (-1, -1, 0), "b": (1, -1, 0), "c": (1, 1, 0), "d": (-1, 1, 0)}
    signs = {"+": 1, "-": -1}
    return {name: tuple(map(signs.get, name)) for name in (x + y + z for z in "-+" for y in "-+" for x in "-+")}


def rotation(axis, angle):
    half = angle / 2
    return [math.cos(half), *(math.sin(half) if i == axis else 0.0 for i in range(3))]


def product(a, b):
    (w, x, y, z), (p, q, r, s) = a, b
    return [w * p - x * q - y * r - z * s, w * q + x * p + y * s - z * r, w * r - x * s + y * p + z * q, w * s + x * r - y * q + z * p]


def upward(turned):
    """Returns the vertical in axes of the body."""
    w, x, y, z = turned
    return 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


def drop(kind, case, size_mm, turned, e, gravity):
    length, width, thickness = (1e-3 * side for side in size_mm)
    corners = [[sign * side / 2 for sign, side in zip(signs, (length, width, thickness))] for signs in names(kind).values()]
    lowest = min(sum(u * c for u, c in zip(upward(turned), corner)) for corner in corners)
    along, across = math.hypot(length, thickness) / math.sqrt(12), math.hypot(width, thickness) / math.sqrt(12)
    # A plate has no thickness: its three moments would be close to those of no body.
    third = math.hypot(length, width) / math.sqrt(12) if kind == "box" else math.hypot(along, across) * (1 - 1e-9)
    return {
        "kind": kind, "case": case, "e": e, "corners_m": corners, "gyration_m": [across, along, third], "turned": turned,
        "height_m": -lowest, "speed_m_s": SPEED_M_S, "gravity_m_s2": gravity, "touches": TOUCHES if kind == "box" else 10_000,
    }


def clatter(command, *options):
    done = subprocess.run([command, *options, "--format=json"], capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode == 0 else sys.exit(done.stderr)


def least_ms(run, seconds):
    """Returns the processor time of this process and those it waits for: for one thread, the wall time of a machine that does nothing else."""
    def used():
        return sum(part.ru_utime + part.ru_stime for part in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)))

    begin, least = time.perf_counter(), math.inf
    while least == math.inf or time.perf_counter() - begin < seconds:
        start = used()
        run()
        least = min(least, used() - start)
    return 1e3 * least


def follow(command, drop, size_mm, contact_s, *more):
    """Returns the drop by contacts that take time."""
    length, width, thickness = (repr(1e-3 * side) for side in size_mm)
    across, along, third = map(repr, drop["gyration_m"])
    # A plate has its radii along both sides, a box about its three axes.
    plate, box = [f"--gyration-m={along},{across}"], [f"--gyration-m={across},{along},{third}", f"--thickness-m={thickness}"]
    given = [f"--e={drop['e']}", f"--speed-m-s={SPEED_M_S}", f"--gravity-m-s2={drop['gravity_m_s2']}", f"--contact-time-s={contact_s}"]
    body = [f"--length-m={length}", f"--width-m={width}", *(plate if drop["kind"] == "plate" else box)]
    return clatter(command, "simulate", "--model=compliant", *body, *given, *more)


def strikes(drop, impacts, time, change, unit_s=1.0, unit_m_s=1.0):
    """Returns a list of clatter in the form of the other tools."""
    order = list(names(drop["kind"]))
    impacts = impacts[:drop["touches"]]
    peaks = [max(abs(impact[change][i]) for impact in impacts) * unit_m_s for i in range(len(order))]
    corners = [order.index(impact["corner"]) for impact in impacts]
    return {"corners": corners, "times_s": [unit_s * impact[time] for impact in impacts], "peaks_m_s": peaks}


def scene(command):
    """Returns all drops, each with the truth, and clatter's own rows."""
    drops, ours = [], []
    for (case, (size, gaps)), e in itertools.product(PLATES.items(), RESTITUTIONS):
        for gap in gaps:
            gap_m = [1e-3 * g for g in gap]
            # About the width first, then about the length that has risen: corners b and d at these heights.
            rise = math.asin(gap_m[0] / (1e-3 * size[0]))
            roll = math.asin(gap_m[1] / (1e-3 * size[1]) / math.cos(rise))
            one = drop("plate", case, size, product(rotation(1, -rise), rotation(0, roll)), e, 0.0)
            along, across = (repr(2e3 * k / side) for k, side in zip((one["gyration_m"][1], one["gyration_m"][0]), size))
            options = ["impacts", f"--gyration-ratio={along},{across}", f"--e={e}", f"--height-gap={1e3 * gap_m[0]!r},{1e3 * gap_m[1]!r}"]
            exact = clatter(command, *options)
            assert exact["count_exact"] and not any(impact["tie"] for impact in exact["impacts"]), (case, gap, e)
            one.update(gaps_mm=gap, truth=strikes(one, exact["impacts"], "time", "delta_v", 1e-3 / SPEED_M_S, SPEED_M_S))
            slow = lambda: follow(command, one, size, REFERENCE_CONTACT_S, f"--gaps-m={gap_m[0]!r},{gap_m[1]!r}")
            answer = strikes(one, slow()["impacts"], "time_s", "delta_v_m_s")
            ours.append([least_ms(lambda: clatter(command, *options), 0.1), answer, least_ms(slow, 0.1)])
            drops.append(one)
    for (case, (roll, rise)), e in itertools.product(LANDINGS.items(), RESTITUTIONS):
        turned = product(rotation(1, math.radians(rise)), rotation(0, math.radians(roll)))
        one = drop("box", case, BOX_MM, turned, e, GRAVITY_M_S2)
        options = ["--orientation=" + ",".join(map(repr, turned)), f"--impact-limit={TOUCHES + 1}"]
        exact = lambda contact=REFERENCE_CONTACT_S: follow(command, one, BOX_MM, contact, *options)["impacts"]
        one.update(truth=strikes(one, exact(), "time_s", "delta_v_m_s"))
        ours.append([least_ms(exact, 0.1), strikes(one, exact(10 * REFERENCE_CONTACT_S), "time_s", "delta_v_m_s"), None])
        drops.append(one)
    for one in drops:
        # The last touch is slow: its error in speed is a delay.
        one["until_s"] = (1.6 if one["kind"] == "plate" else 1.2) * one["truth"]["times_s"][-1]
    return drops, ours


class Mujoco:
    """Simulates contacts as springs with dashpots, stiffness and damping given (solref below zero); the damping is fitted until the
    first touch gives the restitution e, in the mean of all starts."""

    def __init__(self, setting, drop):
        import mujoco, numpy
        from mujoco import rollout

        self.tool, self.numpy, self.rollout, self.setting, self.drop = mujoco, numpy, rollout, setting, drop
        self.corners = numpy.array(drop["corners_m"])
        low, high = 0.01, 3.0
        for _ in range(24):
            middle = math.sqrt(low * high)
            self.build(middle)
            low, high = (middle, high) if self.restitution() > drop["e"] else (low, middle)

    def build(self, damping_ratio):
        setting, drop = self.setting, self.drop
        time_s, d = setting["time_s"], setting["impedance"]
        contact = f'condim="1" solref="{-(d / time_s) ** 2} {-2 * damping_ratio * d / time_s}" solimp="{d} {d} 0.001"'
        place = lambda c: " ".join(map(repr, c))
        sites = "".join(f'<site name="{i}" pos="{place(c)}" size="0.002"/>' for i, c in enumerate(drop["corners_m"]))
        if setting["shape"] == "balls":
            ball = f'<geom type="sphere" size="{BALL_M}" {contact}'
            ground, shapes = -BALL_M, "".join(f'{ball} pos="{place(c)}"/>' for c in drop["corners_m"])
        else:
            ground, shapes = 0.0, f'<geom type="box" size="{place(map(abs, drop["corners_m"][0]))}" {contact}/>'
        inertia = " ".join(repr(k * k) for k in drop["gyration_m"])
        self.model = self.tool.MjModel.from_xml_string(f"""<mujoco>
            <option timestep="{setting['step_s']}" gravity="0 0 {-drop['gravity_m_s2']}" tolerance="0" jacobian="dense"/>
            <worldbody><geom type="plane" size="1 1 1" pos="0 0 {ground}" {contact}/>
            <body><freejoint/><inertial pos="0 0 0" mass="1" diaginertia="{inertia}"/>{shapes}{sites}</body></worldbody>
            <sensor>{"".join(f'<touch site="{i}"/>' for i in range(len(self.corners)))}</sensor></mujoco>""")
        self.data = self.tool.MjData(self.model)

    def follow(self, part, steps):
        """Returns pose and velocities before and after each step, and the corners that press in it; a force reads one step late."""
        model, data, numpy, drop = self.model, self.data, self.numpy, self.drop
        self.tool.mj_resetData(model, data)
        data.qpos[:] = [0.0, 0.0, drop["height_m"] + part * self.setting["step_s"] * drop["speed_m_s"], *drop["turned"]]
        data.qvel[:] = [0.0, 0.0, -drop["speed_m_s"], 0.0, 0.0, 0.0]
        self.tool.mj_forward(model, data)
        full = self.tool.mjtState.mjSTATE_FULLPHYSICS
        state = numpy.empty(self.tool.mj_stateSize(model, full))
        self.tool.mj_getState(model, data, state, full)
        states, forces = self.rollout.rollout(model, data, state, nstep=steps)
        return numpy.vstack([state, states[0]])[:, 1:14], forces[0] > 0

    def vertical(self, motion):
        """Returns the velocities of all corners."""
        w, x, y, z = motion[3:7]
        up = self.numpy.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        return motion[9] + self.numpy.cross(motion[10:13], self.corners) @ up

    def restitution(self):
        found = []
        for part in LIFTED_STEPS:
            motion, pressed = self.follow(part, int(5 * self.setting["time_s"] / self.setting["step_s"]) + 20)
            first = int(pressed.any(0).argmax())
            touching = pressed[:, first]
            begin = int(touching.argmax())
            free = ~touching[begin:]
            end = begin + int(free.argmax()) if free.any() else len(touching)
            found.append(self.vertical(motion[end])[first] / self.drop["speed_m_s"])
        return statistics.mean(found)

    def run(self, part):
        numpy, step_s = self.numpy, self.setting["step_s"]
        motion, pressed = self.follow(part, int(self.drop["until_s"] / step_s))
        onset = pressed & ~numpy.vstack([numpy.zeros(pressed.shape[1], bool), pressed[:-1]])
        onsets = numpy.argwhere(onset)[:self.drop["touches"]]
        last = int(onsets[-1][0]) if len(onsets) else 0
        # A change is from before to after a time in which a corner presses, less the effect of gravity meanwhile.
        edges = numpy.flatnonzero(numpy.diff(numpy.r_[0, pressed.any(1), 0]))
        peaks = numpy.zeros(len(self.corners))
        for start, stop in zip(edges[::2], edges[1::2]):
            if start > last:
                break
            before, after = max(start - 1, 0), min(stop, len(motion) - 1)
            change = self.vertical(motion[after]) - self.vertical(motion[before]) + self.drop["gravity_m_s2"] * step_s * (after - before)
            peaks = numpy.maximum(peaks, abs(change))
        return {"corners": [int(c) for _, c in onsets], "times_s": [float(n * step_s) for n, _ in onsets], "peaks_m_s": peaks.tolist()}


class Siconos:
    """Simulates by events a linear Lagrangian system: the height of the center, the rises of half the length and width."""

    def __init__(self, _, drop):
        import numpy
        import siconos.kernel

        self.numpy, self.tool, self.drop = numpy, siconos.kernel, drop
        self.rows = numpy.array([[1.0, *signs[:2]] for signs in names("plate").values()])

    def run(self, _):
        numpy, sk, drop = self.numpy, self.tool, self.drop
        gaps = [5e-4 * gap for gap in drop["gaps_mm"]]
        half = [abs(c) for c in drop["corners_m"][0]]
        mass = numpy.diag([1.0, (drop["gyration_m"][1] / half[0]) ** 2, (drop["gyration_m"][0] / half[1]) ** 2])
        body = sk.LagrangianLinearTIDS([sum(gaps), *gaps], [-drop["speed_m_s"], 0.0, 0.0], mass)
        model = sk.NonSmoothDynamicalSystem(0.0, drop["until_s"])
        model.insertDynamicalSystem(body)
        law = sk.NewtonImpactNSL(drop["e"])
        for row in self.rows:
            model.link(sk.Interaction(law, sk.LagrangianLinearTIR(row[None, :])), body)
        simulation = sk.EventDriven(model, sk.TimeDiscretisation(0.0, drop["until_s"]))
        simulation.insertIntegrator(sk.LsodarOSI())
        simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_IMPACT)
        simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_SMOOTH_ACC)
        simulation.setToleranceED(1e-16)
        answer, peaks, before = {"corners": [], "times_s": []}, numpy.zeros(4), body.velocity().copy()
        while simulation.hasNextEvent():
            simulation.advanceToEvent()
            simulation.processEvents()
            change = self.rows @ (body.velocity() - before)
            if change.any():
                # The corner that is struck changes most, whatever the radii of gyration.
                answer["corners"].append(int(change.argmax()))
                answer["times_s"].append(float(simulation.startingTime()))
                peaks, before = numpy.maximum(peaks, abs(change)), body.velocity().copy()
        return {**answer, "peaks_m_s": peaks.tolist()}


def answer(tool):
    """Returns each drop from each start, and the least time of the first."""
    given, rows = json.load(sys.stdin), []
    for drop in given["drops"]:
        model = tool(given["setting"], drop)
        starts = [model.run(part) for part in given["lifted_steps"]]
        rows.append({"starts": starts, "ms": least_ms(lambda: model.run(0.0), given["timed_s"])})
    print(json.dumps({"drops": rows}))


def judged(drop, starts):
    """Returns order and errors: the largest of all starts."""
    order, truth = list(names(drop["kind"])), drop["truth"]
    joined = lambda corners: ("" if drop["kind"] == "plate" else " ").join(order[c] for c in corners)
    right = [start["corners"] == truth["corners"] for start in starts]
    # Least number of right touches before the order departs.
    agree = lambda a, b: next((i for i, (p, q) in enumerate(itertools.zip_longest(a, b)) if p != q), len(b))
    peak = max(truth["peaks_m_s"])
    peaks = max(abs(p - q) / peak for start in starts for p, q in zip(start["peaks_m_s"], truth["peaks_m_s"]))
    since = lambda answer, k: answer["times_s"][k] - answer["times_s"][0]
    times = [abs(since(start, k) / since(truth, k) - 1) for start in starts for k in (1, 2) if k < len(start["times_s"])]
    worst = min(starts, key=lambda start: agree(start["corners"], truth["corners"]))
    row = {"case": drop["case"], "gaps_mm": drop.get("gaps_mm"), "e": drop["e"], "order": joined(truth["corners"]),
           "right": sum(right), "starts": len(starts), "agrees_for": agree(worst["corners"], truth["corners"]),
           "peak_error": peaks, "time_error": max(times, default=None)}
    return row if all(right) else {**row, "found": joined(worst["corners"])}


class Search:
    """Varies one setting after the other, the step last, until none improves; each kind of body alone."""

    def __init__(self, command, given, drops, options):
        self.command, self.given, self.drops, self.options, self.tried = command, given, drops, options, {}

    def judge(self, setting, timed_s=0.0):
        import run

        given = json.dumps({"setting": setting, "drops": self.drops, "lifted_steps": self.given, "timed_s": timed_s})
        # It runs in a folder of its own: MuJoCo writes a log in the current one.
        found = json.loads(run.output(self.command, input=given, cwd=run.HOME))["drops"]
        return [{**judged(drop, answer["starts"]), "ms": answer["ms"]} for drop, answer in zip(self.drops, found)]

    def score(self, setting):
        key = tuple(setting.values())
        if key not in self.tried:
            rows = self.judge(setting)
            wrong = sum(row["starts"] - row["right"] for row in rows)
            # Scores count to one digit: of equal settings the first is taken.
            errors = [row["peak_error"] for row in rows]
            error, largest = (float(f"{value:.0e}") for value in (statistics.median(errors), max(errors)))
            self.tried[key] = wrong, error, largest
            print(f"  {wrong} wrong, {error:.0e}, {largest:.0e}: {setting}", file=sys.stderr, flush=True)
        return self.tried[key]

    def best(self):
        best, before = {name: values[0] for name, values in self.options.items()}, None
        while best != before:
            before = best
            for name, values in self.options.items():
                best = min(({**best, name: value} for value in values), key=self.score)
        return best


def clatter_rows(kind, drops, ours):
    own = [(drop, *row) for drop, row in zip(drops, ours) if drop["kind"] == kind]
    flights = [f"clatter simulate, contact {micro} µs" for micro in (1, 10)]
    exact, slow = ("clatter impacts", flights[0]) if kind == "plate" else flights
    yield {"tool": exact, "kind": kind, "drops": [{**judged(drop, [drop["truth"]]), "ms": ms} for drop, ms, _, _ in own]}
    yield {"tool": slow, "kind": kind, "drops": [{**judged(drop, [answer]), "ms": ms} for drop, _, answer, ms in own]}


def tool_row(tool, kind, drops):
    import run

    options = {name: ALONE[kind].get(name, values) for name, values in SETTINGS[tool].items()}
    command = {
        "mujoco": [run.PYTHON, os.path.abspath(__file__), "answer", "mujoco"],
        "rapier": [os.path.join(run.HOME, "rapier", "release", "solids")],
        "siconos": [run.DEBIAN_PYTHON, "-sE", os.path.abspath(__file__), "answer", "siconos"],
    }
    starts = LIFTED_STEPS if options else [0.0]
    search = Search(command[tool], starts, [drop for drop in drops if drop["kind"] == kind], options)
    best = search.best()
    score = ("wrong", "peak_error", "largest_peak_error")
    tried = [{"setting": dict(zip(options, key)), **dict(zip(score, found))} for key, found in search.tried.items()]
    return {"tool": NAMES[tool], "version": version(tool), "kind": kind, "setting": best, "drops": search.judge(best, 0.3), "tried": tried}


def main(tools):
    import run

    command = os.environ.get("CLATTER")
    skipped, load, rows = {}, os.getloadavg()[0], []
    os.makedirs(run.HOME, exist_ok=True)
    if not command:
        command = os.path.join(run.TARGET, "release", "clatter")
        run.build_ours(["-p", "clatter-cli", "--bin", "clatter"])
    if "mujoco" in tools:
        run.environment(skipped, ["mujoco"])
    manifest = os.path.join(HERE, "rapier", "Cargo.toml")
    build = ["cargo", "build", "--release", "--quiet", "--locked", "--manifest-path", manifest, "--bin", "solids"]
    if "rapier" in tools and subprocess.run(build, env=dict(os.environ, CARGO_TARGET_DIR=os.path.join(run.HOME, "rapier"))).returncode:
        skipped["rapier"] = "cargo could not build peers/rapier"
    siconos = [run.DEBIAN_PYTHON, "-sE", "-c", "import siconos.kernel"]
    if "siconos" in tools and subprocess.run(siconos, stderr=subprocess.DEVNULL).returncode:
        skipped["siconos"] = "Debian's package python3-siconos is not installed"
    if skipped:
        sys.exit(f"left out: {skipped}")
    drops, ours = scene(command)
    for kind in ("plate", "box"):
        rows += clatter_rows(kind, drops, ours)
        for tool in tools:
            if (tool, kind) != ("siconos", "box"):
                run.say(f"{NAMES[tool]}, {kind}")
                rows.append(tool_row(tool, kind, drops))
    path = os.path.join(HERE, "solids.json")
    if len(tools) < len(SETTINGS) and os.path.exists(path):
        with open(path) as file:
            rows += [row for row in json.load(file)["rows"] if row["tool"] in NAMES.values() and row["tool"] not in map(NAMES.get, tools)]
    order = list(NAMES.values())
    rows.sort(key=lambda row: (row["kind"] == "box", order.index(row["tool"]) if row["tool"] in order else -1))
    show(rows)
    write(path, {"date": run.today(), "machine": run.machine(load)}, rows)


def write(path, head, rows):
    """Writes one drop or setting a line."""
    compact = lambda value: json.dumps(value, ensure_ascii=False)
    lines = []
    for row in rows:
        lists = [f'"{name}": [\n' + ",\n".join(map(compact, row[name])) + "\n]" for name in ("drops", "tried") if name in row]
        first = {name: value for name, value in row.items() if name not in ("drops", "tried")}
        lines.append(compact(first)[:-1] + ",\n" + ",\n".join(lists) + "}")
    with open(path + ".part", "w") as file:
        file.write(compact(head)[:-1] + ', "rows": [\n' + ",\n".join(lines) + "\n]}\n")
    os.replace(path + ".part", path)


def version(tool):
    import run

    if tool == "rapier":
        return "0.36.0"
    if tool == "siconos":
        return run.output(["dpkg-query", "--show", "--showformat=${Version}", "python3-siconos"])
    return run.PACKAGES["mujoco"][0].split("==")[1]


def show(rows):
    for row in rows:
        print(f"\n{row['tool']}, {row['kind']}: {row.get('setting', '')}\n")
        for drop in row["drops"]:
            order = f"{drop['right']}/{drop['starts']} {drop['order']:12} {drop.get('found', ''):14}"
            time = f"{drop['time_error']:.0e}" if drop["time_error"] is not None else ""
            ms = f"{drop['ms']:>9.3g} ms" if drop["ms"] else ""
            print(f"{drop['case']:16} {str(drop['gaps_mm'] or ''):16} e {drop['e']}  {order} {drop['peak_error']:.0e} {time} {ms}")


TOOLS = {"mujoco": Mujoco, "siconos": Siconos}
if __name__ == "__main__":
    if sys.argv[1:2] == ["answer"]:
        answer(TOOLS[sys.argv[2]])
    elif set(sys.argv[1:]) <= set(SETTINGS):
        main(sys.argv[1:] or list(SETTINGS))
    else:
        sys.exit(__doc__)
