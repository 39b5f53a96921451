"""What each statement of an NX CLSF means. One small method a statement, and a table of them at the end.

In:     statements in the order of the file, each with its line and the row before which it stands.
Out:    drafts of operations, in the units of the file.

Words are told apart by what they are, never by their place: systems differ in ``SPINDL/RPM,n`` and ``SPINDL/n,RPM``.
"""

import math
from collections.abc import Callable
from dataclasses import replace

from trunnion.cl.assemble import CYCLE_LENGTHS
from trunnion.cl.draft import Circle, Columns, Draft, Feed, Start, SurfaceSpeed
from trunnion.cl.findings import Findings, Wrong
from trunnion.cl.scan import ROW
from trunnion.cl.statement import Statement, is_whole, numbers, parse
from trunnion.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Frame,
    GoHome,
    Insert,
    LoadTool,
    Message,
    Mode,
    SelectTool,
    Sense,
    SpindleOff,
    SpindleOn,
    Stop,
    Tool,
    Unknown,
)

MM_PER_INCH = 25.4
_MM_PER_FOOT = 304.8

#: Feed words: mm in the length unit they name, and whether the feed is per revolution.
_FEEDS = {"MMPM": (1.0, False), "MMPR": (1.0, True), "IPM": (MM_PER_INCH, False), "IPR": (MM_PER_INCH, True)}
_LENGTHS = {"MM": 1.0, "INCHES": MM_PER_INCH, "INCH": MM_PER_INCH, "IN": MM_PER_INCH}
#: Surface speeds, as mm/min in one unit.
_SURFACE = {"SFM": _MM_PER_FOOT, "SMM": 1000.0}
_COOLANTS = frozenset({"ON", "OFF", "FLOOD", "MIST", "TAP", "THRU", "AIR"})
_SIDES = frozenset({"LEFT", "RIGHT", "ON", "OFF"})
_PLANES = frozenset({"XYPLAN", "ZXPLAN", "YZPLAN"})
_CYCLE_MODES = frozenset(
    {"DRILL", "DEEP", "BRKCHP", "CSINK", "TAP", "BORE", "DRAG", "NODRAG", "MANUAL", "FACE", "REAM", "THRU", "BACK"}
)
_CYCLE_NUMBERS = CYCLE_LENGTHS | {"DWELL", "TLANGL", "NODRAG"}
_CYCLE_WORDS = frozenset({"AUTO", "MANUAL", "REV", "OPTION"})

#: So far may the vectors of MSYS be off unit length and off square: they are printed with seven decimals.
_FRAME_TOLERANCE = 1e-3

#: Statements that are short enough to come again get their parsed form kept; so many of them.
_KEEP_BYTES = 64
_KEEP = 4096

#: After so many statements without one that is known, the file is no CL file.
_PATIENCE = 1000
_NOT_CL = "not a CL file: no statement in it is known"
_GIVE_CL = "give an NX CLSF (*.cls)"


