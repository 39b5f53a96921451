"""Checks of the axes of a machine definition taken together: names, number, order and geometry."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions import Table
from trunnion.machines.machine import Axis, AxisKind, Mount, Vector
from trunnion.messages import Wording

#: Two directions closer than this count as parallel, rad (0.06 degrees): such a machine could not orient a tool.
PARALLEL_TOLERANCE: Final = 1e-3


def check_chain(
    table: Table, axis_tables: list[Table], axes: tuple[Axis, ...], spindle: Vector, *, sound: bool
) -> None:
    """Note mistakes in the axes of a machine.

    table        the whole definition
    axis_tables  the tables of the axes
    axes         what they describe, from the workpiece to the tool
    spindle      direction of the spindle
    sound        each axis is sound by itself; only then is their geometry checked
    """
    rotary = [k for k, axis in enumerate(axes) if axis.is_rotary]
    slides = [k for k, axis in enumerate(axes) if not axis.is_rotary]
    _check_names(axis_tables, axes)
    if all(entry.to_dict().get("kind") in tuple(AxisKind) for entry in axis_tables) and (
        len(rotary) > 2 or len(slides) != 3
    ):
        table.add_problem(
            "axis",
            Wording(
                "DEF410",
                "linear_rotary_axes",
                count=len(slides),
                rotary_count=len(rotary),
                slides=tuple(axes[k].name for k in (*slides, *rotary)),
            )
            if len(axes) > 5
            else Wording("DEF410", "linear_rotary", count=len(slides), rotary_count=len(rotary)),
        )
        sound = False
    for k in range(1, len(axes)):
        stated = all("carries" in axis_tables[at] for at in (k - 1, k))
        if stated and axes[k].mount is Mount.PART and axes[k - 1].mount is Mount.TOOL:
            axis_tables[k].add_problem("carries", Wording("DEF410", "part_but_before", axes=axes[k - 1].name))
    if sound:
        _check_rotary_directions(axis_tables, axes, rotary, spindle)
        _check_slide_directions(axis_tables, axes, slides)


def _check_names(axis_tables: list[Table], axes: tuple[Axis, ...]) -> None:
    seen: dict[str, int] = {}
    for k, axis in enumerate(axes):
        letter = axis.name.casefold()
        if letter and letter in seen:
            file, line = axis_tables[seen[letter]].location("name")
            axis_tables[k].add_problem(
                "name",
                Wording(
                    "DEF430", "name_too", axis=axis.name, path=axis_tables[seen[letter]].path, file=file, line=line
                ),
            )
        seen.setdefault(letter, k)


def _check_rotary_directions(
    axis_tables: list[Table], axes: tuple[Axis, ...], rotary: list[int], spindle: Vector
) -> None:
    if len(rotary) < 2:
        return
    first, second = (np.array(axes[k].direction) for k in rotary)
    names = [axes[k].name for k in rotary]
    if _sine(first, second) < PARALLEL_TOLERANCE:
        axis_tables[rotary[1]].add_problem("direction", Wording("DEF420", "parallel_machine_could", names=names[0]))
    elif _sine(second, np.array(spindle)) < PARALLEL_TOLERANCE:
        axis_tables[rotary[1]].add_problem(
            "direction", Wording("DEF420", "parallel_spindle_turns", turning=names[1], tilting=names[0])
        )


def _check_slide_directions(axis_tables: list[Table], axes: tuple[Axis, ...], slides: list[int]) -> None:
    directions = np.array([axes[k].direction for k in slides])
    if abs(float(np.linalg.det(directions))) < PARALLEL_TOLERANCE:
        axis_tables[slides[2]].add_problem(
            "direction", Wording("DEF420", "those_other_linear", slides=tuple(axes[k].name for k in slides))
        )
    else:
        _check_slide_senses(axis_tables, axes, slides)


def _check_slide_senses(axis_tables: list[Table], axes: tuple[Axis, ...], slides: list[int]) -> None:
    """Note a slide X, Y or Z that counts another way than the frame, in which programs have these letters."""
    for k in slides:
        letter = "XYZ".find(axes[k].name.upper()) if len(axes[k].name) == 1 else -1
        if letter < 0 or axes[k].direction[letter] * axes[k].sense > PARALLEL_TOLERANCE:
            continue
        name = axes[k].name
        wrong = "positive" if axes[k].direction[letter] > PARALLEL_TOLERANCE else "direction"
        axis_tables[k].add_problem(
            wrong,
            Wording("DEF420", "makes_count_another", name=name)
            if axes[k].direction[letter] > PARALLEL_TOLERANCE
            else Wording("DEF420", "makes_count_another_way", name=name),
        )


def _sine(a: Floats, b: Floats) -> float:
    return float(np.linalg.norm(np.cross(a, b)))
