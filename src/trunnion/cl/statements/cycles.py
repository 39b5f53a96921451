"""CYCLE: mode words, then couplets of a word and its numbers, in any order."""

from dataclasses import dataclass, field, replace

from trunnion.cl.assemble import CYCLE_LENGTHS
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import FEED_UNITS, ReaderState
from trunnion.cl.statement import Statement, numbers
from trunnion.model.toolpath import CycleOff, CycleOn

_MODES = frozenset(
    {"DRILL", "DEEP", "BRKCHP", "CSINK", "TAP", "BORE", "DRAG", "NODRAG", "MANUAL", "FACE", "REAM", "THRU", "BACK"}
)
#: Words that need a number.
_NUMBER_WORDS = CYCLE_LENGTHS | {"DWELL", "TLANGL", "NODRAG"}
#: Words that may stand without a number.
_BARE_WORDS = frozenset({"AUTO", "MANUAL", "REV", "OPTION"})


def cycle(state: ReaderState, statement: Statement) -> None:
    """Switch a cycle off, repeat the last one, or begin another."""
    row, line = state.operation_row, state.line
    if statement.values == ("OFF",):
        state.add(CycleOff(row, line))
        return
    if statement.values == ("ON",):
        if state.cycle is None:
            raise StatementError("CYCLE/ON before any cycle", "write the cycle with its values")
        state.cycle = replace(state.cycle, row=row, line=line)
    else:
        found = _parse(state, statement)
        state.cycle = CycleOn(row, line, tuple(found.mode), tuple(found.couplets), tuple(found.words))
    state.add(state.cycle)


@dataclass(slots=True)
class _Parts:
    """The fields of a ``CycleOn`` while they are collected."""

    mode: list[str] = field(default_factory=list)
    couplets: list[tuple[str, tuple[float, ...]]] = field(default_factory=list)
    words: list[tuple[str, str]] = field(default_factory=list)


def _parse(state: ReaderState, statement: Statement) -> _Parts:
    values = statement.values
    if not values or not isinstance(values[0], str):
        what = "CYCLE without a word for its kind"
        raise StatementError(what, "write CYCLE/DRILL, CYCLE/TAP, ..., or CYCLE/OFF")
    found = _Parts()
    at = 0
    while at < len(values):
        word = values[at]
        if not isinstance(word, str):
            what = f"CYCLE has the number {word:g} without a word before it"
            raise StatementError(what, "name each number of the cycle")
        stop = at + 1
        while stop < len(values) and not isinstance(values[stop], str):
            stop += 1
        given = numbers("CYCLE", values[at + 1 : stop])
        if word in FEED_UNITS:
            _feed(state, found, word, given)
        elif word in _MODES and not found.couplets and not found.words:
            found.mode.append(word)
            if given:
                found.couplets.append((word, given))
        elif not given and (used := _word_pair(found, word, values[stop : stop + 2])):
            stop += used
        else:
            _couplet(state, statement, found, word, given)
        at = stop
    return found


def _feed(state: ReaderState, found: _Parts, word: str, given: tuple[float, ...]) -> None:
    factor, per_rev = FEED_UNITS[word]
    state.note_feed_unit(word)
    (feed,) = numbers(f"CYCLE {word}", given, 1)
    found.couplets.append(("MMPR" if per_rev else "MMPM", (feed * factor,)))


def _word_pair(found: _Parts, word: str, following: tuple[str | float, ...]) -> int:
    """Take RTRCTO,AUTO, RTRCTO,MANUAL or DWELL,REV,n; return how many of the following values belong to it."""
    after = following[0] if following else ""
    if word == "RTRCTO" and after in ("AUTO", "MANUAL"):
        found.words.append((word, str(after)))
        return 1
    if word == "DWELL" and after == "REV":
        found.words.append((word, "REV"))
        given = tuple(value for value in following[1:] if not isinstance(value, str))
        found.couplets.append((word, numbers("CYCLE DWELL,REV", given, 1)))
        return 2
    return 0


def _couplet(state: ReaderState, statement: Statement, found: _Parts, word: str, given: tuple[float, ...]) -> None:
    """Take a word with the numbers behind it, or without any."""
    if given:
        if word not in _NUMBER_WORDS:
            state.note_unknown(statement, f"CYCLE with {word} is not known", word)
        found.couplets.append((word, given))
        return
    if word in _NUMBER_WORDS:
        raise StatementError(f"CYCLE has {word} without a number", f"write {word},value")
    if word not in _BARE_WORDS:
        state.note_unknown(statement, f"CYCLE with {word or 'nothing between two commas'} is not known", word)
    found.words.append((word, ""))
