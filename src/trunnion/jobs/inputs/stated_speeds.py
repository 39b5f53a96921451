"""The setting ``spindle``: speeds of operations whose CL file turns the spindle on too late, or not at all."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import chain
from typing import Final

import numpy as np

from trunnion.errors import InputError, setting_problem
from trunnion.jobs.inputs.stated_by_operation import check_operations, stated_by_operation
from trunnion.messages import Wording
from trunnion.model.toolpath import Event, Kind, LoadTool, Operation, Sense, SpindleOff, SpindleOn, Toolpath

#: The setting, and the speeds that it takes, rev/min.
_KEY: Final = "spindle"
_BOUNDS: Final = (1.0, 500_000.0)


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
    """Turn the spindle on in operations that cut while it stands, at the speeds that settings state.

    Raises ``InputError`` for the speed of an operation that is not there, or has a SPINDL of its own before its first
    cut.
    """
    speeds, found, turns = stated_speeds(settings), list[Toolpath](), False
    if not speeds:
        return [*toolpaths]
    for toolpath in toolpaths:
        operations = list[Operation]()
        for operation in toolpath.operations:
            states = operation.name in speeds
            turns, own = _turning_at_first_cut(operation, turns)
            if states and own:
                said = Wording("ARG230", "states_own_speed", operation=operation.name)
                raise InputError(setting_problem(_KEY, said))
            speed = speeds.get(operation.name, None if turns else speeds.get(""))
            new = operation if speed is None else _turning(operation, speed)
            operations.append(new)
            for event in new.events:
                if isinstance(event, SpindleOn | SpindleOff):
                    turns = isinstance(event, SpindleOn)
        found.append(replace(toolpath, operations=tuple(operations)))
    check_operations(_KEY, speeds, found)
    return found


def _first_cut(operation: Operation) -> int:
    """Return the row of the first cut; the number of rows if there is none."""
    cuts = operation.moves.kind != Kind.RAPID
    return int(np.argmax(cuts)) if cuts.any() else len(cuts)


def _turning_at_first_cut(operation: Operation, turns: bool) -> tuple[bool, bool]:
    """Return whether the spindle turns at the first cut, and whether the operation itself turned it on before.

    Without a cut it turns: nothing is to be stated.
    """
    first, own = _first_cut(operation), False
    for event in operation.events:
        if isinstance(event, SpindleOn | SpindleOff) and event.row <= first:
            turns = own = isinstance(event, SpindleOn)
    return turns or first == len(operation.moves), own


def _turning(operation: Operation, speed: float) -> Operation:
    """Return an operation that turns the spindle on behind its last tool before the first cut."""
    first, events = _first_cut(operation), list[Event](operation.events)
    loads = [k for k, event in enumerate(events) if isinstance(event, LoadTool) and event.row <= first]
    at = loads[-1] + 1 if loads else 0
    row, line = (events[loads[-1]].row, events[loads[-1]].line) if loads else (0, operation.line)
    on = SpindleOn(row, line, abs(speed), Sense.CCLW if speed < 0.0 else Sense.CLW)
    return replace(operation, events=tuple(chain(events[:at], (on,), events[at:])))
