"""What answers are for: tables, notebooks, pictures."""

import json
from pathlib import Path

import clatter
import numpy as np
import polars
import pytest

BAR = (Path(__file__).resolve().parents[2] / "tests/cases/bar-handheld.toml").read_text(encoding="utf-8")


def test_fields_are_attributes_and_items():
    answer = clatter.impacts(q=0.5, e=0.3)
    assert answer.peak.end == answer["peak"]["end"] == 2.145
    assert "peak" in answer and "speed" not in answer and list(answer)[:3] == ["clatter", "q", "gyration_ratio"]
    assert {"peak", "impacts", "to_arrow"} <= set(dir(answer))  # what a prompt completes
    with pytest.raises(AttributeError, match="speed"):
        answer.speed
    assert answer.to_dict() == json.loads(answer.to_json())
    assert answer.clatter == clatter.__version__


def test_tables_have_the_columns_of_the_command(command):
    for arguments, answer in {
        "impacts --q=0.5 --e=0.3 --limit=3": clatter.impacts(q=0.5, e=0.3, limit=3),
        "zone --q=0.5 --e=0.3 --threshold=0.5 --threshold=1": clatter.zone(q=0.5, e=0.3, threshold=[0.5, 1]),
    }.items():
        rows = command(*arguments.split(), "--format=csv").stdout
        theirs = polars.read_csv(rows.encode())
        ours = polars.from_arrow(answer.to_arrow())
        assert ours.select(theirs.columns).equals(theirs), arguments


def test_every_answer_is_a_table():
    pulse = clatter.Pulse("half-sine", amplitude_m_s2=1000, duration_s=1e-3)
    example = clatter.Product.from_text(BAR)
    record = clatter.Record(np.sin(np.arange(100.0)), sample_rate_hz=1e3)
    tables = {
        ("component", "limit", "allowed", "demand", "margin", "verdict"): (clatter.assess(example), 5),
        ("component", "survival", "failed"): (clatter.scatter(example, samples=100), 3),
        ("component", "limit", "model", "value", "error"): (clatter.explain(example), 28),
        ("quantity", "value", "interval"): (clatter.fit(example, bounces=[0, 0.5, 0.7, 0.78, 0.812]), 2),
        ("frequency_hz", "maximax", "time_of_peak_s"): (clatter.spectrum(pulse, frequency_hz=[10, 20, 30]), 3),
        ("frequency_hz", "maximax", "damping"): (clatter.spectrum(pulse, frequency_hz=[10, 20], q_factor=[5, 10]), 4),
        ("name", "largest_m_s2"): (record.describe(), 1),
        ("q", "e", "impacts"): (clatter.map("impacts", q=(0, 0.9, 4), e=(0.1, 0.9, 3)), 12),
        ("q", "e", "count"): (clatter.bars(q=[0.1, 0.2], e=[[0.3], [0.4], [0.5]]), 6),
        ("q", "time", "delta_v_a"): (clatter.trains(q=[0.1, 0.2], e=0.3, limit=4), 2),
        ("maximax", "frequency_hz"): (clatter.spectra(np.ones((2, 50)), sample_rate_hz=1e3, frequency_hz=[10, 20]), 4),
        ("from", "to", "word"): (clatter.atlas(gyration_ratio=(0.577, 0.577), e=0.3, limit=8), None),
    }
    for names, (answer, rows) in tables.items():
        table = answer.to_arrow()
        assert set(names) <= set(table.column_names), table.column_names
        assert table.num_rows == rows or (rows is None and table.num_rows > 1), (names, table.num_rows)


def test_notebooks_show_them_and_obey_nothing_in_them():
    product = clatter.Product.from_text(clatter.Product.example().text.replace('"camera"', '"<b>camera</b>"'))
    shown = clatter.assess(product)._repr_html_()
    assert "<b>" not in shown and "&lt;b&gt;camera" in shown
    assert "<th>margin</th>" in shown
    assert "980 more rows" in clatter.impacts(gyration_ratio=1e-3, e=1, limit=1000)._repr_html_()
    assert "array(2, 3)" in repr(clatter.bars(q=[[0.1, 0.2, 0.3]], e=[[0.1], [0.2]]))


def test_pictures_are_written_whole_or_not_at_all(tmp_path):
    figure = clatter.map("impacts", q=(0, 0.9, 8), e=(0.1, 0.9, 8)).plot()
    assert figure._repr_svg_() == str(figure) and str(figure).startswith("<svg")
    with pytest.raises(ValueError, match=r"the file must end in \.svg"):
        figure.save(tmp_path / "map.png")
    with pytest.raises(FileNotFoundError):
        figure.save(tmp_path / "nowhere" / "map.svg")
    figure.save(tmp_path / "map.svg")
    assert [file.name for file in tmp_path.iterdir()] == ["map.svg"]
    with pytest.raises(ValueError, match="there is no picture"):
        clatter.impacts(q=0.5, e=0.3).plot()
    with pytest.raises(ValueError, match="has no text"):
        clatter.bars(q=0.5, e=0.3).to_json()
