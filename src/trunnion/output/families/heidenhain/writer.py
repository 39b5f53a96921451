"""Writer of Heidenhain iTNC 530 and TNC 640 (Klartext): what words and templates cannot express.

Facts: the manuals of both controls; docs/controls/heidenhain.md lists them.
"""

import re
from collections.abc import Mapping
from typing import Final

import numpy as np

from trunnion.arrays import Flags, Floats, Ints
from trunnion.controls.family_writer import ArcWords, Codes, Formats, UnsupportedFeatureError, WordEvent
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import PROJECTED_ANGLES, RADIUS_ARC_WORDS
from trunnion.controls.words import ABSENT, IncrementWords
from trunnion.messages import Wording, phrase
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Arcs, Coolant, CutterComp, Dwell, Message, Operation, Stop
from trunnion.output.families.heidenhain import arcs as heidenhain_arcs
from trunnion.output.families.heidenhain.cycles import cycle_definition
from trunnion.output.families.heidenhain.planes import PLANE_FIELDS, plane_values
from trunnion.output.families.heidenhain.planes import validate_plane as validate_plane
from trunnion.output.families.heidenhain.sides import sides_at_once
from trunnion.output.shared.lines import program_stop, split_text
from trunnion.output.shared.spindle import dwell_seconds, dwell_text
from trunnion.output.shared.splines import spline_lines as spline_lines
from trunnion.output.shared.splines import takes_spline as takes_spline
from trunnion.planning.holes.cycles import Cycle, SpindleState
from trunnion.transliteration import spelled

#: With M128 the control offsets by delta values (DR) alone, not by the radius.
COMPENSATES_WITH_TCP = False

WORDS: tuple[str, ...] = (
    "line", "vector_line", "surface_x", "surface_y", "surface_z", "axis_x", "axis_y", "axis_z", "arc",
    *RADIUS_ARC_WORDS, "helix", "arc_angle", "arc_rise",
    "counterclockwise", "clockwise", "comp_off", "comp_left", "comp_right", "feed", "feed_per_rev", "rapid",
    "spindle", "coolant", "feed_mode", "call",
)  # fmt: skip

CODES: tuple[str, ...] = (
    "feed_per_minute", "feed_per_revolution", "spindle_clockwise", "spindle_counterclockwise", "spindle_off", "stop",
    "optional_stop", "call",
)  # fmt: skip

PLANE_COMMANDS: tuple[str, ...] = (
    "spatial", "vector", "euler", "points", "relativ", "axial", "projected", "cycle19",
)  # fmt: skip
PLANE_TEMPLATES_OF: Mapping[str, str] = dict.fromkeys(
    ("vector", "euler", "points", "relativ", "axial", "projected"), "spatial"
)
PLANES_OF_POSE: frozenset[str] = frozenset({"axial"})

SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {
    "plane": PLANE_COMMANDS,
    "plane_move": ("turn", "move", "stay"),
    "plane_solution": ("SEQ", "SYM"),
    "plane_free_axis": ("unstated", "coord", "table"),
    "tcpm": ("m128", "function"),
    "rotary_feed": ("degrees", "tip"),
    "retract": ("home", "m140"),
    "orientation": ("angles", "vector"),
    "normals": ("off", "contact"),
}
SETTING_MEANINGS: Mapping[str, str] = {
    "plane": "The command for a tilted plane: PLANE SPATIAL, VECTOR, EULER, POINTS, RELATIV, AXIAL or PROJECTED, or "
    "cycle 19. AXIAL has no X but that of the machine after the tilt; PROJECTED needs what its angles mean in the "
    "definition.",
    "plane_move": "What the rotary axes do when a plane comes on: turn positions them, move does so while the linear "
    "axes hold the tip, stay leaves them where they are.",
    "plane_solution": "The word that selects one of a plane's two rotary positions: SEQ, or SYM on controls that have "
    "it (unconfirmed).",
    "plane_free_axis": "What PLANE turns where it leaves the rotary axis next to the workpiece free: coord (COORD "
    "ROT) the coordinates, table (TABLE ROT) that axis; with unstated the block has no word for it.",
    "tcpm": "The command for TCP: M128, or FUNCTION TCPM.",
    "rotary_feed": "What F counts without TCP while rotary axes turn: degrees as millimetres, or with M116 the path "
    "of the tip, which works for rotary tables only.",
    "retract": "How the tool leaves the part after a tilted or simultaneous operation: home along the linear axis, or "
    "by M140 along its own axis first.",
    "orientation": "How the tool axis is programmed with TCP: angles writes rotary positions, vector writes LN blocks "
    "with TX TY TZ.",
    "normals": "With contact, LN blocks state the surface normal NX NY NZ, from the contact points of the CL file.",
}


