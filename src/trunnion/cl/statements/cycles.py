"""CYCLE: mode words, then couplets of a word and its numbers, in any order."""

from collections.abc import Sequence
from dataclasses import replace

from trunnion.cl.assemble import CYCLE_LENGTHS
from trunnion.cl.conventions import CycleParts
from trunnion.cl.diagnostics import StatementError
from trunnion.cl.state import FEED_UNITS, ReaderState
from trunnion.cl.statement import Statement, numbers
from trunnion.cl.statements.motion import refuse_in_circle
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import CycleOff, CycleOn

#: Words that need a number, and take no more than one; STEP takes up to three.
_NUMBER_WORDS = CYCLE_LENGTHS | {"DWELL", "TLANGL"}
_STEP_NUMBERS = 3
#: The only mode that may have a number of its own, the angle of the spindle.
_ANGLED = "NODRAG"
#: Words that mean something with another one alone.
_PARTS = {"AUTO": "RTRCTO", "MANUAL": "RTRCTO", "REV": "DWELL"}
#: Words that only some modes use: any of these modes.
_USED_BY = {
    "CSKDIA": frozenset({"CSINK"}),
    "OPTION": frozenset({"TAP"}),
    "STEP": frozenset({"DEEP", "BRKCHP"}),
}
#: Controls and their cycles are for fewer pecks than this.
_MOST_PECKS = 1000
#: No cycle has more words and numbers.
_MOST_VALUES = 60
#: Stands for the unit of a feed until that follows.
_BARE_FEED = "FEED"


def cycle(state: ReaderState, statement: Statement) -> None:
    """Switch a cycle off, repeat the last one, or begin another."""
    row, line = state.operation_row, state.line
    if statement.values == ("OFF",):
        if not state.cycle_line and state.operation_row and state.builder.open_cycle is None:
            state.diagnostics.remark(line, Wording("CL850", "cycle_off_where"))
        state.add(CycleOff(row, line))
        state.cycle_line = 0
        return
    refuse_in_circle(state, "CYCLE")
    if statement.values == ("ON",):
        if state.cycle is None:
            raise StatementError(Wording("CL850", "cycle_before_any"))
        state.cycle = replace(state.cycle, row=row, line=line)
    else:
        begin_cycle(state, _parse(state, statement))
        return
    state.add(state.cycle)
    state.cycle_line = line


def begin_cycle(state: ReaderState, found: CycleParts) -> None:
    """Begin a cycle of which all parts are known.

    Raises ``StatementError`` for a dwell or pecks that cannot be.
    """
    _refuse_impossible(found)
    state.cycle = CycleOn(state.operation_row, state.line, tuple(found.mode), tuple(found.couplets), tuple(found.words))
    state.add(state.cycle)
    state.cycle_line = state.line


def _parse(state: ReaderState, statement: Statement) -> CycleParts:
    """Take a cycle apart: each word and each number belongs to exactly one couplet, or the statement is refused."""
    values = statement.values
    if len(values) > _MOST_VALUES:
        raise StatementError(Wording("CL160", "cycle_values_none", count=len(values), most_values=_MOST_VALUES))
    if not values or not isinstance(values[0], str):
        raise StatementError(Wording("CL820", "cycle_without_word"))
    dialect = state.dialect.cycles
    found = CycleParts()
    groups = _groups(values)
    at = 0
    while at < len(groups):
        word, given = groups[at]
        at += 1
        if why := dialect.refused.get(word):
            raise StatementError(Wording("CL820", "cycle_cannot_read", word=word, why=why))
        if word in FEED_UNITS:
            bare = not given and bool(found.couplets) and found.couplets[-1][0] == _BARE_FEED
            _feed(state, found, word, found.couplets.pop()[1] if bare else given)
        elif word in dialect.modes and not found.couplets and not found.words:
            found.mode += dialect.modes[word]
            _positions(state, found, word, given)
        elif word in ("RTRCTO", "DWELL"):
            at += _with_part(found, word, given, groups[at] if at < len(groups) else ("", ()))
        else:
            _couplet(state, statement, found, word, given)
    if any(word == _BARE_FEED for word, _ in found.couplets):
        raise StatementError(Wording("CL820", "cycle_number_too"))
    _refuse_unused(found)
    if dialect.settle is not None:
        dialect.settle(found)
    _refuse_repetitions(found)
    # The same height under its other name.
    heights = [("RAPTO" if word == "CLEAR" else word, given) for word, given in found.couplets]
    found.couplets = list(dict.fromkeys(heights))
    return found


def _groups(values: Sequence[str | float]) -> list[tuple[str, tuple[float, ...]]]:
    """Each word with the numbers behind it; the first value is a word."""
    groups: list[tuple[str, tuple[float, ...]]] = []
    for value in values:
        if isinstance(value, str):
            groups.append((value, ()))
        else:
            groups[-1] = (groups[-1][0], (*groups[-1][1], *numbers("CYCLE", (value,))))
    return groups


