"""What a program says of spindle and coolant, as messages call it."""

from typing import Final

from trunnion.messages import Wording
from trunnion.model.run import EventValue

_WORDS: Final = {
    "clockwise": "clockwise", "counter-clockwise": "counter_clockwise", "off": "off", "flood": "flood", "mist": "mist",
    "through": "through",
}  # fmt: skip


def event_word(value: EventValue) -> Wording | str:
    """Return the value of an event in words: a sense, or a kind of coolant; another as it is."""
    variant = _WORDS.get(str(value))
    return Wording("all", variant) if variant else str(value)
