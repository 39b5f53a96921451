"""The drawing of a set-up: a bounded size, every line once, bodies by their edges."""

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.reporting.path_drawing import DrawnBody, path_drawing
from trunnion.simulation.meshes.primitives import box_mesh


def posted(folder: Path, cl: str) -> trunnion.Run:
    source = folder / "part.cls"
    source.write_text(cl, encoding="utf-8")
    found = trunnion.post(source, machine="yl569").run
    assert found is not None
    return found


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> trunnion.Run:
    return posted(tmp_path_factory.mktemp("drawing"), HEAD + "CIRCLE/0,0,5,0,0,1,10\nGOTO/10.0,0.0,5.0\n" + FOOT)


def paths(svg: str) -> dict[str, str]:
    """Path data by class."""
    root = ElementTree.fromstring(svg)
    return {str(each.get("class")): str(each.get("d")) for each in root.iter("{http://www.w3.org/2000/svg}path")}


def numbers(data: str) -> list[float]:
    return [float(text) for text in re.findall(r"-?\d+(?:\.\d+)?", data)]


def test_cuts_rapids_and_axes_are_drawn_within_the_picture(run: trunnion.Run) -> None:
    svg = path_drawing(run)
    found = paths(svg)
    assert {"cut", "rapid", "axis"} <= found.keys()
    assert all(-1 <= number <= 721 for data in found.values() for number in numbers(data))
    assert found["cut"].count("L") > 12, "a full circle is no point"
    assert svg == path_drawing(run)


def test_home_in_machine_coordinates_is_not_drawn(run: trunnion.Run) -> None:
    # The tip at home is not known: a line to it would be wrong, and the scale with it.
    xs = numbers(paths(path_drawing(run))["cut"])[0::2]
    assert max(xs) - min(xs) > 50


def test_a_long_path_is_drawn_in_few_lines(tmp_path: Path) -> None:
    angle = np.linspace(0.0, 400.0, 20001)
    points = np.column_stack((angle / 10 * np.cos(angle), angle / 10 * np.sin(angle)))
    cl = HEAD + "".join(f"GOTO/{x:.4f},{y:.4f},5.0\n" for x, y in points.tolist()) + FOOT
    svg = path_drawing(posted(tmp_path, cl))
    assert svg.count("L") <= 8010
    assert len(svg) < 200_000


def test_bodies_are_drawn_by_their_edges(run: trunnion.Run) -> None:
    box = box_mesh(np.array([-20.0, -20.0, -10.0]), np.array([20.0, 20.0, 0.0]))
    svg = path_drawing(run, [DrawnBody("stock", box.vertices, box.faces)])
    assert paths(svg)["stock"].count("L") == 12, "no diagonals"
    empty = DrawnBody("part", np.zeros((0, 3)), np.zeros((0, 3), np.int64))
    assert paths(path_drawing(run, [empty]))["part"] == ""
    hostile = DrawnBody('"><script>', box.vertices, box.faces)
    assert "<script>" not in path_drawing(run, [hostile])
