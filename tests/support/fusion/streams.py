"""Programs as their programmer means them: from one description come the events of the post engine and the CL text.

The events have the engine's form: heights of cycles are coordinates along the tool, points of holes are their bottoms,
arcs have the axis of a plane and a sense. The text is written from what is meant.

Units: that of the stream, degrees.
"""

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Final

Vector = tuple[float, float, float]
Plane = tuple[Vector, Vector, Vector]

LEVEL: Final[Plane] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NOWHERE: Final = (0.0, 0.0, 0.0)


def text_of(value: float, decimals: int = 6) -> str:
    """A number as CL text has it: with all its decimals, and zero without a sign."""
    text = f"{value:.{decimals}f}"
    return text.lstrip("-") if float(text) == 0.0 else text


def listed(*values: float, decimals: int = 6) -> str:
    """Numbers between commas."""
    return ",".join(text_of(value, decimals) for value in values)


@dataclass(frozen=True)
class FusionTool:
    """A tool: the engine's name of its type, its sizes, and the words of ``$$-> TOOL`` that state them.

    angle    degrees: the whole one of a drill's point, half of a chamfer mill's, of a taper from the axis
    stated   form and words with numbers, lengths behind them left out; None where the form cannot be said
    """

    number: int = 1
    type: str = "MILLING_END_FLAT"
    diameter: float = 10.0
    corner: float = 0.0
    angle: float = 0.0
    stated: tuple[Any, ...] | None = ("MILL", "DIAMETER", 10.0)
    has_lengths: bool = True
    length: float = 40.0
    flutes: float = 22.0
    pitch: float = 0.0
    is_clockwise: bool = True
    coolant: str = "FLOOD"
    name: str = "MILL D10"
    holder: str = ""
    others: tuple[tuple[str, Any], ...] = ()

    def event(self) -> dict[str, Any]:
        """The tool of the engine."""
        return {
            "number": self.number, "type": TYPES.index(self.type), "diameter": self.diameter,
            "cornerRadius": self.corner, "taperAngle": math.radians(self.angle), "bodyLength": self.length,
            "fluteLength": self.flutes, "threadPitch": self.pitch, "clockwise": self.is_clockwise,
            "coolant": COOLANTS.index(self.coolant), "description": self.name, "lengthOffset": self.number,
            "diameterOffset": self.number, "holderDescription": self.holder,
            "holder": [[32.0, 20.0], [50.0, 40.0]] if self.holder else [], **dict(self.others),
        }  # fmt: skip

    def lines(self) -> Iterator[str]:
        """What the CL text says of it."""
        form, *words = self.stated or ("UNKNOWN", "DIAMETER", self.diameter)
        if self.has_lengths and self.stated:
            words += ["LENGTH", self.length, "FLUTE", min(self.flutes, self.length)]
        words += ["EXTENSION", self.length]
        values = (each if isinstance(each, str) else text_of(each) for each in words)
        yield f"$$-> TOOL / {','.join((form, *values))}"
        if self.holder:
            yield f"$$-> HOLDER / {self.holder}"


#: The order in which the engine's stand-in counts.
TYPES: Final = [
    "UNSPECIFIED", "DRILL", "DRILL_CENTER", "DRILL_SPOT", "MILLING_END_FLAT", "MILLING_END_BALL",
    "MILLING_END_BULLNOSE", "MILLING_CHAMFER", "MILLING_FACE", "MILLING_SLOT", "MILLING_RADIUS", "MILLING_DOVETAIL",
    "MILLING_TAPERED", "MILLING_LOLLIPOP", "MILLING_FORM", "MILLING_THREAD", "TAP_RIGHT_HAND", "TAP_LEFT_HAND",
    "REAMER", "BORING_BAR", "COUNTER_BORE", "COUNTER_SINK", "PROBE",
]  # fmt: skip
COOLANTS: Final = [
    "OFF", "FLOOD", "MIST", "THROUGH_TOOL", "AIR", "AIR_THROUGH_TOOL", "SUCTION", "FLOOD_MIST", "FLOOD_THROUGH_TOOL",
]  # fmt: skip
_COOLANT_WORDS: Final = {"OFF": "OFF", "FLOOD": "FLOOD", "MIST": "MIST", "THROUGH_TOOL": "THRU", "AIR": "AIR"}


