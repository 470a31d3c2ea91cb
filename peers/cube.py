#!/usr/bin/env python3
"""Other tools on the measured tosses of a cube: python3 peers/cube.py (network the first time, some five minutes)

Every tool gets the cube as it comes to its first touch, as `cargo run --release -p clatter-studies --example cube` tells it, and says
where it is at each sample after. Its settings are those with the least error on the training half: the mean over the first twelve
samples of how far corners are off (root mean square over the eight), the median of all tosses; searched one setting after the other
until none improves, from each kind of contact. In steps of 0.1 ms a corner that just touches presses from the first step or from the
next, by a rounding: scores move by 0.1 mm with that. Writes the paths of the other half to peers/cube.json: height in 1e-5 m and the vertical in axes of the cube in 1e-4.
"""
import importlib.metadata, itertools, json, math, os, statistics, subprocess, sys

HERE = os.path.dirname(os.path.abspath(__file__))
FIRST = 12
STEP_S = 1e-4
MASS_KG = 0.37
BALL_M = 0.002


def vertical(w, x, y, z):
    return 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)


def rotated(turned, vector, inverse=False):
    """Rotates a vector by a unit quaternion."""
    w, *axis = turned
    if inverse:
        axis = [-part for part in axis]
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    twice = [2 * part for part in cross(axis, vector)]
    return [v + w * t + c for v, t, c in zip(vector, twice, cross(axis, twice))]


class Mujoco:
    """Simulates boxes, or balls at the corners; the softness of contacts by a time and a damping ratio, as their documentation advises."""

    name = "MuJoCo"
    settings = {
        "shape": ["box", "balls"],
        "time": [2e-4, 5e-4, 1e-3, 1.5e-3, 2e-3, 3e-3, 4e-3, 6e-3],
        "damping": [0.1, 0.2, 0.3, 0.35, 0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 1.0],
        "friction": [0.0, 0.05, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3],
    }
    starts = ["shape", "time"]
    start = {"shape": "box", "time": 2e-3, "damping": 0.4, "friction": 0.16}

    def __init__(self, cube, setting):
        import mujoco

        half, inertia = cube["half_m"], MASS_KG * cube["gyration_m"] ** 2
        if setting["shape"] == "box":
            ground, shapes = 0.0, f'<geom type="box" size="{half} {half} {half}"/>'
        else:
            ground = -BALL_M
            corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
            shapes = "".join(f'<geom type="sphere" size="{BALL_M}" pos="{x} {y} {z}"/>' for x, y, z in corners)
        self.tool = mujoco
        self.model = mujoco.MjModel.from_xml_string(f"""<mujoco>
            <option timestep="{STEP_S}" gravity="0 0 {-cube['gravity_m_s2']}" cone="elliptic" impratio="10"/>
            <default><geom solref="{setting['time']} {setting['damping']}" friction="{setting['friction']} 0 0"/></default>
            <worldbody>
              <geom type="plane" size="5 5 1" pos="0 0 {ground}"/>
              <body><freejoint/><inertial pos="0 0 0" mass="{MASS_KG}" diaginertia="{inertia} {inertia} {inertia}"/>{shapes}</body>
            </worldbody></mujoco>""")
        self.data = mujoco.MjData(self.model)

    def path(self, toss):
        model, data = self.model, self.data
        self.tool.mj_resetData(model, data)
        data.qpos[:] = [0.0, 0.0, toss["height_m"], *toss["turned"]]
        data.qvel[:] = [*toss["velocity_m_s"], *rotated(toss["turned"], toss["spin_rad_s"], inverse=True)]
        poses, done = [], 0
        for time in toss["times_s"]:
            steps = round(time / STEP_S)
            if steps > done:
                self.tool.mj_step(model, data, steps - done)
                done = steps
            poses.append([data.qpos[2], *vertical(*data.qpos[3:7])])
        return poses


