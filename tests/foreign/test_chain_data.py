"""Rotary axes of an 840D: TRAORI and the swivel data of CYCLE800, against definitions."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.support.machines import five_axis_machines
from trunnion.foreign.definition import differences, nearest_machine, written_definition
from trunnion.foreign.machine import ForeignMachine
from trunnion.foreign.machine_data import read_machine_data
from trunnion.machines import Machine, load_machine
from trunnion.machines.links import link_transforms

#: Offset of swivel data -> the first of its three variables.
_FIRST = {1: 1, 2: 4, 3: 15, 4: 18}


def read(folder: Path, lines: list[str]) -> ForeignMachine:
    file = folder / "nck.arc"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return read_machine_data(file)


def names(*axes: str) -> list[str]:
    lines = []
    for k, axis in enumerate(axes):
        lines += [f'$MN_AXCONF_MACHAX_NAME_TAB[{k}]="{axis}"', f"$MC_AXCONF_MACHAX_USED[{k}]={k + 1}"]
    return [*lines, "$MA_IS_ROT_AX[AX4]=1", "$MA_IS_ROT_AX[AX5]=1"]


def vector(first: int, values: tuple[float, float, float]) -> list[str]:
    return [f"$TC_CARR{first + k}[1]={value!r}" for k, value in enumerate(values)]


def swivel_data(machine: Machine) -> list[str]:
    """Swivel data of a machine, from the manual's words: the first axis carries the second, or is in the head."""
    near, far = (machine.axes[column] for column in machine.rotary)  # from the workpiece to the tool
    kinds = {("part", "part"): "P", ("tool", "tool"): "T", ("part", "tool"): "M"}
    kind = kinds[str(near.mount), str(far.mount)]
    one, two = (near, far) if kind == "T" else (far, near)
    gauge = np.array(machine.spindle_point)
    at_one, at_two = np.array(one.point) - gauge, np.array(two.point) - gauge
    offsets = {
        "T": {3: at_two, 2: at_one - at_two, 1: -at_one},
        "P": {2: at_one, 3: at_two - at_one, 4: -at_two},
        "M": {2: at_one, 1: -at_one, 3: at_two, 4: -at_two},
    }[kind]
    lines = [f"$TC_CARR21[1]={one.name}", f"$TC_CARR22[1]={two.name}", f'$TC_CARR23[1]="{kind}"']
    for which, offset in offsets.items():
        lines += vector(_FIRST[which], tuple(offset.tolist()))
    for first, axis in ((7, one), (10, two)):
        turns = axis.sense * (-1.0 if str(axis.mount) == "part" else 1.0)  # what really moves, right-handed
        lines += vector(first, tuple((turns * np.array(axis.direction)).tolist()))
    return lines


@pytest.mark.parametrize("name", five_axis_machines())
def test_swivel_data_of_a_machine_have_nothing_otherwise(name: str, tmp_path: Path) -> None:
    machine = load_machine(name)
    machine = replace(machine, spindle_point=(3.0, -5.0, 250.0))
    found = read(tmp_path, swivel_data(machine))
    assert {key[2] for key in found.values if key[0] == "axis"} >= {"direction", "positive", "point_mm"}
    assert found.rotary == tuple((axis.name, str(axis.mount)) for axis in machine.axes if axis.is_rotary)
    assert list(differences(found, machine)) == []


@pytest.mark.parametrize("name", ["yl569", "generic_head_head_ca", "generic_head_table_bc", "haas_umc750"])
def test_each_changed_number_is_the_one_that_is_named(name: str, tmp_path: Path) -> None:
    machine = load_machine(name)
    lines = swivel_data(machine)
    near, far = (machine.axes[column] for column in machine.rotary)
    is_head = str(near.mount) == "tool"
    one, two = (near, far) if is_head else (far, near)
    for k, line in enumerate(lines):
        number = int(line[len("$TC_CARR") :].partition("[")[0])
        if number in range(7, 13):
            start, _, value = line.partition("=")
            if abs(float(value)) == 1.0:
                changed = [*lines[:k], f"{start}={-float(value)}", *lines[k + 1 :]]
                other = list(differences(read(tmp_path, changed), machine))
                axis = one if number < 10 else two
                assert [each.key for each in other] == [f"axis.{axis.name}.positive"]
                assert {other[0].here, other[0].there} == {"standard", "reversed"}
                assert f"nck.arc:{k + 1 - (number - 1) % 3}" in other[0].source  # where its vector begins


