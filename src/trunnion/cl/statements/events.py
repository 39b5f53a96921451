"""Statements that become feeds and events: spindle, tool, coolant, stops, texts.

Words are recognized by their meaning, not by their place: some systems write ``SPINDL/RPM,n``, others ``SPINDL/n,RPM``.
"""

from dataclasses import replace
from typing import TypeGuard

from trunnion.cl.builder import FeedChange, SurfaceSpeed
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import FEED_UNITS, FILE_UNIT_FEEDS, MM_PER_FOOT, ReaderState
from trunnion.cl.statement import Statement, numbers, whole_number
from trunnion.cl.statements.cutcom_points import CutcomPoints
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    Dwell,
    Event,
    Insert,
    Message,
    SelectTool,
    Sense,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
)

#: Words of surface speeds: mm/min in one unit.
_SURFACE_SPEEDS = {"SFM": MM_PER_FOOT, "SMM": 1000.0}
#: The word of a feed that is one over the minutes of a move.
_INVERSE = "INVERS"
_FEED_WORDS = frozenset({_INVERSE, *FILE_UNIT_FEEDS, *FEED_UNITS})

_GEAR_RANGES = frozenset({"LOW", "MEDIUM", "HIGH", "RANGE"})
_SPINDLE_WORDS = frozenset({"RPM", "SFM", "SMM", "CLW", "CCLW", "ON", "DIAMTR"}) | _GEAR_RANGES
_COOLANTS = frozenset({"ON", "OFF", "FLOOD", "MIST", "TAP", "THRU", "AIR"})
_SIDES = frozenset({"LEFT", "RIGHT", "ON", "OFF"})
_REGISTER = "ADJUST"

#: The points behind this CUTCOM are those where the tool touches the contour.
_CONTACT = "CONTACT"
_PLANES = frozenset({"XYPLAN", "ZXPLAN", "YZPLAN"})

#: Statements about the form of a program that every program fulfils.
_FULFILLED_MODES = frozenset(
    {("SET", "MODE", "ABSOL"), ("MODE", "MILL"), ("MODE", "INCR", "OFF"), ("MULTAX",), ("MULTAX", "ON")}
)


def fedrat(state: ReaderState, statement: Statement) -> None:
    """Set the modal feed and its unit."""
    statement.refuse_contradictions(_FEED_WORDS)
    unit = None
    for word in statement.words():
        if word == _INVERSE:
            state.feed_factor, state.feed_per_rev, state.feed_inverse, state.bare_feeds = 1.0, False, True, False
            continue
        if word in FILE_UNIT_FEEDS:
            state.feed_factor, state.feed_per_rev = 1.0, FILE_UNIT_FEEDS[word]
            state.feed_inverse, state.bare_feeds = False, True
            continue
        if not word:
            raise StatementError(Wording("CL310", "nothing_behind_comma", major=statement.major))
        if word not in FEED_UNITS:
            raise StatementError(Wording("CL710", "fedrat_not_known", listed=statement.listed()))
        state.feed_factor, state.feed_per_rev = FEED_UNITS[word]
        state.feed_inverse = state.bare_feeds = False
        unit = word
    (value,) = numbers("FEDRAT", statement.plain_numbers(), 1)
    if value < 0:
        raise StatementError(Wording("CL710", "fedrat_negative", value=value))
    if value == 0:
        state.diagnostics.remark(state.line, Wording("CL715", "fedrat_0"))
    if unit is not None:
        state.note_feed_unit(unit, value)
    value *= state.feed_factor
    feed = FeedChange(state.operation_row, value, state.feed_per_rev, state.bare_feeds, state.feed_inverse)
    state.builder.feeds.append(feed)


