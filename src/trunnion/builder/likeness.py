"""A short definition that extends a shipped one: what must be measured at the machine is marked, the rest inherited."""

from collections.abc import Iterator

from trunnion.definitions.toml_text import written
from trunnion.machines import Axis, Machine, Mount
from trunnion.schemas import first_line

_HEAD = """\
# Like {base} ({name}), which is another machine.
# A number marked "measure:" is still that one's: measure yours, or read it from the control, write it, and take the
# mark away. trunnion check reports which marks are left.
"""


def definition_like(machine: Machine, name: str) -> str:
    """Return the text of a definition that extends a shipped machine.

    machine  the shipped one
    name     of the new one
    """
    head = first_line("machine") + _HEAD.format(base=machine.key, name=machine.name)
    head += f"extends = {written(machine.key)}\nname = {written(name)}\n"
    parts = [*_spindle(machine), *("\n".join(_axis(axis)) for axis in machine.axes)]
    return head + "".join(f"\n{part}\n" for part in parts)


def _spindle(machine: Machine) -> Iterator[str]:
    lines = []
    has_head = any(axis.is_rotary and axis.mount is Mount.TOOL for axis in machine.axes)
    if has_head or machine.spindle_point_is_stated:
        point, pivot = written(list(machine.spindle_point)), "with the pivot of the head, " if has_head else ""
        lines.append(f"gauge_point_mm = {point} # measure: {pivot}where tool lengths begin, all axes at zero")
    if machine.spindle_max_rpm is not None:
        lines.append(f"max_rpm = {written(machine.spindle_max_rpm)} # measure: the plate of the spindle")
    if lines:
        yield "\n".join(["[spindle]", *lines])


def _axis(axis: Axis) -> Iterator[str]:
    """Yield the table of an axis: what differs from one machine of a type to the next."""
    yield "[[axis]]"
    yield f"name = {written(axis.name)}"
    unit = "deg" if axis.is_rotary else "mm"
    if axis.is_rotary:
        where = "of the pivot" if axis.mount is Mount.TOOL else "of the table's line of rotation"
        yield f"point_mm = {written(list(axis.point))} # measure: a point {where}, by probe or indicator"
    if axis.has_limits:
        yield f"limits_{unit} = {written([axis.low, axis.high])} # measure: software limits of the control"
    elif not axis.endless:
        yield f"# limits_{unit} = [low, high] # measure: software limits of the control; not checked without them"
    if axis.home_is_stated:
        yield f"home_{unit} = {written(axis.home)} # measure: where it waits for a tool change"
