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
    19: ("spindle", "oriented"),
}

#: Codes that switch coolant, and its word in CL files.
COOLANTS: Final = {code: str(value).upper() for code, (kind, value) in EVENTS.items() if kind == "coolant"}

#: Codes that switch the spindle.
SPINDLE: Final = frozenset(code for code, (kind, _) in EVENTS.items() if kind == "spindle")

TOOL_CHANGE: Final = 6
PROGRAM_ENDS: Final = frozenset({2, 30})