SETTING_FIELDS: Mapping[str, tuple[str, ...]] = {
    "tcpm": ("tcp_on", "tcp_off"),
    "retract": ("retract_along",),
    "retract_distance": ("retract_along",),
    "plane_move": ("positioning",),
    "plane_free_axis": ("free_axis",),
    "blank": ("blank_low", "blank_high"),
}
LINE_COMMENTS: tuple[str, ...] = ("; ", "* - ")
COMMENTS: re.Pattern[str] = re.compile(r'(;.*|^\* - .*)|"[^"]*"')
BLOCK_NUMBER_LETTERS: tuple[str, ...] = ("",)
HIGHEST_BLOCK_NUMBER = 99999999
NEVER_NUMBERED = ""
INCREMENTS: IncrementWords | None = IncrementWords(prefix="I")
TEMPLATE_FIELDS: frozenset[str] = frozenset(
    {
        "tcp_on", "tcp_off", "feed_at_tip", "feed_in_degrees", "retract_along", "positioning", "free_axis", "blank_low",
        "blank_high", *PLANE_FIELDS,
    }
)  # fmt: skip

#: Bytes of a comment in one line.
_COMMENT_BYTES: Final = 100

#: TCP on and off, by the setting ``tcpm``.
_TCP_SWITCHES: Final = {
    "m128": ("M128", "M129"),
    "function": ("FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "FUNCTION RESET TCPM"),
}

#: How PLANE positions the rotary axes, by the setting ``plane_move``.
_POSITIONING: Final = {"turn": "TURN FMAX", "move": "MOVE ABST0 FMAX", "stay": "STAY"}

#: What PLANE turns where an axis is free, by the setting ``plane_free_axis``.
_FREE_AXIS: Final = {"unstated": None, "coord": "COORD ROT", "table": "TABLE ROT"}

_COMP_WORDS: Final = {"LEFT": "comp_left", "RIGHT": "comp_right", "OFF": "comp_off"}


def comment(text: str) -> list[str]:
    """Return lines that start with a semicolon."""
    return [f"; {piece}" for piece in split_text(escape_comment(text), _COMMENT_BYTES)]


def escape_comment(text: str) -> str:
    """Return the text without tildes: at the end of a line one would continue the block."""
    return text.replace("~", "-")


def tool_call(number: int, name: str, by_name: bool) -> str:
    """Return what follows ``TOOL CALL``: a number, or a name in quotation marks."""
    if by_name and '"' in name:
        raise UnsupportedFeatureError(Wording("CTL130", "tool_name_quotation", name=name))
    return f'"{name}"' if by_name else str(number)


def tool_preselection(call: str) -> list[str]:
    """Return ``TOOL DEF``."""
    return [f"TOOL DEF {call}"]


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """Return cycle 9 with seconds."""
    return ["CYCL DEF 9.0 DWELL TIME", f"CYCL DEF 9.1 DWELL {dwell_text(dwell_seconds(event, rpm), formats['dwell'])}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """Return M0 or M1, after a comment for the operator."""
    return program_stop(event, codes, comment)


def message(event: Message) -> list[str]:
    """Return a comment, or a structure item for the operator."""
    lines = comment(event.text)
    return [f"* - {line[2:]}" for line in lines] if event.display else lines


def event_words(event: WordEvent, codes: Codes, coolant: Codes) -> dict[str, float]:
    """Return M of the coolant, R0, RL or RR of the radius compensation, or M5; a template starts the spindle."""
    if isinstance(event, Coolant):
        return {"coolant": coolant[event.kind]}
    if isinstance(event, CutterComp):
        return {_COMP_WORDS[event.side]: 1} if event.side in _COMP_WORDS else {}
    return {"spindle": codes["spindle_off"]}


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """Return nothing."""
    return {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Return radius compensation in another plane than XY, and on the other side without a motion with R0 between."""
    planes = [
        (event.line, UnsupportedFeatureError(Wording("CTL220", "radius_compensation_plane", plane=event.plane)))
        for event in operation.events
        if isinstance(event, CutterComp) and event.plane not in ("", "XYPLAN")
    ]
    return [*planes, *sides_at_once(operation)]


#: The most characters of a program's name.
_LONGEST_NAME: Final = 24


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, Wording]]:
    """Return an invalid program name, preset, side, retract or block form."""
    wrong = []
    name, blank = settings.get("program", ""), settings.get("blank", "")
    named = phrase("name_of_program")
    if others := re.sub(r"[A-Za-z0-9_#$%&-]", "", name):
        signs = tuple(f'"{each}"' for each in dict.fromkeys(others))
        fault = named.within("without_characters", characters=signs)
        plain = re.sub(r"[^A-Za-z0-9_#$%&-]", "_", spelled(name, "ascii"))[:_LONGEST_NAME]
        wrong.append(("program", fault.within("spelled_as", name=plain) if plain.strip("_") else fault))
    elif len(name) > _LONGEST_NAME:
        wrong.append(("program", named.within("shorter", count=len(name))))
    if not re.fullmatch(r"[0-9]{1,5}", settings.get("work_offset", "1")):
        wrong.append(("work_offset", phrase("number_of_preset")))
    if settings.get("disengage", "") not in ("", "1", "2", "3", "4"):
        wrong.append(("disengage", phrase("side_to_disengage")))
    distance = settings.get("retract_distance", "")
    if distance and not (re.fullmatch(r"[0-9]{1,5}(\.[0-9]{1,4})?", distance) and float(distance) > 0.0):
        wrong.append(("retract_distance", phrase("distance_of_retract")))
    if blank not in ("", "off", "extents", "stock") and _blank_corners(blank) is None:
        wrong.append(("blank", phrase("corners_of_blank")))
    return wrong


