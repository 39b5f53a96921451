"""The setting ``spindle``: speeds of operations whose CL file turns the spindle on too late, or not at all."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Final

import numpy as np

from trunnion.errors import InputError, setting_problem, warning
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.messages import Wording
from trunnion.model.toolpath import Event, Kind, LoadTool, Operation, Sense, SpindleOff, SpindleOn, Toolpath
from trunnion.output.validation.spindle import ToolInSpindle

#: The setting, and the speeds that it takes, rev/min.
_KEY: Final = "spindle"
_BOUNDS: Final = (1.0, 500_000.0)

#: What the spindle does before the first operation.
_STANDS: Final = SpindleOff(0, 0)


def stated_speeds(settings: Mapping[str, str]) -> dict[str, float]:
    """Return the speeds that settings state, rev/min, by operation; below 0: counter-clockwise. That of all others has
    no name.

    Raises ``InputError`` if the setting is none, or states two speeds of one operation.
    """
    return stated_by_operation(_KEY, settings, _speed)


def _speed(text: str) -> float | None:
    try:
        speed = float(text)
    except ValueError:
        return None
    return speed if _BOUNDS[0] <= abs(speed) <= _BOUNDS[1] else None


def with_stated_speeds(toolpaths: Iterable[Toolpath], settings: Mapping[str, str]) -> list[Toolpath]:
    """Turn the spindle on at the speeds that settings state: that of an operation in it alone, and the one without a
    name in all others that have none of their own. A SPINDL below 1 rev/min is no speed: what is stated replaces it.

    Raises ``InputError`` for the speed of an operation that is not there, or has a SPINDL of its own before its first
    cut.
    """
    speeds, found = stated_speeds(settings), list[Toolpath]()
    if not speeds:
        return [*toolpaths]
    running: SpindleOn | SpindleOff = _STANDS
    tool = ToolInSpindle()
    for toolpath in toolpaths:
        operations, remarks = list[Operation](), list(toolpath.remarks)
        for operation in toolpath.operations:
            before, tool = tool, tool.then(operation)
            if operation.name in speeds and (low := _too_low(operation)):
                new, stated = _replacing(operation, low, speeds[operation.name]), abs(speeds[operation.name])
                said = Wording("CTL320", "speed_replaced", rpm=low[0].rpm, stated=stated)
                remarks.append(warning(toolpath.file, low[0].line, said))
                operations.append(new)
                running = _last_switch(new, running)
                continue
            at_cut = _at_first_cut(operation, running)
            own = at_cut is not running and isinstance(at_cut, SpindleOn)
            if own and operation.name in speeds:
                said = Wording("ARG230", "states_own_speed", operation=operation.name)
                raise InputError(setting_problem(_KEY, said))
            speed = speeds.get(operation.name)
            if speed is None and not own and _first_cut(operation) < len(operation.moves):
                speed = _speed_of_others(speeds, at_cut, tool.is_another(before))
            new = operation if speed is None else _turning(operation, speed)
            if speed is not None:
                said = Wording("CTL320", "speed_stated", operation=operation.name, stated=speed)
                remarks.append(warning(toolpath.file, operation.line, said))
            operations.append(new)
            running = _last_switch(new, running)
        found.append(replace(toolpath, operations=tuple(operations), remarks=tuple(remarks)))
    check_operations(_KEY, speeds, found)
    return found


def _last_switch(operation: Operation, running: SpindleOn | SpindleOff) -> SpindleOn | SpindleOff:
    """Return what the spindle does when an operation ends, where ``running`` is what it does before it."""
    return next((each for each in reversed(operation.events) if isinstance(each, SpindleOn | SpindleOff)), running)


def _too_low(operation: Operation) -> list[SpindleOn]:
    """Return where the CL file turns the spindle on at a speed at which nothing cuts, as of another unit."""
    return [each for each in operation.events if isinstance(each, SpindleOn) and each.rpm < _BOUNDS[0]]


def _replacing(operation: Operation, low: Sequence[SpindleOn], speed: float) -> Operation:
    """Return an operation with a speed in place of those that are too low.

    Raises ``InputError`` if its sign says that the spindle turns otherwise than in the CL file.
    """
    stated = _turned_on(0, 0, speed)
    if any(each.sense is not stated.sense for each in low):
        said = Wording("ARG230", "states_other_sense", operation=operation.name, sense=str(low[0].sense))
        raise InputError(setting_problem(_KEY, said))
    events = [
        replace(stated, row=each.row, line=each.line) if isinstance(each, SpindleOn) and each in low else each
        for each in operation.events
    ]
    return replace(operation, events=tuple(events))


def _speed_of_others(speeds: Mapping[str, float], at_cut: SpindleOn | SpindleOff, another_tool: bool) -> float | None:
    """Return the speed of all others, for an operation that has none of its own; None if it goes on with its tool at
    the speed of the CL file, or at that same speed.
    """
    speed = speeds.get("")
    if speed is None or another_tool or isinstance(at_cut, SpindleOff):
        return speed
    return speed if at_cut.stated and _turned_on(0, 0, speed) != replace(at_cut, row=0, line=0) else None


def _first_cut(operation: Operation) -> int:
    """Return the row of the first cut; the number of rows if there is none."""
    cuts = operation.moves.kind != Kind.RAPID
    return int(np.argmax(cuts)) if cuts.any() else len(cuts)


def _at_first_cut(operation: Operation, running: SpindleOn | SpindleOff) -> SpindleOn | SpindleOff:
    """Return what the spindle does at the first cut, where ``running`` is what it does before the operation."""
    first = _first_cut(operation)
    switches = [each for each in operation.events if isinstance(each, SpindleOn | SpindleOff) and each.row <= first]
    return switches[-1] if switches else running


def _turning(operation: Operation, speed: float) -> Operation:
    """Return an operation that turns the spindle on behind its last tool before the first cut."""
    first, events = _first_cut(operation), list[Event](operation.events)
    loads = [k for k, event in enumerate(events) if isinstance(event, LoadTool) and event.row <= first]
    at = loads[-1] + 1 if loads else 0
    row, line = (events[loads[-1]].row, events[loads[-1]].line) if loads else (0, operation.line)
    return replace(operation, events=tuple(chain(events[:at], (_turned_on(row, line, speed),), events[at:])))


def _turned_on(row: int, line: int, speed: float) -> SpindleOn:
    return SpindleOn(row, line, abs(speed), Sense.CCLW if speed < 0.0 else Sense.CLW, stated=True)
