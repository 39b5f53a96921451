"""M codes with the same meaning on all controls that follow ISO 6983."""

from typing import Final

#: Codes that make an event: kind and value.
EVENTS: Final = {
    0: ("stop", None),
    1: ("optional_stop", None),
    3: ("spindle", "clockwise"),
    4: ("spindle", "counter-clockwise"),
    5: ("spindle", "off"),
    7: ("coolant", "mist"),
    8: ("coolant", "flood"),
    9: ("coolant", "off"),
}

#: Sense of rotation of the spindle: +1 clockwise, -1 counter-clockwise, 0 off.
SPINDLE: Final = {3: 1, 4: -1, 5: 0}

TOOL_CHANGE: Final = 6
PROGRAM_ENDS: Final = frozenset({2, 30})
