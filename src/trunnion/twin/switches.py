"""Door and clamp, as words of the machine builder switch them in a program.

In:     events of a run, and the machine, whose definition says under ``[control.known]`` what its words do.
Out:    for each switch its state after each event.
"""

from collections.abc import Iterable, Sequence
from typing import Final

from trunnion.machines import Machine
from trunnion.model.run import RunEvent
from trunnion.readers import KnownWord, known_words
from trunnion.readers.program.known_words import begins_with

#: Switches -> the effects of words that turn them on and off.
SWITCHES: Final = {"door": ("door closes", "door opens"), "clamp": ("clamp closes", "clamp opens")}


def has_switch(machine: Machine, switch: str) -> bool:
    """Whether the definition of a machine has a word that operates a switch."""
    return any(set(SWITCHES[switch]) & set(word.effects) for word in known_words(machine))


def switched(machine: Machine, switch: str, events: Iterable[RunEvent]) -> Sequence[bool | None]:
    """Return the state before all events, and after each of them: True for closed, None before the first word."""
    on, off = ([word for word in known_words(machine) if effect in word.effects] for effect in SWITCHES[switch])
    states: list[bool | None] = [None]
    for event in events:
        state = states[-1]
        if on and _is_one_of(on, event):
            state = True
        if off and _is_one_of(off, event):
            state = False
        states.append(state)
    return states


def _is_one_of(words: Sequence[KnownWord], event: RunEvent) -> bool:
    if event.kind == "m":
        return any(word.code == event.value for word in words)
    return event.kind == "known" and begins_with(words, str(event.value))
