"""From a definition file to a ``Machine``, with every mistake reported at once.

The functions that read a table are lists of its keys; ``docs/definitions.md`` says the same in words, and a test holds
the two together. Keys carry their units, because the unit of ``rapid`` or ``limits`` depends on how the axis moves.
"""

import math
import re
from collections.abc import Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path, PurePath
from typing import Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.definitions import Table, definition_names, load_table
from trunnion.machines.machine import (
    AngleOutput,
    Axis,
    AxisKind,
    Machine,
    MachineFacts,
    Mount,
    PositiveDirection,
    PreferredSign,
    Vector,
)

#: The version of the schema of machine definitions; it changes when old files need changing.
SCHEMA: Final = 1

#: Two directions nearer than this count as parallel, rad (0.06 degrees): a machine built so could not orient a tool.
PARALLEL_TOLERANCE: Final = 1e-3

_AXIS_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,7}")

_VECTOR_FALLBACK: Vector = (0.0, 0.0, 1.0)


def machine_library() -> Traversable:
    """The folder of shipped machine definitions."""
    return files("trunnion.machines").joinpath("library")


def shipped_machines() -> list[str]:
    """Names of the shipped machines, sorted."""
    return definition_names(machine_library())


def load_machine(name_or_path: str | Path, overrides: Mapping[str, object] | None = None) -> Machine:
    """Return the machine that a definition describes.

    Parameters
    ----------
    name_or_path
        The name of a shipped machine, or a path that ends in ``.toml``.
    overrides
        Values in place of those of the file, shaped like it:
        ``{"workpiece": {"zero_mm": [0, 0, 80]}, "axis": [{"name": "B", "limits_deg": [-5, 95]}]}``.

    Raises
    ------
    InputError
        With every mistake of the definition, each at its file and line.
    """
    key = PurePath(str(name_or_path)).name.removesuffix(".toml")
    return read_machine(load_table(name_or_path, machine_library(), overrides, kind="machine"), key)


def read_machine(table: Table, key: str) -> Machine:
    """Turn the table of a definition into a machine; the ``[control]`` table is handed on unread."""
    table.integer("schema", at_least=SCHEMA, at_most=SCHEMA)
    name = table.text("name")
    description = table.text("description", "")
    spindle = table.table("spindle")
    workpiece = table.table("workpiece")
    control = table.table("control")
    axis_tables = table.tables("axis", required=True)
    spindle_direction = _direction(spindle, "direction", (0.0, 0.0, 1.0))
    spindle_point = _vector(spindle.vector("gauge_point_mm", 3, (0.0, 0.0, 0.0)))
    max_rpm = spindle.number("max_rpm", None, above=0)
    facts = _facts(spindle, table.table("facts"))
    zero = workpiece.vector("zero_mm", 3, None)
    before = len(table.problems)
    axes = tuple(_axis(entry) for entry in axis_tables)
    if "axis" in table and axis_tables:
        _check_chain(table, axis_tables, axes, spindle_direction, sound=len(table.problems) == before)
    for part in (spindle, workpiece, table):
        part.report_unread_keys()
    table.raise_problems()
    return Machine(
        key=key,
        name=name,
        axes=axes,
        spindle_direction=spindle_direction,
        spindle_point=spindle_point,
        workpiece_zero=None if zero is None else _vector(zero),
        spindle_max_rpm=max_rpm,
        description=description,
        facts=facts,
        control=control.unread_copy(),
        files=tuple(table.files()),
    )


def _axis(entry: Table) -> Axis:
    name = entry.text("name")
    if name and not _AXIS_NAME.fullmatch(name):
        entry.add_problem("name", f'is "{name}"', "write a letter, then up to seven letters and digits")
    word = entry.text("kind", one_of=tuple(AxisKind))
    mount = entry.text("carries", one_of=tuple(Mount))
    direction = _direction(entry, "direction", None)
    positive = entry.text("positive", PositiveDirection.STANDARD, one_of=tuple(PositiveDirection))
    if not word:
        # Which units the other keys should have is not known: guessing would only add noise.
        entry.mark_read(*entry.keys())
        return Axis(name, AxisKind.LINEAR, Mount(mount or Mount.PART), direction)
    kind = AxisKind(word)
    unit = "mm" if kind is AxisKind.LINEAR else "deg"
    endless, output, point, prefer = False, AngleOutput.NONE, (0.0, 0.0, 0.0), PreferredSign.EITHER
    limits = entry.interval(f"limits_{unit}", None)
    if kind is AxisKind.ROTARY:
        point = _vector(entry.vector("point_mm", 3))
        endless = entry.flag("endless", False)
        output = AngleOutput(entry.text("output", AngleOutput.NONE, one_of=tuple(AngleOutput)))
        prefer = PreferredSign(entry.text("prefer", PreferredSign.EITHER, one_of=tuple(PreferredSign)))
        _check_winding(entry, endless, output)
    low, high = limits or (-math.inf, math.inf)
    home = entry.number(f"home_{unit}", 0.0)
    if not low <= home <= high:
        explicit = f"home_{unit}" in entry
        what = f"is {home:g}, outside of the limits {low:g} to {high:g}"
        entry.add_problem(
            f"home_{unit}", what if explicit else f"{what} (it is 0 unless stated)", "write a home inside them"
        )
    rapid = entry.number(f"rapid_{unit}_min", None, above=0)
    acceleration = entry.number(f"acceleration_{unit}_s2", None, above=0)
    entry.report_unread_keys()
    return Axis(
        name=name,
        kind=kind,
        mount=Mount(mount or Mount.PART),
        direction=direction,
        point=point,
        low=low,
        high=high,
        endless=endless,
        output=output,
        rapid=rapid,
        acceleration=acceleration,
        home=home,
        positive=PositiveDirection(positive),
        prefer=prefer,
    )


