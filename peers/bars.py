"""The four bars by one tool a call: scenes as JSON from standard input, impacts, largest shock and time as JSON to standard output.

Every scene begins as end a touches. The time is the best of at least five runs and 0.3 s, from the numbers of the scene to
the count and the largest shock. Tools that step through time are told when the last impact is due and stop soon after it.
"""
import importlib.metadata, json, math, subprocess, sys, time


def best(run):
    """Returns the answer and the least time in ms."""
    begin, least, runs = time.perf_counter(), math.inf, 0
    while runs < 5 or time.perf_counter() - begin < 0.3:
        start = time.perf_counter()
        answer = run()
        least = min(least, time.perf_counter() - start)
        runs += 1
    return answer, 1e3 * least


def python_loop(scene, bar):
    """Runs Eq. 1 of the paper: v <- A v where the ends take turns, until the next end moves up."""
    q, e, v0 = bar["q"], bar["e"], scene["speed_m_s"]

    def run():
        matrix = ((-e, 0.0), (q * (1 + e), 1.0))
        v, impacts, largest = [-v0, -v0], 0, 0.0
        while v[0] < 0:
            after = [row[0] * v[0] + row[1] * v[1] for row in matrix]
            largest = max(largest, abs(after[0] - v[0]), abs(after[1] - v[1]))
            v, impacts = [after[1], after[0]], impacts + 1
        return impacts, largest

    return run


def scipy_events(scene, bar):
    """Follows the free flight of both ends by solve_ivp, stopped at each touch by an event, restarted from the paper's matrix."""
    from scipy.integrate import solve_ivp

    q, e, v0 = bar["q"], bar["e"], scene["speed_m_s"]

    def touch(end):
        def height(_, y):
            return y[end]

        height.terminal, height.direction = True, -1
        return height

    events = [touch(0), touch(1)]

    def run():
        y, end, left = [0.0, scene["height_gap_m"], -v0, -v0], 0, bar["until_s"]
        impacts, largest = 0, 0.0
        while True:
            approach = y[2 + end]
            y[2 + end], y[3 - end] = -e * approach, y[3 - end] + q * (1 + e) * approach
            impacts, largest = impacts + 1, max(largest, (1 + e) * abs(approach), abs(q * (1 + e) * approach))
            flight = solve_ivp(lambda _, y: [y[2], y[3], 0.0, 0.0], [0.0, left], y, events=events, rtol=1e-12, atol=1e-15)
            if flight.status != 1:
                return impacts, largest
            end = 0 if flight.t_events[0].size else 1
            y, left = flight.y[:, -1].tolist(), left - flight.t[-1]
            y[end] = 0.0

    return run


def siconos_events(scene, bar):
    """Simulates by events a linear Lagrangian system in the height of the center and the turn times L."""
    import numpy as np
    import siconos.kernel as sk

    gap, v0 = scene["height_gap_m"], scene["speed_m_s"]
    mass = np.diag([1.0, (bar["gyration_m"] / scene["half_length_m"]) ** 2])

    def run():
        body = sk.LagrangianLinearTIDS([gap / 2, gap / 2], [-v0, 0.0], mass)
        model = sk.NonSmoothDynamicalSystem(0.0, bar["until_s"])
        model.insertDynamicalSystem(body)
        law = sk.NewtonImpactNSL(bar["e"])
        for side in (-1.0, 1.0):
            model.link(sk.Interaction(law, sk.LagrangianLinearTIR(np.array([[1.0, side]]))), body)
        simulation = sk.EventDriven(model, sk.TimeDiscretisation(0.0, bar["until_s"]))
        simulation.insertIntegrator(sk.LsodarOSI())
        simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_IMPACT)
        simulation.insertNonSmoothProblem(sk.LCP(), sk.SICONOS_OSNSP_ED_SMOOTH_ACC)
        simulation.setToleranceED(1e-16)
        impacts, largest, before = 0, 0.0, body.velocity().copy()
        while simulation.hasNextEvent():
            simulation.advanceToEvent()
            simulation.processEvents()
            jump = body.velocity() - before
            if jump.any():
                impacts, largest = impacts + 1, max(largest, abs(jump[0]) + abs(jump[1]))
                before = body.velocity().copy()
        return impacts, largest

    return run


STEP_S = 1e-6
# Time constant of the contact spring, five steps: the shortest with which the largest shocks stay within 3 %.
MUJOCO_TIME_CONSTANT_S = 5e-6


