"""A short definition that extends a shipped one: what must be measured at the machine is marked, the rest inherited."""

from collections.abc import Iterator

from trunnion.definitions.toml_text import written
from trunnion.machines import Axis, Machine, Mount
from trunnion.messages import LIBRARY, Words, phrase
from trunnion.schemas import first_line


def definition_like(machine: Machine, name: str, words: Words = LIBRARY) -> str:
    """Return the text of a definition that extends a shipped machine.

    machine  the shipped one
    name     of the new one
    words    of who measures: comments are in their language
    """
    remarks = phrase("head_of_definition", base=machine.key, name=machine.name).text("what", words)
    head = first_line("machine") + "".join(f"# {line}\n" for line in remarks.splitlines())
    head += f"extends = {written(machine.key)}\nname = {written(name)}\n"
    parts = [*_spindle(machine, words), *("\n".join(_axis(axis, words)) for axis in machine.own_axes)]
    return head + "".join(f"\n{part}\n" for part in parts)


def _spindle(machine: Machine, words: Words) -> Iterator[str]:
    lines = []
    has_head = any(axis.is_rotary and axis.mount is Mount.TOOL for axis in machine.own_axes)
    if has_head or machine.spindle_point_is_stated:
        point = written(list(machine.spindle_point))
        what = "measure_pivot" if has_head else "measure_gauge_point"
        lines.append(f"gauge_point_mm = {point} {_to_measure(what, words)}")
    if machine.spindle_max_rpm is not None:
        lines.append(f"max_rpm = {written(machine.spindle_max_rpm)} {_to_measure('measure_plate', words)}")
    if lines:
        yield "\n".join(["[spindle]", *lines])


def _axis(axis: Axis, words: Words) -> Iterator[str]:
    """Yield the table of an axis: what differs from one machine of a type to the next."""
    yield "[[axis]]"
    yield f"name = {written(axis.name)}"
    unit = "deg" if axis.is_rotary else "mm"
    if axis.is_rotary:
        where = "measure_point_of_pivot" if axis.mount is Mount.TOOL else "measure_point_of_table"
        yield f"point_mm = {written(list(axis.point))} {_to_measure(where, words)}"
    if axis.has_limits:
        yield f"limits_{unit} = {written([axis.low, axis.high])} {_to_measure('measure_limits', words)}"
    elif not axis.endless:
        yield f"# limits_{unit} = [low, high] {_to_measure('measure_limits_or_none', words)}"
    if axis.home_is_stated:
        yield f"home_{unit} = {written(axis.home)} {_to_measure('measure_home', words)}"


def _to_measure(what: str, words: Words) -> str:
    """Return the comment behind a value that stands for a measured one; ``what`` is the phrase that says which."""
    return f"# measure: {phrase(what).text('what', words)}"
