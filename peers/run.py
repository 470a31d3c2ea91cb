#!/usr/bin/env python3
"""clatter beside what one would use instead: python3 peers/run.py (network the first time, about ten minutes)
or python3 peers/run.py spectra, or records: those alone, the rest of peers/results.json stays as it was measured (a minute)

1. Impacts of the four bars of Table 1: a plain loop, SciPy, Siconos, Rapier, MuJoCo, each at the best setting found.
2. Shock response spectra: pyyeti and endaq.
3. A map of a million bars: numpy.
4. Measured records: reading a file of a million rows (polars), its spectra and those of band-limited tones (pyyeti, endaq).

Makes its own environment in target/peers, takes the best of three rounds in which all tools take turns, prints tables and
writes peers/results.json. Siconos is Debian's package (apt install python3-siconos). What is missing is named and left out.
"""
import datetime, json, math, os, platform, subprocess, sys, time, venv
from fractions import Fraction

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(HERE)
HOME = os.path.join(ROOT, "target", "peers")
TARGET = os.path.abspath(os.environ.get("CARGO_TARGET_DIR", os.path.join(ROOT, "target")))
PYTHON = os.path.join(HOME, "venv", "bin", "python")
DEBIAN_PYTHON = "/usr/bin/python3"
RAPIER = os.path.join(HOME, "rapier", "release", "clatter-peers-rapier")
ROUNDS = 3
# Packages of each tool; all need numpy.
NUMPY = "numpy==2.4.6"
PACKAGES = {
    "numpy": [], "scipy": ["scipy==1.17.1"], "mujoco": ["mujoco==4.0.0"],
    "pyyeti": ["pyyeti==1.4.7", "scipy==1.17.1", "pandas==3.1.1"], "endaq": ["endaq==1.5.3", "scipy==1.17.1", "pandas==3.1.1"],
    "polars": ["polars==2.1.0"],
}
# Each tool has one thread, and leaves no files of Python in the tree.
VARIABLES = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", PYTHONDONTWRITEBYTECODE="1", PYTHONWARNINGS="ignore")
DESIGNS = [(0.5, 0.3), (0.73, 0.2), (0.67, 0.15), (0.57, 0.1)]
HALF_LENGTH_M, SPEED_M_S, TILT_DEG = 0.07, 2.0, 1.0
# Tools that step through time also run from starts lifted by parts of a step's travel: their counts depend on it.
LIFTED_STEPS = [k / 8 for k in range(1, 8)]
OURS = {
    "closed": ("clatter, closed form", "count and largest shock"),
    "train": ("clatter, train", "every impact with its time and shocks"),
    "finite": ("clatter, real tilt", "every impact, tilt of 1° as it is"),
}
BEGUN = time.monotonic()


def version():
    """Returns the version of clatter, from the workspace."""
    with open(os.path.join(ROOT, "Cargo.toml")) as manifest:
        return next(line.split('"')[1] for line in manifest if line.startswith("version"))


def say(text):
    print(f"[{time.monotonic() - BEGUN:5.0f} s] {text}", file=sys.stderr, flush=True)


def output(command, **more):
    """Returns the output of a command; its own progress goes to the terminal."""
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, env=VARIABLES, **more).stdout


def scene():
    """Returns the four bars, with the truth by rational arithmetic from a_{n+1} = q(1 + e) a_n - e a_{n-1}."""
    gap = 2 * HALF_LENGTH_M * math.sin(math.radians(TILT_DEG))
    bars, truth = [], []
    for q, e in DESIGNS:
        turn, e_exact = Fraction(q) * (1 + Fraction(e)), Fraction(e)
        a, coming, b, b_coming, impacts, largest = Fraction(-1), -turn - 1, Fraction(0), Fraction(1), 1, Fraction(1)
        while coming < 0:
            a, coming = coming, turn * coming - e_exact * a
            b, b_coming = b_coming, turn * b_coming - e_exact * b
            impacts, largest = impacts + 1, max(largest, -a)
        due = gap / SPEED_M_S * float(b / -a)
        gyration = HALF_LENGTH_M * math.sqrt((1 - q) / (1 + q))
        bars.append({"q": q, "e": e, "gyration_m": gyration, "until_s": 1.05 * due + 1e-5})
        truth.append((impacts, SPEED_M_S * float((1 + e_exact) * largest)))
    given = {"half_length_m": HALF_LENGTH_M, "speed_m_s": SPEED_M_S, "tilt_deg": TILT_DEG, "height_gap_m": gap}
    return {**given, "lifted_steps": LIFTED_STEPS, "bars": bars}, truth


