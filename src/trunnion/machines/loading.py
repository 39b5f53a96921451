"""Reads a machine from its definition file, and reports every mistake at once.

The functions that read a table are lists of its keys. ``docs/definitions.md`` describes the same keys, and a test
compares the two. Keys contain their unit, because that of ``rapid`` or ``limits`` depends on how the axis moves.
"""

import math
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path, PurePath
from typing import Final, NamedTuple

from trunnion.definitions import Table, TextForm, definition_names, load_table
from trunnion.definitions.duplicate_keys import report_duplicates, statement_form
from trunnion.definitions.marked_values import marked_in
from trunnion.definitions.messages import meant_word
from trunnion.definitions.value_marks import ASSUMED, MARKS
from trunnion.errors import InputError, Problem
from trunnion.machines.body_tables import read_bodies
from trunnion.machines.chain_checks import check_chain
from trunnion.machines.inherited import inherited_values
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
from trunnion.machines.missing_axes import with_missing_axes
from trunnion.messages import Wording, phrase

#: Version of the schema of machine definitions; a new one makes changes to old files necessary.
SCHEMA: Final = 1

#: Where axes must be at home, unless a definition names fewer.
HOME_PLACES: Final = ("tool_change", "end")

#: What a definition may demand that a proof stands on.
DEMANDS: Final = (
    "zero",
    "tool_length",
    "dynamics",
    "start_modes",
    "radius_register",
    "cl_units",
    "measured",
    "given_words",
)

_AXIS_NAME: Final = "[A-Za-z][A-Za-z0-9_]{0,7}"

#: Shipped definitions of no builder's machine: chains to extend, and the examples of LinuxCNC.
EXAMPLES: Final = frozenset(
    (
        "desk_mill_a",
        "generic_head_head_ca",
        "generic_head_table_bc",
        "generic_nutated_b45_c",
        "linuxcnc_5axis",
        "xyzac_trt",
        "xyzbc_trt",
    )
)

_VECTOR_FALLBACK: Vector = (0.0, 0.0, 1.0)


def machine_library() -> Traversable:
    """Return the folder of shipped machine definitions."""
    return files("trunnion.machines").joinpath("library")


def shipped_machines() -> list[str]:
    """Names of the shipped machines, sorted."""
    return definition_names(machine_library())


def is_example(name: str) -> bool:
    """Whether a name is that of a shipped definition of no builder's machine."""
    return name in EXAMPLES


def check_is_shipped(name: str) -> None:
    """Raise ``InputError`` for a name that is not that of a shipped machine."""
    names = shipped_machines()
    if name not in names:
        near = meant_word(name, names)
        raise InputError(
            Problem(
                name,
                0,
                Wording("DEF110", "no_shipped_machine", near=near, names=tuple(names))
                if near
                else Wording("DEF110", "no_shipped_machine_name", names=tuple(names)),
            )
        )


def load_machine(name_or_path: str | Path, overrides: Mapping[str, object] | None = None) -> Machine:
    """Return the machine that a definition describes.

    name_or_path  the name of a shipped machine, or a path that ends in ``.toml``
    overrides     values in place of those of the file, shaped like it: ``{"workpiece": {"zero_mm": [0, 0, 80]}, "axis":
                  [{"name": "B", "limits_deg": [-5, 95]}]}``

    Raises ``InputError`` with every mistake of the definition, each at its file and line.
    """
    text = str(name_or_path)
    if not overrides and not text.endswith(".toml"):
        return _shipped_machine(text)
    key = PurePath(text).name.removesuffix(".toml")
    return read_machine(load_table(name_or_path, machine_library(), overrides, kind="machine"), key)


@lru_cache(maxsize=16)  # one process posts many files on a machine
def _shipped_machine(name: str) -> Machine:
    return read_machine(load_table(name, machine_library(), kind="machine"), PurePath(name).name)


