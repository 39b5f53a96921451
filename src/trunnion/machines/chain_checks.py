"""Checks of the axes of a machine definition taken together: names, number, order and geometry."""

from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions import Table
from trunnion.machines.machine import Axis, AxisKind, Mount, Vector

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
        len(rotary) != 2 or len(slides) != 3
    ):
        what = f"has {len(slides)} linear and {len(rotary)} rotary axes"
        cure = "write three linear and two rotary axes, from the workpiece to the tool"
        if len(axes) > 5:
            what += f" ({', '.join(axes[k].name for k in (*slides, *rotary))})"
            cure = (
                "leave out what a program does not move, such as a quill or a clamped axis (remove = true in the"
                " [[axis]] of a file that extends another): three linear and two rotary axes are moved together"
            )
        table.add_problem("axis", what, cure, code="DEF410")
        sound = False
    for k in range(1, len(axes)):
        stated = all("carries" in axis_tables[at] for at in (k - 1, k))
        if stated and axes[k].mount is Mount.PART and axes[k - 1].mount is Mount.TOOL:
            what = f'is "part", but {axes[k - 1].name} before it carries the tool'
            cure = "order the axes from the workpiece to the tool: all that carry the part come first"
            axis_tables[k].add_problem("carries", what, cure, code="DEF410")
    if sound:
        _check_rotary_directions(axis_tables, axes, rotary, spindle)
        _check_slide_directions(axis_tables, axes, slides)


def _check_names(axis_tables: list[Table], axes: tuple[Axis, ...]) -> None:
    seen: dict[str, int] = {}
    for k, axis in enumerate(axes):
        letter = axis.name.casefold()
        if letter and letter in seen:
            file, line = axis_tables[seen[letter]].location("name")
            what = f'is "{axis.name}", the name of {axis_tables[seen[letter]].path} too ({file}:{line})'
            axis_tables[k].add_problem("name", what, "give every axis its own name", code="DEF430")
        seen.setdefault(letter, k)


def _check_rotary_directions(
    axis_tables: list[Table], axes: tuple[Axis, ...], rotary: list[int], spindle: Vector
) -> None:
    first, second = (np.array(axes[k].direction) for k in rotary)
    names = [axes[k].name for k in rotary]
    if _sine(first, second) < PARALLEL_TOLERANCE:
        what = f"is parallel to that of {names[0]}: the machine could not orient a tool"
        cure = "write the directions of the two rotary axes as they are built"
        axis_tables[rotary[1]].add_problem("direction", what, cure, code="DEF420")
    elif _sine(second, np.array(spindle)) < PARALLEL_TOLERANCE:
        what = f"is parallel to the spindle: {names[1]} turns the tool about itself, and {names[0]} alone tilts it"
        cure = "the rotary axis further from the workpiece must tilt the tool: check the order of the axes"
        axis_tables[rotary[1]].add_problem("direction", what, cure, code="DEF420")


def _check_slide_directions(axis_tables: list[Table], axes: tuple[Axis, ...], slides: list[int]) -> None:
    directions = np.array([axes[k].direction for k in slides])
    if abs(float(np.linalg.det(directions))) < PARALLEL_TOLERANCE:
        names = ", ".join(axes[k].name for k in slides)
        what = f"and those of the other linear axes ({names}) do not reach every point: the directions lie in one plane"
        axis_tables[slides[2]].add_problem(
            "direction", what, "write three directions that do not lie in one plane", code="DEF420"
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
        if axes[k].direction[letter] > PARALLEL_TOLERANCE:
            wrong, cure = (
                "positive",
                (
                    'write "standard": by ISO 841 growing values move the tool, as seen from the workpiece, to '
                    f"+{name}, so that a table goes the other way"
                ),
            )
        else:
            wrong, cure = "direction", f"lay the frame of the whole file so that {name} grows to its +{name}"
        what = f"makes {name} count another way than the {name} of programs, whose holes and arcs would be mirrored"
        axis_tables[k].add_problem(wrong, what, cure, code="DEF420")


def _sine(a: Floats, b: Floats) -> float:
    return float(np.linalg.norm(np.cross(a, b)))