class Interpreter:
    """Takes statements one after the other; ``drafts`` are the operations, ``unit()`` the length unit."""

    def __init__(self, columns: Columns, findings: Findings, encoding: str, strict: bool) -> None:
        self.drafts: list[Draft] = []
        self.part = ""
        self._columns = columns
        self._findings = findings
        self._encoding = encoding
        self._strict = strict
        # What stands between two operations is kept here until one takes it over.
        self._draft = Draft("", 0, 0)
        self._inside = False
        self._row = 0
        self._line = 0
        self._has_row = False
        self._known = 0
        self._strange = 0
        self._kept: dict[bytes, tuple[Rule | None, Statement]] = {}
        self._per_rev = False
        self._bare = True
        self._factor = 1.0
        self._spindle: SpindleOn | SurfaceSpeed | None = None
        self._cycle: CycleOn | None = None
        self._units: tuple[float, int] | None = None
        self._spline = False
        self._metric = 0
        self._inch = 0

    def take(self, raw: bytes, line: int, row: int, mark: int) -> None:
        """Interpret one statement.

        raw   bytes of the statement, with its continuation lines
        line  its line
        row   row of the columns before which it stands; its own row if ``mark`` says that it makes one
        """
        self._line = line
        self._row = row
        self._has_row = mark & ROW != 0
        try:
            rule, statement = self._kept.get(raw) or self._look_up(raw)
            if rule is None:
                self._unknown(statement)
            else:
                rule(self, statement)
                self._known += 1
        except Wrong as wrong:
            self._findings.error(line, wrong.what, wrong.cure)

    def finish(self, row: int, whole: bool, lines: int) -> None:
        """Close the file.

        row    rows read in all
        whole  whether the last line has a line end
        lines  number of the last line
        """
        self._row = row
        if self._inside:
            draft = self._draft
            what = f"operation {draft.name} has no END-OF-PATH before the end of the file"
            if not whole:
                what += f", which ends in the middle of line {lines}"
            self._findings.error(lines if not whole else draft.line, what, "the file is cut off: write it out again")
            self._close()
        elif row > self._draft.first:
            self._motion_outside()
        if not self._known and not row:
            self._findings.error(0, _NOT_CL, _GIVE_CL)
        elif not row and not self._findings.failed:
            self._findings.error(0, "there is no motion in the file", "write out an operation with a tool path")
        if self.drafts and self._draft.events:
            # What follows the last operation is done after its last row.
            last = self.drafts[-1]
            last.events.extend(replace(event, row=last.stop - last.first) for event in self._draft.events)

    def unit(self, given: str | None) -> float:
        """Return the length unit of the file in mm: the one given, or as the file says, or as its feeds let guess."""
        if given is not None:
            return _LENGTHS[given.upper()]
        if self._units is not None:
            return self._units[0]
        if self._metric and self._inch:
            self._findings.error(
                max(self._metric, self._inch),
                f"feeds in mm (line {self._metric}) and in inches (line {self._inch}), and no UNITS",
                "say what the lengths are with --set units=mm or --set units=inch",
            )
        if self._inch and not self._metric:
            self._findings.remark(
                self._inch,
                "all feeds are in inches, so lengths are taken as inches too",
                "if they are not, say so with --set units=mm",
            )
            return MM_PER_INCH
        return 1.0

    def _look_up(self, raw: bytes) -> "tuple[Rule | None, Statement]":
        statement = parse(raw, self._encoding)
        entry = RULES.get(statement.major), statement
        if len(raw) <= _KEEP_BYTES and len(self._kept) < _KEEP:
            self._kept[raw] = entry
        return entry

    def _add(self, event: Event) -> None:
        self._draft.events.append(event)

    @property
    def _here(self) -> int:
        """Row within the operation."""
        return self._row - self._draft.first

    def _unknown(self, statement: Statement) -> None:
        if not statement.source:
            return  # the end mark of a DOS file
        self._strange += 1
        if self._strange > _PATIENCE and self._known == 0 and self._row == 0:
            raise self._findings.fatal(0, _NOT_CL, _GIVE_CL)
        self._unsure(statement, f"{statement.major or 'a statement without a word'} is not known")

    def _unsure(self, statement: Statement, what: str) -> None:
        """Keep a statement as it stands, once however much of it is not known."""
        last = self._draft.events[-1] if self._draft.events else None
        if not isinstance(last, Unknown) or last.line != self._line:
            self._add(Unknown(self._here, self._line, statement.source))
        if self._strict:
            self._findings.error(self._line, what, "take the statement out, or read without strict")
        else:
            self._findings.remark(self._line, f"{what}; kept as it stands", "look whether the program needs it")

    # -- operations ---------------------------------------------------------------------------------------------

    def _tool_path(self, statement: Statement) -> None:
        if self._inside:
            self._findings.error(
                self._draft.line,
                f"operation {self._draft.name} has no END-OF-PATH before the next TOOL PATH in line {self._line}",
                "end each operation with END-OF-PATH",
            )
            self._close()
        elif self._here:
            self._motion_outside()
            self._draft.starts.clear()
        # The tool's name may have commas in it, the word TOOL stands between the two names.
        name, _, tool = statement.text.partition(",TOOL,")
        outside = self._draft
        self._draft = replace(
            outside, name=name.strip(), line=self._line, first=self._row, colours=[], rapids=[], circles=[]
        )
        self._draft.tool = replace(outside.tool, name=tool.strip() or outside.tool.name)
        self._inside = True
        self._spindle = None
        self._cycle = None

    def _end_of_path(self, statement: Statement) -> None:
        if not self._inside:
            raise Wrong("END-OF-PATH without TOOL PATH", "begin each operation with TOOL PATH/name,TOOL,tool")
        self._close()

    def _close(self) -> None:
        self._draft.stop = self._row
        self.drafts.append(self._draft)
        self._draft = Draft("", self._line, self._row)
        self._inside = False

    def _motion_outside(self) -> None:
        self._findings.error(
            int(self._columns.line[self._draft.first]),
            "motion outside any operation",
            "write TOOL PATH/name,TOOL,tool before it and END-OF-PATH behind it",
        )

    def _tldata(self, statement: Statement) -> None:
        words = statement.words()
        given = numbers("TLDATA", statement.values[len(words) :])
        if any(number < 0 for number in given[:1]):
            raise Wrong("TLDATA has a negative diameter", "write the diameter of the tool")
        form = words[0] if words else ""
        layouts = _TOOLS.get(form, {})
        if form in _TOOLS and len(given) not in layouts:
            wanted = " or ".join(map(str, layouts))
            raise Wrong(f"TLDATA/{form} has {len(given)} numbers, expected {wanted}", "write TLDATA as NX does")
        fields = {field: number for field, number in zip(layouts.get(len(given), ()), given, strict=False) if field}
        self._draft.tool = Tool(kind=form if form in _TOOLS else "UNKNOWN", name=self._draft.tool.name, **fields)
        if form not in _TOOLS:
            self._unsure(statement, f"TLDATA/{form} is not a known form of tool")

    def _msys(self, statement: Statement) -> None:
        if self._here:
            raise Wrong("MSYS after motion", "one operation has one frame: write MSYS before its first GOTO")
        ox, oy, oz, *vectors = statement.numbers(9)
        x, y = vectors[:3], vectors[3:]
        for name, vector in (("X", x), ("Y", y)):
            if abs(math.hypot(*vector) - 1) > _FRAME_TOLERANCE:
                raise Wrong(
                    f"the {name} vector of MSYS has the length {math.hypot(*vector):.6g}, not 1",
                    "write origin, X and Y of the coordinate system",
                )
        x = _unit(x)
        along = _dot(x, y)
        if abs(along) > _FRAME_TOLERANCE:
            raise Wrong("X and Y of MSYS are not square to each other", "write origin, X and Y of the frame")
        y = _unit([b - along * a for a, b in zip(x, y, strict=True)])
        self._draft.frame = Frame((ox, oy, oz), (x[0], x[1], x[2]), (y[0], y[1], y[2]))

    def _partno(self, statement: Statement) -> None:
        self.part = self.part or statement.text

    def _unit_word(self, statement: Statement) -> None:
        word = statement.values[0] if statement.values else ""
        if not isinstance(word, str) or word not in _LENGTHS:
            raise Wrong(f"UNITS/{word} is not a unit that is read", "write UNITS/MM or UNITS/INCHES")
        if self._units is not None and self._units[0] != _LENGTHS[word]:
            raise Wrong(f"UNITS/{word} after another unit in line {self._units[1]}", "keep to one unit in a file")
        self._units = self._units or (_LENGTHS[word], self._line)

    def _intol(self, statement: Statement) -> None:
        self._draft.intol = statement.numbers(1)[0]

    def _outtol(self, statement: Statement) -> None:
        self._draft.outtol = statement.numbers(1)[0]

    # -- motion -------------------------------------------------------------------------------------------------

    def _rapid(self, statement: Statement) -> None:
        if statement.values:
            self._unsure(statement, f"RAPID/{statement.words()} is not known")
        self._draft.rapids.append(self._here)

    def _goto(self, statement: Statement) -> None:
        self._fill(statement.numbers(3, 6))

    def _godlta(self, statement: Statement) -> None:
        x, y, z = statement.numbers(3)
        start = self._tip()
        if start is None:
            raise Wrong("GODLTA without a point to go from", "write FROM/ or GOTO/ before it")
        self._no_circle("GODLTA")
        self._fill((start[0] + x, start[1] + y, start[2] + z))

    def _gohome(self, statement: Statement) -> None:
        self._no_circle("GOHOME")
        if not statement.values:
            self._add(GoHome(self._here, self._line))
            return
        if not self._has_row:
            self._unsure(statement, "GOHOME with words is not known")
            return
        self._draft.rapids.append(self._here)
        self._fill(statement.numbers(3, 6))

    def _fill(self, values: tuple[float, ...]) -> None:
        """Write a row; the scan has kept it free and marked its axis as not given."""
        if not self._has_row:
            raise Wrong("a motion without coordinates", "write GOTO/x,y,z or GOTO/x,y,z,i,j,k")
        self._columns.tip[self._row] = values[:3]
        if len(values) == 6:
            self._columns.axis[self._row] = values[3:]

    def _tip(self) -> tuple[float, float, float] | None:
        """Where the tool stands now."""
        starts = self._draft.starts
        if starts and starts[-1].row == self._here:
            return starts[-1].tip
        if self._here == 0:
            return None
        x, y, z = self._columns.tip[self._row - 1].tolist()
        return x, y, z

    def _from(self, statement: Statement) -> None:
        x, y, z, *axis = statement.numbers(3, 6)
        vector = (axis[0], axis[1], axis[2]) if axis else None
        self._draft.starts.append(Start(self._here, self._line, (x, y, z), vector))

    def _circle(self, statement: Statement) -> None:
        if not self._inside:
            raise Wrong("CIRCLE outside any operation", "write TOOL PATH/name,TOOL,tool before it")
        self._no_circle("another CIRCLE")
        values = statement.values
        turns = 1.0
        if "TIMES" in values:
            place = values.index("TIMES")
            (turns,) = numbers("CIRCLE TIMES", values[place + 1 :], 1)
            values = values[:place]
        given = numbers("CIRCLE", values, 7, 8, 11, 12)
        if len(given) in (8, 12):
            turns = given[-1]
        if not is_whole(turns, 1) or turns > 10000:
            raise Wrong(f"CIRCLE has {turns:g} turns", "write TIMES,n with n = 1, 2, 3 ...")
        self._draft.circles.append(Circle(self._here, self._line, given[:7], int(turns)))

    def _no_circle(self, what: str) -> None:
        """Refuse ``what`` where the end point of an arc must stand."""
        circles = self._draft.circles
        if circles and circles[-1].row == self._here:
            circle = circles.pop()
            raise Wrong(
                f"{what} where the GOTO of the CIRCLE in line {circle.line} must stand",
                "write GOTO/ with the end point of the arc after each CIRCLE",
            )

    def _not_readable(self, statement: Statement) -> None:
        if statement.major in ("KNOT", "CNTRL") and self._spline:
            return  # part of a NURBS that was refused already
        self._spline = True
        raise Wrong(
            f"{statement.major} is motion that cannot be read",
            "turn off spline output in the CAM system, and write lines and circles in the machining coordinates",
        )

    # -- feed, spindle, tool ------------------------------------------------------------------------------------

    def _fedrat(self, statement: Statement) -> None:
        for word in statement.words():
            if word not in _FEEDS:
                raise Wrong(f"FEDRAT/{word} is not a feed that is read", "write the feed in MMPM, MMPR, IPM or IPR")
            self._factor, self._per_rev = _FEEDS[word]
            self._bare = False
            self._saw(word)
        (value,) = numbers("FEDRAT", tuple(value for value in statement.values if not isinstance(value, str)), 1)
        if value < 0:
            raise Wrong(f"FEDRAT is negative: {value:g}", "write a feed above 0")
        if value == 0:
            self._findings.remark(self._line, "FEDRAT is 0", "write a feed above 0, or RAPID")
        self._draft.feeds.append(Feed(self._here, value * self._factor, self._per_rev, self._bare))

    def _saw(self, word: str) -> None:
        if _FEEDS[word][0] == 1.0:
            self._metric = self._metric or self._line
        else:
            self._inch = self._inch or self._line

    def _spindl(self, statement: Statement) -> None:
        words = set(statement.words())
        if "OFF" in words:
            self._add(SpindleOff(self._here, self._line))
            return
        if words - {"RPM", "SFM", "SMM", "CLW", "CCLW", "ON", "LOW", "MEDIUM", "HIGH", "RANGE", "DIAMTR"}:
            self._unsure(statement, f"SPINDL/{','.join(statement.words())} is not known")
            return
        speed: float | None = None
        diameter: float | None = None
        last: str | float = ""
        for value in statement.values:
            if not isinstance(value, str):
                (value,) = numbers("SPINDL", (value,))
                if last == "DIAMTR":
                    diameter = value
                elif last != "RANGE":
                    speed = value
            last = value
        sense = self._sense(words)
        surface = words & _SURFACE.keys()
        if speed is None:
            if self._spindle is None:
                raise Wrong("SPINDL turns the spindle on before any speed was given", "write SPINDL/RPM,n,CLW")
            self._spindle = replace(self._spindle, row=self._here, line=self._line, sense=sense)
        elif speed < 0:
            raise Wrong(f"SPINDL has a negative speed: {speed:g}", "write CLW or CCLW for the sense")
        elif surface:
            self._spindle = SurfaceSpeed(self._here, self._line, speed * _SURFACE[surface.pop()], sense, diameter)
        else:
            self._spindle = SpindleOn(self._here, self._line, speed, sense)
        self._add(self._spindle)

    def _sense(self, words: set[str]) -> Sense:
        """Return the sense named, else the one in force."""
        for sense in Sense:
            if sense.value in words:
                return sense
        return self._spindle.sense if self._spindle else Sense.CLW

    def _load(self, statement: Statement) -> None:
        values = statement.values
        if values[:1] != ("TOOL",):
            self._unsure(statement, f"{statement.major} without TOOL is not known")
            return
        number = _whole(statement.major, values[1:2])
        if statement.major == "SELECT":
            self._add(SelectTool(self._here, self._line, number))
            return
        adjust = 0
        if "ADJUST" in values:
            place = values.index("ADJUST")
            adjust = _whole("LOAD ADJUST", values[place + 1 : place + 2])
            values = values[:place] + values[place + 2 :]
        if len(values) > 2:
            self._unsure(statement, f"LOAD/TOOL with {','.join(map(str, values[2:]))} is not known beyond its number")
        self._add(LoadTool(self._here, self._line, number, adjust))

    def _coolnt(self, statement: Statement) -> None:
        values = statement.values or ("ON",)
        if len(values) != 1 or not isinstance(values[0], str) or values[0] not in _COOLANTS:
            self._unsure(statement, f"{statement.source.strip()} is not a coolant that is known")
            return
        self._add(Coolant(self._here, self._line, values[0]))

    def _cutcom(self, statement: Statement) -> None:
        words = statement.words()
        side = [word for word in words if word in _SIDES]
        plane = [word for word in words if word in _PLANES]
        register = tuple(value for value in statement.values if not isinstance(value, str))
        if len(side) != 1 or len(plane) > 1 or len(words) != len(side) + len(plane) or len(register) > 1:
            self._unsure(statement, f"{statement.source.strip()} is not known")
            return
        number = _whole("CUTCOM", register) if register else 0
        self._add(CutterComp(self._here, self._line, side[0], plane[0] if plane else "", number))

    # -- cycles -------------------------------------------------------------------------------------------------

    def _cycle_word(self, statement: Statement) -> None:
        values = statement.values
        if values == ("OFF",):
            self._add(CycleOff(self._here, self._line))
            return
        if values == ("ON",):
            if self._cycle is None:
                raise Wrong("CYCLE/ON before any cycle", "write the cycle with its values")
            self._cycle = replace(self._cycle, row=self._here, line=self._line)
        else:
            self._cycle = self._cycle_on(statement)
        self._add(self._cycle)

    def _cycle_on(self, statement: Statement) -> CycleOn:
        """Read mode words, then couplets of a word and what belongs to it, in any order."""
        mode: list[str] = []
        couplets: list[tuple[str, tuple[float, ...]]] = []
        words: list[tuple[str, str]] = []
        values = statement.values
        if not values or not isinstance(values[0], str):
            raise Wrong("CYCLE without a word for its kind", "write CYCLE/DRILL, CYCLE/TAP, ..., or CYCLE/OFF")
        at = 0
        while at < len(values):
            word = values[at]
            if not isinstance(word, str):
                raise Wrong(f"CYCLE has the number {word:g} without a word before it", "name each number of the cycle")
            stop = at + 1
            while stop < len(values) and not isinstance(values[stop], str):
                stop += 1
            given = numbers("CYCLE", values[at + 1 : stop])
            after = values[stop] if stop < len(values) else ""
            if word in _FEEDS:
                factor, per_rev = _FEEDS[word]
                self._saw(word)
                (feed,) = numbers(f"CYCLE {word}", given, 1)
                couplets.append(("MMPR" if per_rev else "MMPM", (feed * factor,)))
            elif word in _CYCLE_MODES and not couplets and not words:
                mode.append(word)
                if given:
                    couplets.append((word, given))
            elif word == "RTRCTO" and not given and after in ("AUTO", "MANUAL"):
                words.append((word, str(after)))
                stop += 1
            elif word == "DWELL" and not given and after == "REV":
                words.append((word, "REV"))
                given = tuple(value for value in values[stop + 1 : stop + 2] if not isinstance(value, str))
                couplets.append((word, numbers("CYCLE DWELL,REV", given, 1)))
                stop += 2
            elif word in _CYCLE_NUMBERS and given:
                couplets.append((word, given))
            elif word in _CYCLE_NUMBERS:
                raise Wrong(f"CYCLE has {word} without a number", f"write {word},value")
            elif given:
                self._unsure(statement, f"CYCLE with {word} is not known")
                couplets.append((word, given))
            else:
                if word not in _CYCLE_WORDS:
                    self._unsure(statement, f"CYCLE with {word or 'nothing between two commas'} is not known")
                words.append((word, ""))
            at = stop
        return CycleOn(self._here, self._line, tuple(mode), tuple(couplets), tuple(words))

    # -- other events -------------------------------------------------------------------------------------------

    def _delay(self, statement: Statement) -> None:
        words = statement.words()
        if words not in ([], ["REV"]):
            self._unsure(statement, f"DELAY/{','.join(words)} is not known")
            return
        (amount,) = numbers("DELAY", tuple(value for value in statement.values if not isinstance(value, str)), 1)
        if amount < 0:
            raise Wrong("DELAY is negative", "write the time in seconds, or the revolutions and REV")
        self._add(Dwell(self._here, self._line, amount, bool(words)))

    def _stop(self, statement: Statement) -> None:
        self._add(Stop(self._here, self._line, statement.major == "OPSTOP", statement.text))

    def _message(self, statement: Statement) -> None:
        self._add(Message(self._here, self._line, statement.text, statement.major in ("DISPLY", "DISPLAY")))

    def _insert(self, statement: Statement) -> None:
        self._add(Insert(self._here, self._line, statement.text))

    def _opskip(self, statement: Statement) -> None:
        if statement.values not in (("ON",), ("OFF",)):
            self._unsure(statement, f"{statement.source.strip()} is not known")
            return
        self._add(BlockSkip(self._here, self._line, statement.values == ("ON",)))

    def _mode(self, statement: Statement) -> None:
        values = [value if isinstance(value, str) else f"{value:g}" for value in statement.values]
        self._add(Mode(self._here, self._line, (statement.major, *values)))

    def _paint(self, statement: Statement) -> None:
        if statement.values[:1] != ("COLOR",):
            return  # how the path is drawn on the screen
        self._draft.colours.append((self._here, _whole("PAINT/COLOR", statement.values[1:])))

    def _nothing(self, statement: Statement) -> None:
        """Ends of the file, which the file itself shows, and names of machines."""