def spindl(state: ReaderState, statement: Statement) -> None:
    """Turn the spindle on or off."""
    statement.refuse_contradictions(("OFF", "ON"), ("OFF", "CLW", "CCLW"), ("OFF", "RPM", *_SURFACE_SPEEDS))
    words = set(statement.words())
    if not statement.values:
        raise StatementError(Wording("CL730", "spindl_without_speed"))
    if "OFF" in words:
        if statement.values != ("OFF",):
            rest = [word for word in statement.words() if word != "OFF"]
            state.note_unknown(statement, phrase("not_known", statement=f"SPINDL/{statement.listed()}"), *rest)
        state.add(SpindleOff(state.operation_row, state.line))
        return
    if unknown := sorted(words - _SPINDLE_WORDS):
        state.note_unknown(statement, phrase("not_known_with", statement="SPINDL", words=",".join(unknown)), *unknown)
    if ranges := sorted(words & _GEAR_RANGES):
        state.note_unknown(statement, phrase("no_words_for_range", words=",".join(ranges)), *ranges)
    speed, diameter = _speed_and_diameter(statement)
    if unknown and speed is None and not words & _SPINDLE_WORDS:
        return
    sense = _sense(state, words)
    surface = words & _SURFACE_SPEEDS.keys()
    row, line = state.operation_row, state.line
    if speed is None:
        if state.spindle is None:
            raise StatementError(Wording("CL730", "spindl_turns_spindle"))
        state.spindle = replace(state.spindle, row=row, line=line, sense=sense)
    elif speed < 0:
        raise StatementError(Wording("CL730", "spindl_negative_speed", speed=speed))
    elif speed == 0:
        raise StatementError(Wording("CL730", "spindl_speed_0"))
    elif surface:
        state.spindle = SurfaceSpeed(row, line, speed * _SURFACE_SPEEDS[surface.pop()], sense, diameter)
    else:
        state.spindle = SpindleOn(row, line, speed, sense)
    state.add(state.spindle)


def _speed_and_diameter(statement: Statement) -> tuple[float | None, float | None]:
    """Speed, and the number behind DIAMTR; None where there is none.

    A number behind RANGE is neither, nor is one behind a word that is not known: it goes with that word.
    """
    speed: float | None = None
    diameter: float | None = None
    last: str | float = ""
    for value in statement.values:
        if not isinstance(value, str):
            (value,) = numbers("SPINDL", (value,))
            if last == "DIAMTR":
                diameter = value
            elif last == "RANGE" or (isinstance(last, str) and last and last not in _SPINDLE_WORDS):
                continue
            elif speed is not None:
                raise StatementError(Wording("CL320", "spindl_two_speeds", speed=speed, value=value))
            else:
                speed = value
        last = value
    return speed, diameter


def _sense(state: ReaderState, words: set[str]) -> Sense:
    """Return the sense named, else the last one."""
    for sense in Sense:
        if sense.value in words:
            return sense
    if state.spindle is None and state.turned_left:
        raise StatementError(Wording("CL730", "spindl_without_sense", operation=state.turned_left))
    return state.spindle.sense if state.spindle else Sense.CLW


def load(state: ReaderState, statement: Statement) -> None:
    """Load or select a tool."""
    values = statement.values
    if values[:1] != ("TOOL",):
        state.note_unknown(statement, phrase("not_known_without_tool", statement=statement.major), *statement.words())
        return
    number = whole_number(statement.major, values[1:2])
    adjust = 0
    if "ADJUST" in values and statement.major != "SELECT":
        index = values.index("ADJUST")
        adjust = whole_number("LOAD ADJUST", values[index + 1 : index + 2])
        values = values[:index] + values[index + 2 :]
    if rest := [value if isinstance(value, str) else f"{value:g}" for value in values[2:]]:
        words = [value for value in values[2:] if isinstance(value, str)]
        state.note_unknown(
            statement, phrase("not_known_with", statement=f"{statement.major}/TOOL", words=",".join(rest)), *words
        )
    if statement.major == "SELECT":
        state.add(SelectTool(state.operation_row, state.line, number))
    else:
        state.load_tool(number, adjust)


def loadtl(state: ReaderState, statement: Statement) -> None:
    """Load a tool by the older word: LOADTL/n is LOAD/TOOL,n."""
    load(state, statement._replace(major="LOAD", values=("TOOL", *statement.values)))


def coolnt(state: ReaderState, statement: Statement) -> None:
    """Switch the coolant; COOLNT alone is ON."""
    if not statement.values and "/" in statement.source:
        raise StatementError(Wording("CL330", "coolnt_without_word"))
    kind, *rest = statement.values or ("ON",)
    known = isinstance(kind, str) and kind in _COOLANTS
    if rest or not known:
        words = [word for word in (rest if known else statement.values) if isinstance(word, str)]
        state.note_unknown(statement, phrase("no_known_coolant", statement=f"COOLNT/{statement.listed()}"), *words)
    if known:
        state.add(Coolant(state.operation_row, state.line, str(kind)))


