"""What each statement of an NX CLSF means. One small method a statement, and a table of all of them at the end.

In:     statements in the order of the file, each with its line and the row before which it stands.
Out:    drafts of operations, in the units of the file.

Here are the operations, their frames and tools, and motion; feeds and events are in ``trunnion.cl.events``.
"""

import math
import re
from collections.abc import Callable
from dataclasses import replace

from trunnion.cl.builder import CircleStatement, FromStatement, MoveColumns, OperationBuilder
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.events import MM_PER_INCH, EventStatements, whole_number
from trunnion.cl.scan import MAKES_ROW
from trunnion.cl.statement import Statement, is_whole, numbers, parse
from trunnion.model.toolpath import Frame, GoHome, Tool

_LENGTHS = {"MM": 1.0, "INCHES": MM_PER_INCH, "INCH": MM_PER_INCH, "IN": MM_PER_INCH}

#: So far may the vectors of MSYS be off unit length and off square: they are printed with seven decimals.
_FRAME_TOLERANCE = 1e-3

#: Statements that are short enough to come again get their parsed form kept; so many of them.
_CACHED_STATEMENT_BYTES = 64
_CACHE_SIZE = 4096

#: After so many statements without one that is known, the file is no CL file.
_MAX_UNKNOWN_STATEMENTS = 1000
#: Between the names of operation and tool.
_TOOL_WORD = re.compile(r",\s*TOOL\s*,")

_NOT_CL = "not a CL file: no statement in it is known"
_GIVE_CL = "give an NX CLSF (*.cls)"