def _refuse_unused(found: CycleParts) -> None:
    """Refuse a word that the mode does not use: one of the two is wrong."""
    for word, _ in (*found.couplets, *found.words):
        if word in _USED_BY and _USED_BY[word].isdisjoint(found.mode):
            raise StatementError(
                Wording(
                    "CL820", "cycle_only_uses", mode=tuple(found.mode), word=word, used_by=tuple(sorted(_USED_BY[word]))
                )
            )


def _refuse_repetitions(found: CycleParts) -> None:
    """Refuse a number that is given twice: which of them is meant is unknown."""
    names = ["a feed" if word in ("MMPM", "MMPR") else word for word, _ in found.couplets]
    if twice := next((name for n, name in enumerate(names) if name in names[:n]), ""):
        raise StatementError(Wording("CL320", "cycle_twice", twice=twice))
    couplets, words = dict(found.couplets), dict(found.words)
    if "RTRCTO" in couplets and "RTRCTO" in words:
        raise StatementError(Wording("CL320", "cycle_rtrcto_height", words=words["RTRCTO"]))
    if couplets.get("CLEAR", couplets.get("RAPTO")) != couplets.get("RAPTO", couplets.get("CLEAR")):
        raise StatementError(Wording("CL320", "cycle_rapto_clear"))


def _refuse_impossible(found: CycleParts) -> None:
    """Refuse a dwell below 0, and pecks of which no control makes so many."""
    couplets = dict(found.couplets)
    if any(value < 0.0 for value in couplets.get("DWELL", ())):
        raise StatementError(Wording("CL830", "cycle_dwell_below", couplets=couplets["DWELL"][0]))
    first, less, least = (*couplets.get("STEP", ()), 0.0, 0.0, 0.0)[:3]
    if "STEP" in couplets and (not first > 0.0 or not 0.0 <= less < first or not 0.0 <= least <= first):
        raise StatementError(
            Wording("CL830", "cycle_pecks_cannot", couplets=tuple(f"{number:g}" for number in couplets["STEP"]))
        )
    shortest = least if less else first
    depth = abs(couplets.get("FEDTO", (0.0,))[0])
    if shortest > 0.0 and depth > _MOST_PECKS * shortest:
        raise StatementError(
            Wording("CL830", "cycle_would_peck", most_pecks=_MOST_PECKS, shortest=shortest, depth=depth)
        )


def _positions(state: ReaderState, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    """Take the numbers directly behind a mode."""
    positions = state.dialect.cycles.positions
    if not given:
        return
    if word == _ANGLED:
        found.couplets.append((word, numbers(f"CYCLE {word}", given, 1)))
        return
    if not len(positions) <= len(given) <= len(positions) + 1 or not positions:
        raise StatementError(Wording("CL820", "cycle_numbers_without", word=word))
    found.couplets += [(name, (number,)) for name, number in zip(positions, given, strict=False)]
    if len(given) > len(positions):
        found.couplets.append((_BARE_FEED, given[-1:]))


def _feed(state: ReaderState, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    factor, per_rev = FEED_UNITS[word]
    (feed,) = numbers(f"CYCLE {word}", given, 1)
    state.note_feed_unit(word, feed)
    found.couplets.append(("MMPR" if per_rev else "MMPM", (feed * factor,)))


def _with_part(found: CycleParts, word: str, given: tuple[float, ...], following: tuple[str, tuple[float, ...]]) -> int:
    """Take RTRCTO,c, RTRCTO,AUTO, DWELL,t, DWELL,n,REV or DWELL,REV,n; return how many following words belong to it."""
    part, behind = following
    if _PARTS.get(part) != word or (given and part != "REV"):
        found.couplets.append((word, _one_number(word, given)))
        return 0
    found.words.append((word, part))
    if part == "REV":
        found.couplets.append((word, _one_number(f"{word},REV", given + behind)))
    elif behind:
        raise StatementError(Wording("CL320", "cycle_behind", behind=behind[0], word=word, part=part))
    return 1


def _one_number(word: str, given: tuple[float, ...], most: int = 1) -> tuple[float, ...]:
    """Return the numbers behind a word: one, or up to ``most``."""
    if not given:
        raise StatementError(Wording("CL820", "cycle_without_number", word=word))
    if len(given) > most:
        raise StatementError(
            Wording(
                "CL820",
                "cycle_numbers_behind",
                count=len(given),
                word=word,
                given=tuple(f"{number:g}" for number in given),
            )
        )
    return given


def _couplet(state: ReaderState, statement: Statement, found: CycleParts, word: str, given: tuple[float, ...]) -> None:
    """Take a word with the numbers behind it, or without any."""
    if word in _PARTS:
        raise StatementError(Wording("CL820", "cycle_belongs_behind", word=word, parts=_PARTS[word]))
    meant = state.dialect.cycles.words.get(word, word)
    if meant in _NUMBER_WORDS | state.dialect.cycles.numbers:
        found.couplets.append((meant, _one_number(word, given, _STEP_NUMBERS if meant == "STEP" else 1)))
        return
    if given or word != "OPTION":
        state.note_unknown(statement, phrase("not_known_with", statement="CYCLE", words=word), word)
    if given:
        found.couplets.append((word, given))
    else:
        found.words.append((word, ""))
