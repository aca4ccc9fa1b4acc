"""The paper's experiments: that they run, and what a page is."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import quadrics
from quadrics import synth
from quadrics.cli.main import main
from quadrics.cli.reproduce import NAMES
from quadrics.reproduce import experiment
from quadrics.reproduce.data import Data, Model
from quadrics.reproduce.figure4 import boundary_length
from quadrics.reproduce.figure11 import METHODS
from quadrics.reproduce.page import page
from quadrics.reproduce.plot import Curve, _log_ticks, plot
from quadrics.reproduce.section import Block, Note, Pictures, Section, Table
from quadrics.reproduce.table2 import compare

SHARED = Path(__file__).parents[2] / "shared" / "data"


def test_every_name_has_an_experiment() -> None:
    for name in NAMES:
        assert experiment(name).__name__ == "make"


def test_a_figure_is_printed_and_written_as_a_page_that_needs_no_network(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "page.html"
    assert main(["reproduce", "figure1", "-o", str(out)]) == 0
    assert "stand-in" in capsys.readouterr().out
    text = out.read_text()
    assert text.count("<img") == 5
    assert not re.search(r'(src|href)="http', text)
    assert main(["reproduce", "figure1", "-o", str(out)]) == 4
    assert main(["reproduce", "figure1", "--data", str(tmp_path / "none"), "-o", "x.html"]) == 3


def test_ours_and_qsf_are_compared_at_the_same_number_of_regions() -> None:
    rows = compare(Model("bone", synth.part("shaft", 5_000).mesh, "a shaft"))
    assert [row[1] for row in rows] == ["QSF, mean", "QSF, best", "ours"]
    assert {row[2] for row in rows} == {"5"}
    assert rows[0][6:] == ("0.2483", "0.0141", "7.939")


def test_every_method_runs_from_python_and_vsa_needs_a_number() -> None:
    part = synth.part("shaft", 5_000)
    for options in METHODS.values():
        assert len(quadrics.segment(part.mesh, regions=15, **options).regions) > 5
    with pytest.raises(quadrics.OptionError, match="needs a number of regions"):
        quadrics.segment(part.mesh, method="vsa")


def test_a_plot_is_svg_and_keeps_its_points_inside() -> None:
    curves = [Curve("a & b", (0, 1, 2), (1e-3, 1e-5, 1e-4)), Curve("c", (0, 2), (1, 1), True)]
    for log in (False, True):
        svg = ET.fromstring(plot(curves, "x", "y", log=log))  # noqa: S314
        for line in svg.iter("polyline"):
            points = [tuple(map(float, p.split(","))) for p in line.attrib["points"].split()]
            assert all(0 <= x <= 800 and 0 <= y <= 360 for x, y in points)


@pytest.mark.parametrize(
    ("low", "high"), [(3.1e-4, 3.6e-4), (1e-4, 4e-4), (2e-6, 1e-3), (1e-20, 1)]
)
def test_ticks_of_a_logarithmic_axis_are_round_and_neither_few_nor_many(
    low: float, high: float
) -> None:
    ticks = _log_ticks(low, high)
    assert 3 <= len(ticks) <= 8
    assert all(
        low <= tick <= high and float(f"{tick:.2g}") == pytest.approx(tick) for tick in ticks
    )


def test_pictures_stand_in_rows_of_one_length() -> None:
    blank = np.zeros((4, 4, 3), np.uint8)
    for count, columns in ((1, 1), (4, 4), (5, 5), (6, 3), (8, 4)):
        assert f"repeat({columns}," in Pictures([("", blank)] * count).html()


def test_the_length_of_boundaries_is_that_of_the_edges_between_labels() -> None:
    # Two triangles of a unit square: they share its diagonal.
    corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    square = quadrics.as_mesh((corners, [[0, 1, 2], [0, 2, 3]]))
    labels = np.array([0, 1], np.int32)
    assert boundary_length(square, labels) == pytest.approx(np.sqrt(2))
    assert boundary_length(square, np.zeros(2, np.int32)) == 0


def test_words_of_a_page_are_escaped() -> None:
    blank = np.zeros((4, 4, 3), np.uint8)
    blocks: list[Block] = [Table(("a<b",), (("1>0",),)), Note("x & y"), Pictures([("<i>", blank)])]
    text = page([Section("t", blocks)])
    assert "a&lt;b" in text
    assert "x &amp; y" in text
    assert "<i>" not in text


def test_models_come_from_the_folder_or_from_the_generator() -> None:
    assert Data(None).model("fandisk").note.startswith("stand-in")
    assert len(Data(None).known()) == 5
    if not SHARED.is_dir():
        pytest.skip("the shared meshes are not beside this checkout")
    data = Data(SHARED)
    assert data.has("fandisk")
    assert data.model("fandisk").note == "the file fandisk.ply"
    assert data.known()[0].name == "ball_joint"