def environment(skipped, tools):
    """Installs the packages of each of these tools; a tool without them is skipped."""
    if not os.path.exists(PYTHON):
        say("making a Python environment in target/peers/venv")
        venv.create(os.path.join(HOME, "venv"), with_pip=True)
    for tool in tools:
        packages = PACKAGES[tool]
        stamp = os.path.join(HOME, f"{tool}.installed")
        wanted = " ".join([NUMPY, *packages])
        if os.path.exists(stamp) and open(stamp).read() == wanted:
            continue
        say(f"installing {wanted}")
        pip = [PYTHON, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *wanted.split()]
        if subprocess.run(pip, stdout=sys.stderr).returncode:
            skipped[tool] = f"pip could not install {wanted}"
        else:
            with open(stamp, "w") as file:
                file.write(wanted)


def build_ours(targets):
    say("building clatter")
    subprocess.run(["cargo", "build", "--release", "--quiet", *targets], cwd=ROOT, check=True)


def build(skipped):
    """Builds our programs, which must succeed; Rapier is skipped if it does not."""
    build_ours(["-p", "clatter", "-p", "clatter-shock", "-p", "clatter-cli", "-p", "clatter-record",
                "--example", "bars", "--example", "peers", "--example", "records", "--bin", "clatter"])
    say("building Rapier")
    manifest = os.path.join(HERE, "rapier", "Cargo.toml")
    command = ["cargo", "build", "--release", "--quiet", "--locked", "--manifest-path", manifest]
    if subprocess.run(command, env=dict(os.environ, CARGO_TARGET_DIR=os.path.join(HOME, "rapier"))).returncode:
        skipped["rapier"] = "cargo could not build peers/rapier"
    siconos = [DEBIAN_PYTHON, "-sE", "-c", "import siconos.kernel"]
    if not os.path.exists(DEBIAN_PYTHON) or subprocess.run(siconos, stderr=subprocess.DEVNULL).returncode:
        skipped["siconos"] = "Debian's package python3-siconos is not installed"


def take_turns(tools, skipped):
    """Returns each tool's answer round by round; one that fails is skipped from then on."""
    answers = {}
    for turn in range(ROUNDS):
        for tool, (command, given) in tools.items():
            if tool in skipped:
                continue
            say(f"round {turn + 1} of {ROUNDS}: {tool}")
            try:
                answers.setdefault(tool, []).append(json.loads(output(command, input=given)))
            except (subprocess.CalledProcessError, OSError, ValueError) as error:
                skipped[tool] = f"it failed: {error}"
                answers.pop(tool, None)
    return answers


def bars_table(answers, truth):
    """Returns the rows of the four bars: counts of the first round, the least time of all."""
    rows = []

    def row(tool, setting, version, rounds):
        first = rounds[0]
        errors = [abs(bar["largest_m_s"] / largest - 1) for bar, (_, largest) in zip(first, truth)]
        rows.append({
            "tool": tool, "version": version, "setting": setting, "impacts": [bar["impacts"] for bar in first],
            "error": max(errors), "ms": [min(bars[i]["ms"] for bars in rounds) for i in range(len(DESIGNS))],
        })
        if "impacts_lifted" in first[0]:
            rows[-1]["impacts_lifted"] = [bar["impacts_lifted"] for bar in first]

    for key, (tool, setting) in OURS.items():
        row(tool, setting, version(), [answer[key] for answer in answers["clatter"]])
    for key, tool, setting in [
        ("python", "plain Python loop", "Eq. 1; no times"),
        ("scipy", "SciPy solve_ivp", "events at both ends, restarted; rtol 1e-12, atol 1e-15"),
        ("siconos", "Siconos", "event-driven, LsodarOSI, gap tolerance 1e-16"),
        ("rapier", "Rapier2D f64", "dt 1e-6 s, prediction 1e-5 m"),
        ("mujoco", "MuJoCo", "dt 1e-6 s, solref fitted to e, time constant 5e-6 s"),
    ]:
        if key in answers:
            rounds = answers[key]
            row(tool, setting, rounds[0]["version"], [answer["bars"] for answer in rounds])
    unit = rows[1]["ms"]
    for entry in rows:
        entry["ratio"] = [ms / one for ms, one in zip(entry["ms"], unit)]
    return rows


