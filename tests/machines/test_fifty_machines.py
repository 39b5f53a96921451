"""Fifty real machines, as public posts describe them: each becomes a definition and goes there and back in its limits.

``tests/data/machines.csv`` is a table of facts of 50 post-processors. In it the fourth axis is the one on the base and
carries the fifth; ``plane`` is the plane in which an axis turns; offsets lead from the fourth to the fifth axis; the
pivot lies above the gauge point. Rows that contradict themselves are listed here with the reason; they must not load.
"""

import csv
from pathlib import Path

import numpy as np
import pytest

from tests.support.locations import TESTS
from trunnion.errors import InputError
from trunnion.machines import Machine, forward, inverse, load_machine

ROWS = {row["name"]: row for row in csv.DictReader((TESTS / "data" / "machines.csv").open(newline=""))}

#: Why a row is no machine, and what the definition made from it is told.
CONTRADICTIONS = {
    "dmu50_MILL_PLUS": (
        "planes disagree with vectors (YZ but 0 0 1, ZX but 0 1 -1), and by the vectors the axis next to the slides "
        "is parallel to the spindle; both axis letters are missing",
        ["axis[0].name is missing", "axis[1].name is missing", "axis[1].direction is parallel to the spindle"],
    ),
    "mazak_5x": ("both axis letters are missing", ["axis[0].name is missing", "axis[1].name is missing"]),
    "discovery4022_mach9": ("the letter of the fourth axis is missing", ["axis[1].name is missing"]),
    "ingersol_840d_5e_hh_cab50g": (
        "B carries C, but C is parallel to the spindle: the fourth and the fifth axis are exchanged",
        ["axis[4].direction is parallel to the spindle"],
    ),
    "Macturn30": ('the letter of the fourth axis is "BA=", which is a word of the control', ['axis[4].name is "BA="']),
}

#: Facts that are odd and yet make a machine; what the test does about them.
ODD = {
    "Haas_vf2_ss_5axis": "an axis about Z is called B: names are free",
    "Haas_5T": "an axis about Z is called B: names are free",
    "Makino_Axx-5x": "an axis about X is called C: names are free",
    "zfg630_fanuc0m": "an axis about Z is called B; its zero is turned by 180 degrees, which turns the workpiece frame",
    "MAZAK_VORTEX": "no spindle axis is stated: Z, the default",
    "DMU_70_eVo_840D_in": "a nutated B at 45 degrees with 102 degrees of travel tilts the tool by less than 90",
}

ABOUT = {"YZ": (1.0, 0.0, 0.0), "ZX": (0.0, 1.0, 0.0), "XY": (0.0, 0.0, 1.0)}


def numbers(text: str) -> list[float]:
    """Numbers between blanks."""
    return [float(word) for word in text.split()]


def rotary(row: dict[str, str], which: str, point: list[float]) -> str:
    """The definition of a rotary axis."""
    vector = numbers(row[f"{which}_vector"]) or list(ABOUT[row[f"{which}_plane"]])
    side = "tool" if row[f"{which}_side"].lower() == "head" else "part"
    sense = "reversed" if row[f"{which}_sense"].lower() == "reverse" else "standard"
    name = f'name = "{row[which]}"\n' if row[which] else ""
    low, high = float(row[f"{which}_min_deg"]), float(row[f"{which}_max_deg"])
    home = min(max(0.0, low), high)
    return (
        f'[[axis]]\n{name}kind = "rotary"\ncarries = "{side}"\ndirection = {vector}\npoint_mm = {point}\n'
        f'positive = "{sense}"\nlimits_deg = [{low}, {high}]\nhome_deg = {home}\n'
    )


def slide(row: dict[str, str], letter: str, inch: float) -> str:
    """The definition of a slide, travel on both sides of zero."""
    text = f'[[axis]]\nname = "{letter}"\nkind = "linear"\ncarries = "tool"\n'
    text += f"direction = {[float(letter == other) for other in 'XYZ']}\n"
    travel = row[f"{letter.lower()}_travel"]
    if travel:
        text += f"limits_mm = [{-float(travel) * inch / 2}, {float(travel) * inch / 2}]\n"
    if row["rapid_feed"]:
        text += f"rapid_mm_min = {float(row['rapid_feed']) * inch}\n"
    return text


