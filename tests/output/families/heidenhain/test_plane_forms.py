"""One plane in every form of PLANE: written, read, and the same."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.klartext import OWN, SHARES, TILTED, Post, proven
from tests.support.planes import reachable, text_of
from tests.support.posting import FOOT, HEAD
from trunnion import diff
from trunnion.arrays import Floats
from trunnion.cl import read_cl
from trunnion.controls import load_control
from trunnion.errors import InputError, RefusedError
from trunnion.families import load_reader
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.readers import run_program
from trunnion.readers.program.options import DEFAULT_OPTIONS

FORMS = ("vector", "euler", "points", "relativ", "axial", "projected")
MEANINGS = ("turning", "rising")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("forms")


def definition(folder: Path, name: str, meaning: str) -> Path:
    """A shipped machine that says what projected angles mean."""
    file = folder / f"{name}_{meaning}.toml"
    file.write_text(f'extends = "{name}"\n[control]\nprojected_angles = "{meaning}"\n', encoding="utf-8")
    return file


def plane_of(run: Run) -> Floats:
    """The last plane that is turned, (3, 3)."""
    turned = [plane[:, :3] for plane in run.planes if np.abs(plane[:, :3] - np.eye(3)).max() > 1e-12]
    return np.asarray(turned[-1] if turned else np.eye(3))


@settings(max_examples=examples(12))
@given(
    name=st.sampled_from(sorted(OWN)),
    share=SHARES,
    meaning=st.sampled_from(MEANINGS),
    tips=st.lists(st.tuples(*[st.floats(-80.0, 80.0)] * 3), min_size=2, max_size=4),
)
def test_every_form_makes_the_same_program_of_a_plane(
    folder: Path, name: str, share: tuple[float, float], meaning: str, tips: list[tuple[float, float, float]]
) -> None:
    file = definition(folder, name, meaning)
    machine = load_machine(file)
    control = load_control(machine.control)
    cl = folder / "plane.cls"
    axis = reachable(machine, share)
    cl.write_text(text_of([axis], tips), encoding="utf-8")
    try:
        spatial = proven(read_cl(cl), machine, control, folder, plane="spatial")
    except (RefusedError, InputError):
        assume(False)
    kept = folder / "spatial.h"
    kept.write_bytes((folder / "part.h").read_bytes())
    # Three angles with so many decimals turn the plane, and what is as far off as home, by this.
    degrees = 3.0 * 10.0 ** -control.number_formats(three_axis=False)["plane_angle"].decimals
    matrix = plane_of(spatial.run)
    for form in FORMS:
        if form == "projected" and axis[2] < np.cos(np.radians(67.0)):
            with pytest.raises(InputError, match="CTL640"):
                proven(read_cl(cl), machine, control, folder, plane=form)
            continue
        found = proven(read_cl(cl), machine, control, folder, plane=form)
        np.testing.assert_allclose(plane_of(found.run), matrix, rtol=0, atol=np.radians(degrees), err_msg=form)
        same = diff(kept, folder / "part.h", machine=file, tolerance=1500.0 * np.radians(degrees))
        assert same.same, (form, same)


def turn(axis: int, degrees: float) -> Floats:
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix, (one, two) = np.eye(3), ((axis + 1) % 3, (axis + 2) % 3)
    matrix[[one, two], [one, two]] = cos
    matrix[one, two], matrix[two, one] = -sin, sin
    return matrix


def read(folder: Path, block: str, meaning: str = "turning") -> tuple[Floats, list[str]]:
    """The plane after a block on the DMU 65, and the codes of what the reader found."""
    machine = load_machine(definition(folder, "dmu65", meaning))
    path = folder / "block.h"
    path.write_text(f"BEGIN PGM P MM\n{block}\nEND PGM P MM\n", encoding="utf-8")
    interpreter = load_reader("heidenhain_tnc640").interpreter(path, machine, DEFAULT_OPTIONS)
    interpreter.run()
    return interpreter.control.frame.linear.copy(), [finding.code for finding in run_program(path, machine).diagnostics]


@pytest.mark.parametrize(
    ("block", "expected"),
    [
        ("PLANE PROJECTED PROPR+0 PROMIN+30 ROT+0 STAY", turn(0, 30.0)),
        ("PLANE PROJECTED PROPR+30 PROMIN+0 ROT+0 STAY", turn(1, 30.0)),
        ("PLANE PROJECTED PROPR+0 PROMIN+0 ROT+30 STAY", turn(2, 30.0)),
        ("PLANE PROJECTED PROPR+30 PROMIN+0 ROT-90 STAY", turn(1, 30.0) @ turn(2, -90.0)),
        ("PLANE PROJECTED PROPR+0 PROMIN+30 ROT+45 STAY TABLE ROT", turn(0, 30.0) @ turn(2, 45.0)),
    ],
)
def test_projected_angles_about_one_axis_are_spatial_angles(folder: Path, block: str, expected: Floats) -> None:
    np.testing.assert_allclose(read(folder, block)[0], expected, rtol=0, atol=1e-12)


def test_projected_angles_that_rise_are_seen_in_both_planes(folder: Path) -> None:
    matrix, _ = read(folder, "PLANE PROJECTED PROPR+20 PROMIN+35 ROT+0 STAY", "rising")
    x, y, z = matrix[:, 2]
    # The plane x X + y Y + z Z = 0, cut by Y = 0 and by X = 0: it rises with both.
    assert np.degrees(np.arctan(-x / z)) == pytest.approx(20.0, abs=1e-9)
    assert np.degrees(np.arctan(-y / z)) == pytest.approx(35.0, abs=1e-9)
    assert matrix[:, 0] == pytest.approx([np.cos(np.radians(20.0)), 0.0, np.sin(np.radians(20.0))], abs=1e-12)


@pytest.mark.parametrize("block", ["PROPR+90 PROMIN+0 ROT+0", "PROPR+0 PROMIN-90 ROT+0", "PROPR+5 PROMIN+5", "ROT+5"])
def test_projected_angles_that_make_no_plane_are_refused(folder: Path, block: str) -> None:
    assert read(folder, f"PLANE PROJECTED {block} STAY")[1] == ["NC210"]


def test_projected_angles_of_unknown_meaning_are_refused_both_ways(
    folder: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert read(folder, "PLANE PROJECTED PROPR+5 PROMIN+5 ROT+5 STAY", "unknown")[1] == ["NC220"]
    code, out, err = Post(tmp_path, capfd).all(TILTED, "--set", "plane=projected")
    assert (code != 0, out) == (True, "")
    assert "projected_angles" in err
    assert "[CTL640]" in err


#: An operation in a coordinate system of its own, whose X is not the machine's after the tilt.
TWISTED = HEAD.replace("OP1", "OP2").replace(
    "1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0", "0,0.8,-0.6,-1,0,0.0"
)


def test_axial_refuses_a_plane_with_an_x_of_its_own(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    post = Post(tmp_path, capfd)
    code, _, err = post.all(HEAD + FOOT + TWISTED + FOOT, "--set", "plane=axial")
    assert (code != 0, "[CTL640]" in err) == (True, True)
    for form in ("spatial", "euler", "relativ", "points"):
        assert post.all(HEAD + FOOT + TWISTED + FOOT, "--set", f"plane={form}")[0] == 0, form


@pytest.mark.parametrize(("choice", "words"), [("coord", " COORD ROT"), ("table", " TABLE ROT"), ("unstated", "")])
@pytest.mark.parametrize("form", ["spatial", "vector", "euler", "points", "relativ"])
def test_the_word_for_a_free_axis_is_written_and_read(
    form: str, choice: str, words: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    blocks = Post(tmp_path, capfd)(TILTED, "--set", f"plane={form}", "--set", f"plane_free_axis={choice}")
    plane = [block for block in blocks if block.startswith("PLANE") and "RESET" not in block][-1]
    assert plane.endswith("SEQ-" + words)