def read_machine(table: Table, key: str) -> Machine:
    """Turn the table of a definition into a machine; the ``[control]`` table is passed on unread."""
    table.integer("schema", at_least=SCHEMA, at_most=SCHEMA)
    name = table.text("name")
    description = table.text("description", "")
    spindle = table.table("spindle")
    workpiece = table.table("workpiece")
    control = table.table("control")
    cl = table.table("cl")
    words = cl.table("words")
    proof = table.table("proof")
    axis_tables = table.tables("axis", required=True)
    spindle_direction = _direction(spindle, "direction", (0.0, 0.0, 1.0))
    spindle_point = _vector(spindle.vector("gauge_point_mm", 3, (0.0, 0.0, 0.0)))
    max_rpm = spindle.number("max_rpm", None, above=0)
    facts = _facts(spindle, table.table("facts"))
    _report_contradiction(spindle, facts.spindle_min_rpm, max_rpm)
    zero = workpiece.vector("zero_mm", 3, None)
    before = len(table.problems)
    axes = tuple(_axis(entry) for entry in axis_tables)
    if "axis" in table and axis_tables:
        check_chain(table, axis_tables, axes, spindle_direction, sound=len(table.problems) == before)
    demands, home_at = _demands(proof), _home_at(proof, axes)
    bodies = read_bodies(table, [axis.name for axis in axes])
    cl_words = {word: words.text(word) for word in words.names()}
    report_duplicates(words, statement_form)
    for part in (spindle, workpiece, words, cl, proof, table):
        part.report_unread_keys()
    table.raise_problems()
    return Machine(
        key=key,
        name=name,
        axes=with_missing_axes(axes, spindle_direction),
        spindle_direction=spindle_direction,
        spindle_point=spindle_point,
        workpiece_zero=None if zero is None else _vector(zero),
        spindle_max_rpm=max_rpm,
        description=description,
        facts=facts,
        control=control.unread_copy(),
        files=tuple(table.files()),
        cl_words=cl_words,
        cl_word_places={word: words.location(word) for word in cl_words},
        bodies=bodies,
        spindle_point_is_stated="gauge_point_mm" in spindle,
        unmeasured=tuple(marked_in(table.content, MARKS)),
        assumed=tuple(marked_in(table.content, ASSUMED)),
        inherited=tuple(inherited_values(table, str(machine_library()))),
        demands=demands,
        home_at=home_at,
    )


def _demands(proof: Table) -> tuple[str, ...]:
    """Return what a proof must stand on."""
    names = proof.texts("require", ())
    for name in names:
        if name not in DEMANDS:
            proof.add_problem("require", Wording("DEF330", "no_basis", name=name, known=DEMANDS))
    return tuple(name for name in DEMANDS if name in names)


def _home_at(proof: Table, axes: Sequence[Axis]) -> dict[str, tuple[str, ...]]:
    """Return which axes must be at home where; what the definition is silent about needs all linear ones."""
    known = tuple(axis.name for axis in axes)
    found = {}
    for place in HOME_PLACES:
        key = f"home_at_{place}"
        names = proof.texts(key, None)
        if names is None:
            continue
        for name in names:
            if name not in known:
                proof.add_problem(key, Wording("DEF330", "no_axis_at_home", name=name, known=known))
        found[place] = tuple(name for name in known if name in names)
    return found


def _axis(entry: Table) -> Axis:
    name = entry.text("name", written=TextForm(phrase("name_of_axis"), _AXIS_NAME))
    word = entry.text("kind", one_of=tuple(AxisKind))
    mount = Mount(entry.text("carries", one_of=tuple(Mount)) or Mount.PART)
    direction = _direction(entry, "direction", None)
    positive = entry.text("positive", PositiveDirection.STANDARD, one_of=tuple(PositiveDirection))
    if not word:
        # The units of the other keys are not known, and guessing them would only report more mistakes.
        entry.mark_read(*entry.keys())
        return Axis(name, AxisKind.LINEAR, mount, direction)
    kind = AxisKind(word)
    unit = "mm" if kind is AxisKind.LINEAR else "deg"
    low, high = entry.interval(f"limits_{unit}", None) or (-math.inf, math.inf)
    rotary = _rotary_keys(entry) if kind is AxisKind.ROTARY else _RotaryKeys()
    home = _home(entry, f"home_{unit}", low, high)
    _check_displayed(entry, home, rotary)
    rapid = entry.number(f"rapid_{unit}_min", None, above=0)
    acceleration = entry.number(f"acceleration_{unit}_s2", None, above=0)
    jerk = entry.number(f"jerk_{unit}_s3", None, above=0)
    entry.report_unread_keys()
    return Axis(
        name=name,
        kind=kind,
        mount=mount,
        direction=direction,
        point=rotary.point,
        low=low,
        high=high,
        endless=rotary.endless,
        output=rotary.output,
        rapid=rapid,
        acceleration=acceleration,
        jerk=jerk,
        home=home,
        positive=PositiveDirection(positive),
        prefer=rotary.prefer,
        home_is_stated=f"home_{unit}" in entry,
    )


class _RotaryKeys(NamedTuple):
    """The keys that only rotary axes have."""

    point: Vector = (0.0, 0.0, 0.0)
    endless: bool = False
    output: AngleOutput = AngleOutput.NONE
    prefer: PreferredSign = PreferredSign.EITHER


