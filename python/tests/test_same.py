"""Every answer has the text of the command, to the last byte."""

import json
from pathlib import Path

import clatter
import pytest

ROOT = Path(__file__).resolve().parents[2]
WORKED = ROOT / "reports/examples"
HANDHELD = (ROOT / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")
DROP = "--length-m=0.14 --gyration-m=0.0404 --e=0.3 --speed-m-s=4.43 --tilt-deg=5"
DROP_OF = {"length_m": 0.14, "gyration_m": 0.0404, "e": 0.3, "speed_m_s": 4.43, "tilt_deg": 5}
PLATE_OF = {"length_m": 0.15, "width_m": 0.07, "gyration_m": (0.0433, 0.0202), "e": 0.3, "speed_m_s": 4.43}
PLATE = "--length-m=0.15 --width-m=0.07 --gyration-m=0.0433,0.0202 --e=0.3 --speed-m-s=4.43"
BOX_OF = {**PLATE_OF, "thickness_m": 0.015, "gyration_m": (0.0207, 0.0435, 0.0478)}
BOX = "--length-m=0.15 --width-m=0.07 --thickness-m=0.015 --gyration-m=0.0207,0.0435,0.0478 --e=0.3 --speed-m-s=4.43"
K = 0.577350269
PULSE = clatter.Pulse("half-sine", amplitude_m_s2=5000, duration_s=0.5e-3, start_s=0.001)

QUESTIONS = {
    "impacts --q=0.5 --e=0.3": lambda: clatter.impacts(q=0.5, e=0.3),
    "impacts --q=1 --e=1 --limit=3": lambda: clatter.impacts(q=1, e=1, limit=3),
    "impacts --gyration-ratio=1e-9 --e=1 --limit=0": lambda: clatter.impacts(gyration_ratio=1e-9, e=1, limit=0),
    "impacts --q=0.73 --e=0.2 --velocity=-1,-0.3 --height-gap=2.5 --at=0 --at=-0.4": lambda: clatter.impacts(
        q=0.73, e=0.2, velocity=(-1, -0.3), height_gap=2.5, at=[0, -0.4]
    ),
    "impacts --gyration-ratio=0.5 --center-of-mass=0.2 --e=0.3": lambda: clatter.impacts(
        gyration_ratio=0.5, center_of_mass=0.2, e=0.3
    ),
    "impacts --mass=2@-1:1 --mass=1@0.5 --e=0.4": lambda: clatter.impacts(masses=[(2, -1, 1), (1, 0.5)], e=0.4),
    f"impacts --gyration-ratio={K},{K} --e=0.3 --height-gap=2,1 --at=0.5,0.2": lambda: clatter.impacts(
        gyration_ratio=(K, K), e=0.3, height_gap=(2, 1), at=[(0.5, 0.2)]
    ),
    "zone --q=0.5 --e=0.3 --threshold=0.5 --threshold=1 --first=a": lambda: clatter.zone(
        q=0.5, e=0.3, threshold=[0.5, 1], first="a"
    ),
    f"zone --gyration-ratio={K},{K} --e=0.3 --threshold=0.5": lambda: clatter.zone(gyration_ratio=(K, K), e=0.3, threshold=0.5),
    f"atlas --gyration-ratio={K},{K} --e=0.3 --limit=12": lambda: clatter.atlas(gyration_ratio=(K, K), e=0.3, limit=12),
    f"simulate --model=map {DROP}": lambda: clatter.simulate(model="map", **DROP_OF),
    f"simulate --model=finite-tilt {DROP} --thickness-m=0.01 --at=0.5": lambda: clatter.simulate(
        model="finite-tilt", **DROP_OF, thickness_m=0.01, at=[0.5]
    ),
    f"simulate --model=compliant {DROP} --contact-time-s=4e-4 --center-of-mass=0.1 --spin-rad-s=2": lambda: clatter.simulate(
        model="compliant", **DROP_OF, contact_time_s=4e-4, center_of_mass=0.1, spin_rad_s=2
    ),
    f"simulate --model=map {PLATE} --gaps-m=0.002,0.001": lambda: clatter.simulate(
        model="map", **PLATE_OF, gaps_m=(0.002, 0.001)
    ),
    f"simulate --model=compliant {PLATE} --tilt-deg=2 --direction-deg=30 --contact-time-s=1e-3": lambda: clatter.simulate(
        model="compliant", **PLATE_OF, tilt_deg=2, direction_deg=30, contact_time_s=1e-3
    ),
    f"simulate --model=compliant {BOX} --tilt-deg=20 --direction-deg=30 --contact-time-s=5e-4 --friction=0.4": lambda: clatter.simulate(
        model="compliant", **BOX_OF, tilt_deg=20, direction_deg=30, contact_time_s=5e-4, friction=0.4
    ),
    "respond --q=0.5 --e=0.3 --at=0.4 --omega=3 --damping=0.05": lambda: clatter.respond(
        q=0.5, e=0.3, at=0.4, omega=3, damping=0.05
    ),
    f"respond --model=compliant {PLATE} --gaps-m=0.002,0.001 --contact-time-s=4e-4 --at=0.4,0.2 --omega=900": lambda: (
        clatter.respond(model="compliant", **PLATE_OF, gaps_m=(0.002, 0.001), contact_time_s=4e-4, at=(0.4, 0.2), omega=900)
    ),
    f"respond --model=compliant {BOX} --tilt-deg=20 --contact-time-s=5e-4 --friction=0.4 --at=0.4,0.2,0 --axis=any": lambda: clatter.respond(
        model="compliant", **BOX_OF, tilt_deg=20, contact_time_s=5e-4, friction=0.4, at=(0.4, 0.2, 0), axis="any"
    ),
    f"respond --model=compliant {DROP} --contact-time-s=4e-4 --at=0.4 --frequency=180Hz": lambda: clatter.respond(
        model="compliant", **DROP_OF, contact_time_s=4e-4, at=0.4, frequency_hz=180
    ),
    f"respond --model=compliant {DROP} --contact-time-s=4e-4 --at=0.4 --frequency=60Hz --stop=1mm,0.5ms,0.4": lambda: clatter.respond(
        model="compliant", **DROP_OF, contact_time_s=4e-4, at=0.4, frequency_hz=60, stop=(1e-3, 0.5e-3, 0.4)
    ),
    "spectrum --pulse=half-sine,5000,0.0005,0.001 --frequency=60,180 --stop=1mm,0.5ms,0.4": lambda: clatter.spectrum(
        PULSE, frequency_hz=[60, 180], stop=(1e-3, 0.5e-3, 0.4)
    ),
    f"respond --model=finite-tilt {DROP} --at=0.4 --omega=900 --q-factor=25 --first=b": lambda: clatter.respond(
        model="finite-tilt", **DROP_OF, at=0.4, omega=900, q_factor=25, first="b"
    ),
    "spectrum --pulse=half-sine,5000,0.0005,0.001 --frequency=100,180 --limit=4000": lambda: clatter.spectrum(
        PULSE, frequency_hz=[100, 180], limit=4000
    ),
    "spectrum --pulse=half-sine,5000,0.0005,0.001 --q-factor=5,25 --quantity=pseudo-velocity": lambda: clatter.spectrum(
        PULSE, q_factor=[5, 25], quantity="pseudo-velocity"
    ),
    "spectrum --pulse=JESD22-B110/B --frequency=10:1000:6 --damping=0 --enveloping-pulse=rectangle": lambda: clatter.spectrum(
        clatter.Pulse.of_standard("JESD22-B110/B"), per_octave_hz=(10, 1000, 6), damping=0, enveloping_pulse="rectangle"
    ),
    "spectrum --shock=2.5,0 --shock=-1,0.004 --frequency=180 --required=10:9,80:75,2000:75 --tolerance=-1.5,6": lambda: (
        clatter.spectrum(
            shocks=[(0, 2.5), (0.004, -1)],
            frequency_hz=180,
            required=[(10, 9), (80, 75), (2000, 75)],
            tolerance_db=(1.5, 6),
        )
    ),
    "design": clatter.design,
    "design --zone=0.5:0.1 --turn=1.5": lambda: clatter.design(zones=[(0.5, 0.1)], turn=1.5),
    "design handheld.toml --margin=20% --e=0.1:0.5": lambda: clatter.design("handheld.toml", margin=0.2, e=(0.1, 0.5)),
    "assess handheld.toml": lambda: clatter.assess("handheld.toml"),
    "assess handheld.toml --tolerance=5% --model=map": lambda: clatter.assess("handheld.toml", tolerance=0.05, model="map"),
    "scatter handheld.toml --samples=500 --seed=7 --target=99%": lambda: clatter.scatter(
        "handheld.toml", samples=500, seed=7, target=0.99
    ),
    "explain handheld.toml --tolerance=10%": lambda: clatter.explain("handheld.toml", tolerance=0.1),
}


@pytest.fixture
def handheld(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tmp_path.joinpath("handheld.toml").write_text(HANDHELD)


@pytest.mark.parametrize("arguments", QUESTIONS)
def test_text_of_the_command(arguments, command, handheld):
    printed = command(*arguments.split(), "--format=json").stdout
    assert QUESTIONS[arguments]().to_json() == printed.rstrip("\n")


@pytest.mark.parametrize("path", sorted(WORKED.glob("*.toml")), ids=lambda path: path.stem)
def test_worked_products(path, command):
    told = clatter.assess(path)
    answers = {"assess": told, "scatter": clatter.scatter(path, samples=300), "explain": clatter.explain(path)}
    if "width =" not in path.read_text():
        # Of a plate or a box it takes long.
        answers["design"] = clatter.design(path)
    for asked, answer in answers.items():
        samples = ["--samples=300"] if asked == "scatter" else []
        assert answer.to_json() == command(asked, path, *samples, "--format=json").stdout.rstrip("\n"), asked


def test_infinite_is_a_float_and_endless_a_word():
    answer = clatter.impacts(q=1, e=1, limit=0)
    assert answer.count == "endless"
    assert answer.peak.end == float("inf")
    assert '"end":"infinite"' in answer.to_json()


def test_a_part_named_infinite_keeps_its_name():
    product = clatter.Product.from_text(HANDHELD.replace('"camera"', '"infinite"'))
    assert clatter.assess(product).components[1].name == "infinite"


def test_fit(command, handheld, tmp_path):
    tmp_path.joinpath("bounces").write_text("bounce_s\n0\n0.5\n0.7\n0.78\n0.812\n")
    printed = command("fit", "bounces", "--product=handheld.toml", "--timing=1ms", "--format=json").stdout
    answer = clatter.fit("handheld.toml", bounces=[0, 0.5, 0.7, 0.78, 0.812], timing_s=1e-3)
    assert answer.to_json() == printed.rstrip("\n")
    command("fit", "bounces", "--product=handheld.toml", "--timing=1ms", "-o", "fitted.toml")
    assert answer.fitted.text == tmp_path.joinpath("fitted.toml").read_text()


def test_fit_of_strikes(command, handheld, tmp_path):
    drop = clatter.simulate(model="finite-tilt", **{**DROP_OF, "tilt_deg": 2})
    strikes = [(impact.time_s, impact.end) for impact in drop.impacts[:6]]
    rows = "".join(f"{time!r},{end}\n" for time, end in strikes)
    tmp_path.joinpath("strikes").write_text(f"time_s,end\n{rows}")
    product = HANDHELD.replace("contact_time =", "# contact_time =")
    tmp_path.joinpath("instant.toml").write_text(product)
    printed = command("fit", "strikes", "--product=instant.toml", "--timing=10us", "--format=json").stdout
    assert clatter.fit("instant.toml", strikes=strikes, timing_s=10 * 1e-6).to_json() == printed.rstrip("\n")


def test_pictures(command, handheld, tmp_path):
    pictures = {
        "map impacts --q=0:0.9:20 --e=0.1:0.9:20": clatter.map("impacts", q=(0, 0.9, 20), e=(0.1, 0.9, 20)),
        "map zone --gyration-ratio=0.2:1:8 --e=0:0.5:6 --threshold=1": clatter.map(
            "zone", gyration_ratio=(0.2, 1, 8), e=(0, 0.5, 6), threshold=1
        ),
        f"simulate --model=compliant {DROP} --contact-time-s=0.001 --at=0.5": clatter.simulate(
            model="compliant", **DROP_OF, contact_time_s=0.001, at=[0.5]
        ),
        "spectrum --pulse=half-sine,5000,0.0005,0.001 --limit=4000": clatter.spectrum(PULSE, limit=4000),
        "spectrum --pulse=half-sine,5000,0.0005,0.001 --q-factor=5,25": clatter.spectrum(PULSE, q_factor=[5, 25]),
    }
    for arguments, answer in pictures.items():
        command(*arguments.split(), "-o", "of-command.svg")
        answer.plot().save("of-wheel.svg")
        assert tmp_path.joinpath("of-wheel.svg").read_bytes() == tmp_path.joinpath("of-command.svg").read_bytes(), arguments


def test_map_has_the_values_of_the_command(command, tmp_path):
    file = tmp_path / "map.json"
    command("map", "peak-end", "--q=-0.5:1:7", "--e=0:1:5", "-o", file)
    ours = clatter.map("peak-end", q=(-0.5, 1, 7), e=(0, 1, 5))
    theirs = json.loads(file.read_text())
    assert [[x if x != float("inf") else "infinite" for x in row] for row in ours["values"].tolist()] == theirs["values"]
    assert (ours.q.tolist(), ours.e.tolist()) == (theirs["q"], theirs["e"])