class ClsfInterpreter(EventStatements):
    """Takes statements one after the other; ``builders`` are the operations, ``unit()`` the length unit."""

    def __init__(self, columns: MoveColumns, diagnostics: Diagnostics, encoding: str, strict: bool) -> None:
        super().__init__(diagnostics, strict)
        self.builders: list[OperationBuilder] = []
        self.part = ""
        self._columns = columns
        self._encoding = encoding
        self._in_operation = False
        self._has_row = False
        self._known_statements = 0
        self._unknown_statements = 0
        self._parse_cache: dict[bytes, tuple[Handler | None, Statement]] = {}
        self._units: tuple[float, int] | None = None
        self._spline_reported = False

    def interpret(self, raw: bytes, line: int, row: int, mark: int) -> None:
        """Interpret one statement.

        raw   bytes of the statement, with its continuation lines
        line  its line
        row   row of the columns before which it stands; its own row if ``mark`` says that it makes one
        """
        self._line = line
        self._row = row
        self._has_row = mark & MAKES_ROW != 0
        try:
            handler, statement = self._parse_cache.get(raw) or self._look_up(raw)
            if handler is None:
                self._unknown_statement(statement)
            else:
                handler(self, statement)
                self._known_statements += 1
        except StatementError as error:
            self._diagnostics.error(line, error.what, error.cure)

    def finish(self, row: int, complete: bool, lines: int) -> None:
        """Close the file.

        row    rows read in all
        whole  whether the last line has a line end
        lines  number of the last line
        """
        self._row = row
        if self._in_operation:
            builder = self._builder
            what = f"operation {builder.name} has no END-OF-PATH before the end of the file"
            if not complete:
                what += f", which ends in the middle of line {lines}"
            self._diagnostics.error(
                lines if not complete else builder.line, what, "the file is cut off: write it out again"
            )
            self._close()
        elif row > self._builder.first:
            self._motion_outside()
        if not self._known_statements and not row:
            self._diagnostics.error(0, _NOT_CL, _GIVE_CL)
        elif not row and not self._diagnostics.has_errors:
            self._diagnostics.error(0, "there is no motion in the file", "write out an operation with a tool path")
        if self.builders and self._builder.events:
            # What follows the last operation is done after its last row.
            last = self.builders[-1]
            last.events.extend(replace(event, row=last.stop - last.first) for event in self._builder.events)

    def unit(self, given: str | None) -> float:
        """Return the length unit of the file in mm: the one given, or as the file says, or as its feeds let guess."""
        if given is not None:
            return _LENGTHS[given.upper()]
        if self._units is not None:
            return self._units[0]
        if self._metric and self._inch:
            self._diagnostics.error(
                max(self._metric, self._inch),
                f"feeds in mm (line {self._metric}) and in inches (line {self._inch}), and no UNITS",
                "say what the lengths are with --set units=mm or --set units=inch",
            )
        if self._inch and not self._metric:
            self._diagnostics.remark(
                self._inch,
                "all feeds are in inches, so lengths are taken as inches too",
                "if they are not, say so with --set units=mm",
            )
            return MM_PER_INCH
        return 1.0

    def _look_up(self, raw: bytes) -> "tuple[Handler | None, Statement]":
        statement = parse(raw, self._encoding)
        entry = HANDLERS.get(statement.major), statement
        if len(raw) <= _CACHED_STATEMENT_BYTES and len(self._parse_cache) < _CACHE_SIZE:
            self._parse_cache[raw] = entry
        return entry

    def _unknown_statement(self, statement: Statement) -> None:
        if not statement.source:
            return  # the end mark of a DOS file
        self._unknown_statements += 1
        if self._unknown_statements > _MAX_UNKNOWN_STATEMENTS and self._known_statements == 0 and self._row == 0:
            raise self._diagnostics.fatal(0, _NOT_CL, _GIVE_CL)
        self._keep_unknown(statement, f"{statement.major or 'a statement without a word'} is not known")

    # -- operations ---------------------------------------------------------------------------------------------

    def _tool_path(self, statement: Statement) -> None:
        if self._in_operation:
            self._diagnostics.error(
                self._builder.line,
                f"operation {self._builder.name} has no END-OF-PATH before the next TOOL PATH in line {self._line}",
                "end each operation with END-OF-PATH",
            )
            self._close()
        elif self._operation_row:
            self._motion_outside()
            self._builder.starts.clear()
        # The tool's name may have commas in it, the word TOOL stands between the two names.
        name, tool = (*_TOOL_WORD.split(statement.text, maxsplit=1), "")[:2]
        outside = self._builder
        self._builder = replace(
            outside, name=name.strip(), line=self._line, first=self._row, colours=[], rapids=[], circles=[]
        )
        self._builder.tool = replace(outside.tool, name=tool.strip() or outside.tool.name)
        self._in_operation = True
        self._spindle = None
        self._cycle = None

    def _end_of_path(self, statement: Statement) -> None:
        if not self._in_operation:
            raise StatementError("END-OF-PATH without TOOL PATH", "begin each operation with TOOL PATH/name,TOOL,tool")
        self._close()

    def _close(self) -> None:
        self._builder.stop = self._row
        self.builders.append(self._builder)
        self._builder = OperationBuilder("", self._line, self._row)
        self._in_operation = False

    def _motion_outside(self) -> None:
        self._diagnostics.error(
            int(self._columns.line[self._builder.first]),
            "motion outside any operation",
            "write TOOL PATH/name,TOOL,tool before it and END-OF-PATH behind it",
        )

    def _tldata(self, statement: Statement) -> None:
        words = statement.words()
        given = numbers("TLDATA", statement.values[len(words) :])
        if any(number < 0 for number in given[:1]):
            raise StatementError("TLDATA has a negative diameter", "write the diameter of the tool")
        form = words[0] if words else ""
        layouts = _TLDATA_FIELDS.get(form, {})
        if form in _TLDATA_FIELDS and len(given) not in layouts:
            *others, last = map(str, layouts)
            wanted = f"{', '.join(others)} or {last}" if others else last
            raise StatementError(
                f"TLDATA/{form} has {len(given)} numbers, expected {wanted}", "write TLDATA as NX does"
            )
        fields = {field: number for field, number in zip(layouts.get(len(given), ()), given, strict=False) if field}
        self._builder.tool = Tool(
            kind=form if form in _TLDATA_FIELDS else "UNKNOWN", name=self._builder.tool.name, **fields
        )
        if form not in _TLDATA_FIELDS:
            self._keep_unknown(statement, f"TLDATA/{form} is not a known form of tool")

    def _msys(self, statement: Statement) -> None:
        if self._operation_row:
            raise StatementError("MSYS after motion", "one operation has one frame: write MSYS before its first GOTO")
        ox, oy, oz, *vectors = statement.numbers(9)
        x, y = vectors[:3], vectors[3:]
        for name, vector in (("X", x), ("Y", y)):
            if abs(math.hypot(*vector) - 1) > _FRAME_TOLERANCE:
                raise StatementError(
                    f"the {name} vector of MSYS has the length {math.hypot(*vector):.6g}, not 1",
                    "write origin, X and Y of the coordinate system",
                )
        x = _unit(x)
        along = _dot(x, y)
        if abs(along) > _FRAME_TOLERANCE:
            raise StatementError("X and Y of MSYS are not square to each other", "write origin, X and Y of the frame")
        y = _unit([b - along * a for a, b in zip(x, y, strict=True)])
        self._builder.frame = Frame((ox, oy, oz), (x[0], x[1], x[2]), (y[0], y[1], y[2]))

    def _partno(self, statement: Statement) -> None:
        self.part = self.part or statement.text

    def _units_statement(self, statement: Statement) -> None:
        word = statement.values[0] if statement.values else ""
        if not isinstance(word, str) or word not in _LENGTHS:
            raise StatementError(f"UNITS/{word} is not a unit that is read", "write UNITS/MM or UNITS/INCHES")
        if self._units is not None and self._units[0] != _LENGTHS[word]:
            raise StatementError(
                f"UNITS/{word} after another unit in line {self._units[1]}", "keep to one unit in a file"
            )
        self._units = self._units or (_LENGTHS[word], self._line)

    def _intol(self, statement: Statement) -> None:
        self._builder.intol = statement.numbers(1)[0]

    def _outtol(self, statement: Statement) -> None:
        self._builder.outtol = statement.numbers(1)[0]

    # -- motion -------------------------------------------------------------------------------------------------

    def _rapid(self, statement: Statement) -> None:
        if statement.values:
            self._keep_unknown(statement, f"RAPID/{statement.words()} is not known")
        self._builder.rapids.append(self._operation_row)

    def _goto(self, statement: Statement) -> None:
        self._write_row(statement.numbers(3, 6))

    def _godlta(self, statement: Statement) -> None:
        x, y, z = statement.numbers(3)
        start = self._current_tip()
        if start is None:
            raise StatementError("GODLTA without a point to go from", "write FROM/ or GOTO/ before it")
        self._no_circle("GODLTA")
        self._write_row((start[0] + x, start[1] + y, start[2] + z))

    def _gohome(self, statement: Statement) -> None:
        self._no_circle("GOHOME")
        if not statement.values:
            self._add(GoHome(self._operation_row, self._line))
            return
        if not self._has_row:
            self._keep_unknown(statement, "GOHOME with words is not known")
            return
        self._builder.rapids.append(self._operation_row)
        self._write_row(statement.numbers(3, 6))

    def _write_row(self, values: tuple[float, ...]) -> None:
        """Write a row; the scan has kept it free and marked its axis as not given."""
        if not self._has_row:
            raise StatementError("a motion without coordinates", "write GOTO/x,y,z or GOTO/x,y,z,i,j,k")
        self._columns.tip[self._row] = values[:3]
        if len(values) == 6:
            self._columns.axis[self._row] = values[3:]

    def _current_tip(self) -> tuple[float, float, float] | None:
        """Where the tool stands now."""
        starts = self._builder.starts
        if starts and starts[-1].row == self._operation_row:
            return starts[-1].tip
        if self._operation_row == 0:
            return None
        x, y, z = self._columns.tip[self._row - 1].tolist()
        return x, y, z

    def _from(self, statement: Statement) -> None:
        x, y, z, *axis = statement.numbers(3, 6)
        vector = (axis[0], axis[1], axis[2]) if axis else None
        self._builder.starts.append(FromStatement(self._operation_row, self._line, (x, y, z), vector))

    def _circle(self, statement: Statement) -> None:
        if not self._in_operation:
            raise StatementError("CIRCLE outside any operation", "write TOOL PATH/name,TOOL,tool before it")
        self._no_circle("another CIRCLE")
        values = statement.values
        turns = 1.0
        if "TIMES" in values:
            index = values.index("TIMES")
            (turns,) = numbers("CIRCLE TIMES", values[index + 1 :], 1)
            values = values[:index]
        given = numbers("CIRCLE", values, 7, 8, 11, 12)
        if len(given) in (8, 12):
            turns = given[-1]
        if not is_whole(turns, 1) or turns > 10000:
            raise StatementError(f"CIRCLE has {turns:g} turns", "write TIMES,n with n = 1, 2, 3 ...")
        self._builder.circles.append(CircleStatement(self._operation_row, self._line, given[:7], int(turns)))

    def _no_circle(self, what: str) -> None:
        """Refuse ``what`` where the end point of an arc must stand."""
        circles = self._builder.circles
        if circles and circles[-1].row == self._operation_row:
            circle = circles.pop()
            raise StatementError(
                f"{what} where the GOTO of the CIRCLE in line {circle.line} must stand",
                "write GOTO/ with the end point of the arc after each CIRCLE",
            )

    def _unsupported_motion(self, statement: Statement) -> None:
        if statement.major in ("KNOT", "CNTRL") and self._spline_reported:
            return  # part of a NURBS that was refused already
        self._spline_reported = True
        raise StatementError(
            f"{statement.major} is motion that cannot be read",
            "turn off spline output in the CAM system, and write lines and circles in the machining coordinates",
        )

    # -- how the path is drawn -----------------------------------------------------------------------------------

    def _paint(self, statement: Statement) -> None:
        if statement.values[:1] != ("COLOR",):
            return  # how the path is drawn on the screen
        self._builder.colours.append((self._operation_row, whole_number("PAINT/COLOR", statement.values[1:])))

    def _ignored(self, statement: Statement) -> None:
        """Ends of the file, which the file itself shows, and names of machines."""