def cutcom(state: ReaderState, statement: Statement) -> None:
    """Switch cutter radius compensation."""
    words = statement.words()
    side = [word for word in words if word in _SIDES]
    plane = [word for word in words if word in _PLANES]
    register = statement.plain_numbers()
    if side and _names_register(statement.values):
        words.remove(_REGISTER)
    if contact := side in (["LEFT"], ["RIGHT"]) and _CONTACT in words:
        words.remove(_CONTACT)
    if len(side) != 1 or len(plane) > 1 or len(words) != len(side) + len(plane) or len(register) > 1:
        state.note_unknown(statement, phrase("not_known", statement=f"CUTCOM/{statement.listed()}"), *words)
        return
    number = whole_number("CUTCOM", register) if register else 0
    if side == ["ON"]:  # as it was last
        contour = next((event.contour for event in reversed(state.builder.events) if _has_side(event)), False)
    else:
        points = state.own(CutcomPoints)
        contour = side != ["OFF"] and points.are_of_contour(state, statement, contact=contact)
    state.add(CutterComp(state.operation_row, state.line, side[0], plane[0] if plane else "", number, contour))


def _has_side(event: Event) -> TypeGuard[CutterComp]:
    return isinstance(event, CutterComp) and event.side in ("LEFT", "RIGHT")


def _names_register(values: tuple[str | float, ...]) -> bool:
    """Whether ADJUST,n stands among the values; ADJUST of other forms shifts work offsets."""
    at = values.index(_REGISTER) if values.count(_REGISTER) == 1 else len(values)
    return at + 1 < len(values) and not isinstance(values[at + 1], str)


def delay(state: ReaderState, statement: Statement) -> None:
    """Dwell for a time or a number of revolutions."""
    words = statement.words()
    if words not in ([], ["REV"]):
        state.note_unknown(statement, phrase("not_known", statement=f"DELAY/{statement.listed()}"), *words)
        return
    (amount,) = numbers("DELAY", statement.plain_numbers(), 1)
    if amount < 0:
        raise StatementError(Wording("CL340", "delay_negative"))
    state.add(Dwell(state.operation_row, state.line, amount, bool(words)))


def stop(state: ReaderState, statement: Statement) -> None:
    """Stop the program, or stop it if the operator wants it (OPSTOP)."""
    state.add(Stop(state.operation_row, state.line, statement.major == "OPSTOP", statement.text))


def message(state: ReaderState, statement: Statement) -> None:
    """Write a text into the program, or show it to the operator (DISPLY)."""
    state.add(Message(state.operation_row, state.line, statement.text, statement.major in ("DISPLY", "DISPLAY")))


def quoted_message(state: ReaderState, statement: Statement) -> None:
    """Write a text into the program, without the quotation marks in which some systems put it."""
    text = statement.text
    if len(text) > 1 and text[0] == text[-1] == "'":
        text = text[1:-1]
    message(state, statement._replace(text=text))


def insert(state: ReaderState, statement: Statement) -> None:
    """Put a text into the program as it stands."""
    state.add(Insert(state.operation_row, state.line, statement.text))


def opskip(state: ReaderState, statement: Statement) -> None:
    """Switch block skip."""
    if statement.values not in (("ON",), ("OFF",)):
        state.note_unknown(statement, phrase("not_known", statement=f"OPSKIP/{statement.listed()}"), *statement.words())
        return
    state.add(BlockSkip(state.operation_row, state.line, statement.values == ("ON",)))


def set_mode(state: ReaderState, statement: Statement) -> None:
    """Keep SET, MODE or MULTAX where it states what every program does anyway."""
    words = (statement.major, *statement.words())
    if "INCR" in words and "OFF" not in words:
        raise StatementError(Wording("CL480", "points_follow_would", source=statement.source.strip()))
    if words == ("MODE", "TURN"):
        raise StatementError(Wording("CL260", "mode_turn_turning"))
    if words in _FULFILLED_MODES and not statement.plain_numbers():
        state.add(SetMode(state.operation_row, state.line, words))
    else:
        state.note_unknown(statement, phrase("not_followed", statement=statement.source.strip()), *words[1:])
