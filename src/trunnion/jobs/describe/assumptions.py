"""What is taken for granted of a machine: what its definition leaves open, and what it has from another machine.

In:     a machine, and the table of its definition if that is known.
Out:    sentences for a person beside the machine.
"""

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Final

from trunnion.definitions import Table
from trunnion.definitions.marked_values import marked_in
from trunnion.definitions.value_marks import ASSUMED, MARKS
from trunnion.machines import Axis, Machine
from trunnion.machines.loading import machine_library
from trunnion.messages import Wording, phrase

#: Keys of what no two machines of a type share for certain, and the phrase of what it is.
_MEASURED: Final = {
    "point_mm": "measured_lines", "limits_mm": "measured_travel", "limits_deg": "measured_travel",
    "endless": "measured_endless", "output": "measured_angles", "positive": "measured_senses",
    "home_mm": "measured_home", "home_deg": "measured_home",
    "rapid_mm_min": "measured_rapid", "rapid_deg_min": "measured_rapid",
    "acceleration_mm_s2": "measured_acceleration", "acceleration_deg_s2": "measured_acceleration",
    "gauge_point_mm": "measured_gauge_point", "max_rpm": "measured_speed", "zero_mm": "measured_zero",
    "shape": "measured_bodies",
}  # fmt: skip


#: Ends of keys that say where axes lie, and how far slides go.
_PLACES: Final = (" point_mm", " limits_mm", " gauge_point_mm")


def assumptions(machine: Machine, table: Table | None) -> tuple[Wording, ...]:
    """Return what is assumed of a machine.

    machine  the machine
    table    its definition, merged with what it extends; None: the machine comes from no file
    """
    own = None if table is None else table.unread_copy()
    if own is None:
        return tuple(_left_open(machine))
    assumed = _marked(own, ASSUMED, "assumed_by_shipped")
    # What is still to be done comes last, where it is seen.
    return (*assumed, *_inherited(machine), *_left_open(machine), *_marked(own, MARKS, "still_to_enter"))


def assumed_places(machine: Machine, table: Table | None) -> Wording | None:
    """Why it is not known where axes lie in their travel; None if the definition states it.

    Parameters as for ``assumptions``.
    """
    if not machine.spindle_point_is_stated:
        return phrase("gauge_point_not_stated")
    marked = [] if table is None else marked_in(table.content, ASSUMED)
    names = [each.name for each in marked if each.name.endswith(_PLACES)]
    return phrase("places_assumed", names=tuple(names)) if names else None


def _marked(table: Table, mark: re.Pattern[str], variant: str) -> Iterator[Wording]:
    """Values whose comments say that they are none of the machine's."""
    library = str(machine_library())
    found: dict[str, list[Wording]] = {}
    for value in marked_in(table.content, mark):
        found.setdefault(value.file, []).append(value.said)
    for file in sorted(found, key=lambda each: not each.startswith(library)):
        yield phrase(variant, values=tuple(found[file]))


def _inherited(machine: Machine) -> Iterator[Wording]:
    """Measured things that another machine's definition says."""
    found: dict[str, dict[str, list[str]]] = {}
    for value in machine.inherited:
        axes = found.setdefault(Path(value.file).name, {}).setdefault(_MEASURED[value.key], [])
        if value.table == "axis":
            axes.append(value.of)
    for name, things in found.items():
        told = tuple(
            phrase("of_axes", what=phrase(what), axes=tuple(dict.fromkeys(axes))) if axes else phrase(what)
            for what, axes in things.items()
        )
        yield phrase("from_another_machine", name=name, things=told)


def _left_open(machine: Machine) -> Iterator[Wording]:
    """Yield what the definition does not state, and what that means."""
    if machine.workpiece_zero is None:
        yield phrase("zero_not_stated")
    yield phrase("lengths_not_known")
    if not machine.spindle_point_is_stated:
        heads = [axis.name for axis in machine.own_axes if axis.is_rotary and axis.mount == "tool"]
        yield phrase("gauge_point_open_with_head", axis=heads[-1]) if heads else phrase("gauge_point_open")
    checks: tuple[tuple[str, Callable[[Axis], bool]], ...] = (
        ("travel_open", lambda axis: not axis.endless and not axis.has_limits),
        ("home_open", lambda axis: not axis.home_is_stated),
        ("rapid_open", lambda axis: axis.rapid is None),
        ("acceleration_open", lambda axis: axis.acceleration is None),
    )
    for variant, is_open in checks:
        if names := tuple(axis.name for axis in machine.own_axes if is_open(axis)):
            yield phrase(variant, axes=names)
    if machine.spindle_max_rpm is None:
        yield phrase("highest_speed_open")
    if machine.facts.tool_change_s is None:
        yield phrase("tool_change_open")
