"""What a twin tells MTConnect: values by the keys of the device model, conditions and messages, in order of time."""

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from datetime import UTC, datetime
from typing import Final

from trunnion.twin.playback import Playback, PlayState
from trunnion.twin.snapshots import Snapshots, TwinProgram, displayed

UNAVAILABLE: Final = "UNAVAILABLE"

#: Level, code, severity, qualifier and text of a condition.
Condition = tuple[str, str, str, str, str]

_NORMAL: Final[Condition] = ("NORMAL", "", "", "", "")

#: EXECUTION of MTConnect.
_EXECUTION: Final = {
    PlayState.READY: "READY",
    PlayState.RUNNING: "ACTIVE",
    PlayState.HELD: "FEED_HOLD",
    PlayState.STOPPED: "PROGRAM_STOPPED",
    PlayState.ENDED: "PROGRAM_COMPLETED",
}


class Observations(ABC):
    """Takes what a twin tells, and tells what of it has changed.

    values      by key, as they were told last
    conditions  by key
    last        time of what was told last
    """

    def __init__(self, program: TwinProgram) -> None:
        self.program = program
        self.values = {"avail": "AVAILABLE", "estop": "ARMED", "mode": "AUTOMATIC", "main_program": program.name}
        self.conditions = dict.fromkeys(
            ("system", *(f"{axis.name}_travel" for axis in program.machine.own_axes)), _NORMAL
        )
        self.last = datetime.fromtimestamp(0.0, UTC)

    @abstractmethod
    def tell(self, stamp: datetime, changed: Mapping[str, str]) -> None:
        """Tell values that have changed."""

    @abstractmethod
    def tell_condition(self, stamp: datetime, key: str, condition: Condition) -> None:
        """Tell a condition."""

    @abstractmethod
    def tell_message(self, stamp: datetime, text: str) -> None:
        """Tell a message of the program."""

    # What the twin tells

    async def show(self, snapshots: Snapshots, stamps: list[datetime], microseconds: list[int]) -> None:
        """Tell what has changed from each time to the next."""
        for k, stamp in enumerate(stamps):
            self._tell_changed(stamp, _values_at(self.program, snapshots, k))

    async def changed(self, playback: Playback, wall: float) -> None:
        """Tell what the program does now."""
        now = {
            "exec": _EXECUTION[playback.state],
            "feed_override": f"{playback.override:g}",
            "part_count": str(playback.completed),
        }
        self._tell_changed(datetime.fromtimestamp(wall, UTC), now)

    async def message(self, text: str, stamp: datetime) -> None:
        """Tell a message of the program."""
        self.tell_message(self.in_order(stamp), text)

    async def alarm(self, identifier: str, text: str, stamp: datetime) -> None:
        """Tell an alarm of the machine: a fault of the axis that it names, or of the system."""
        self._tell_condition(identifier, ("FAULT", identifier, "", "", text), stamp)

    async def alarm_over(self, identifier: str, text: str, stamp: datetime) -> None:
        """Tell that a fault is over."""
        self._tell_condition(identifier, _NORMAL, stamp)

    def in_order(self, stamp: datetime) -> datetime:
        """Return a time that is not before what was told last."""
        self.last = max(stamp, self.last)
        return self.last

    def _tell_changed(self, stamp: datetime, values: Mapping[str, str]) -> None:
        changed = {key: value for key, value in values.items() if self.values.get(key) != value}
        if changed:
            self.values |= changed
            self.tell(self.in_order(stamp), changed)

    def _tell_condition(self, identifier: str, condition: Condition, stamp: datetime) -> None:
        kind, _, axis = identifier.partition(" ")
        key = f"{axis}_{kind}" if f"{axis}_{kind}" in self.conditions else "system"
        self.conditions[key] = condition
        self.tell_condition(self.in_order(stamp), key, condition)


def stamp_text(moment: datetime) -> str:
    """Return a time as MTConnect writes it."""
    return moment.strftime("%Y-%m-%dT%H:%M:%S.%fZ")


def _values_at(program: TwinProgram, snapshots: Snapshots, k: int) -> dict[str, str]:
    block, machine = snapshots.blocks[k], program.machine
    rpm = float(snapshots.rpm[k])
    values = {
        "program": block.file,
        "block": block.blocks[1],
        "line": str(block.line),
        "block_number": block.number or UNAVAILABLE,
        "tool": block.tool or UNAVAILABLE,
        "feed": shown_number(float(snapshots.feed[k])),
        "tip": " ".join(map(shown_number, snapshots.tip[k].tolist())),
        "S_actual": shown_number(abs(rpm)),
        "S_commanded": shown_number(abs(float(snapshots.told_rpm[k]))),
        "S_direction": "CLOCKWISE" if rpm > 0.0 else "COUNTER_CLOCKWISE" if rpm < 0.0 else UNAVAILABLE,
    }
    if UNAVAILABLE in values["tip"]:
        values["tip"] = UNAVAILABLE
    for column, axis in machine.own_columns:
        shown = displayed(machine, column, snapshots.joints[k : k + 1, column])
        values[f"{axis.name}_actual"] = shown_number(float(shown[0]))
        values[f"{axis.name}_state"] = "TRAVEL" if snapshots.moving[k, column] else "STOPPED"
    return values


def shown_number(value: float) -> str:
    """Return a number to a millionth of what any machine measures, 500.0 and not 500.00000000000006."""
    return repr(float(f"{value:.12g}") + 0.0) if math.isfinite(value) else UNAVAILABLE