def test_a_place_counts_beside_its_line_alone(tmp_path: Path) -> None:
    machine = load_machine("yl569")
    lines = [each for each in swivel_data(machine) if not each.startswith(("$TC_CARR4[", "$TC_CARR5[", "$TC_CARR6["))]
    other = list(differences(read(tmp_path, [*lines, *vector(4, (0.02, 7.0, -0.03))]), machine))
    assert [(each.key, each.here, each.there) for each in other] == [
        ("axis.B.point_mm X", 0.0, 0.02), ("axis.B.point_mm Z", 0.0, -0.03), ("axis.C.point_mm X", 0.0, 0.02),
        ("axis.C.point_mm Y", 0.0, 7.0),
    ]  # fmt: skip


def test_an_axis_that_is_not_square_is_a_difference(tmp_path: Path) -> None:
    machine = load_machine("yl569")
    lines = [each for each in swivel_data(machine) if not each.startswith(("$TC_CARR7[", "$TC_CARR8[", "$TC_CARR9["))]
    found = read(tmp_path, [*lines, *vector(7, (0.001, -1.0, 0.0))])
    assert [each.key for each in differences(found, machine)] == ["axis.B.direction X"]


def test_a_table_turns_its_offset_as_the_manual_has_it(tmp_path: Path) -> None:
    """Siemens, tool compensation W1: I4 of 15 mm along Z, and B at 45 degrees about +Y, move the zero by X10.607 and
    Z-4.393: the vector of a table is right-handed about what the table does.
    """
    lines = [*names("X1", "Y1", "Z1", "B1", "C1"), "$TC_CARR21[1]=B", "$TC_CARR22[1]=C", "$TC_CARR23[1]=P"]
    lines += [*vector(7, (0.0, 1.0, 0.0)), *vector(10, (0.0, 0.0, 1.0)), *vector(18, (0.0, 0.0, 15.0))]
    found = read(tmp_path, lines)
    text = written_definition(found, "yl569", "ours").text
    (tmp_path / "ours.toml").write_text(text, encoding="utf-8")
    machine = load_machine(tmp_path / "ours.toml")
    joints = np.zeros((1, 5))
    joints[0, [axis.name for axis in machine.axes].index("B")] = 45.0
    pose = link_transforms(machine, joints)["workpiece"].reshape(-1)
    moved = _applied(pose, (0.0, 0.0, 15.0))
    assert moved == pytest.approx((15.0 * math.sin(math.pi / 4), 0.0, 15.0 * math.cos(math.pi / 4)), abs=1e-9)
    assert (moved[0], moved[2] - 15.0) == pytest.approx((10.607, -4.393), abs=5e-4)


def _applied(pose: np.ndarray, point: tuple[float, float, float]) -> tuple[float, float, float]:
    matrix = pose.reshape(-1, 4)[:3] if pose.size >= 12 else pose
    turned = matrix[:, :3] @ np.array(point) + matrix[:, 3]
    return float(turned[0]), float(turned[1]), float(turned[2])


TRAORI = {
    24: ("generic_head_head_ca", {"PART_OFFSET": 1, "JOINT_OFFSET": 4, "BASE_TOOL": 15}),
    40: ("yl569", {"BASE_TOOL": 4, "JOINT_OFFSET": 15, "PART_OFFSET": 18}),
    56: ("generic_head_table_bc", {"JOINT_OFFSET": 1, "BASE_TOOL": 4, "JOINT_OFFSET_PART": 15, "PART_OFFSET": 18}),
}


@pytest.mark.parametrize("kind", TRAORI)
def test_traori_has_the_vectors_of_the_swivel_data(kind: int, tmp_path: Path) -> None:
    name, places = TRAORI[kind]
    machine = load_machine(name)
    swivel = {int(each[8:].partition("[")[0]): each.partition("=")[2] for each in swivel_data(machine)}
    lines = names("X", "Y", "Z", swivel[21], swivel[22])
    lines += [f"$MC_TRAFO_TYPE_1={kind}", "$MC_TRAFO_AXES_IN_1[3]=4", "$MC_TRAFO_AXES_IN_1[4]=5"]
    for datum, first in (*places.items(), ("AXIS1", 7), ("AXIS2", 10)):
        lines += [f"$MC_TRAFO5_{datum}_1[{k}]={swivel[first + k]}" for k in range(3)]
    found = read(tmp_path, lines)
    assert found.rotary == tuple((axis.name, str(axis.mount)) for axis in machine.axes if axis.is_rotary)
    assert [each.what for each in found.left] == []
    assert {key[2] for key in found.values if key[0] == "axis"} == {"direction", "positive", "point_mm"}
    assert list(differences(found, machine)) == []
    both = read(tmp_path, [*lines, *swivel_data(machine), "$TC_CARR4[1]=0.5"])
    assert [each.what for each in both.left if "counts" in each.why]  # the swivel data say something else


