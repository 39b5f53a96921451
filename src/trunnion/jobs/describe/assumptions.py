"""What is taken for granted of a machine: what its definition leaves open, and what it has from another machine.

In:     a machine, and the table of its definition if that is known.
Out:    sentences for a person beside the machine.
"""

import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.marked_values import marked_in
from trunnion.definitions.value_marks import ASSUMED, MARKS
from trunnion.machines import Axis, Machine
from trunnion.machines.loading import machine_library
from trunnion.messages import Wording, phrase

#: Keys of what no two machines of a type share for certain, and what it is.
_MEASURED: Final = {
    "point_mm": "the lines about which axes turn", "limits_mm": "travel", "limits_deg": "travel",
    "endless": "which axes turn endlessly", "output": "how a program writes their angles",
    "positive": "which way axes go",
    "home_mm": "home", "home_deg": "home", "rapid_mm_min": "rapid traverse", "rapid_deg_min": "rapid traverse",
    "acceleration_mm_s2": "acceleration", "acceleration_deg_s2": "acceleration",
    "gauge_point_mm": "gauge point", "max_rpm": "highest spindle speed", "zero_mm": "workpiece zero",
    "shape": "bodies of the simulation",
}  # fmt: skip


#: Ends of keys that say where axes lie, and how far slides go.
_PLACES: Final = (" point_mm", " limits_mm", " gauge_point_mm")


def assumptions(machine: Machine, table: Table | None) -> tuple[str, ...]:
    """Return what is assumed of a machine.

    machine  the machine
    table    its definition, merged with what it extends; None: the machine comes from no file
    """
    own = None if table is None else table.unread_copy()
    if own is None:
        return tuple(_left_open(machine))
    assumed = _marked(own, ASSUMED, "Assumed by the shipped definition")
    # What is still to be done comes last, where it is seen.
    return (*assumed, *_inherited(machine), *_left_open(machine), *_marked(own, MARKS, "Still to enter"))


def assumed_places(machine: Machine, table: Table | None) -> Wording | None:
    """Why it is not known where axes lie in their travel; None if the definition states it.

    Parameters as for ``assumptions``.
    """
    if not machine.spindle_point_is_stated:
        return phrase("gauge_point_not_stated")
    marked = [] if table is None else marked_in(table.content, ASSUMED)
    names = [each.name for each in marked if each.name.endswith(_PLACES)]
    return phrase("places_assumed", names=tuple(names)) if names else None


def _marked(table: Table, mark: re.Pattern[str], what: str) -> Iterator[str]:
    """Values whose comments say that they are none of the machine's."""
    library = str(machine_library())
    found: dict[str, list[str]] = {}
    for value in marked_in(table.content, mark):
        found.setdefault(value.file, []).append(str(value))
    for file in sorted(found, key=lambda each: not each.startswith(library)):
        yield f"{what}: {', '.join(found[file])}."


def _inherited(machine: Machine) -> Iterator[str]:
    """Measured things that another machine's definition says."""
    found: dict[str, dict[str, list[str]]] = {}
    for value in machine.inherited:
        axes = found.setdefault(Path(value.file).name, {}).setdefault(_MEASURED[value.key], [])
        if value.table == "axis":
            axes.append(value.of)
    for name, things in found.items():
        told = [f"{what} ({', '.join(dict.fromkeys(axes))})" if axes else what for what, axes in things.items()]
        yield f"From {name}, which is another machine until you have compared it with yours: {', '.join(told)}."


def _left_open(machine: Machine) -> Iterator[str]:
    """Yield what the definition does not state, and what that means."""
    if machine.workpiece_zero is None:
        yield (
            "Workpiece zero: not stated, and taken for the origin. Linear axes are checked for whether the program "
            "fits their travel anywhere; programs without TCP need setting zero=X,Y,Z."
        )
    yield "Tool lengths: not known, for no definition has them. Programs without TCP want setting tool_length=MM."
    if not machine.spindle_point_is_stated:
        heads = [axis.name for axis in machine.axes if axis.is_rotary and axis.mount == "tool"]
        pivot = f" The pivot length of {heads[-1]} counts from there." if heads else ""
        yield f"Gauge point: not stated, and taken for the origin of the frame.{pivot}"
    checks: tuple[tuple[str, Callable[[Axis], bool], str], ...] = (
        ("Travel", lambda axis: not axis.endless and not axis.has_limits, "and not checked"),
        ("Home", lambda axis: not axis.home_is_stated, "and taken for 0"),
        ("Rapid traverse", lambda axis: axis.rapid is None, "so that rapids take no time"),
        ("Acceleration", lambda axis: axis.acceleration is None, "so that times are estimates that are too short"),
    )
    for what, is_open, means in checks:
        if names := _names(axis for axis in machine.axes if is_open(axis)):
            yield f"{what} of {names}: not stated, {means}."
    if machine.spindle_max_rpm is None:
        yield "Highest spindle speed: not stated, and not checked."
    if machine.facts.tool_change_s is None:
        yield "Tool change: not stated, so that times count none."


def _names(axes: Iterable[Axis]) -> str:
    return ", ".join(axis.name for axis in axes)
