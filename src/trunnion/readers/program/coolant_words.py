"""``[control.coolant]`` against what readers take its M codes for: the control itself, and ``[control.known]``."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Final

from trunnion.errors import InputError
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.readers.program.known_words import known_words
from trunnion.readers.program.settings import control_of

#: Coolants -> the coolant that a reader takes their words for, where one has a name for it.
_READ_AS: Final = {"OFF": "OFF", "ON": "FLOOD", "FLOOD": "FLOOD", "TAP": "FLOOD", "MIST": "MIST", "THRU": "THRU"}

#: Coolants -> the effect that ``[control.known]`` may give their M codes.
_EFFECTS: Final = {"OFF": "coolant off", "FLOOD": "coolant flood", "MIST": "coolant mist", "THRU": "coolant through"}

#: Effects of an M code that may switch a coolant, although it does not say so.
_HARMLESS: Final = frozenset({"no effect", "waits"})

#: M codes of stops, spindle, programs and tool changes, which the loader of controls refuses by their names.
_NAMED: Final = frozenset({0, 1, 2, 3, 4, 5, 6, 30})


def coolant_meanings(machine: Machine, coolants: Mapping[int, str]) -> dict[int, str]:
    """Return the control's own coolants as the definition of a machine has them: M7 may be flood, and M8 mist.

    coolants     M codes of the control's own coolants -> ``OFF``, ``FLOOD`` or ``MIST``
    """
    stated = control_of(machine).table("coolant").to_dict()
    if stated.get("FLOOD") == stated.get("MIST"):
        return dict(coolants)  # a fault that the control's loader names
    own = {stated[kind]: kind for kind in ("FLOOD", "MIST") if stated.get(kind) in coolants}
    return {code: own.get(code, kind) if kind != "OFF" else kind for code, kind in coolants.items()}


@lru_cache(maxsize=32)
def coolant_of(machine: Machine, code: int, usual: str | None) -> str | None:
    """Return what one of the control's own words for coolant switches on a machine; ``usual``: on most."""
    if usual == "off":
        return usual
    stated = control_of(machine).table("coolant").to_dict()
    return next((kind.lower() for kind in ("FLOOD", "MIST") if stated.get(kind) == code), usual)


def check_coolant_words(machine: Machine, is_own_word: Callable[[str], bool], coolants: Mapping[int, str]) -> None:
    """Check that no coolant of a definition has an M code that readers take for something else.

    is_own_word  whether the control has a word itself
    coolants     M codes of the control's own coolants -> ``OFF``, ``FLOOD`` or ``MIST``

    Raises ``InputError`` with each such coolant.
    """
    table = control_of(machine).table("coolant")
    coolants = coolant_meanings(machine, coolants)
    declared = {word.code: word for word in known_words(machine) if word.code is not None}
    for kind, code in table.to_dict().items():
        if not isinstance(code, int):
            continue  # "none", or a fault that the control's loader names
        read_as, word = _READ_AS.get(kind, ""), declared.get(code)
        if code in _NAMED:
            continue
        if code in coolants and is_own_word(f"M{code}"):
            if coolants[code] != read_as:
                both = table.to_dict().get("FLOOD") == table.to_dict().get("MIST")
                table.add_problem(kind, _other_coolant(kind, code, coolants, both=both))
        elif is_own_word(f"M{code}"):
            table.add_problem(kind, Wording("DEF330", "coolant_is_own_word", code=code))
        elif word is not None and not _may_switch(_EFFECTS.get(read_as, ""), word.effects):
            table.add_problem(kind, Wording("DEF330", "coolant_is_declared", code=code, says=word.says))
    if table.problems:
        raise InputError(table.problems)


def _other_coolant(kind: str, code: int, coolants: Mapping[int, str], *, both: bool) -> Wording:
    """Return what is wrong with a name of a coolant whose M code is that of another one; ``both``: FLOOD and MIST have
    one M code, which the control's loader names in the same words, as it does that of OFF.
    """
    read_as = _READ_AS.get(kind, "")
    right = next((each for each, meaning in coolants.items() if meaning == read_as), None)
    said = {"code": code, "other": coolants[code]}
    if right is None or both or "OFF" in (kind, coolants[code]):
        return Wording("DEF330", "coolant_is_other_word", **said)
    return Wording("DEF330", "coolant_is_other_coolant", **said, kind=kind, right=right, read_as=read_as)


def _may_switch(effect: str, effects: Sequence[str]) -> bool:
    """Whether an M code of some effects may switch the coolant of an effect; it may stop the spindle for that too."""
    coolants = {each for each in effects if each.startswith("coolant")}
    return coolants == {effect} if coolants else {*effects} <= _HARMLESS
