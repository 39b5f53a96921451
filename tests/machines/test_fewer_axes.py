"""Machines with one rotary axis and with none: maps, reach, and programs without the axes that they lack."""

from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.posting import CLEAR, FOOT
from trunnion.errors import InputError, RefusedError
from trunnion.machines import Machine, forward, inverse, link_transforms, load_machine
from trunnion.machines.jog_table import jog_table

_SLIDES = {"X": "[1, 0, 0]", "Y": "[0, 1, 0]", "Z": "[0, 0, 1]"}

#: Order of the axes, and the lines of the rotary ones.
CHAINS = {
    "A table": ("A X Y | Z", {"A": "[1, 0, 0]"}),
    "B table": ("B X | Y Z", {"B": "[0, 1, 0]"}),
    "C table": ("C X Y | Z", {"C": "[0, 0, 1]"}),
    "A head": ("X Y | Z A", {"A": "[1, 0, 0]"}),
    "B head between slides": ("X | Y B Z", {"B": "[0, 1, 0]"}),
    "nutated table": ("B X Y | Z", {"B": "[0, 1, 1]"}),
    "three slides": ("X Y | Z", {}),
    "three slides in the head": ("| X Y Z", {}),
}

CONTROLS = ["linuxcnc", "fanuc_31i", "haas_ngc", "heidenhain_tnc640", "sinumerik_840d"]

FLAT = CLEAR + "FEDRAT/MMPM,500.0\nGOTO/20.0,0.0,5.0\nGOTO/20.0,10.0,5.0\n" + FOOT
LEANING = CLEAR + "FEDRAT/MMPM,500.0\nGOTO/20.0,0.0,5.0\nGOTO/20.0,10.0,5.0,0.6,0.0,0.8\n" + FOOT
WINDING = (
    CLEAR
    + "FEDRAT/MMPM,500.0\n"
    + "".join(
        f"GOTO/{10 + k},{-20 * np.sin(a):.6f},{20 * np.cos(a):.6f},0,{-np.sin(a):.9f},{np.cos(a):.9f}\n"
        for k, a in enumerate(np.radians(np.arange(0.0, 200.0, 10.0)))
    )
    + FOOT
)


def definition(chain: str, control: str = "linuxcnc", more: str = "") -> str:
    order, lines = CHAINS[chain]
    part, _, tool = order.partition("|")
    text = f'schema = 1\nname = "{chain}"\n[control]\nextends = "{control}"\n'
    for side, names in (("part", part.split()), ("tool", tool.split())):
        for name in names:
            rotary = name in lines
            text += f'[[axis]]\nname = "{name}"\nkind = "{"rotary" if rotary else "linear"}"\ncarries = "{side}"\n'
            text += f"direction = {lines.get(name) or _SLIDES[name]}\n"
            text += f"point_mm = [10, -20, 30]\nendless = true\n{more}" if rotary else "limits_mm = [-900, 900]\n"
    return text


def machine_of(folder: Path, chain: str, control: str = "linuxcnc", more: str = "") -> Machine:
    file = folder / "ours.toml"
    file.write_text(definition(chain, control, more), encoding="utf-8")
    return load_machine(file)


@pytest.mark.parametrize("more", ["", 'positive = "reversed"\n'])
@pytest.mark.parametrize("chain", CHAINS)
def test_the_inverse_finds_what_the_forward_map_has(chain: str, more: str, tmp_path: Path) -> None:
    machine = machine_of(tmp_path, chain, more=more)
    own = [column for column, _ in machine.own_columns]
    joints = np.zeros((50, 5))
    joints[:, own] = np.random.default_rng(7).uniform(-80.0, 80.0, (50, len(own)))
    if chain == "C table":
        joints[:, machine.column("C")] = 0.0  # which no tool axis asks for
    tip, axis = forward(machine, joints, 70.0)
    found = inverse(machine, tip, axis, 70.0)
    assert found.reachable.all()
    for branch in found.joints:
        np.testing.assert_allclose(branch, joints, rtol=0, atol=1e-9)


@pytest.mark.parametrize("chain", CHAINS)
def test_a_tool_axis_beside_the_reach_is_refused_and_one_by_the_last_digit_is_not(chain: str, tmp_path: Path) -> None:
    machine = machine_of(tmp_path, chain)
    joints = np.zeros((1, 5))
    tip, axis = forward(machine, joints, 70.0)
    rotary = [np.array(machine.axes[column].direction) for column in machine.own_rotary]
    away = rotary[0] if rotary and abs(rotary[0] @ axis[0]) < 0.9 else np.array([1.0, 0.0, 0.0])
    for off, reached in ((5e-7, True), (5e-6, True), (1e-4, False), (0.3, False)):
        there = inverse(machine, tip, axis + off * away, 70.0)
        assert bool(there.reachable[0]) is reached, off
        if reached:
            assert np.abs(there.joints[0] - joints).max() < 0.1, "no axis turns by what cannot be reached"