def definition(row: dict[str, str]) -> str:
    """One row of the table as a machine definition."""
    inch = 25.4 if row["unit"] == "IN" else 1.0
    fourth = np.array(numbers(row["axis4_offset"])) * inch
    fifth = np.array(numbers(row["axis5_offset"])) * inch
    pivot = np.array([0.0, 0.0, float(row["pivot_gauge_offset"] or 0.0) * inch])
    slides = [slide(row, letter, inch) for letter in "XYZ"]
    heads = [row[f"{which}_side"].lower() == "head" for which in ("axis4", "axis5")]
    if heads == [False, False]:
        chain = [rotary(row, "axis5", (fourth + fifth).tolist()), rotary(row, "axis4", fourth.tolist()), *slides]
    elif heads == [True, True]:
        chain = [*slides, rotary(row, "axis4", (pivot - fifth).tolist()), rotary(row, "axis5", pivot.tolist())]
    else:
        assert heads == [True, False]
        chain = [rotary(row, "axis5", fifth.tolist()), *slides, rotary(row, "axis4", pivot.tolist())]
    spindle = f"[spindle]\ndirection = {numbers(row['spindle_axis']) or [0, 0, 1]}\n"
    return f'schema = 1\nname = "{row["name"]}"\n{spindle}' + "".join(chain)


def load(row: dict[str, str], folder: Path) -> Machine:
    """Write the definition of a row and load it."""
    path = folder / "machine.toml"
    path.write_text(definition(row), encoding="utf-8")
    return load_machine(path)


def test_the_table_holds_fifty_machines_and_every_exception_is_one_of_them() -> None:
    assert len(ROWS) == 50
    assert set(CONTRADICTIONS) | set(ODD) <= set(ROWS)


@pytest.mark.parametrize("name", sorted(set(ROWS) - set(CONTRADICTIONS)))
def test_a_real_machine_goes_there_and_back_within_its_limits(name: str, tmp_path: Path) -> None:
    machine = load(ROWS[name], tmp_path)
    for which in ("axis4", "axis5"):
        axis = machine.axis(ROWS[name][which])
        assert [axis.low, axis.high] == [float(ROWS[name][f"{which}_{end}_deg"]) for end in ("min", "max")]
    random = np.random.default_rng(5)
    low, high = np.clip(machine.limits, -5000.0, 5000.0).T
    values = random.uniform(low, high, (500, 5))
    tip, axis_there = forward(machine, values, 120.0)
    found = inverse(machine, tip, axis_there, 120.0)
    assert found.reachable.all()
    for branch in found.joints:
        again_tip, again_axis = forward(machine, branch, 120.0)
        np.testing.assert_allclose(again_tip, tip, rtol=0, atol=1e-9)
        np.testing.assert_allclose(again_axis, axis_there, rtol=0, atol=1e-12)
    off = found.joints - values
    turning = list(machine.rotary)
    off[:, :, turning] = (off[:, :, turning] + 180.0) % 360.0 - 180.0
    assert np.abs(off).max(axis=2).min(axis=0).max() < 1e-6


@pytest.mark.parametrize("name", sorted(CONTRADICTIONS))
def test_a_row_that_contradicts_itself_is_refused_for_the_reason_listed(name: str, tmp_path: Path) -> None:
    _, expected = CONTRADICTIONS[name]
    with pytest.raises(InputError) as caught:
        load(ROWS[name], tmp_path)
    said = [problem.what for problem in caught.value.problems]
    for what in expected:
        if "parallel" in what and any("missing" in line for line in said):
            continue  # the chain is looked at only when every axis is sound by itself
        assert any(line.startswith(what) for line in said), said


def test_planes_and_vectors_agree_wherever_both_are_given() -> None:
    differ = set()
    for name, row in ROWS.items():
        for which in ("axis4", "axis5"):
            vector, plane = numbers(row[f"{which}_vector"]), row[f"{which}_plane"]
            if vector and plane in ABOUT and tuple(vector) != ABOUT[plane]:
                differ.add(name)
    assert differ == {"dmu50_MILL_PLUS"}