def _check_winding(entry: Table, endless: bool, output: AngleOutput) -> None:
    if endless and "limits_deg" in entry:
        entry.add_problem("limits_deg", "is given for an endless axis", "take out limits_deg, or write endless = false")
    if not endless and "limits_deg" not in entry:
        cure = "write [low, high] with low < high, in degrees, or endless = true"
        entry.add_problem("limits_deg", "is missing", cure)
    if not endless and output is not AngleOutput.NONE:
        cure = "take out output, or write endless = true: values of a limited axis are written as they are"
        entry.add_problem("output", f'is "{output}" for an axis with limits', cure)


def _facts(spindle: Table, facts: Table) -> MachineFacts:
    size = facts.vector("table_size_mm", 2, None)
    result = MachineFacts(
        spindle_min_rpm=spindle.number("min_rpm", None, at_least=0),
        spindle_power_kw=spindle.number("power_kw", None, above=0),
        spindle_torque_nm=spindle.number("torque_nm", None, above=0),
        tool_holder=facts.text("tool_holder", None),
        tool_pockets=facts.integer("tool_pockets", None, at_least=1),
        table_size_mm=None if size is None else (size[0], size[1]),
        table_diameter_mm=facts.number("table_diameter_mm", None, above=0),
        table_load_kg=facts.number("table_load_kg", None, above=0),
    )
    facts.report_unread_keys()
    return result


def _vector(numbers: tuple[float, ...]) -> Vector:
    x, y, z = numbers
    return x, y, z


def _direction(table: Table, key: str, default: Vector | None) -> Vector:
    """Return a unit vector along the one that is written; a mistake gives Z."""
    before = len(table.problems)
    numbers = table.vector(key, 3) if default is None else table.vector(key, 3, default)
    largest = max(map(abs, numbers))
    if largest == 0.0:
        if len(table.problems) == before:
            table.add_problem(key, "is [0, 0, 0]", "write a vector that has a direction")
        return _VECTOR_FALLBACK
    # Scaled first, so that squares neither vanish nor overflow.
    x, y, z = (number / largest for number in numbers)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length


def _check_chain(
    table: Table, axis_tables: list[Table], axes: tuple[Axis, ...], spindle: Vector, *, sound: bool
) -> None:
    """Note what is wrong with the axes taken together; the geometry only if each axis is sound by itself."""
    rotary = [k for k, axis in enumerate(axes) if axis.is_rotary]
    slides = [k for k, axis in enumerate(axes) if not axis.is_rotary]
    _check_names(axis_tables, axes)
    if sound and (len(rotary) != 2 or len(slides) != 3):
        what = f"has {len(slides)} linear and {len(rotary)} rotary axes"
        table.add_problem("axis", what, "write three linear and two rotary axes, from the workpiece to the tool")
    for k in range(1, len(axes)):
        if axes[k].mount is Mount.PART and axes[k - 1].mount is Mount.TOOL:
            what = f'is "part", but {axes[k - 1].name} before it carries the tool'
            cure = "order the axes from the workpiece to the tool: all that carry the part come first"
            axis_tables[k].add_problem("carries", what, cure)
    if not sound or len(rotary) != 2 or len(slides) != 3:
        return
    first, second = (np.array(axes[k].direction) for k in rotary)
    names = [axes[k].name for k in rotary]
    if _sine(first, second) < PARALLEL_TOLERANCE:
        what = f"is parallel to that of {names[0]}: the machine could not orient a tool"
        axis_tables[rotary[1]].add_problem(
            "direction", what, "write the directions of the two rotary axes as they are built"
        )
    elif _sine(second, np.array(spindle)) < PARALLEL_TOLERANCE:
        what = f"is parallel to the spindle: {names[1]} turns the tool about itself, and {names[0]} alone tilts it"
        cure = "the rotary axis further from the workpiece must tilt the tool: check the order of the axes"
        axis_tables[rotary[1]].add_problem("direction", what, cure)
    box = np.array([axes[k].direction for k in slides])
    if abs(float(np.linalg.det(box))) < PARALLEL_TOLERANCE:
        what = "do not reach every point: the directions lie in one plane"
        listed = ", ".join(axes[k].name for k in slides)
        axis_tables[slides[2]].add_problem(
            "direction", f"and those of the other linear axes ({listed}) {what}", "write three"
        )


def _check_names(axis_tables: list[Table], axes: tuple[Axis, ...]) -> None:
    seen: dict[str, int] = {}
    for k, axis in enumerate(axes):
        letter = axis.name.casefold()
        if letter and letter in seen:
            file, line = axis_tables[seen[letter]].location("name")
            what = f'is "{axis.name}", the name of {axis_tables[seen[letter]].path} too ({file}:{line})'
            axis_tables[k].add_problem("name", what, "give every axis its own name")
        seen.setdefault(letter, k)


def _sine(a: Floats, b: Floats) -> float:
    return float(np.linalg.norm(np.cross(a, b)))
