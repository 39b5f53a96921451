"""Programmable frames and swivelled planes, by the facts of the programming manual."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from tests.support.reading import Runner, close
from trunnion.arrays import Floats
from trunnion.machines import load_machine
from trunnion.readers import run_program


def vector(*numbers: float) -> Floats:
    """Return an array."""
    return np.array(numbers)


def rotation(axis: int, angle: float) -> Floats:
    """Rotation matrix as a textbook prints it."""
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.array(
        [
            [[1, 0, 0], [0, c, -s], [0, s, c]],
            [[c, 0, s], [0, 1, 0], [-s, 0, c]],
            [[c, -s, 0], [s, c, 0], [0, 0, 1]],
        ][axis]
    )


X, Y, Z = (partial(rotation, axis) for axis in range(3))
P = np.array([1.0, 2.0, 3.0])


@pytest.mark.parametrize(
    ("words", "point"),
    [
        ("TRANS X10 Y20", P + vector(10, 20, 0)),
        ("TRANS X10\nTRANS Y5", P + vector(0, 5, 0)),
        ("TRANS X10\nATRANS X1 Z2", P + vector(11, 0, 2)),
        ("TRANS X10\nTRANS", P),
        ("TRANS X10\nROT", P),
        ("ROT Z30", Z(30) @ P),
        ("TRANS X10\nROT Z30", Z(30) @ P),
        ("TRANS X10\nAROT Z30", Z(30) @ P + vector(10, 0, 0)),
        ("ROT Z30\nATRANS X10", Z(30) @ (P + vector(10, 0, 0))),
        ("ROT X10 Y20 Z30", Z(30) @ Y(20) @ X(10) @ P),
        ("AROT X10\nAROT Y20\nAROT Z30", X(10) @ Y(20) @ Z(30) @ P),
        ("ROT RPL=30", Z(30) @ P),
        ("G18\nROT RPL=30", Y(30) @ P),
        ("G19\nAROT RPL=30", X(30) @ P),
        ("MIRROR X0", P * vector(-1, 1, 1)),
        ("TRANS X10\nAMIRROR Y0", P * vector(1, -1, 1) + vector(10, 0, 0)),
        ("SCALE X2 Y2 Z2", 2 * P),
        ("ATRANS X1\nASCALE X2", P * vector(2, 1, 1) + vector(1, 0, 0)),
        ("G70\nTRANS X1\nG71", P + vector(25.4, 0, 0)),
        ("G505\nTRANS X1", P + vector(1, 0, 0)),
    ],
)
def test_frames(run: Runner, words: str, point: Floats) -> None:
    result = run(f"{words}\nG17 X1 Y2 Z3")
    close(result.tip[-1], point, atol=1e-12)
    assert result.diagnostics == ()


def test_vectors_and_circles_turn_with_the_frame(run: Runner) -> None:
    result = run("TRAORI\nROT Y90\nX0 Y0 Z0\nG3 X10 Y0 I5 J0 C3=1")
    close(result.axis[-1], [1, 0, 0], atol=1e-9)
    close(result.tip[-1], [0, 0, -10], atol=1e-9)
    close(result.arcs.centre[0], [0, 0, -5], atol=1e-12)
    close(result.arcs.normal[0], [1, 0, 0], atol=1e-12)


def test_a_mirror_turns_circles_the_other_way(run: Runner) -> None:
    result = run("MIRROR X0\nG3 X10 Y0 I5 J0")
    close(result.arcs.normal[0], [0, 0, -1])
    close(result.arcs.centre[0], [-5, 0, 0])


def test_unequal_scales_make_no_circle(run: Runner) -> None:
    assert "ellipse" in run("SCALE X2\nG3 X10 Y0 I5 J0").errors[0].text


@pytest.mark.parametrize("mirrored", [False, True])
def test_equal_scales_of_a_plane_keep_its_circles(run: Runner, mirrored: bool) -> None:
    result = run(f"SCALE X2 Y2\n{'AMIRROR X0' if mirrored else ''}\nG3 X10 Y10 Z1 I0 J10")
    sign = -1.0 if mirrored else 1.0
    close(result.tip[-1], [sign * 20, 20, 1])
    close(result.arcs.centre[0], [0, 20, 0])
    close(result.arcs.normal[0], [0, 0, sign])
    assert not result.errors
    assert "ellipse" in run("SCALE X2 Y2\nG18\nG3 X10 Z0 I5 K0").errors[0].text


def test_circles_of_the_slides_are_circles_of_the_tip_on_a_tilted_table(run: Runner) -> None:
    result = run("B90\nX0 Y0 Z0\nG3 X10 Y0 I5 J0")
    close(result.arcs.centre[0], [0, 0, -5], atol=1e-12)
    close(result.arcs.normal[0], [1, 0, 0], atol=1e-12)


MODES = {57: (X, Y, Z), 27: (Z, Y, X), 39: (Z, X, Y), 45: (X, Z, Y), 30: (Y, Z, X), 54: (Y, X, Z)}


@pytest.mark.parametrize("mode", MODES)
def test_cycle800_turns_about_axes_already_turned(run: Runner, mode: int) -> None:
    result = run(
        f'CYCLE800(0,"",0,{mode},20,0,-5,10,20,30,1,2,3,-1,,1)\nX1 Y2 Z3',
        machine=load_machine("dmu65"),
        family="sinumerik_840d",
    )
    first, second, third = MODES[mode]
    plane = first(10) @ second(20) @ third(30)
    close(result.tip[-1], plane @ (P + vector(1, 2, 3)) + vector(20, 0, -5), atol=1e-9)
    close(result.axis[-1], plane[:, 2], atol=1e-9)
    assert result.joints[-1, 1] < 0
    assert result.diagnostics == ()


def test_cycle800_moves_the_rotary_axes_or_only_computes(run: Runner) -> None:
    moved = run('CYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,1)\nX1 Y0 Z0')
    still = run('CYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,0)\nX1 Y0 Z0')
    close(moved.joints[:, 1], [30, 30], atol=1e-9)
    assert moved.programmed[0] == 24
    assert len(still) == 1
    assert still.joints[0, 1] == 0
    close(still.tip[0], moved.tip[1], atol=1e-12)


def test_cycle800_takes_the_only_solution_inside_the_travel_and_says_so(run: Runner) -> None:
    result = run('CYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,-1)\nX1')
    assert result.joints[0, 1] == pytest.approx(30)
    assert "outside the travel" in result.diagnostics[0].text


@pytest.mark.parametrize("reset", ["CYCLE800()", 'CYCLE800(,"0",,,,,,,,,,,,,)'])
def test_cycle800_resets(run: Runner, reset: str) -> None:
    result = run(f'CYCLE800(0,"",0,57,5,0,0,0,30,0,0,0,0,1)\n{reset}\nG0 B0 C0\nX1 Y2 Z3')
    close(result.tip[-1], P, atol=1e-12)
    assert result.diagnostics == ()


def test_cycle800_new_replaces_and_additive_adds(run: Runner) -> None:
    one = 'CYCLE800(0,"",0,57,10,0,0,0,0,90,0,0,0,1)\n'
    new = run(one + 'CYCLE800(0,"",0,57,1,0,0,0,0,0,0,0,0,1)\nX1 Y2 Z3')
    added = run(one + 'CYCLE800(0,"",1,57,1,0,0,0,0,0,0,0,0,1)\nX1 Y2 Z3')
    close(new.tip[-1], P + vector(1, 0, 0), atol=1e-9)
    close(added.tip[-1], Z(90) @ (P + vector(1, 0, 0)) + vector(10, 0, 0), atol=1e-9)


def test_cycle800_with_direct_angles(run: Runner) -> None:
    machine = load_machine("yl569")
    result = run('CYCLE800(0,"",0,192,0,0,0,20,40,0,0,0,0,1)\nX0 Y0 Z1')
    assert result.joints[0, list(machine.rotary)].tolist() == [20.0, 40.0]
    assert ["only the swivel data say which" in error.text for error in result.errors] == [True]
    close(result.tip[-1], result.axis[-1], atol=1e-12)


@pytest.mark.parametrize(("order", "rotary"), [("first", [20.0, 40.0]), ("second", [40.0, 20.0])])
def test_a_definition_names_the_axes_of_direct_angles(order: str, rotary: list[float], tmp_path: Path) -> None:
    yl569 = load_machine("yl569")
    names = [yl569.names[k] for k in yl569.rotary]
    axes = names if order == "first" else names[::-1]
    (tmp_path / "own.toml").write_text(f'extends = "yl569"\n[control.reading]\nswivel_axes = {axes}\n')
    (tmp_path / "part.mpf").write_text('D1\nCYCLE800(0,"",0,192,0,0,0,20,40,0,0,0,0,1)\nX0 Y0 Z1\nM30\n')
    machine = load_machine(str(tmp_path / "own.toml"))
    result = run_program(tmp_path / "part.mpf", machine)
    assert result.errors == ()
    assert result.joints[0, list(machine.rotary)].tolist() == rotary


def test_cycle800_accepts_fifteen_values_and_names_what_it_cannot_do(run: Runner) -> None:
    assert run('CYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,1,)\nX1').diagnostics == ()
    assert "_MODE 64" in run('CYCLE800(0,"",0,64,0,0,0,0,30,0,0,0,0,1,)').errors[0].text
    assert "retracts" in run('CYCLE800(1,"",0,57,0,0,0,0,30,0,0,0,0,1,)').diagnostics[0].text


@pytest.mark.parametrize(
    ("words", "along"),
    [
        ("TOROT\nG1 Z10", 10.0),
        ("TOROTZ\nG1 Z-5", -5.0),
        ("TRANS X3 Y-4 Z5\nTOROT\nG1 Z10", 10.0 + vector(3, -4, 5) @ (Z(40) @ Y(30))[:, 2]),
        ("TRANS X3 Y-4 Z5\nTOFRAME\nG1 Z10", 10.0),
        ("TOROT\nTOROTOF\nTOROT\nG1 Z10", 10.0),
    ],
)
def test_z_of_a_frame_is_turned_to_the_tool(words: str, along: float, run: Runner) -> None:
    result = run(f"G54\nG0 B30 C40\nTRAORI\nG0 X7 Y2 Z20 F100\n{words}\nTRAFOOF\nM30\n")
    assert not result.diagnostics
    axis = (Z(40) @ Y(30))[:, 2]
    start, end = result.tip[-2:]
    close(result.axis[-1], axis, atol=1e-12)
    close(np.cross(end - start, axis), np.zeros(3), atol=1e-9)
    close(end @ axis, along, atol=1e-9)


def test_what_the_tool_has_turned_is_turned_back(run: Runner) -> None:
    result = run("TRAORI\nG54\nG0 X7 Y2 Z20 B30 C40\nTRANS X1\nTOROT\nG0 Z50\nTOROTOF\nG0 X1 Y2 Z3\n")
    close(result.tip[-1], [2, 2, 3], atol=1e-9)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("TRAORI\nG0 B30\nTOROT\nX5", "X and Y before TOROTOF"),
        ("TRAORI\nG0 B30\nTOROT\nTRANS\nG0 X5", "X and Y before TOROTOF"),
        ("TRAORI\nG0 B30\nTOROT\nCYCLE86(10,0,3,-6,,,3,1,0,0,0)", "lifts off along X and Y"),
        ("G0 B30\nTOROT", "without TRAORI"),
        ("TRAORI\nAROT X10\nTOROT", "on top of a turned frame"),
    ],
)
def test_what_settings_of_the_control_decide_is_not_guessed(text: str, says: str, run: Runner) -> None:
    assert any(says in finding.text for finding in run(text + "\n").errors)


def test_a_plane_is_swivelled_with_the_tool_length(run: Runner) -> None:
    tilt = 'CYCLE800(0,"",0,57,0,0,0,0,30,0,0,0,0,1)'
    assert [each.line for each in run(f"SUPA G0 Z0 D0\nCYCLE800()\n{tilt}\nX1 D1").errors] == [3]
    assert run(f"SUPA G0 Z0 D0\nCYCLE800()\nG0 B0 D1\n{tilt}\nX1").errors == ()
