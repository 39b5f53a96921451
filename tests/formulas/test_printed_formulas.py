"""The page about printed formulas: its tables and formulas are what machines do."""

import math
import re

import numpy as np
import pytest

import trunnion
from tests.support.locations import DOCS
from trunnion.machines import forward, load_machine

PAGE = (DOCS / "printed-formulas.md").read_text(encoding="utf-8")
ROWS = re.findall(r"^\| (\d+\.\d{4}) \| (\d+\.\d{4}) \| (\S+) \| (\S+) \| (\S+) \|$", PAGE, re.MULTILINE)


def test_the_table_of_angles_follows_the_formulas_of_the_machine_and_not_the_printed_ones() -> None:
    machine = load_machine("yl569")
    assert len(ROWS) == 5
    for row in ROWS:
        b, c, *axis = map(float, row)
        joints = np.zeros((1, 5))
        joints[0, machine.column("B")], joints[0, machine.column("C")] = b, c
        np.testing.assert_allclose(forward(machine, joints)[1][0], axis, atol=2e-4)
        turn_b, turn_c = math.radians(b), math.radians(c)
        printed = math.sin(turn_b) * math.sin(turn_c), math.sin(turn_b) * math.cos(turn_c), math.cos(turn_b)
        assert np.abs(np.subtract(printed, axis)).max() > 0.2


@pytest.mark.parametrize(
    ("machine", "axis"),
    [
        ("yl569", ["cos(C)*sin(B)", "sin(B)*sin(C)", "cos(B)"]),
        ("ucp800", ["sin(A)*sin(C)", "cos(C)*sin(A)", "cos(A)"]),
        ("hs664rt", ["sin(A)*sin(C)", "-cos(C)*sin(A)", "cos(A)"]),
    ],
)
def test_the_tool_axes_on_the_page_are_those_of_the_machines(machine: str, axis: list[str]) -> None:
    assert [each.text for each in trunnion.kinematics(machine).forward[3:]] == axis
    if machine != "ucp800":  # whose factors are in the order of the work
        assert [part for part in axis if f"`{'ijk'[axis.index(part)]} = {part}`" not in PAGE] == []


def test_the_corrected_lines_of_the_ucp800_are_the_words_of_the_machine() -> None:
    random = np.random.default_rng(1)
    lines = dict(re.findall(r"^(s[xyz]) = (.+)$", PAGE, re.MULTILINE))
    found = trunnion.kinematics("ucp800").without_tcp
    cosine, sine = (lambda angle: math.cos(math.radians(angle))), (lambda angle: math.sin(math.radians(angle)))
    for values in random.uniform(-90.0, 90.0, (20, 8)).tolist():
        page = dict(zip(("px", "py", "pz", "mx", "my", "mz", "A", "C"), values, strict=True))
        ours = dict(zip(("x", "y", "z", "a_x", "a_y", "a_z", "A", "C"), values, strict=True))
        functions = {"cos": cosine, "sin": sine}
        for name, each in zip(("sx", "sy", "sz"), found, strict=True):
            assert math.isclose(
                eval(lines[name], {**functions, **page}), eval(each.text, {**functions, **ours}), abs_tol=1e-9
            )


@pytest.mark.parametrize(
    ("angles", "axis"),
    [((-54.736, 0.0, -135.0), (0.57735, -0.57735, 0.57735)), ((-45.0, 0.0, -90.0), (0.70711, 0.0, 0.70711))],
)
def test_planes_turn_in_the_order_of_the_page(angles: tuple[float, ...], axis: tuple[float, ...]) -> None:
    a, b, c = np.radians(angles)
    turned = np.array([0.0, -math.sin(a), math.cos(a)])
    turned = np.array([[math.cos(b), 0, math.sin(b)], [0, 1, 0], [-math.sin(b), 0, math.cos(b)]]) @ turned
    turned = np.array([[math.cos(c), -math.sin(c), 0], [math.sin(c), math.cos(c), 0], [0, 0, 1]]) @ turned
    expected = np.array(axis)
    assert f"({', '.join(f'{part:g}' for part in axis)})".replace("-", "−") in PAGE
    np.testing.assert_allclose(turned, expected, atol=1e-4)
