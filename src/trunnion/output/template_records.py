"""The tools and operations of a program as records, for templates with expressions.

In:     a program.
Out:    what `controls.vocabulary` lists of each tool and operation; lengths and feeds in mm.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cache, partial
from typing import Final

import numpy as np

from trunnion.controls.setting_rules import tool_number
from trunnion.controls.texts.values import Later, Length, Record
from trunnion.model.motion import MachiningMode, Motion
from trunnion.model.toolpath import Coolant, Kind, SpindleOn, Tool
from trunnion.output.coordinates.extents import cut_extents
from trunnion.output.program import Program
from trunnion.output.template_values import TemplateValues, plain_text

#: How templates call machining modes.
_MODES: Final = {
    MachiningMode.THREE_AXIS: "three_axis",
    MachiningMode.TILTED: "tilted",
    MachiningMode.TCP: "tcp",
    MachiningMode.WITHOUT_TCP: "without_tcp",
    MachiningMode.M114: "m114",
}

_FEEDS: Final = ("least_feed", "greatest_feed")
_EXTENTS: Final = ("x_min", "y_min", "z_min", "x_max", "y_max", "z_max")


class TemplateRecords:
    """The records of one program.

    tools       in the order of their first calls
    operations  in the order of the program
    """

    def __init__(self, program: Program, values: TemplateValues) -> None:
        self._program, self._values = program, values
        calls = values.tools.calls
        count = {call: sum(other == call for other, *_ in calls) for call, *_ in calls}
        tools = {call: operation.tool for call, _, operation in reversed(calls)}
        self._tools = {call: self._tool(call, tools[call], count[call]) for call in dict.fromkeys(c for c, *_ in calls)}
        self.tools = tuple(self._tools.values())
        motions: list[list[Motion]] = []
        for motion in program.motions:
            if motion.starts_operation:
                motions.append([])
            motions[-1].append(motion)
        self.operations = tuple(
            self._operation(number, each, self._tools[call])
            for number, (each, (call, *_)) in enumerate(zip(motions, calls, strict=True), 1)
        )

    def tool(self, call: str | None) -> Record | None:
        """Return a tool as the program calls it; None without one."""
        return None if call is None else self._tools[call]

    def _text(self, text: str) -> str | None:
        """Return a text of the CL file that ends no comment and no other text; None for an empty one."""
        return plain_text(self._program, text) or None

    def _tool(self, call: str, tool: Tool, operations: int) -> Record:
        known = tool.kind != "UNKNOWN"
        number = tool_number(call)
        values: dict[str, object] = {
            "call": call,
            "number": None if number is None else int(number),
            "name": self._text(tool.name),
            "kind": tool.kind if known else None,
            "diameter": Length(tool.diameter) if known else None,
            "corner_radius": Length(tool.corner_radius) if known else None,
            "length": Length(tool.length) if known else None,
            "flute_length": Length(tool.flute_length) if tool.flute_length else None,
            "taper_angle": tool.taper_angle or None,
            "tip_angle": tool.tip_angle or None,
            "holder": self._text(tool.holder),
            "extension": Length(tool.extension) if tool.extension else None,
            "set_length": Length(tool.set_length) if tool.set_length else None,
            "operations": operations,
        }
        return Record(call, values)

    def _operation(self, number: int, motions: Sequence[Motion], tool: Record) -> Record:
        operation = motions[0].operation
        events = [event for motion in motions for event in motion.operation.events]
        spindle = next((event for event in events if isinstance(event, SpindleOn)), None)
        coolant = next((event.kind for event in events if isinstance(event, Coolant) and event.kind != "OFF"), None)
        values: dict[str, object] = {
            "name": self._text(operation.name),
            "number": number,
            "tool": tool,
            "mode": _MODES[motions[0].mode],
            "method": self._text(self._program.method_of(operation)),
            "time": Later(partial(self._values.time_of, number)),
            "points": sum(len(motion.operation.moves) for motion in motions),
            "spindle_speed": spindle and spindle.rpm,
            "spindle_sense": spindle and spindle.sense.value,
            "coolant": coolant,
            "work_offset": self._text(self._program.effective_setting("work_offset", operation)),
            "planes": sum(motion.plane is not None for motion in motions),
        }
        for names, found in ((_FEEDS, cache(lambda: _feeds(motions))), (_EXTENTS, cache(lambda: _extents(motions)))):
            values |= {name: Later(partial(_of, found, name)) for name in names}
        return Record(self._text(operation.name) or "", values)


def _of(found: Callable[[], Mapping[str, object]], name: str) -> object:
    return found().get(name)


def _feeds(motions: Sequence[Motion]) -> dict[str, object]:
    """Return the least and the greatest feed of the cuts, those per revolution apart."""
    moves = [motion.operation.moves for motion in motions]
    feeds = np.concatenate([each.feed[(each.kind != Kind.RAPID) & ~each.per_rev] for each in moves])
    if not len(feeds) or np.isnan(feeds).any():
        return {}
    return {"least_feed": Length(feeds.min()), "greatest_feed": Length(feeds.max())}


def _extents(motions: Sequence[Motion]) -> dict[str, object]:
    """Return the box around all cuts of the tip, in whole millimetres outwards."""
    box = cut_extents(motions)
    return {} if box is None else dict(zip(_EXTENTS, map(Length, np.concatenate(box).tolist()), strict=True))
