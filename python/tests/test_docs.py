"""What is written about the package holds: examples of docstrings, types, the notebook."""

import doctest
import importlib
import inspect
import re
import subprocess
import sys
from pathlib import Path

import clatter
import nbformat
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[2]
PUBLIC = {name: getattr(clatter, name) for name in clatter.__all__ if callable(getattr(clatter, name))}


@pytest.mark.parametrize("name", ["_bars", "_drops", "_records", "_products", "_studies"])
def test_examples(name):
    module = importlib.import_module(f"clatter.{name}")
    failed, tried = doctest.testmod(module, optionflags=doctest.NORMALIZE_WHITESPACE)
    assert failed == 0
    assert tried >= 10


@pytest.mark.parametrize("name", PUBLIC)
def test_every_parameter_is_documented_with_what_it_is(name):
    what, doc = PUBLIC[name], inspect.getdoc(PUBLIC[name])
    assert doc and re.match(r".*\.\n", doc + "\n"), "a sentence first"
    if name in ("Answer", "Figure"):
        return  # made by the package
    if inspect.isfunction(what):
        assert "Returns\n-------" in doc or name == "schema"
        assert ">>> " in doc or name == "schema"
    parameters = [p for p in inspect.signature(what).parameters if p != "more"]
    section = doc.partition("Parameters\n----------\n")[2].partition("\n\nReturns")[0]
    named = {
        one for line in section.splitlines() if not line.startswith(" ") for one in re.findall(r"\w+", line.split(" : ")[0])
    }
    assert set(parameters) <= named, set(parameters) - named


def test_types(tmp_path):
    use = tmp_path / "use.py"
    use.write_text(
        "import clatter\n"
        "import numpy as np\n"
        "peak: float = clatter.impacts(q=0.5, e=0.3).peak.end\n"
        "table = clatter.bars(q=np.array([0.5]), e=[0.3, 0.4]).to_arrow()\n"
        "reveal_type(clatter.assess(clatter.Product.example()))\n"
        "clatter.impacts(q='a lot', e=0.3)\n"
        "clatter.spectrum(clatter.Record([1.0, 2.0], sample_rate_hz=1e3), quantity='speed')\n"
        "clatter.Pulse('half-sine', amplitude_m_s2=1, duration_s=1).durations_s\n"
        "clatter.Record.open('drop.csv').values_m_s2('a').maxima()\n"
        "ends: list[str] = [impact.end for impact in clatter.impacts(q=0.5, e=0.3).impacts]\n"
        "counts: list[float] = clatter.bars(q=[0.5], e=0.3).count.tolist()\n"
        "limits = {p.name: p.limits[0].margin for p in clatter.assess(clatter.Product.example()).components}\n"
        "step: float | None = clatter.Record([1.0, 2.0], sample_rate_hz=1e3).low_pass(100).step_s\n"
        "same: bool = clatter.bars(q=0.5, e=0.3) == clatter.zones(q=0.5, e=0.3, threshold=1)\n"
        "picture: str = clatter.spectrum('drop.csv').plot().svg\n"
        "text: str = clatter.fit('p.toml', bounces=np.array([0, 0.5])).fitted.text\n"
    )
    package = ROOT / "python" / "clatter"
    mypy = [sys.executable, "-m", "mypy", "--strict", f"--config-file={ROOT / 'pyproject.toml'}", f"--cache-dir={tmp_path}"]
    own = subprocess.run([*mypy, package], capture_output=True, text=True)
    assert own.returncode == 0, own.stdout
    found = subprocess.run([*mypy, use], capture_output=True, text=True).stdout
    assert 'Revealed type is "clatter._answer.Answer"' in found
    assert re.findall(r"use\.py:(\d+): error", found) == ["6", "7", "8", "9"], found


def test_readme(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    tmp_path.joinpath("handheld.toml").write_text(clatter.Product.example().text)
    block = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL).group(1)
    names = {"frame": {"time [s]": [0, 1e-4, 2e-4, 3e-4], "a [g]": [0, 100, 0, 0]}}
    answers = []
    for line in block.splitlines():
        if line.startswith("import"):
            exec(line, names)
        elif line:
            answers.append(eval(line, names))
    peak, counts, verdict, figure = answers
    assert (peak, counts.shape, verdict) == (2.145, (2, 1000), "safe")
    assert str(figure).startswith("<svg")


def test_notebook(tmp_path):
    notebook = nbformat.read(ROOT / "examples" / "handheld.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "outputs are not kept"
    NotebookClient(notebook, timeout=120, resources={"metadata": {"path": tmp_path}}).execute()
    shown = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    assert sum("image/svg+xml" in data for data in shown) == 2
    verdicts = next(data["text/html"] for data in shown if "camera" in data.get("text/html", ""))
    assert "unsafe" in verdicts and "safe" in verdicts