def _dot(a: list[float], b: list[float]) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _unit(vector: list[float]) -> list[float]:
    length = math.hypot(*vector)
    return [number / length for number in vector]


_MILL = ("diameter", "corner_radius", "length", "taper_angle", "tip_angle")
_DRILL = ("diameter", "corner_radius", "length", "tip_angle", "flute_length")
_TCUTTER = ("diameter", "corner_radius", "upper_radius", "length", "flute_length")

#: Forms of TLDATA: for each possible count of numbers, the fields of ``Tool`` that they are; empty where it has none.
_TLDATA_FIELDS: dict[str, dict[int, tuple[str, ...]]] = {
    "MILL": {5: _MILL, 7: (*_MILL, "", ""), 10: (*_MILL, "", "", "upper_radius", "", "")},
    "DRILL": {5: _DRILL},
    "TCUTTER": {5: _TCUTTER},
    "BARREL": {5: _MILL, 7: (*_MILL, "", ""), 10: (*_MILL, "", "", "upper_radius", "", "")},
}

Handler = Callable[[ClsfInterpreter, Statement], None]

#: Every statement that is known.
HANDLERS: dict[str, Handler] = {
    "TOOLPATH": ClsfInterpreter._tool_path,
    "END-OF-PATH": ClsfInterpreter._end_of_path,
    "TLDATA": ClsfInterpreter._tldata,
    "MSYS": ClsfInterpreter._msys,
    "PARTNO": ClsfInterpreter._partno,
    "UNITS": ClsfInterpreter._units_statement,
    "INTOL": ClsfInterpreter._intol,
    "OUTTOL": ClsfInterpreter._outtol,
    "RAPID": ClsfInterpreter._rapid,
    "GOTO": ClsfInterpreter._goto,
    "GODLTA": ClsfInterpreter._godlta,
    "GOHOME": ClsfInterpreter._gohome,
    "FROM": ClsfInterpreter._from,
    "CIRCLE": ClsfInterpreter._circle,
    "NURBS": ClsfInterpreter._unsupported_motion,
    "KNOT": ClsfInterpreter._unsupported_motion,
    "CNTRL": ClsfInterpreter._unsupported_motion,
    "TLON": ClsfInterpreter._unsupported_motion,
    "INDIRV": ClsfInterpreter._unsupported_motion,
    "COPY": ClsfInterpreter._unsupported_motion,
    "TRACUT": ClsfInterpreter._unsupported_motion,
    "TRANS": ClsfInterpreter._unsupported_motion,
    "FEDRAT": ClsfInterpreter._fedrat,
    "SPINDL": ClsfInterpreter._spindl,
    "LOAD": ClsfInterpreter._load,
    "SELECT": ClsfInterpreter._load,
    "COOLNT": ClsfInterpreter._coolnt,
    "CUTCOM": ClsfInterpreter._cutcom,
    "CYCLE": ClsfInterpreter._cycle_statement,
    "DELAY": ClsfInterpreter._delay,
    "STOP": ClsfInterpreter._stop,
    "OPSTOP": ClsfInterpreter._stop,
    "PPRINT": ClsfInterpreter._message,
    "TPRINT": ClsfInterpreter._message,
    "DISPLY": ClsfInterpreter._message,
    "DISPLAY": ClsfInterpreter._message,
    "INSERT": ClsfInterpreter._insert,
    "OPSKIP": ClsfInterpreter._opskip,
    "SET": ClsfInterpreter._mode,
    "MODE": ClsfInterpreter._mode,
    "MULTAX": ClsfInterpreter._mode,
    "PAINT": ClsfInterpreter._paint,
    "MACHIN": ClsfInterpreter._ignored,
    "END": ClsfInterpreter._ignored,
    "FINI": ClsfInterpreter._ignored,
}
