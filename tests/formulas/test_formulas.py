"""The formulas that are printed, evaluated as a reader would: they give forward and inverse, for every machine."""

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import trunnion
from tests.support.fifty_machines import CONTRADICTIONS, ROWS, load
from tests.support.formulas import ODD_MACHINES, evaluated
from tests.support.machines import five_axis_machines
from trunnion.cli import main
from trunnion.errors import MissingExtraError
from trunnion.formulas import chain, symbols
from trunnion.machines import Machine, forward, inverse, load_machine, slide_positions

TOLERANCE = 1e-9
ZERO, LENGTH = (11.0, -23.0, 47.0), 83.0


def differences(machine: Machine) -> float:
    """The largest difference between what is printed and forward and inverse, at some positions."""
    found = trunnion.kinematics(machine, zero=ZERO, tool_length=LENGTH)
    assert found.passed, found.agreement
    placed = found.machine
    known = {each.name: each.value for each in found.parameters}
    random, worst = np.random.default_rng(3), 0.0
    low, high = np.clip(machine.limits, -300.0, 300.0).T
    names = [each.variable for each in found.axes]
    for joints in random.uniform(low, high, (8, 5)):
        tip, axis = forward(placed, joints[None], LENGTH)
        there = evaluated((*found.parts, *found.forward), known | dict(zip(names, joints.tolist(), strict=True)))
        tool = dict(zip("xyzijk", (*tip[0].tolist(), *axis[0].tolist()), strict=True))
        worst = max(worst, *(abs(there[name] - value) for name, value in tool.items()))
        solved = inverse(placed, tip, axis, LENGTH)
        offset = slide_positions(placed, np.zeros((1, 3)), np.zeros((1, 2)), LENGTH)[0]
        for solution, expected in zip(found.solutions, solved.joints[:, 0], strict=True):
            turned = names[machine.rotary[1]]
            angle = evaluated(solution.rotary[:1], known | tool)
            parts = [each for each in found.parts if each.name.startswith(f"R_{turned}_")]
            turns = evaluated((*parts, *solution.rotary[1:]), angle)
            slides = evaluated((*found.parts, *found.linear), turns)
            words = evaluated((*found.parts, *found.without_tcp), turns)
            for k, name in enumerate(names):
                if machine.axes[k].is_rotary:
                    worst = max(worst, abs((turns[name] - expected[k] + 180.0) % 360.0 - 180.0))
                else:
                    worst = max(worst, abs(slides[name] - expected[k]), abs(words[name] - expected[k] + offset[k]))
    return worst


@pytest.mark.parametrize("name", five_axis_machines())
def test_formulas_of_shipped_machines_are_forward_and_inverse(name: str) -> None:
    assert differences(load_machine(name)) < TOLERANCE


@pytest.mark.third
@pytest.mark.parametrize("name", sorted(set(ROWS) - set(CONTRADICTIONS)))
def test_formulas_of_fifty_machines_are_forward_and_inverse(name: str, tmp_path: Path) -> None:
    assert differences(load(ROWS[name], tmp_path)) < TOLERANCE


@pytest.mark.parametrize("name", ODD_MACHINES)
def test_formulas_of_odd_chains_are_forward_and_inverse(name: str, tmp_path: Path) -> None:
    file = tmp_path / "odd.toml"
    file.write_text(ODD_MACHINES[name], encoding="utf-8")
    assert differences(load_machine(file)) < TOLERANCE


def test_formulas_of_the_ucp800_are_the_published_ones() -> None:
    found = trunnion.kinematics("ucp800")
    assert {each.name: each.text for each in found.without_tcp} == {
        "X": "cos(C)*(x - a_x) - sin(C)*(y - a_y) + a_x",
        "Y": "cos(A)*(cos(C)*(y - a_y) + sin(C)*(x - a_x)) - sin(A)*(z - a_z) + a_y",
        "Z": "sin(A)*(cos(C)*(y - a_y) + sin(C)*(x - a_x)) + cos(A)*(z - a_z) + a_z",
    }
    assert [each.text for each in found.forward[3:]] == ["sin(A)*sin(C)", "cos(C)*sin(A)", "cos(A)"]
    assert [[each.text for each in one.rotary] for one in found.solutions] == [
        ["acos(k)", "atan2(i, j)"], ["-acos(k)", "atan2(-i, -j)"]
    ]  # fmt: skip