def test_the_first_axis_of_a_mixed_machine_is_in_the_head(tmp_path: Path) -> None:
    lines = [*names("X", "Y", "Z", "B", "C"), "$MC_TRAFO_TYPE_1=51", "$MC_TRAFO_AXES_IN_1[3]=4"]
    found = read(tmp_path, [*lines, "$MC_TRAFO_AXES_IN_1[4]=5", "$MC_TRAFO5_BASE_TOOL_1[2]=200"])
    assert found.rotary == (("C", "part"), ("B", "tool"))
    assert nearest_machine(found) == "generic_head_table_bc"
    assert "24, 40 and 56" in next(each.why for each in found.left if "BASE_TOOL" in each.what)


def test_type_72_takes_the_tool_carrier_that_it_names(tmp_path: Path) -> None:
    lines = [each.replace("[1]", "[2]") for each in swivel_data(load_machine("yl569"))]
    lines = [*lines, '$TC_CARR23[1]="T"', "$MC_TRAFO_TYPE_1=72", "$MC_TRAFO5_TCARR_NO_1=2"]
    found = read(tmp_path, lines)
    assert found.rotary == (("C", "part"), ("B", "part"))
    assert "1 value of the swivel data 1" in [each.what for each in found.left]


def test_what_the_definition_does_not_take_is_listed(tmp_path: Path) -> None:
    lines = [*swivel_data(load_machine("yl569")), "$TC_CARR24[1]=12", "$TC_CARR28[1]=5", "$TC_CARR44[1]=0.01"]
    lines += ['$TC_CARR34[1]="TABLE"', "$TC_CARR25[1]=0", "$TC_CARR65[1]=0.2", "$TC_CARR20[1]=7"]
    lines = [line for line in lines if line != "$TC_CARR20[1]=-0.0"]
    left = {each.what: each.why for each in read(tmp_path, lines).left}
    assert "all axes at 0" in left["$TC_CARR24[1] = 12"]
    assert "Hirth" in left["$TC_CARR28[1] = 5"]
    assert "can add" in left["$TC_CARR44[1] = 0.01"]
    assert "can add" in left["$TC_CARR65[1] = 0.2"]
    assert left["1 value of the swivel data 1"] == "0 or empty"
    assert "not closed" in left["I2 + I3 + I4 = [0.0, 0.0, 7.0] (swivel data 1)"]


def test_the_range_of_swivel_data_does_not_replace_software_limits(tmp_path: Path) -> None:
    ranges = ["$TC_CARR30[1]=-5", "$TC_CARR32[1]=90", "$TC_CARR31[1]=0", "$TC_CARR33[1]=0"]
    lines = [*names("X", "Y", "Z", "B", "C"), *swivel_data(load_machine("yl569")), *ranges]
    found = read(tmp_path, lines)
    assert found.values["axis", "B", "limits_deg"].value == [-5.0, 90.0]
    assert ("axis", "C", "limits_deg") not in found.values  # both 0: they do not count
    found = read(tmp_path, [*lines, "$MA_POS_LIMIT_MINUS[AX4]=-11", "$MA_POS_LIMIT_PLUS[AX4]=100"])
    assert found.values["axis", "B", "limits_deg"].value == [-11.0, 100.0]
    assert [each.what for each in found.left if "CYCLE800 alone" in each.why]


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ("$MA_POS_LIMIT_PLUS[AX4]=100,5", "$MA_POS_LIMIT_PLUS[AX4]=100,5"),
        ("$TC_CARR7=1", "$TC_CARR7=1"),
        ("$TC_CARR4[1]=1e99", "$TC_CARR4[1] = 1e99"),
        ("$TC_CARR4[1]=NAN", "$TC_CARR4[1] = NAN"),
        ("$MN_SOMETHING=3", "1 other machine datum from here on"),
        ('$MN_AXCONF_MACHAX_NAME_TAB[6]="Z"', "$MN_AXCONF_MACHAX_NAME_TAB[6] = Z"),
    ],
)
def test_a_line_that_counts_for_nothing_is_reported(line: str, what: str, tmp_path: Path) -> None:
    lines = swivel_data(load_machine("yl569"))
    lines = [*names("X", "Y", "Z", "B", "C"), line, *(each for each in lines if not each.startswith("$TC_CARR4["))]
    assert what in [each.what for each in read(tmp_path, lines).left]