def _rotary_keys(entry: Table) -> _RotaryKeys:
    keys = _RotaryKeys(
        point=_vector(entry.vector("point_mm", 3)),
        endless=entry.flag("endless", False),
        output=AngleOutput(entry.text("output", AngleOutput.NONE, one_of=tuple(AngleOutput))),
        prefer=PreferredSign(entry.text("prefer", PreferredSign.EITHER, one_of=tuple(PreferredSign))),
    )
    _check_winding(entry, keys.endless, keys.output)
    return keys


def _home(entry: Table, key: str, low: float, high: float) -> float:
    home = entry.number(key, 0.0)
    if not low <= home <= high:
        entry.add_problem(
            key,
            Wording("DEF440", "outside_limits" if key in entry else "outside_limits_0", home=home, low=low, high=high),
        )
    return home


def _check_displayed(entry: Table, home: float, rotary: _RotaryKeys) -> None:
    """Note a home that the control never displays: it would turn the axis to another place than it says."""
    low, high = {AngleOutput.POSITIVE: (0.0, 360.0), AngleOutput.SYMMETRIC: (-180.0, 180.0)}.get(
        rotary.output, (-math.inf, math.inf)
    )
    if rotary.endless and not low <= home <= high:
        entry.add_problem(
            "home_deg",
            Wording(
                "DEF330",
                "axis_output_never",
                home=home,
                output=rotary.output,
                shown_home=home % 360.0 if low == 0.0 else (home + 180.0) % 360.0 - 180.0,
            ),
        )


def _check_winding(entry: Table, endless: bool, output: AngleOutput) -> None:
    if endless and "limits_deg" in entry:
        entry.add_problem("limits_deg", Wording("DEF440", "given_endless_axis"))
    if not endless and "limits_deg" not in entry:
        entry.add_problem("limits_deg", Wording("DEF440", "missing"))
    if not endless and output is not AngleOutput.NONE:
        entry.add_problem("output", Wording("DEF440", "axis_limits", output=output))


def _gear(table: Table) -> tuple[float, float]:
    """Return the least and the greatest speed of a gear, rev/min."""
    least, greatest = table.number("min_rpm", at_least=0), table.number("max_rpm", above=0)
    _report_contradiction(table, least, greatest)
    table.report_unread_keys()
    return least, greatest


def _report_contradiction(table: Table, least: float | None, greatest: float | None) -> None:
    """Report a least speed above the greatest one."""
    if least is not None and greatest is not None and least > greatest:
        table.add_problem("min_rpm", Wording("DEF440", "above_max_rpm", least=least, greatest=greatest))


def _facts(spindle: Table, facts: Table) -> MachineFacts:
    size, centre = facts.vector("table_size_mm", 2, None), facts.vector("table_centre_mm", 2, None)
    if size is not None and min(size) <= 0.0:
        facts.add_problem("table_size_mm", Wording("DEF330", "no_two_lengths", width=size[0], depth=size[1]))
    result = MachineFacts(
        spindle_min_rpm=spindle.number("min_rpm", None, at_least=0),
        spindle_gears_rpm=tuple(_gear(gear) for gear in spindle.tables("gear")),
        spindle_power_kw=spindle.number("power_kw", None, above=0),
        spindle_torque_nm=spindle.number("torque_nm", None, above=0),
        spindle_acceleration_rpm_s=spindle.number("acceleration_rpm_s", None, above=0),
        tool_change_s=spindle.number("tool_change_s", None, at_least=0),
        tool_holder=facts.text("tool_holder", None),
        tool_pockets=facts.integer("tool_pockets", None, at_least=1),
        table_size_mm=None if size is None else (size[0], size[1]),
        table_diameter_mm=facts.number("table_diameter_mm", None, above=0),
        table_centre_mm=None if centre is None else (centre[0], centre[1]),
        table_load_kg=facts.number("table_load_kg", None, above=0),
    )
    facts.report_unread_keys()
    return result


def _vector(numbers: tuple[float, ...]) -> Vector:
    x, y, z = numbers
    return x, y, z


def _direction(table: Table, key: str, default: Vector | None) -> Vector:
    """Return a unit vector along the given one; a mistake gives Z."""
    before = len(table.problems)
    numbers = table.vector(key, 3) if default is None else table.vector(key, 3, default)
    largest = max(map(abs, numbers))
    if largest == 0.0:
        if len(table.problems) == before:
            table.add_problem(key, Wording("DEF420", "of_0_0"))
        return _VECTOR_FALLBACK
    # Scaled first, so that squares neither vanish nor overflow.
    x, y, z = (number / largest for number in numbers)
    length = math.sqrt(x * x + y * y + z * z)
    return x / length, y / length, z / length