@pytest.mark.parametrize("chain", CHAINS)
def test_what_people_see_has_the_axes_of_the_machine_alone(chain: str, tmp_path: Path) -> None:
    machine = machine_of(tmp_path, chain)
    names = CHAINS[chain][0].replace("|", "").split()
    jogs = jog_table(machine)
    assert [axis.name for axis in machine.own_axes] == names
    assert [name for name in jogs.order if name != "bed"] == [jog.axis.name for jog in jogs.axes] == names
    assert jogs.same_axis == ()
    assert all(set(pose.values) == set(CHAINS[chain][1]) for pose in jogs.poses)
    assert set(names) < set(link_transforms(machine, np.zeros((1, 5))))


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize(("chain", "path"), [("three slides", FLAT), ("A table", FLAT), ("A table", WINDING)])
def test_a_program_is_proven_and_names_no_axis_that_is_missing(
    control: str, chain: str, path: str, tmp_path: Path
) -> None:
    machine = machine_of(tmp_path, chain, control)
    cl, program = tmp_path / "part.cls", tmp_path / "part.nc"
    cl.write_text(path, encoding="utf-8")
    for tcp in ("on", "off") if path is WINDING else ("on",):
        settings = {"zero": "0,0,0", "tool_length": "60", **({"tcp": tcp} if len(machine.own_rotary) else {})}
        result = trunnion.post(cl, machine=machine, settings=settings, output=program)
        assert result.passed, result.verification
        text = program.read_text(encoding="utf-8")
        missing = {"A", "B", "C"} - {axis.name for axis in machine.own_axes}
        words = [word for line in text.splitlines() for word in _words(line)]
        assert not [word for word in words if word[0] in missing and word[1:2] in "+-0123456789="]
        assert any(word[0] == "A" for word in words) is (chain == "A table")


def _words(line: str) -> list[str]:
    bare = line.partition(";")[0].partition("(")[0]
    return [] if "CYCL" in bare or bare.startswith("*") else [word for word in bare.split() if len(word) > 1]


@pytest.mark.parametrize(
    ("chain", "said"), [("three slides", "needs a rotary axis"), ("A table", "needs a second rotary axis")]
)
def test_a_tool_axis_that_needs_another_rotary_axis_is_refused_with_its_line(
    chain: str, said: str, tmp_path: Path
) -> None:
    machine = machine_of(tmp_path, chain)
    cl = tmp_path / "part.cls"
    cl.write_text(LEANING, encoding="utf-8")
    with pytest.raises(RefusedError) as refused:
        trunnion.post(cl, machine=machine, settings={"zero": "0,0,0", "tool_length": "60"})
    faults = [problem for problem in refused.value.problems if problem.code == "PLN110"]
    line = LEANING.splitlines().index("GOTO/20.0,10.0,5.0,0.6,0.0,0.8") + 1
    assert [fault.line for fault in faults] == [line]
    assert said in str(faults[0])
    assert "0.600000, 0.000000, 0.800000" in str(faults[0])


@pytest.mark.parametrize("control", ["linuxcnc", "fanuc_31i", "haas_ngc"])
def test_a_word_of_an_axis_that_the_machine_lacks_is_no_word(control: str, tmp_path: Path) -> None:
    machine = machine_of(tmp_path, "A table", control)
    program = tmp_path / "part.nc"
    text = "%\nO1\nG21 G17 G40 G49 G80 G90 G94\nG0 X0 Y0 Z50\nG1 X10 A10 B10 F100\nM30\n%\n"
    program.write_text(text, encoding="utf-8")
    run = trunnion.read_program(program, machine=machine)
    assert [str(fault).partition(": ")[2] for fault in run.diagnostics if "[NC230]" in str(fault)] == [
        "error: B: the machine has no such axis [NC230]"
    ]


def test_three_rotary_axes_are_too_many(tmp_path: Path) -> None:
    file = tmp_path / "ours.toml"
    third = '[[axis]]\nname = "{}"\nkind = "rotary"\ncarries = "tool"\ndirection = [0, {}, 1]\npoint_mm = [0, 0, 0]\n'
    third += "endless = true\n"
    file.write_text(definition("A table") + third.format("B", 1) + third.format("C", 2), encoding="utf-8")
    with pytest.raises(InputError, match="DEF410"):
        load_machine(file)


@pytest.mark.parametrize("chain", ["A table", "C table", "B head between slides", "nutated table", "three slides"])
def test_the_formulas_of_a_machine_are_its_maps(chain: str, tmp_path: Path) -> None:
    found = trunnion.kinematics(machine_of(tmp_path, chain))
    assert found.passed, found.agreement
    assert len(found.solutions) == (1 if chain[0] in "AB" or chain.startswith("nut") else 0)
    assert found.poles == ()