def cycle_call(
    cycle: Cycle, top: float, spindle: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """Return the definition of the cycle, which M99 calls at each hole."""
    return cycle_definition(cycle, top, spindle, formats, settings.get("disengage", ""))


def cycle_cancel() -> list[str]:
    """Return nothing: no cycle is modal."""
    return []


def row_words(rapid: Flags, per_rev: Flags, codes: Codes) -> dict[str, Ints]:
    """Return ``L``, ``FMAX`` of rapids, and the feed mode of rows that have a feed."""
    mode = np.where(per_rev, codes["feed_per_revolution"], codes["feed_per_minute"])
    return {
        "line": np.ones(len(rapid), np.int64),
        "rapid": np.where(rapid, 1, ABSENT).astype(np.int64),
        "feed_mode": np.where(rapid, ABSENT, mode).astype(np.int64),
    }


def arc_words(arcs: Arcs, tip: Floats, rows: Ints, codes: Codes, formats: Formats, by_radius: bool = False) -> ArcWords:
    """Return ``CC`` and ``C``, ``CP`` for helices, ``CR`` for circles by their radius."""
    return heidenhain_arcs.arc_words(arcs, tip, rows, formats, by_radius)


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """Return the words for TCP and retracts, the angles and vectors of a plane, the corners of the block form."""
    on, off = _TCP_SWITCHES[str(settings["tcpm"])]
    if settings["orientation"] == "vector":
        on = on.replace("PATHCTRL AXIS", "PATHCTRL VECTOR")
    low, high = _blank_corners(str(settings.get("blank") or "")) or (None, None)
    at_tip = settings["rotary_feed"] == "tip"
    distance = str(settings.get("retract_distance") or " MAX")
    words: dict[str, Value] = {
        "tcp_on": on,
        "tcp_off": off,
        "feed_at_tip": "M116" if at_tip else None,
        "feed_in_degrees": "M117" if at_tip else None,
        "retract_along": f"L M140 MB{distance}" if settings["retract"] == "m140" else None,
        "positioning": _POSITIONING[str(settings["plane_move"])],
        "free_axis": _FREE_AXIS[str(settings["plane_free_axis"])],
        "blank_low": low,
        "blank_high": high,
    }
    return words | plane_values(plane, str(settings.get(PROJECTED_ANGLES) or ""))


def _blank_corners(blank: str) -> tuple[str, str] | None:
    """Both corners of the block form as words; None if the text is not six numbers, the lower corner first."""
    try:
        numbers = [float(part) for part in blank.split(",")]
    except ValueError:
        return None
    sides = zip(numbers[:3], numbers[3:], strict=False)
    if len(numbers) != 6 or any(not low < high or not abs(low) + abs(high) < 1e5 for low, high in sides):
        return None
    # Rounded before, and no zero has a minus.
    texts = [f"{round(number, 4) + 0.0:+.4f}".rstrip("0").rstrip(".") for number in numbers]
    low, high = (
        " ".join(f"{axis}{text}" for axis, text in zip("XYZ", corner, strict=True)) for corner in (texts[:3], texts[3:])
    )
    return low, high