def test_what_is_unknown_stays_a_symbol_and_zeros_are_left_out() -> None:
    unknown = {each.name for each in trunnion.kinematics("yl569").parameters if each.value is None}
    assert unknown == {"a_x", "a_y", "a_z", "L"}
    known = trunnion.kinematics("yl569", zero=(0.0, 0.0, 25.0), tool_length=100.0)
    assert {each.name: each.value for each in known.parameters} == {"a_z": -25.0, "L": 100.0}
    assert known.linear[1].text == "cos(C)*y - sin(C)*x"


def test_poles_limits_and_reach_are_named() -> None:
    found = trunnion.kinematics("yl569")
    assert [(pole.tool_axis, pole.free, pole.angle, pole.in_travel) for pole in found.poles] == [
        ((0.0, 0.0, 1.0), "C", 0.0, True), ((0.0, 0.0, -1.0), "C", 180.0, False)
    ]  # fmt: skip
    travel = [each.where and each.where.travel for each in found.solutions]
    assert travel == [((0.0, 100.0),), ((-11.0, 0.0),)]
    nutated = trunnion.kinematics("generic_nutated_b45_c").reach
    assert (nutated.nearest, round(nutated.farthest, 9)) == (0.0, 90.0)


def test_a_wrong_sign_in_a_formula_fails(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    def turned_back(direction: symbols.Triple, angle: Any) -> symbols.Rows:
        return symbols.transposed(symbols.rotation(direction, angle))

    monkeypatch.setattr(chain, "rotation", turned_back)
    assert main(["kinematics", "dmu65"]) == 1
    assert "is MORE THAN 1e-09." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("change", "wrong"),
    [
        (lambda formula: formula.replace("sin(C)", "cos(C)"), "linear"),
        (lambda formula: formula.replace(" - a_z", " + a_z"), "linear"),
    ],
)
def test_the_test_sees_a_changed_formula(change: Callable[[str], str], wrong: str) -> None:
    found = trunnion.kinematics("yl569", zero=ZERO, tool_length=LENGTH)
    values: Mapping[str, Any] = {each.name: each.value for each in found.parameters}
    values = {**values, **dict(zip("xyzBC", (5.0, 6.0, 7.0, 20.0, 30.0), strict=True))}
    formulas = getattr(found, wrong)
    changed = [type(each)(each.name, change(each.text), "") for each in formulas]
    assert evaluated(formulas, values) != evaluated(changed, values)


@pytest.mark.parametrize("notation", ["text", "markdown", "latex"])
def test_pages_have_every_formula(notation: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["kinematics", "generic_nutated_b45_c", "--format", notation]) == 0
    page = capsys.readouterr().out
    found = trunnion.kinematics("generic_nutated_b45_c")
    formulas = (
        *found.forward,
        *found.linear,
        *found.without_tcp,
        *found.solutions[0].rotary,
        *found.solutions[1].rotary,
    )
    shown = [each.text if notation == "text" else each.latex.replace(" = ", " &= ", 1) for each in formulas]
    assert [formula for formula in shown if formula not in page] == []
    assert page.count("{") == page.count("}")
    if notation == "latex":
        assert page.startswith("\\documentclass")
        assert page.rstrip().endswith("\\end{document}")
        assert page.count(r"\begin{") == page.count(r"\end{")


_TURNING = 'name = "C"\nendless = false\nlimits_deg'


@pytest.mark.parametrize(
    "axis",
    [
        f"{_TURNING} = [-1e9, 1e9]\n",
        f"{_TURNING} = [3e4, 4e4]\nhome_deg = 3e4\n",
        f"{_TURNING} = [-3e4, 50]\n",
        'name = "A"\nlimits_deg = [-1, 1]\n',
    ],
)
def test_travel_that_is_far_or_all_near_a_pole_is_tried_elsewhere(axis: str, tmp_path: Path) -> None:
    file = tmp_path / "odd.toml"
    file.write_text(f'extends = "dmu65"\n[[axis]]\n{axis}', encoding="utf-8")
    found = trunnion.kinematics(file)
    assert (found.agreement.poses, found.passed) == (500, True)


def test_one_length_and_one_zero_are_wanted(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["kinematics", "yl569", "--tool-length", "1=5"]) == 2
    assert main(["kinematics", "yl569", "--zero", "G54=1,2,3"]) == 2
    assert capsys.readouterr().err.count("[ARG220]") == 2


def test_without_sympy_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "sympy", None)
    with pytest.raises(MissingExtraError, match=r"trunnion\[kinematics\]"):
        trunnion.kinematics("yl569")