def spectra_table(answers):
    """Returns the rows of all tools, the least time of all rounds, with the ratio to ours at the same rate."""
    rows = []
    for tool in ("clatter spectra", "pyyeti", "endaq"):
        for same in zip(*answers.get(tool, [])):
            rows.append({**same[0], "ms": min(row["ms"] for row in same)})
    ours = {row["rate_hz"]: row["ms"] for row in rows if row["tool"] == "clatter, record"}
    for row in rows:
        row["ratio"] = row["ms"] / ours[row["rate_hz"]] if row["rate_hz"] in ours else None
    return rows


def maps_table(answers):
    """Returns our times in this process's own time and as a command, numpy with and without a file."""
    rows = [{"tool": "clatter, one thread", "ms": min(answer["map_ms"] for answer in answers["clatter"])}]
    difference = None
    if "numpy" in answers:
        least = {key: min(answer[key] for answer in answers["numpy"]) for key in ("process_ms", "numpy_ms", "numpy_saved_ms")}
        difference = answers["numpy"][0]["largest_difference"]
        rows += [
            {"tool": "numpy, whole arrays", "ms": least["numpy_ms"]},
            {"tool": "clatter map, whole process with its file", "ms": least["process_ms"]},
            {"tool": "numpy, computed and saved", "ms": least["numpy_saved_ms"]},
        ]
    for row in rows:
        row["ratio"] = row["ms"] / rows[0 if rows.index(row) < 2 else 2]["ms"]
    return {"points": 1_000_000, "rows": rows, "largest_difference": difference}


def records_table(answers):
    """Returns one row a tool: least times, errors of the first round."""
    rows = []
    for tool, name in (("clatter records", "clatter"), ("polars records", "polars"), ("pyyeti records", "pyyeti"), ("endaq records", "endaq")):
        rounds = answers.get(tool, [])
        if not rounds:
            continue
        row = {"tool": name, "errors": rounds[0].get("errors")}
        for key in ("reading_ms", "ms"):
            times = [answer[key] for answer in rounds if key in answer]
            row[key] = min(times) if times else None
        rows.append(row)
        if "linear_ms" in rounds[0]:
            rows.append({"tool": f"{name}, straight lines", "reading_ms": None, "ms": min(answer["linear_ms"] for answer in rounds),
                         "errors": rounds[0]["linear_errors"]})
    return rows