def mujoco_contact(scene, bar, lifted_m=0.0):
    """Simulates one body on a slide and a hinge, with a small sphere at each end; the damping ratio is fitted until the first strike
    gives the restitution e."""
    import mujoco
    import numpy as np
    from mujoco import rollout

    length, v0, tilt = scene["half_length_m"], scene["speed_m_s"], math.radians(scene["tilt_deg"])
    inertia = bar["gyration_m"] ** 2
    full = mujoco.mjtState.mjSTATE_FULLPHYSICS

    def built(damping_ratio):
        contact = f'condim="1" solref="{MUJOCO_TIME_CONSTANT_S} {damping_ratio}" solimp="0.99 0.99 0.001"'
        ends = "".join(
            f'<geom type="sphere" size="0.001" pos="{x} 0 0" {contact}/><site name="{x}" pos="{x} 0 0" size="0.002"/>'
            for x in (-length, length))
        model = mujoco.MjModel.from_xml_string(f"""<mujoco>
            <option timestep="{STEP_S}" gravity="0 0 0" tolerance="0" jacobian="dense"><flag refsafe="disable"/></option>
            <worldbody><geom type="plane" size="1 1 1" pos="0 0 -0.001" {contact}/>
            <body><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 -1 0"/>
            <inertial pos="0 0 0" mass="1" diaginertia="{inertia} {inertia} {inertia}"/>{ends}</body></worldbody>
            <sensor><touch site="{-length}"/><touch site="{length}"/></sensor></mujoco>""")
        data = mujoco.MjData(model)
        data.qpos[:], data.qvel[:] = [length * math.sin(tilt) + lifted_m, tilt], [-v0, 0.0]
        mujoco.mj_forward(model, data)
        state = np.empty(mujoco.mj_stateSize(model, full))
        mujoco.mj_getState(model, data, state, full)
        return model, data, state

    def follow(parts, steps):
        """Returns angle, velocity and spin, and the force at each end, step by step."""
        model, data, state = parts
        states, forces = rollout.rollout(model, data, state, nstep=steps)
        return np.vstack([state, states[0]])[:, 2:5], np.vstack([forces[0], np.zeros(2)])

    def restitution(damping_ratio):
        motion, _ = follow(built(damping_ratio), 200)
        return (motion[-1, 1] - length * math.cos(motion[-1, 0]) * motion[-1, 2]) / v0

    low, high = 0.02, 6.0
    for _ in range(40):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if restitution(middle) > bar["e"] else (low, middle)
    parts = built(middle)

    def run():
        motion, forces = follow(parts, int(bar["until_s"] / STEP_S))
        pressed = forces > 0
        impacts = int((pressed[1:] & ~pressed[:-1]).sum() + pressed[0].sum())
        # A shock is the change from before to after a time in which an end presses. A force reads one step late.
        edges = np.flatnonzero(np.diff(np.r_[0, pressed.any(1), 0]))
        largest = 0.0
        for start, stop in zip(edges[::2], edges[1::2]):
            before, after = motion[max(start - 2, 0)], motion[min(stop, len(motion) - 1)]
            arm = length * math.cos(after[0])
            largest = max(largest, abs(after[1] - before[1]) + arm * abs(after[2] - before[2]))
        return impacts, largest

    return run


TOOLS = {"python": python_loop, "scipy": scipy_events, "siconos": siconos_events, "mujoco": mujoco_contact}


def version(tool):
    if tool == "python":
        return sys.version.split()[0]
    if tool == "siconos":
        query = ["dpkg-query", "--show", "--showformat=${Version}", "python3-siconos"]
        return subprocess.run(query, capture_output=True, text=True).stdout
    return importlib.metadata.version(tool)


def main(tool):
    scene = json.load(sys.stdin)
    rows = []
    for bar in scene["bars"]:
        make = TOOLS[tool]
        (impacts, largest), ms = best(make(scene, bar))
        row = {"impacts": impacts, "largest_m_s": largest, "ms": ms}
        if tool == "mujoco":
            travel = STEP_S * scene["speed_m_s"]
            lifted = [make(scene, bar, part * travel)()[0] for part in scene["lifted_steps"]]
            row["impacts_lifted"] = [min(lifted), max(lifted)]
        rows.append(row)
        print(f"  bar ({bar['q']}, {bar['e']})", file=sys.stderr, flush=True)
    print(json.dumps({"version": version(tool), "bars": rows}))


if __name__ == "__main__":
    main(sys.argv[1])
