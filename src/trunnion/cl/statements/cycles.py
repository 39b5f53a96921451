"""CYCLE: mode words, then couplets of a word and its numbers, in any order."""

from dataclasses import replace

from trunnion.cl.assemble import CYCLE_LENGTHS
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.dialect import CycleParts
from trunnion.cl.state import FEED_UNITS, ReaderState
from trunnion.cl.statement import Statement, numbers
from trunnion.cl.statements.motion import refuse_in_circle
from trunnion.model.toolpath import CycleOff, CycleOn

#: Words that need a number.
_NUMBER_WORDS = CYCLE_LENGTHS | {"DWELL", "TLANGL", "NODRAG"}
#: Words that may stand without a number.
_BARE_WORDS = frozenset({"AUTO", "MANUAL", "REV", "OPTION"})
#: Modes of holes that are made in pecks.
_PECKING = frozenset({"DEEP", "BRKCHP"})
#: Controls and their cycles are for fewer pecks than this.
_MOST_PECKS = 1000
#: Stands for the unit of a feed until that follows.
_BARE_FEED = "FEED"


def cycle(state: ReaderState, statement: Statement) -> None:
    """Switch a cycle off, repeat the last one, or begin another."""
    row, line = state.operation_row, state.line
    if statement.values == ("OFF",):
        if not state.cycle_line and state.operation_row:
            what = "CYCLE/OFF where no cycle is on: the points before it are no holes"
            state.diagnostics.remark(line, what, "look for a CYCLE that is missing")
        state.add(CycleOff(row, line))
        state.cycle_line = 0
        return
    refuse_in_circle(state, "CYCLE")
    if statement.values == ("ON",):
        if state.cycle is None:
            raise StatementError("CYCLE/ON before any cycle", "write the cycle with its values")
        state.cycle = replace(state.cycle, row=row, line=line)
    else:
        found = _parse(state, statement)
        state.cycle = CycleOn(row, line, tuple(found.mode), tuple(found.couplets), tuple(found.words))
    state.add(state.cycle)
    state.cycle_line = line


def _parse(state: ReaderState, statement: Statement) -> CycleParts:
    values = statement.values
    if not values or not isinstance(values[0], str):
        what = "CYCLE without a word for its kind"
        raise StatementError(what, "write CYCLE/DRILL, CYCLE/TAP, ..., or CYCLE/OFF")
    dialect = state.dialect.cycles
    found = CycleParts()
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
        if why := dialect.refused.get(word):
            raise StatementError(f"CYCLE with {word} cannot be read: {why}", "output the holes as motion")
        if word in FEED_UNITS and given and len(given) > 1:
            raise StatementError(f"CYCLE has {len(given)} numbers behind {word}", "name each number of the cycle")
        if word in FEED_UNITS and not given and found.couplets and found.couplets[-1][0] == _BARE_FEED:
            _feed(state, found, word, found.couplets.pop()[1])
        elif word in FEED_UNITS:
            _feed(state, found, word, given)
        elif word in dialect.modes and not found.couplets and not found.words:
            found.mode += dialect.modes[word]
            _positions(state, found, word, given)
        elif not given and (used := _word_pair(found, word, values[stop : stop + 2])):
            stop += used
        else:
            _couplet(state, statement, found, dialect.words.get(word, word), given)
        at = stop
    if any(word == _BARE_FEED for word, _ in found.couplets):
        raise StatementError("CYCLE has a number too many, or a feed without a unit", "name each number of the cycle")
    if dialect.settle is not None:
        dialect.settle(found)
    _refuse_repetitions(found)
    _refuse_impossible(found)
    return found


def _refuse_repetitions(found: CycleParts) -> None:
    """Refuse a number that is given twice: nobody knows which of them is meant."""
    names = ["a feed" if word in ("MMPM", "MMPR") else word for word, _ in found.couplets]
    if twice := next((name for n, name in enumerate(names) if name in names[:n]), ""):
        raise StatementError(f"CYCLE has {twice} twice", "write the one that is meant")
    couplets, words = dict(found.couplets), dict(found.words)
    if "RTRCTO" in couplets and "RTRCTO" in words:
        raise StatementError(f"CYCLE has RTRCTO with a height and {words['RTRCTO']}", "write the one that is meant")
    if couplets.get("CLEAR", couplets.get("RAPTO")) != couplets.get("RAPTO", couplets.get("CLEAR")):
        raise StatementError("CYCLE has RAPTO and CLEAR of different heights", "write the one that is meant")
    if "STEP" in couplets and _PECKING.isdisjoint(found.mode):
        what = f"CYCLE/{','.join(found.mode)} has STEP, and only DEEP and BRKCHP are made in pecks"
        raise StatementError(what, "write DEEP or BRKCHP, or leave STEP out")


def _refuse_impossible(found: CycleParts) -> None:
    """Refuse a dwell below 0, and pecks of which no control makes so many."""
    couplets = dict(found.couplets)
    if any(value < 0.0 for value in couplets.get("DWELL", ())):
        raise StatementError(f"CYCLE has the dwell {couplets['DWELL'][0]:g}, below 0", "write DWELL,seconds, or none")
    first, *others = couplets.get("STEP", ()) or (0.0,)
    shortest = first if not others or not others[0] else others[1] if len(others) > 1 else 0.0
    depth = abs(couplets.get("FEDTO", (0.0,))[0])
    if shortest > 0.0 and depth > _MOST_PECKS * shortest:
        what = f"CYCLE would peck more than {_MOST_PECKS} times: STEP {shortest:g} for a depth of {depth:g}"
        raise StatementError(what, "write longer pecks")


def _positions(state: ReaderState, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    """Take the numbers directly behind a mode."""
    positions = state.dialect.cycles.positions
    if not given:
        return
    if not positions and state.dialect.in_sections:
        found.couplets.append((word, given))  # such as NODRAG,angle
        return
    if not len(positions) <= len(given) <= len(positions) + 1 or not positions:
        what = f"CYCLE/{word} has numbers without words, which mean something else in each system"
        raise StatementError(what, "name each number of the cycle, or output the holes as motion")
    found.couplets += [(name, (number,)) for name, number in zip(positions, given, strict=False)]
    if len(given) > len(positions):
        found.couplets.append((_BARE_FEED, given[-1:]))


def _feed(state: ReaderState, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    factor, per_rev = FEED_UNITS[word]
    state.note_feed_unit(word)
    (feed,) = numbers(f"CYCLE {word}", given, 1)
    found.couplets.append(("MMPR" if per_rev else "MMPM", (feed * factor,)))


def _word_pair(found: CycleParts, word: str, following: tuple[str | float, ...]) -> int:
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


def _couplet(state: ReaderState, statement: Statement, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    """Take a word with the numbers behind it, or without any."""
    if given:
        if word not in _NUMBER_WORDS | state.dialect.cycles.numbers:
            state.note_unknown(statement, f"CYCLE with {word} is not known", word)
        found.couplets.append((word, given))
        return
    if word in _NUMBER_WORDS:
        raise StatementError(f"CYCLE has {word} without a number", f"write {word},value")
    if word not in _BARE_WORDS:
        state.note_unknown(statement, f"CYCLE with {word or 'nothing between two commas'} is not known", word)
    found.words.append((word, ""))
