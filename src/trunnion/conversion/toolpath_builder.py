"""From what a control did with a program back to the ``Toolpath`` that asks for it.

In:     a ``Run`` (what the reader found out), the program's text, and the definition of the control that it was written
        for: its templates say what the lines of a head mean, its ``phases`` what the comments between motions mean.
Out:    operations in the workpiece frame, mm, and the settings that a toolpath has no place for.

What belongs to the machine and not to the part is left out: moves to machine positions, and the placing of the rotary
axes before an operation's first position.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from trunnion.arrays import Flags, Ints
from trunnion.controls.definition import Control
from trunnion.controls.template import Template
from trunnion.conversion.events import Events
from trunnion.conversion.moves import arcs_of, moves_of
from trunnion.conversion.program_events import Item, items
from trunnion.conversion.program_text import LANGUAGES, Source
from trunnion.conversion.settings import number, settings_of
from trunnion.conversion.template_matching import match, patterns, spellings
from trunnion.conversion.unsupported import (
    Remarks,
    remark_homes,
    remark_normals,
    remark_poses,
    remark_registers,
    remark_ways,
    remark_words,
)
from trunnion.errors import Problem
from trunnion.model.run import Run, Written, offset_name
from trunnion.model.toolpath import Frame, Kind, LoadTool, Operation, Phase, Tool, Toolpath
from trunnion.readers import numbers_lengths
from trunnion.readers.common.settings import family_of
from trunnion.verification import with_rapids

_PHASES = {
    "rapid": Phase.RAPID,
    "approach": Phase.APPROACH,
    "engage": Phase.ENGAGE,
    "cut": Phase.CUT,
    "stepover": Phase.STEPOVER,
    "retract": Phase.RETRACT,
    "departure": Phase.DEPARTURE,
    "traverse": Phase.TRAVERSE,
}
#: How the templates of an operation's head and of its end are called; those of kinds of operations by what follows.
_HEADS = ("operation_start", "first_tool", "tool_change", "approach_", "plane_on_")
_ENDS = ("operation_end_",)


@dataclass(frozen=True, slots=True, eq=False)
class Converted:
    """A program as a toolpath.

    settings  what the program says and a toolpath has no place for, as ``--set`` takes it; only what is not the default
    remarks   what does not survive the way back
    """

    toolpath: Toolpath
    settings: dict[str, str]
    remarks: tuple[Problem, ...]


def convert(run: Run, control: Control) -> Converted:
    """Turn a program that was read without errors into a toolpath.

    Parameters
    ----------
    run
        Of the reader. Its files are looked into once more for what the columns do not hold.
    control
        Of the machine that the program was written for. Where its rapids are lines at a feed (``rapid_feed``), lines at
        that feed are rapids.
    """
    usual = control.settings.get("rapid_feed", "")
    converted = _Converter(with_rapids(run, number(usual)), control).convert()
    said = converted.settings.get("rapid_feed", usual)
    return converted if said == usual else _Converter(with_rapids(run, number(said)), control).convert()


@dataclass(slots=True)
class _Part:
    """The part of a program that becomes an operation.

    line    where it begins
    begin   items from here on are said in it
    end     up to here; behind it the path has ended
    first   row of the run where it begins
    stop    row behind it
    rows    (n,) rows that move the tool at the workpiece
    values  what its head says
    """

    line: int
    begin: int
    first: int
    end: int = -1
    stop: int = 0
    rows: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    values: dict[str, str] = field(default_factory=dict)


class _Converter:
    """Converts one program."""

    def __init__(self, run: Run, control: Control) -> None:
        self._run = run
        self._control = control
        self._family = family_of(run.machine)
        language = LANGUAGES.get(self._family, "rs274")
        self._sources = [Source(file, control.numbers.letter, language) for file in run.files]
        self._source = self._sources[0]
        self._remark = Remarks(run.files)
        axes = run.machine.axes
        primary, secondary = axes[run.machine.primary].name, axes[run.machine.secondary].name
        self._values = {"primary": primary, "secondary": secondary, "machine": run.machine.name}
        self._spoken = spellings(control)
        self._known: set[int] = set()
        # M number -> CL word; of words with one number OFF, ON and then the first
        self._coolants: dict[int, str] = {}
        for word in ("OFF", "ON", *control.coolant):
            if word in control.coolant:
                self._coolants.setdefault(control.coolant[word], word)

    def convert(self) -> Converted:
        """The whole program."""
        run, control = self._run, self._control
        said = items(run, self._source, self._remark)
        starts = self._first_lines(said, [control.templates["operation_start"]])
        parts = self._parts(said, starts)
        self._match_heads(parts, said)
        phases = self._phases()
        marked = bool(starts) and bool(phases)
        unspoken = marked and not control.phases.get("rapid")
        events = Events(phases, self._coolants, self._known, marked, unspoken, self._remark)
        owned = self._share(said, parts)
        operations = tuple(self._operation(part, own, events) for part, own in zip(parts, owned, strict=True))
        settings = settings_of(control, [(part.line, part.values) for part in parts], self._remark)
        rows = [part.rows for part in parts]
        remark_homes(run, self._remark)
        remark_normals(run, self._remark)
        offset = "G" if self._offset_is_word else "work offset "
        remark_registers(run, rows, offset, self._remark)
        remark_ways(run, rows, settings.get("orientation") == "vector", self._remark)
        remark_poses(run, zip(rows, (operation.moves for operation in operations), strict=True), self._remark)
        remark_words(self._sources, self._family, self._known, self._remark)
        return Converted(Toolpath(run.files[0], operations, settings.get("part", "")), settings, self._remark.problems)

    def _phases(self) -> dict[str, Phase]:
        """Comment -> phase; of phases with one comment the first."""
        found: dict[str, Phase] = {}
        for name, phase in _PHASES.items():
            if spoken := self._control.phases.get(name, "").strip("; *()"):
                found.setdefault(spoken, phase)
        return found

    # Parts

    def _called(self, names: tuple[str, ...]) -> list[Template]:
        """The templates whose names begin so, in the order of ``names``."""
        templates = self._control.templates
        return [templates[key] for name in names for key in templates if key.startswith(name)]

    def _first_lines(self, said: Iterable[Item], templates: Iterable[Template]) -> set[int]:
        """The lines of ``said`` that are the first line of one of the templates, if that is more than a value."""
        settings = self._control.settings
        firsts = [patterns([template], self._values, settings, self._spoken)[:1] for template in templates]
        first = [line.expression for lines in firsts for line in lines if not line.bare]
        lines = sorted({item.line for item in said if item.file == 0})
        return {line for line in lines if any(each.fullmatch(self._source.text(line)) for each in first)}

    def _parts(self, said: Sequence[Item], starts: set[int]) -> list[_Part]:
        """Cut the program where operations begin: at the lines ``starts``, or without any at tool changes."""
        spoken = [item for item in said if item.kind == "comment"]
        ends = self._first_lines(spoken, self._called(_ENDS)) if starts else set[int]()
        parts = [_Part(1, 0, 0)]
        begun = 0
        for k, item in enumerate(said):
            last = parts[-1]
            here = item.line if item.file == 0 else 0
            begun = begun if here == begun else 0
            if (here in starts and here != begun and item.kind != "skip") if starts else (item.kind == "tool_change"):
                last.stop, begun = item.row, here
                last.end = k if last.end < 0 else last.end
                parts.append(_Part(item.line, k, item.row))
            elif item.kind == "comment" and here in ends and last.end < 0:
                last.end = k
        parts[-1].stop = len(self._run)
        parts[-1].end = len(said) if parts[-1].end < 0 else parts[-1].end
        for part in parts:
            part.rows = self._rows(part)
        return [part for part in parts if len(part.rows)]

    def _rows(self, part: _Part) -> Ints:
        """The rows that move the tool at the workpiece."""
        run = self._run
        rows = np.arange(part.first, part.stop)
        moved = ~run.machine_frame[rows]
        across = self._across(rows)
        placed = moved & ~across & ((run.programmed[rows] & (Written.X | Written.Y | Written.Z)) != 0)
        if not placed.any():
            return rows[:0]
        begin = int(np.argmax(placed))
        moved &= ~self._placed_away(rows) & ~across
        last = int(np.flatnonzero(moved)[-1])
        gone = begin + np.flatnonzero(~(moved | across)[begin:last])
        if len(gone):
            row = int(rows[gone[0]])
            what = "moves to machine positions within an operation are left out"
            self._remark(int(run.block[row]), what, file=int(run.file[row]))
        kept = begin + np.flatnonzero(moved[begin:])
        if run.kind[rows[begin]] == Kind.ARC and rows[begin] > 0:
            return np.concatenate(([rows[begin] - 1], rows[kept]))  # an arc needs the place where it begins
        return rows[kept]

    def _placed_away(self, rows: Ints) -> Flags:
        """(n,) bool: the rotary axes alone are placed, without TCP: away from the part, or after its last position."""
        run = self._run
        programmed = run.programmed[rows]
        places = (programmed & (Written.X | Written.Y | Written.Z | Written.VECTOR)) != 0
        alone = ~places & (programmed != 0) & ~run.tcp[rows] & (run.kind[rows] == Kind.RAPID)
        order = np.arange(len(rows))
        machine = np.maximum.accumulate(np.where(run.machine_frame[rows], order, -1))
        works = ~alone & ~run.machine_frame[rows]
        worked = np.maximum.accumulate(np.where(works, order, -1))
        after = order > (int(np.flatnonzero(works)[-1]) if works.any() else -1)
        return np.asarray(alone & ((machine > worked) | after))

    def _across(self, rows: Ints) -> Flags:
        """(n,) bool: the first leg of an approach, on controls that go from home to X and Y first, then down in Z."""
        found = np.zeros(len(rows), np.bool_)
        if not self._control.level_approach:
            return found
        run = self._run
        said = run.programmed[rows] & (Written.X | Written.Y | Written.Z | Written.VECTOR)
        works = ~run.machine_frame[rows] & (said != 0)
        order = np.arange(len(rows))
        home = np.maximum.accumulate(np.where(run.machine_frame[rows], order, -1))
        worked = np.maximum.accumulate(np.where(works, order, -1))
        before = np.concatenate(([-1], worked[:-1]))
        rapid = (run.kind[rows] == Kind.RAPID) & ~run.tcp[rows]
        first = works & rapid & ((said & ~np.uint8(Written.X | Written.Y)) == 0) & (home >= before) & (before < order)
        found[:-1] = first[:-1] & rapid[1:] & (said[1:] == Written.Z)
        return found

    def _match_heads(self, parts: Sequence[_Part], said: Sequence[Item]) -> None:
        """Find the lines of templates, and what they say. Where an operation's end begins, its path has ended."""
        templates, run, settings = self._control.templates, self._run, self._control.settings
        start = patterns([templates["program_start"]], self._values, settings, self._spoken)
        head = patterns(self._called(_HEADS), self._values, settings, self._spoken)
        tail = patterns([*self._called(_ENDS), templates["program_end"]], self._values, settings, self._spoken)
        common: dict[str, str] = {}
        for k, part in enumerate(parts):
            after = parts[k + 1].line if k + 1 < len(parts) else self._source.count + 1
            first, last = (
                int(run.block[part.rows[end]]) if run.file[part.rows[end]] == 0 else after for end in (0, -1)
            )
            if k == 0:
                self._known |= match(self._source.texts(1, part.line if part.line > 1 else first), start, common)
            self._known |= match(self._source.texts(part.line, first), head, part.values)
            ended = match(self._source.texts(last + 1, after), tail, part.values)
            self._known |= ended
            there = (n for n in range(part.begin, part.end) if said[n].file == 0 and said[n].line in ended)
            part.end = next((n for n in there if said[n].kind != "skip"), part.end)
            part.values = {**common, **part.values, **self._plane(part.line, first), **self._registers(part)}

    def _plane(self, first: int, last: int) -> dict[str, str]:
        """The way in which a head from line to line says its tilted plane, where the control has several."""
        lines, control = self._source.texts(first, last), self._control
        for way in control.family.PLANES if "plane" in control.settings else ():
            wanted = patterns(self._called((f"plane_on_{way}",)), self._values, control.settings, self._spoken)
            if any(not each.bare and each.expression.fullmatch(text) for _, text in lines for each in wanted):
                return {"plane": way}
        return {}

    def _registers(self, part: _Part) -> dict[str, str]:
        """Work offset and edge in force at the first row; an offset that is no G word was found in the head.

        Where the source calls no edges, the number is that of a length (H), which goes with the tool.
        """
        offset, edge = int(self._run.offset[part.rows[0]]), int(self._run.edge[part.rows[0]])
        named = {"work_offset": offset_name(offset)} if offset and self._offset_is_word else {}
        named |= {"edge": str(edge)} if edge >= 0 and "edge" in self._control.settings else {}
        return named | ({"orientation": how} if (how := self._orientation(part.rows)) else {})

    def _orientation(self, rows: Ints) -> str:
        """How a program says orientations under TCP; empty where it says none, or the control has but one way."""
        if "orientation" not in self._control.settings:
            return ""
        said = int(np.bitwise_or.reduce(self._run.programmed[rows[self._run.tcp[rows]]], initial=0))
        return "vector" if said & Written.VECTOR else "angles" if said & (Written.FIRST | Written.SECOND) else ""

    @property
    def _offset_is_word(self) -> bool:
        """Whether a work offset is called by its G word alone."""
        return bool(re.fullmatch(r"G\d+", self._control.settings.get("work_offset", "")))

    def _share(self, said: Sequence[Item], parts: Sequence[_Part]) -> list[list[Item]]:
        """What is said in each operation; what stands outside of all belongs to the next, or else to the last."""
        owned: list[list[Item]] = []
        at = 0
        for k, part in enumerate(parts):
            stop = part.end if k + 1 < len(parts) else len(said)
            inside = range(part.begin, part.end)
            own = [said[n] for n in range(at, stop) if n in inside or self._matters(said[n])]
            row = int(part.rows[0])
            running = self._running(said[: part.begin])
            if running and not any(item.row <= row and self._is_coolant(item) for item in own):
                own.insert(0, running._replace(row=row))
            owned.append(own)
            at = stop
        return owned

    def _running(self, said: Sequence[Item]) -> Item | None:
        """What turned the coolant on that runs after all this; every operation of a toolpath asks for its own."""
        last = next((item for item in reversed(said) if self._is_coolant(item)), None)
        return None if last is None or last.value == "off" else last

    def _is_coolant(self, item: Item) -> bool:
        return item.kind == "coolant" or (item.kind == "m" and item.value in self._coolants)

    def _matters(self, item: Item) -> bool:
        """Whether an item outside an operation's path has anything to say to another operation."""
        if item.file == 0 and item.line in self._known:
            return False
        return not (item.kind == "coolant" and item.value == "off") and item.kind not in ("end", "cycle832")

    # Operations

    def _operation(self, part: _Part, said: Sequence[Item], events: Events) -> Operation:
        run, values = self._run, part.values
        phase, happened = events.of(said, run, part.rows, part.line)
        lengths = run.edge[part.rows][run.edge[part.rows] > 0]
        if len(lengths) and numbers_lengths(run.machine):
            register = int(lengths[0])
            happened = tuple(
                replace(one, adjust=register) if isinstance(one, LoadTool) and one.number != register else one
                for one in happened
            )
        named = f"TOOL_{events.tool}" if events.tool else Path(run.files[0]).stem
        return Operation(
            name=values.get("operation", "") or named,
            tool=self._tool(values, events.tool),
            frame=Frame(),
            moves=moves_of(run, part.rows, phase, self._remark),
            arcs=arcs_of(run, part.rows),
            events=happened,
            line=part.line,
            intol=number(values.get("intol")),
            outtol=number(values.get("outtol")),
        )

    def _tool(self, values: dict[str, str], called: str) -> Tool:
        """The cutter; ``values`` gets the settings that call it as the program does, by ``called``."""
        kinds = {text: kind for kind, text in self._control.tool_types.items()}
        kind = kinds.get(values.get("tool_type", ""), "UNKNOWN")
        diameter = number(values.get("tool_diameter"))
        if kind == "BALL" or (kind == "UNKNOWN" and diameter):
            kind = "MILL"
        by_name = bool(called) and (not called.isdigit() or values.get("tool", "").startswith('"'))
        values.pop("tool", None)
        name = values.get("tool_name", "") or (called if by_name else "")
        if called:
            values["tool_call"] = "name" if by_name and name == called else "number"
        if by_name and name != called:
            values["tool"] = f'"{called}"'
        return Tool(
            kind=kind,
            name=name,
            diameter=diameter or 0.0,
            corner_radius=number(values.get("tool_corner_radius")) or 0.0,
            length=number(values.get("tool_length")) or 0.0,
        )
