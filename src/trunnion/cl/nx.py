"""What each statement of an NX CLSF means. One small method a statement, and a table of all of them at the end.

In:     statements in the order of the file, each with its line and the row before which it stands.
Out:    drafts of operations, in the units of the file.

Here are the operations, their frames and tools, and motion; feeds and events are in ``trunnion.cl.events``.
"""

import math
import re
from collections.abc import Callable
from dataclasses import replace

from trunnion.cl.builder import Circle, Columns, Draft, Start
from trunnion.cl.diagnostics import Findings, Wrong
from trunnion.cl.events import MM_PER_INCH, EventStatements, whole
from trunnion.cl.scan import ROW
from trunnion.cl.statement import Statement, is_whole, numbers, parse
from trunnion.model.toolpath import Frame, GoHome, Tool

_LENGTHS = {"MM": 1.0, "INCHES": MM_PER_INCH, "INCH": MM_PER_INCH, "IN": MM_PER_INCH}

#: So far may the vectors of MSYS be off unit length and off square: they are printed with seven decimals.
_FRAME_TOLERANCE = 1e-3

#: Statements that are short enough to come again get their parsed form kept; so many of them.
_KEEP_BYTES = 64
_KEEP = 4096

#: After so many statements without one that is known, the file is no CL file.
_PATIENCE = 1000
#: Between the names of operation and tool.
_TOOL_WORD = re.compile(r",\s*TOOL\s*,")

_NOT_CL = "not a CL file: no statement in it is known"
_GIVE_CL = "give an NX CLSF (*.cls)"


class Interpreter(EventStatements):
    """Takes statements one after the other; ``drafts`` are the operations, ``unit()`` the length unit."""

    def __init__(self, columns: Columns, findings: Findings, encoding: str, strict: bool) -> None:
        super().__init__(findings, strict)
        self.drafts: list[Draft] = []
        self.part = ""
        self._columns = columns
        self._encoding = encoding
        self._inside = False
        self._has_row = False
        self._known = 0
        self._strange = 0
        self._kept: dict[bytes, tuple[Rule | None, Statement]] = {}
        self._units: tuple[float, int] | None = None
        self._spline = False

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

    def _unknown(self, statement: Statement) -> None:
        if not statement.source:
            return  # the end mark of a DOS file
        self._strange += 1
        if self._strange > _PATIENCE and self._known == 0 and self._row == 0:
            raise self._findings.fatal(0, _NOT_CL, _GIVE_CL)
        self._unsure(statement, f"{statement.major or 'a statement without a word'} is not known")

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
        name, tool = (*_TOOL_WORD.split(statement.text, maxsplit=1), "")[:2]
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
            *others, last = map(str, layouts)
            wanted = f"{', '.join(others)} or {last}" if others else last
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

    # -- how the path is drawn -----------------------------------------------------------------------------------

    def _paint(self, statement: Statement) -> None:
        if statement.values[:1] != ("COLOR",):
            return  # how the path is drawn on the screen
        self._draft.colours.append((self._here, whole("PAINT/COLOR", statement.values[1:])))

    def _nothing(self, statement: Statement) -> None:
        """Ends of the file, which the file itself shows, and names of machines."""


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
    "MILL": {5: _MILL, 7: (*_MILL, "", ""), 10: (*_MILL, "", "", "upper_radius", "", "")},
    "DRILL": {5: _DRILL},
    "TCUTTER": {5: _T},
    "BARREL": {5: _MILL, 7: (*_MILL, "", ""), 10: (*_MILL, "", "", "upper_radius", "", "")},
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