def _whole(major: str, values: tuple[str | float, ...]) -> int:
    (number,) = numbers(major, values, 1)
    if not is_whole(number, 0):
        raise Wrong(f"{major} has {number:g} where a whole number belongs", "write 0, 1, 2 ...")
    return int(number)


def _dot(a: list[float], b: list[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(vector: list[float]) -> list[float]:
    length = math.hypot(*vector)
    return [number / length for number in vector]


_MILL = ("diameter", "corner_radius", "length", "taper_angle", "tip_angle")
_DRILL = ("diameter", "corner_radius", "length", "tip_angle", "flute_length")
_T = ("diameter", "corner_radius", "upper_radius", "length", "flute_length")

#: Forms of TLDATA: for each possible count of numbers, the fields of ``Tool`` that they are; empty where it has none.
_TOOLS: dict[str, dict[int, tuple[str, ...]]] = {
    "MILL": {5: _MILL, 10: (*_MILL, "", "", "upper_radius", "", "")},
    "DRILL": {5: _DRILL},
    "TCUTTER": {5: _T},
    "BARREL": {5: _MILL, 10: (*_MILL, "", "", "upper_radius", "", "")},
}

Rule = Callable[[Interpreter, Statement], None]

#: Every statement that is known.
RULES: dict[str, Rule] = {
    "TOOLPATH": Interpreter._tool_path,
    "END-OF-PATH": Interpreter._end_of_path,
    "TLDATA": Interpreter._tldata,
    "MSYS": Interpreter._msys,
    "PARTNO": Interpreter._partno,
    "UNITS": Interpreter._unit_word,
    "INTOL": Interpreter._intol,
    "OUTTOL": Interpreter._outtol,
    "RAPID": Interpreter._rapid,
    "GOTO": Interpreter._goto,
    "GODLTA": Interpreter._godlta,
    "GOHOME": Interpreter._gohome,
    "FROM": Interpreter._from,
    "CIRCLE": Interpreter._circle,
    "NURBS": Interpreter._not_readable,
    "KNOT": Interpreter._not_readable,
    "CNTRL": Interpreter._not_readable,
    "TLON": Interpreter._not_readable,
    "INDIRV": Interpreter._not_readable,
    "COPY": Interpreter._not_readable,
    "TRACUT": Interpreter._not_readable,
    "TRANS": Interpreter._not_readable,
    "FEDRAT": Interpreter._fedrat,
    "SPINDL": Interpreter._spindl,
    "LOAD": Interpreter._load,
    "SELECT": Interpreter._load,
    "COOLNT": Interpreter._coolnt,
    "CUTCOM": Interpreter._cutcom,
    "CYCLE": Interpreter._cycle_word,
    "DELAY": Interpreter._delay,
    "STOP": Interpreter._stop,
    "OPSTOP": Interpreter._stop,
    "PPRINT": Interpreter._message,
    "TPRINT": Interpreter._message,
    "DISPLY": Interpreter._message,
    "DISPLAY": Interpreter._message,
    "INSERT": Interpreter._insert,
    "OPSKIP": Interpreter._opskip,
    "SET": Interpreter._mode,
    "MODE": Interpreter._mode,
    "MULTAX": Interpreter._mode,
    "PAINT": Interpreter._paint,
    "MACHIN": Interpreter._nothing,
    "END": Interpreter._nothing,
    "FINI": Interpreter._nothing,
}