class Drake:
    """Simulates balls at the corners, because their point contact sees one point of a box alone; Hunt and Crossley's law, or the linear dissipation of SAP."""

    name = "Drake"
    settings = {
        "contact": ["lagged", "similar", "tamsi", "sap"],
        "stiffness": [1e3, 3e3, 1e4, 2e4, 3e4, 1e5, 3e5, 1e6],
        "dissipation": [0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0],
        "relaxation": [1e-4, 3e-4, 1e-3, 3e-3],
        "friction": [0.0, 0.05, 0.1, 0.13, 0.16, 0.2, 0.25, 0.3],
    }
    starts = ["contact"]
    start = {"contact": "lagged", "stiffness": 2e4, "dissipation": 1.0, "relaxation": 1e-3, "friction": 0.16}

    def __init__(self, cube, setting):
        from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
        from pydrake.math import RigidTransform
        from pydrake.multibody.plant import AddMultibodyPlant, CoulombFriction, MultibodyPlantConfig
        from pydrake.multibody.tree import SpatialInertia, UnitInertia
        from pydrake.systems.analysis import Simulator
        from pydrake.systems.framework import DiagramBuilder

        builder = DiagramBuilder()
        config = MultibodyPlantConfig(time_step=STEP_S, contact_model="point", discrete_contact_approximation=setting["contact"])
        plant, _ = AddMultibodyPlant(config, builder)
        plant.mutable_gravity_field().set_gravity_vector([0, 0, -cube["gravity_m_s2"]])
        square = cube["gyration_m"] ** 2
        body = plant.AddRigidBody("cube", SpatialInertia(MASS_KG, [0, 0, 0], UnitInertia(square, square, square)))
        friction = CoulombFriction(setting["friction"], setting["friction"])

        def surface(stiffness):
            # The stiffnesses act in series: a ground that is much stiffer leaves the stiffness to the cube.
            properties = ProximityProperties()
            AddContactMaterial(dissipation=setting["dissipation"], point_stiffness=stiffness, friction=friction, properties=properties)
            properties.AddProperty("material", "relaxation_time", setting["relaxation"])
            return properties

        half = cube["half_m"]
        corners = [(x, y, z) for x in (-half, half) for y in (-half, half) for z in (-half, half)]
        for i, corner in enumerate(corners):
            plant.RegisterCollisionGeometry(body, RigidTransform(corner), Sphere(BALL_M), f"corner{i}", surface(setting["stiffness"]))
        ground = RigidTransform([0, 0, -BALL_M])
        plant.RegisterCollisionGeometry(plant.world_body(), ground, HalfSpace(), "ground", surface(1e3 * setting["stiffness"]))
        plant.Finalize()
        self.plant, self.body, self.simulator = plant, body, Simulator(builder.Build())
        self.context = plant.GetMyMutableContextFromRoot(self.simulator.get_mutable_context())

    def path(self, toss):
        from pydrake.common.eigen_geometry import Quaternion
        from pydrake.math import RigidTransform, RotationMatrix
        from pydrake.multibody.math import SpatialVelocity

        root = self.simulator.get_mutable_context()
        root.SetTime(0.0)
        pose = RigidTransform(RotationMatrix(Quaternion(toss["turned"])), [0, 0, toss["height_m"]])
        self.plant.SetFreeBodyPose(self.context, self.body, pose)
        velocity = SpatialVelocity(toss["spin_rad_s"], toss["velocity_m_s"])
        self.plant.SetFreeBodySpatialVelocity(context=self.context, body=self.body, V_JpJc=velocity)
        self.simulator.Initialize()
        poses = []
        for time in toss["times_s"]:
            self.simulator.AdvanceTo(time)
            pose = self.plant.EvalBodyPoseInWorld(self.context, self.body)
            poses.append([pose.translation()[2], *pose.rotation().matrix()[2]])
        return poses


def score(tool, cube, setting):
    """Returns the error in m."""
    model = tool(cube, setting)

    def off(toss):
        short = dict(toss, times_s=toss["times_s"][:FIRST])
        pairs = list(zip(toss["measured"], model.path(short)))
        square = lambda a, b: (a[0] - b[0]) ** 2 + cube["half_m"] ** 2 * sum((p - q) ** 2 for p, q in zip(a[1:], b[1:]))
        return sum(math.sqrt(square(a, b)) for a, b in pairs) / len(pairs)

    return statistics.median(off(toss) for toss in cube["tosses"] if toss["training"])


def fitted(tool, cube, settings):
    """Varies one setting after the other from each start, until none improves; returns the setting, its score, and the number of trials."""
    scores = {}

    def tried(setting):
        key = tuple(setting.values())
        if key not in scores:
            scores[key] = score(tool, cube, setting)
        return scores[key]

    for values in itertools.product(*(settings[name] for name in tool.starts)):
        alone = {name: values[0] for name, values in settings.items() if len(values) == 1}
        best, least = {**tool.start, **alone, **dict(zip(tool.starts, values))}, math.inf
        while tried(best) < least:
            least = tried(best)
            for name in [name for name in settings if name not in tool.starts]:
                best = min(({**best, name: value} for value in settings[name]), key=tried)
        print(f"{tool.name}: {1e3 * tried(best):.2f} mm by {best}", file=sys.stderr, flush=True)
    key = min(scores, key=scores.get)
    return dict(zip(settings, key)), scores[key], len(scores)


def answer(tool):
    """Returns the paths by the best settings, and by the best ones without friction."""
    cube = json.load(sys.stdin)
    rounded = lambda pose: [round(1e5 * pose[0]), *(round(1e4 * part) for part in pose[1:])]
    rows = []
    for settings in (tool.settings, {**tool.settings, "friction": [0.0]}):
        setting, least, tried = fitted(tool, cube, settings)
        model = tool(cube, setting)
        paths = [{"toss": toss["toss"], "poses": [rounded(pose) for pose in model.path(toss)]} for toss in cube["tosses"] if not toss["training"]]
        version = importlib.metadata.version(tool.name.lower())
        rows.append({"tool": tool.name, "version": version, "setting": setting, "tried": tried, "training_mm": 1e3 * least, "paths": paths})
    print(json.dumps(rows))


def main():
    import run

    run.PACKAGES["drake"] = ["drake==1.51.1"]
    skipped = {}
    os.makedirs(run.HOME, exist_ok=True)
    run.environment(skipped, ["mujoco", "drake"])
    if skipped:
        sys.exit(f"left out: {skipped}")
    command = ["cargo", "run", "--release", "--quiet", "-p", "clatter-studies", "--example", "cube"]
    touches = run.output(command, cwd=run.ROOT)
    rows = [row for tool in TOOLS for row in json.loads(run.output([run.PYTHON, __file__, tool], input=touches))]
    path = lambda toss: json.dumps(toss, separators=(",", ":"))
    lines = [json.dumps(dict(row, paths=None))[:-5] + "[\n" + ",\n".join(map(path, row["paths"])) + "]}" for row in rows]
    beside = os.path.join(HERE, "cube.json.part")
    cube = {name: value for name, value in json.loads(touches).items() if name != "tosses"}
    with open(beside, "w") as file:
        file.write(f'{{"date": "{run.today()}", "cube": {json.dumps(cube)}, "rows": [\n' + ",\n".join(lines) + "\n]}\n")
    os.replace(beside, os.path.join(HERE, "cube.json"))


TOOLS = {"mujoco": Mujoco, "drake": Drake}
if __name__ == "__main__":
    answer(TOOLS[sys.argv[1]]) if sys.argv[1:] else main()
