"""The table of fifty real machines, and the definition that each row of it makes."""

import csv
from pathlib import Path

import numpy as np

from tests.support.locations import TESTS
from trunnion.machines import Machine, load_machine

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
        ["axis C direction is parallel to the spindle"],
    ),
    "Macturn30": ('the letter of the fourth axis is "BA=", which is a word of the control', ['axis[4].name is "BA="']),
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