def machine(load):
    cpu = platform.processor() or platform.machine()
    if os.path.exists("/proc/cpuinfo"):
        names = [line.split(":", 1)[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")]
        cpu = names[0] if names else cpu
    return {"cpu": cpu, "cores": os.cpu_count(), "system": platform.system(), "load_before": load, "load_after": os.getloadavg()[0],
            "rustc": output(["rustc", "--version"]).split()[1], "python": platform.python_version()}


def show(results):
    def times(values):
        return " ".join(f"{v:>9.3g}" for v in values)

    print(f"\nImpacts on the four bars of Table 1 (true: {' '.join(map(str, results['bars']['impacts']))})\n")
    print(f"{'':24} {'impacts':16} {'lifted':26} {'error':>8}  {'ms a scene':39}  {'over the train of clatter':39}")
    for row in results["bars"]["rows"]:
        counts = " ".join(f"{n:>3}" for n in row["impacts"])
        lifted = " ".join(f"{low}-{high}" if low < high else str(low) for low, high in row.get("impacts_lifted", []))
        print(f"{row['tool']:24} {counts:16} {lifted:26} {row['error']:>8.0e}  {times(row['ms'])}  {times(row['ratio'])}")
    print("\nSpectra of eight half-sines, 200 frequencies: largest error, time, over that of clatter at the same rate\n")
    for row in results["spectra"]["rows"]:
        rate = f"{row['rate_hz'] // 1000} kHz" if row["rate_hz"] else "pulses"
        ratio = f"{row['ratio']:8.1f}" if row["ratio"] else ""
        print(f"{row['tool']:32} {rate:>8} {100 * row['error']:>9.3f} % {row['ms']:>9.2f} ms {ratio}")
    print("\nMap of the peak, 1000 x 1000 bars\n")
    for row in results["maps"]["rows"]:
        print(f"{row['tool']:42} {row['ms']:>8.2f} ms {row['ratio']:8.1f}")
    if "records" in results:
        show_records(results["records"])
    for tool, why in results["skipped"].items():
        print(f"\nleft out: {tool}: {why}")


def records_answer(answers, load):
    return {"date": today(), "machine": machine(load), "samples": 1_000_000, "samples_a_cycle": [20.0, 10.0, 6.0, 5.0, 4.0, 3.0, 2.5],
            "rows": records_table(answers)}


def show_records(records):
    print(f"\nA file of {records['samples']} rows, 200 spectra; errors at tones of {' '.join(map(str, records['samples_a_cycle']))} samples a cycle\n")
    for row in records["rows"]:
        times = [f"{row[key]:>9.1f} ms" if row[key] else f"{'':>12}" for key in ("reading_ms", "ms")]
        errors = " ".join(f"{100 * error:>8.2f}" for error in row["errors"] or [])
        print(f"{row['tool']:26} {times[0]} {times[1]}   {errors}{' %' if errors else ''}")


def main(parts):
    if parts not in ([], ["spectra"], ["records"]):
        sys.exit(__doc__)
    skipped, load = {}, os.getloadavg()[0]
    os.makedirs(HOME, exist_ok=True)
    script = lambda name: os.path.join(HERE, name)
    example = [os.path.join(TARGET, "release", "examples", "peers")]
    spectra = {
        "clatter spectra": ([PYTHON, script("spectra.py"), "clatter", *example], None),
        "pyyeti": ([PYTHON, script("spectra.py"), "pyyeti", *example], None),
        "endaq": ([PYTHON, script("spectra.py"), "endaq", *example], None),
    }
    record_command = os.path.join(TARGET, "release", "examples", "records")
    records = {f"{tool} records": ([PYTHON, script("records.py"), tool, HOME, record_command], None) for tool in ("clatter", "polars", "pyyeti", "endaq")}
    if parts == ["records"]:
        environment(skipped, ["pyyeti", "endaq", "polars"])
        build_ours(["-p", "clatter-record", "--example", "records"])
        answers = take_turns(records, skipped)
        if skipped.keys() & records.keys():
            sys.exit(f"left out: {skipped}")
        with open(os.path.join(HERE, "results.json")) as file:
            results = json.load(file)
        results["records"] = records_answer(answers, load)
        write(results)
        return
    if parts:
        environment(skipped, ["pyyeti", "endaq"])
        build_ours(["-p", "clatter-shock", "--example", "peers"])
        answers = take_turns(spectra, skipped)
        if skipped.keys() & spectra.keys():
            sys.exit(f"left out: {skipped}")
        with open(os.path.join(HERE, "results.json")) as file:
            results = json.load(file)
        results["spectra"] = {"date": today(), "machine": machine(load), "rows": spectra_table(answers)}
        write(results)
        return
    environment(skipped, PACKAGES)
    build(skipped)
    given, truth = scene()
    given = json.dumps(given)
    answers = take_turns({
        "clatter": ([os.path.join(TARGET, "release", "examples", "bars")], given),
        "python": ([PYTHON, script("bars.py"), "python"], given),
        "scipy": ([PYTHON, script("bars.py"), "scipy"], given),
        "siconos": ([DEBIAN_PYTHON, "-sE", script("bars.py"), "siconos"], given),
        "rapier": ([RAPIER], given),
        "mujoco": ([PYTHON, script("bars.py"), "mujoco"], given),
        **spectra,
        **records,
        "numpy": ([PYTHON, script("maps.py"), os.path.join(TARGET, "release", "clatter"), HOME], None),
    }, skipped)
    if "clatter" in skipped:
        sys.exit(skipped["clatter"])
    results = {
        "date": today(), "machine": machine(load),
        "bars": {"designs": DESIGNS, "impacts": [impacts for impacts, _ in truth], "half_length_m": HALF_LENGTH_M,
                 "speed_m_s": SPEED_M_S, "tilt_deg": TILT_DEG, "rows": bars_table(answers, truth)},
        "spectra": {"rows": spectra_table(answers)}, "maps": maps_table(answers), "skipped": skipped,
    }
    write(results)


def today():
    return datetime.date.today().isoformat()


def write(results):
    show(results)
    beside = os.path.join(HERE, "results.json.part")
    with open(beside, "w") as file:
        file.write(json.dumps(results, indent=1) + "\n")
    os.replace(beside, os.path.join(HERE, "results.json"))
    say("written: peers/results.json")


if __name__ == "__main__":
    main(sys.argv[1:])
