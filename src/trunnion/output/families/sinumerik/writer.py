"""What Sinumerik says that words and templates alone cannot: dwells, messages, the tool's call, planes.

Facts: SINUMERIK 840D sl programming manuals, *Fundamentals* and *Job planning*; docs/controls/sinumerik.md has them
one by one.
"""

from collections.abc import Mapping

from trunnion.arrays import Floats
from trunnion.controls.family_writer import EACH_HOLE, Codes, Formats, UnsupportedFeatureError
from trunnion.controls.template import Value
from trunnion.controls.vocabulary import HOLES_IN_PLANES, HOLES_SETTING
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Dwell, Message, Operation, Stop
from trunnion.output.coordinates.euler_angles import tait_bryan_angles
from trunnion.output.families import iso
from trunnion.output.families.iso import arc_words as arc_words
from trunnion.output.families.iso import event_words as event_words
from trunnion.output.families.iso import row_words as row_words
from trunnion.output.families.sinumerik.cycles import cycle_statement, is_valid_lift
from trunnion.planning.holes.cycles import Cycle, HoleCycleError, HoleMethod, SpindleState

WORDS: tuple[str, ...] = (
    *iso.WORDS, "edge", "primary_shortest", "secondary_shortest", "axis_x", "axis_y", "axis_z", "by_vector", "by_axes",
)  # fmt: skip
CODES: tuple[str, ...] = iso.CODES
PLANE_COMMANDS: tuple[str, ...] = ("cycle800", "frames")
SETTING_CHOICES: Mapping[str, tuple[str, ...]] = {
    "plane": PLANE_COMMANDS,
    "swivel_mode": ("57", "27", "39", "45", "30", "54"),
    "orientation": ("angles", "vector"),
    HOLES_SETTING: (HOLES_IN_PLANES, "torot", "positions"),
}
_PLANE_FIELDS = ("plane_first", "plane_second", "plane_third", "plane_mode")
TEMPLATE_FIELDS: frozenset[str] = frozenset({*_PLANE_FIELDS, "interpolation"})


def comment(text: str) -> list[str]:
    """A semicolon begins a comment."""
    return [f";{text}"]


def escape_comment(text: str) -> str:
    """Nothing needs to be changed in what stands after a semicolon."""
    return text


def tool_call(number: int, name: str, by_name: bool) -> str:
    """What stands after ``T=``: a number, or a name in quotation marks, in which none can stand."""
    if by_name and '"' in name:
        raise UnsupportedFeatureError(f"the tool name {name} has a quotation mark in it", "write --set tool=NUMBER")
    return f'"{name}"' if by_name else str(number)


def swivel_axes(mode: int) -> tuple[int, int, int]:
    """Axes of the three turns of CYCLE800's _MODE, 0 for X: bits 1 and 0 name the first, 3 and 2 the second, 5 and 4
    the third; 1 is X, 2 is Y, 3 is Z."""
    return (mode & 3) - 1, (mode >> 2 & 3) - 1, (mode >> 4 & 3) - 1


def template_values(settings: Mapping[str, Value], plane: Floats | None) -> dict[str, Value]:
    """How orientations are interpolated, and the three turns of a plane in the order of ``plane_mode``; the frame words
    turn about X, Y, Z, which is 57."""
    interpolation: dict[str, Value] = {"interpolation": "VECT" if settings["orientation"] == "vector" else "AXES"}
    if plane is None:
        return interpolation | dict.fromkeys(_PLANE_FIELDS)
    mode = str(settings["swivel_mode"]) if settings["plane"] == "cycle800" else "57"
    first, second, third = tait_bryan_angles(plane, swivel_axes(int(mode)))
    turns: dict[str, Value] = {"plane_first": first, "plane_second": second, "plane_third": third, "plane_mode": mode}
    return interpolation | turns


def dwell(event: Dwell, rpm: float | None, formats: Formats) -> list[str]:
    """``G4 F`` waits seconds, ``G4 S`` spindle revolutions; both stand in a block of their own."""
    return [f"G4 {'S' if event.revolutions else 'F'}{formats['dwell'].text(event.amount)}"]


def stop(event: Stop, codes: Codes) -> list[str]:
    """M0 or M1, after the text that the operator is to see."""
    code = codes["optional_stop" if event.optional else "stop"]
    return [*(comment(event.text) if event.text else ()), f"M{code}"]


def first_block_words(motion: Motion, tool: str, register: int, settings: Mapping[str, str]) -> dict[str, float]:
    """The cutting edge, whose length counts from here on."""
    return {"edge": int(settings["edge"])} if "edge" in settings else {}


def validate_operation(operation: Operation, spindle_known: bool) -> list[tuple[int, UnsupportedFeatureError]]:
    """Nothing."""
    return []


def validate_settings(settings: Mapping[str, str]) -> list[tuple[str, str]]:
    """A lift that is none."""
    return (
        []
        if is_valid_lift(settings.get("bore_lift", ""))
        else [("bore_lift", "write millimetres, such as 0.5, or nothing")]
    )


def cycle_call(
    cycle: Cycle, top: float, turning: SpindleState | None, settings: Mapping[str, str], formats: Formats
) -> list[str]:
    """``MCALL`` with the call of the cycle; or for each hole a frame that is turned to the tool, and the call."""
    lift = float(settings["bore_lift"]) if settings.get("bore_lift") else None
    if settings[HOLES_SETTING] != HOLES_IN_PLANES and cycle.method is HoleMethod.BORE_WITH_LIFT:
        raise HoleCycleError(
            "BORE,NODRAG while the tool axis changes: X of the frame is not known", "--set holes=planes"
        )
    call = cycle_statement(cycle, top, turning, lift, formats)
    return [EACH_HOLE, "TOROT", call, "TOROTOF", "TRANS"] if settings[HOLES_SETTING] == "torot" else [f"MCALL {call}"]


def cycle_cancel() -> list[str]:
    """``MCALL`` alone."""
    return ["MCALL"]


def message(event: Message) -> list[str]:
    """A comment, or for the operator MSG; a quotation mark inside would end the text early."""
    return ['MSG("' + event.text.replace('"', "'") + '")'] if event.display else comment(event.text)
