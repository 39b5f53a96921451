"""Statements that are feeds or events: spindle, tool, coolant, cycles, and what is said to control and operator.

In:     statements, and where in the operation they stand.
Out:    feeds and events in the draft of the operation, in the units of the file.

Words are told apart by what they are, never by their place: systems differ in ``SPINDL/RPM,n`` and ``SPINDL/n,RPM``.
"""

from dataclasses import replace

from trunnion.cl.assemble import CYCLE_LENGTHS
from trunnion.cl.builder import FeedChange, OperationBuilder, SurfaceSpeed
from trunnion.cl.diagnostics import Diagnostics, StatementError
from trunnion.cl.statement import Statement, is_whole, numbers
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Insert,
    LoadTool,
    Message,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    UnknownStatement,
)

MM_PER_INCH = 25.4
_MM_PER_FOOT = 304.8

#: Feed words: mm in the length unit they name, and whether the feed is per revolution.
_FEEDS = {"MMPM": (1.0, False), "MMPR": (1.0, True), "IPM": (MM_PER_INCH, False), "IPR": (MM_PER_INCH, True)}
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


class EventStatements:
    """What each of these statements means; a method a statement.

    What stands between two operations is kept in a draft without a name until one takes it over.
    """

    def __init__(self, diagnostics: Diagnostics, strict: bool) -> None:
        self._diagnostics = diagnostics
        self._strict = strict
        self._builder = OperationBuilder("", 0, 0)
        self._row = 0
        self._line = 0
        self._feed_per_rev = False
        self._feed_in_file_units = True
        self._feed_factor = 1.0
        self._spindle: SpindleOn | SurfaceSpeed | None = None
        self._cycle: CycleOn | None = None
        self._metric = 0
        self._inch = 0

    def _add(self, event: Event) -> None:
        self._builder.events.append(event)

    @property
    def _operation_row(self) -> int:
        """Row within the operation."""
        return self._row - self._builder.first

    def _keep_unknown(self, statement: Statement, what: str) -> None:
        """Keep a statement as it stands, once however much of it is not known."""
        last = self._builder.events[-1] if self._builder.events else None
        if not isinstance(last, UnknownStatement) or last.line != self._line:
            self._add(UnknownStatement(self._operation_row, self._line, statement.source))
        if self._strict:
            self._diagnostics.error(self._line, what, "take the statement out, or read without strict")
        else:
            self._diagnostics.remark(self._line, f"{what}; kept as it stands", "look whether the program needs it")

    # -- feed, spindle, tool ------------------------------------------------------------------------------------

    def _fedrat(self, statement: Statement) -> None:
        for word in statement.words():
            if word not in _FEEDS:
                raise StatementError(
                    f"FEDRAT/{word} is not a feed that is read", "write the feed in MMPM, MMPR, IPM or IPR"
                )
            self._feed_factor, self._feed_per_rev = _FEEDS[word]
            self._feed_in_file_units = False
            self._note_feed_unit(word)
        (value,) = numbers("FEDRAT", tuple(value for value in statement.values if not isinstance(value, str)), 1)
        if value < 0:
            raise StatementError(f"FEDRAT is negative: {value:g}", "write a feed above 0")
        if value == 0:
            self._diagnostics.remark(self._line, "FEDRAT is 0", "write a feed above 0, or RAPID")
        self._builder.feeds.append(
            FeedChange(self._operation_row, value * self._feed_factor, self._feed_per_rev, self._feed_in_file_units)
        )

    def _note_feed_unit(self, word: str) -> None:
        if _FEEDS[word][0] == 1.0:
            self._metric = self._metric or self._line
        else:
            self._inch = self._inch or self._line

    def _spindl(self, statement: Statement) -> None:
        words = set(statement.words())
        if "OFF" in words:
            self._add(SpindleOff(self._operation_row, self._line))
            return
        if words - {"RPM", "SFM", "SMM", "CLW", "CCLW", "ON", "LOW", "MEDIUM", "HIGH", "RANGE", "DIAMTR"}:
            self._keep_unknown(statement, f"SPINDL/{','.join(statement.words())} is not known")
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
        if "RANGE" in words or words & {"LOW", "MEDIUM", "HIGH"}:
            self._diagnostics.remark(
                self._line, "the gear range of SPINDL is not written", "INSERT/ says it, if it must be"
            )
        sense = self._sense(words)
        surface = words & _SURFACE.keys()
        if speed is None:
            if self._spindle is None:
                raise StatementError("SPINDL turns the spindle on before any speed was given", "write SPINDL/RPM,n,CLW")
            self._spindle = replace(self._spindle, row=self._operation_row, line=self._line, sense=sense)
        elif speed < 0:
            raise StatementError(f"SPINDL has a negative speed: {speed:g}", "write CLW or CCLW for the sense")
        elif surface:
            self._spindle = SurfaceSpeed(
                self._operation_row, self._line, speed * _SURFACE[surface.pop()], sense, diameter
            )
        else:
            self._spindle = SpindleOn(self._operation_row, self._line, speed, sense)
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
            self._keep_unknown(statement, f"{statement.major} without TOOL is not known")
            return
        number = whole_number(statement.major, values[1:2])
        if statement.major == "SELECT":
            self._add(SelectTool(self._operation_row, self._line, number))
            return
        adjust = 0
        if "ADJUST" in values:
            index = values.index("ADJUST")
            adjust = whole_number("LOAD ADJUST", values[index + 1 : index + 2])
            values = values[:index] + values[index + 2 :]
        if len(values) > 2:
            self._keep_unknown(
                statement, f"LOAD/TOOL with {','.join(map(str, values[2:]))} is not known beyond its number"
            )
        self._add(LoadTool(self._operation_row, self._line, number, adjust))

    def _coolnt(self, statement: Statement) -> None:
        values = statement.values or ("ON",)
        if len(values) != 1 or not isinstance(values[0], str) or values[0] not in _COOLANTS:
            self._keep_unknown(statement, f"{statement.source.strip()} is not a coolant that is known")
            return
        self._add(Coolant(self._operation_row, self._line, values[0]))

    def _cutcom(self, statement: Statement) -> None:
        words = statement.words()
        side = [word for word in words if word in _SIDES]
        plane = [word for word in words if word in _PLANES]
        register = tuple(value for value in statement.values if not isinstance(value, str))
        if len(side) != 1 or len(plane) > 1 or len(words) != len(side) + len(plane) or len(register) > 1:
            self._keep_unknown(statement, f"{statement.source.strip()} is not known")
            return
        number = whole_number("CUTCOM", register) if register else 0
        self._add(CutterComp(self._operation_row, self._line, side[0], plane[0] if plane else "", number))

    # -- cycles -------------------------------------------------------------------------------------------------

    def _cycle_statement(self, statement: Statement) -> None:
        values = statement.values
        if values == ("OFF",):
            self._add(CycleOff(self._operation_row, self._line))
            return
        if values == ("ON",):
            if self._cycle is None:
                raise StatementError("CYCLE/ON before any cycle", "write the cycle with its values")
            self._cycle = replace(self._cycle, row=self._operation_row, line=self._line)
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
            raise StatementError("CYCLE without a word for its kind", "write CYCLE/DRILL, CYCLE/TAP, ..., or CYCLE/OFF")
        at = 0
        while at < len(values):
            word = values[at]
            if not isinstance(word, str):
                raise StatementError(
                    f"CYCLE has the number {word:g} without a word before it", "name each number of the cycle"
                )
            stop = at + 1
            while stop < len(values) and not isinstance(values[stop], str):
                stop += 1
            given = numbers("CYCLE", values[at + 1 : stop])
            after = values[stop] if stop < len(values) else ""
            if word in _FEEDS:
                factor, per_rev = _FEEDS[word]
                self._note_feed_unit(word)
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
                raise StatementError(f"CYCLE has {word} without a number", f"write {word},value")
            elif given:
                self._keep_unknown(statement, f"CYCLE with {word} is not known")
                couplets.append((word, given))
            else:
                if word not in _CYCLE_WORDS:
                    self._keep_unknown(statement, f"CYCLE with {word or 'nothing between two commas'} is not known")
                words.append((word, ""))
            at = stop
        return CycleOn(self._operation_row, self._line, tuple(mode), tuple(couplets), tuple(words))

    # -- other events -------------------------------------------------------------------------------------------

    def _delay(self, statement: Statement) -> None:
        words = statement.words()
        if words not in ([], ["REV"]):
            self._keep_unknown(statement, f"DELAY/{','.join(words)} is not known")
            return
        (amount,) = numbers("DELAY", tuple(value for value in statement.values if not isinstance(value, str)), 1)
        if amount < 0:
            raise StatementError("DELAY is negative", "write the time in seconds, or the revolutions and REV")
        self._add(Dwell(self._operation_row, self._line, amount, bool(words)))

    def _stop(self, statement: Statement) -> None:
        self._add(Stop(self._operation_row, self._line, statement.major == "OPSTOP", statement.text))

    def _message(self, statement: Statement) -> None:
        self._add(Message(self._operation_row, self._line, statement.text, statement.major in ("DISPLY", "DISPLAY")))

    def _insert(self, statement: Statement) -> None:
        self._add(Insert(self._operation_row, self._line, statement.text))

    def _opskip(self, statement: Statement) -> None:
        if statement.values not in (("ON",), ("OFF",)):
            self._keep_unknown(statement, f"{statement.source.strip()} is not known")
            return
        self._add(BlockSkip(self._operation_row, self._line, statement.values == ("ON",)))

    def _mode(self, statement: Statement) -> None:
        values = [value if isinstance(value, str) else f"{value:g}" for value in statement.values]
        self._add(SetMode(self._operation_row, self._line, (statement.major, *values)))


def whole_number(major: str, values: tuple[str | float, ...]) -> int:
    (number,) = numbers(major, values, 1)
    if not is_whole(number, 0):
        raise StatementError(f"{major} has {number:g} where a whole number belongs", "write 0, 1, 2 ...")
    return int(number)