@dataclass
class Stream:
    """A program, as events and as text; ``inserts`` is what its property says of commands."""

    name: str
    inch: bool = False
    inserts: dict[str, str] = field(default_factory=dict)
    properties: dict[str, str] = field(default_factory=dict)
    stock: tuple[Vector, Vector] | None = ((-60.0, -60.0, -50.0), (60.0, 60.0, 0.0))
    has_offsets: bool = False
    sections: list[dict[str, Any]] = field(default_factory=list)
    comment: str = ""
    lines: list[str] = field(default_factory=list)
    _waiting: list[list[Any]] = field(default_factory=list)
    _said: list[str] = field(default_factory=list)
    _now: dict[str, Any] | None = None
    _feed: float | None = None
    _axis: Vector | None = None
    _cycle: str = ""

    @property
    def text(self) -> str:
        """The CL file."""
        head = ["$$-> TRUNNION / 1", f"PARTNO/{self.name}", f"UNITS/{'INCHES' if self.inch else 'MM'}"]
        if self.stock and not self.has_offsets:
            low, high = self.stock
            size = [b - a for a, b in zip(low, high, strict=True)]
            head.append(f"$$-> STOCK / BOX,{listed(*size, *low)}")
        return "\n".join([*head, *self.lines, *self._said, "END-OF-PATH", "FINI"]) + "\n"

    def event(self) -> dict[str, Any]:
        """The stream, for the stand-in of the engine."""
        inserts = ";".join(f"{name}={line}" for name, line in self.inserts.items())
        return {
            "name": self.name, "comment": self.comment, "inch": self.inch,
            "properties": {"inserts": inserts, **self.properties}, "stock": self.stock or (NOWHERE, NOWHERE),
            "sections": self.sections, "after": self._waiting,
        }  # fmt: skip

    @contextmanager
    def section(
        self, name: str, tool: FusionTool, start: Vector, *, plane: Plane = LEVEL, axis: Vector | None = None,
        **more: Any,
    ) -> Iterator[None]:  # fmt: skip
        """An operation; what is said within is its path. ``axis``: five-axis, with this tool axis at its start."""
        parameters: dict[str, Any] = {"operation-comment": name, "operation:tolerance": 0.0005 if self.inch else 0.01}
        parameters.update(more.pop("parameters", {}))
        spindle = more.pop("spindle", 4000.0)
        offset = more.get("offset", 1) or 1  # 0: the first
        self._now = {
            "tool": tool.event(), "plane": plane, "axis": axis, "fiveAxis": axis is not None, "start": start,
            "spindle": spindle, "offset": 1, "wcs": {"origin": NOWHERE, "x": LEVEL[0], "y": LEVEL[1]},
            "parameters": parameters, "before": self._waiting, "events": [], **more,
        }  # fmt: skip
        if self.sections:
            self.lines.append("END-OF-PATH")
        self.sections.append(self._now)
        tolerance = text_of(parameters["operation:tolerance"])
        self.lines += [
            f"TOOL PATH/{name},TOOL,{tool.name}", *tool.lines(),
            f"MSYS/{listed(*NOWHERE)},{listed(*plane[0], *plane[1], decimals=9)}",
            f"INTOL/{tolerance}", f"OUTTOL/{tolerance}",
            f"$$-> WORK-OFFSET / {offset}",
            *self._said,
            *([f"STOP/T{tool.number}"] if dict(tool.others).get("manualToolChange") else []),
            f"LOADTL/{tool.number},ADJUST,{tool.number}",
            *(f"PPRINT/{note}" for note in parameters.get("notes", "").split("\n") if note),
        ]  # fmt: skip
        if tool.type != "PROBE":
            self.lines.append(f"SPINDL/RPM,{text_of(spindle)},{'CLW' if tool.is_clockwise else 'CCLW'}")
            word = _COOLANT_WORDS.get(tool.coolant)
            self.lines.append(f"COOLNT/{word}" if word else f"INSERT/{self.inserts.get(f'COOLANT_{tool.coolant}')}")
        self._waiting, self._said, self._feed, self._axis, self._cycle = [], [], None, axis, ""
        self.lines += ["RAPID", self._goto(start), *(["OPSKIP/ON"] if more.get("optional") else [])]
        yield
        if more.get("optional"):
            self.lines.append("OPSKIP/OFF")
        self._now = None

    def _goto(self, point: Sequence[float]) -> str:
        axis = "" if self._axis is None else "," + listed(*self._axis, decimals=9)
        return f"GOTO/{listed(*point)}{axis}"

    def _feeding(self, feed: float) -> None:
        if feed != self._feed:
            self.lines.append(f"FEDRAT/{'IPM' if self.inch else 'MMPM'},{text_of(feed)}")
        self._feed = feed

    def _event(self, *event: Any) -> None:
        (self._waiting if self._now is None else self._now["events"]).append(list(event))

    def say(self, event: Sequence[Any], *statements: str) -> None:
        """An event that is no motion, and what it is in the text: inside of an operation, or between two of them."""
        self._event(*event)
        (self._said if self._now is None else self.lines).extend(statements)

    def rapid(self, *point: float) -> None:
        """A rapid; of three axes, or with the tool axis of before."""
        self._event("rapid", point)
        self.lines += ["RAPID", self._goto(point)]

    def line(self, *point: float, feed: float = 800.0) -> None:
        """A line at a feed per minute."""
        self._event("line", point, feed)
        self._feeding(feed)
        self.lines.append(self._goto(point))

    def rapid5(self, point: Vector, axis: Vector) -> None:
        """A five-axis rapid."""
        self._event("rapid5", point, axis)
        self._axis = axis
        self.lines += ["RAPID", self._goto(point)]

    def line5(self, point: Vector, axis: Vector, feed: float = 1200.0) -> None:
        """A five-axis line."""
        self._event("line5", point, axis, feed)
        self._feeding(feed)
        self._axis = axis
        self.lines.append(self._goto(point))

    def arc(
        self, centre: Vector, normal: Vector, degrees: float, ends: Sequence[Vector], radius: float, *,
        rise: float = 0.0, feed: float = 600.0,
    ) -> None:  # fmt: skip
        """An arc about ``normal`` by the right-hand rule; ``ends`` are those of its parts of 120 degrees at most."""
        self._event("arc", centre, normal, degrees, rise, feed)
        self._feeding(feed)
        for end in ends:
            self.lines.append(f"CIRCLE/{listed(*centre)},{listed(*normal, decimals=9)},{text_of(radius)}")
            self.lines.append(self._goto(end))

    def holes(
        self, kind: str, mode: str, tops: Sequence[Vector], depth: float, *, feed: str = "MMPM,150", rapid: float = 2.0,
        clearance: float = 10.0, **words: float,
    ) -> None:  # fmt: skip
        """A cycle: heights count from the tops of the holes; ``feed`` as CL text; empty ``mode``: written as moves."""
        unit, value = feed.split(",")
        rate = float(value) * (self._now or {})["spindle"] if unit in ("MMPR", "IPR") else float(value)
        height = {"depth": depth, "feedrate": rate, **words}
        points = [
            {"point": (x, y, z - depth), "stock": z, "retract": z + rapid, "clearance": z + clearance}
            for x, y, z in tops
        ]
        self._event("cycle", kind, height, points)
        before = ""
        for x, y, z in tops:
            if mode:
                heights = f"RAPTO,{text_of(rapid)},FEDTO,{text_of(-depth)},RTRCTO,{text_of(clearance)}"
                statement = f"CYCLE/{mode},{heights},{unit},{text_of(float(value))}"
                self.lines += [statement] if statement != before else []
                before = statement
                self.lines.append(self._goto((x, y, z)))
            else:
                self.lines += ["RAPID", self._goto((x, y, z + clearance)), "RAPID", self._goto((x, y, z + rapid))]
                self._feeding(rate)
                self.lines += [self._goto((x, y, z - depth)), "RAPID", self._goto((x, y, z + clearance))]
        if mode:
            self.lines.append("CYCLE/OFF")
