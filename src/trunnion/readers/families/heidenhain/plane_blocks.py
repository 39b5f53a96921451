"""PLANE and FUNCTION TCPM blocks."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.model.run import Orientation
from trunnion.readers.control.affine_map import rotation_matrix
from trunnion.readers.control.event_recorder import Note
from trunnion.readers.control.row_recorder import MAX_POSITION
from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.lexer import Word
from trunnion.readers.families.heidenhain.parameters import KlartextError, Parameters
from trunnion.readers.families.heidenhain.path_blocks import MAX_FEED, only, value_of
from trunnion.readers.families.heidenhain.plane_control import Positioning
from trunnion.readers.families.heidenhain.plane_frames import PLANE_WORDS, plane
from trunnion.readers.families.heidenhain.settings import projected_angles

#: An axis within this of zero is at zero, degrees.
_AT_ZERO: Final = 1e-4

#: Words that follow on others.
_PAIRS: Final = {"COORD": "ROT", "TABLE": "ROT", "MB": "MAX"}

#: Words of a PLANE block of which it takes one.
_ALTERNATIVES: Final = (
    frozenset({"TURN", "MOVE", "STAY"}), frozenset({"SEQ+", "SEQ-", "SYM+", "SYM-"}), frozenset({"F", "FMAX"}),
    frozenset({"DIST", "ABST"}), frozenset({"MB"}), frozenset({"ROT"}),
)  # fmt: skip

#: What PLANE RESET takes: it turns the axes back, with no choice between two positions.
_OF_RESET: Final = frozenset({"TURN", "MOVE", "STAY", "F", "FMAX", "MB", "MAX", "DIST", "ABST"})

_SEQUENCES: Final = {"SEQ+": 1, "SEQ-": -1, "SYM+": 1, "SYM-": -1}


def plane_block(control: HeidenhainControl, block_words: Sequence[Word], parameters: Parameters) -> None:
    """Execute a PLANE block; ``block_words`` without PLANE."""
    if not block_words or block_words[0].operand is not None:
        raise KlartextError(Wording("NC210", "plane_needs_kind"))
    control.say_mode("tilted plane")
    kind = block_words[0].name
    # ROT with a value is an angle of PROJECTED, without one the word behind COORD and TABLE.
    written = [word.name for word in block_words[1:] if word.name != "ROT" or word.operand is None]
    positioning, values = _positioning(control, block_words[1:], parameters)
    if kind == "RESET":
        only(written, _OF_RESET | values.keys(), "PLANE RESET")
    if not positioning.mode:
        # The manuals call the entry mandatory; only a bare PLANE RESET has nothing to position.
        if written or kind != "RESET":
            raise KlartextError(Wording("NC210", "plane_needs_positioning", kind=kind))
        positioning = replace(positioning, mode="STAY")
    _check_positioning(written, positioning)
    if kind in PLANE_WORDS:
        only(values, PLANE_WORDS[kind], f"PLANE {kind}")
    if kind == "RESET":
        control.untilt(positioning)
    elif kind == "AXIAL":
        _axial(control, values, positioning, parameters)
    elif kind == "RELATIV":
        if len(values) != 1 or not values.keys() <= {"SPA", "SPB", "SPC"}:
            raise KlartextError(Wording("NC210", "plane_relativ_takes_spa_spb"))
        ((name, angle),) = values.items()
        store_rotary_angles(
            parameters, control, control.tilt(rotation_matrix("ABC".index(name[2]), angle), positioning, relative=True)
        )
    else:
        store_rotary_angles(
            parameters, control, control.tilt(plane(kind, values, projected_angles(control.machine)), positioning)
        )


def _check_positioning(written: Sequence[str], positioning: Positioning) -> None:
    """Refuse words that exclude each other, and those of a motion that the block does not make."""
    for group in _ALTERNATIVES:
        if len(found := [name for name in written if name in group]) > 1:
            raise KlartextError(Wording("NC212", "written_twice", word=" ".join(dict.fromkeys(found))))
    unused: tuple[str, ...] = () if positioning.mode == "MOVE" else ("DIST", "ABST")
    if positioning.mode == "STAY" and not positioning.retract:
        unused += ("F",)  # FMAX says nothing that may go missing
    for name in written:
        if name in unused:
            raise KlartextError(Wording("NC210", "block_takes_no", block=f"PLANE … {positioning.mode}", word=name))


def _axial(
    control: HeidenhainControl, values: dict[str, float], positioning: Positioning, parameters: Parameters
) -> None:
    unknown = values.keys() - set(control.rotary_names)
    if unknown or not values:
        raise KlartextError(Wording("NC210", "plane_axial_takes", axes=tuple(control.rotary_names)))
    control.resolve_rows()
    current = [float(control.current_joints[column]) for column in control.machine.rotary]
    for name, now in zip(control.rotary_names, current, strict=False):
        if name not in values and abs(now) > _AT_ZERO:
            raise KlartextError(Wording("NC351", "plane_axial_leaves_out", axis=name, position=now))
    first, second = (values.get(name, 0.0) for name in (*control.rotary_names, "", "")[:2])
    control.tilt_axial((first, second), positioning)
    store_rotary_angles(parameters, control, (first, second))


def _positioning(
    control: HeidenhainControl, block_words: Sequence[Word], parameters: Parameters
) -> tuple[Positioning, dict[str, float]]:
    """Return how the block positions the rotary axes (mode empty: not said), and the values that define the plane."""
    positioning = Positioning(mode="")
    values: dict[str, float] = {}
    names = [word.name for word in block_words]
    for place, word in enumerate(block_words):
        value = None if word.operand is None else value_of(word.operand, parameters)
        before = names[place - 1] if place else ""
        match word.name, value:
            case (("TURN" | "MOVE" | "STAY"), None):
                positioning = replace(positioning, mode=word.name)
            case (("SEQ+" | "SEQ-" | "SYM+" | "SYM-"), None):
                positioning = replace(positioning, sequence=_SEQUENCES[word.name])
            case "FMAX", None:
                positioning = replace(positioning, rapid=True)
            case "MAX", None if before == "MB":
                positioning = replace(positioning, retract=math.inf)
            case "ROT", None if before in ("COORD", "TABLE"):
                positioning = replace(positioning, table=before == "TABLE")
            case (("COORD" | "TABLE" | "MB"), None) if names[place + 1 : place + 2] == [_PAIRS[word.name]]:
                pass
            case (("COORD" | "TABLE" | "MB"), None):
                raise KlartextError(Wording("NC210", "word_needs_value", word=word.name))
            case "F", float() if 0.0 <= value <= MAX_FEED:
                positioning = replace(positioning, feed=value * control.feed_unit)
            case (("DIST" | "ABST"), float()) if abs(value) * control.length_unit < MAX_POSITION:
                positioning = replace(positioning, distance=value * control.length_unit)
            case "MB", float() if abs(value) * control.length_unit < MAX_POSITION:
                positioning = replace(positioning, retract=value * control.length_unit)
            case _, float():
                if word.name in values:
                    raise KlartextError(Wording("NC212", "written_twice", word=word.name))
                values[word.name] = value
            case _:
                raise KlartextError(Wording("NC211", "unknown_word", word=word.name or word.text))
    return positioning, values


def tcpm_block(control: HeidenhainControl, block_words: Sequence[Word], note: Note) -> None:
    """Execute FUNCTION TCPM; ``block_words`` without FUNCTION TCPM."""
    names = [word.name for word in block_words]
    for word in block_words:
        if word.operand is not None:
            note(Wording("NC210", "block_takes_no", block="FUNCTION TCPM", word=word.name), Severity.ERROR)
    pairs = list(zip(names[::2], names[1::2], strict=False))
    spatial_angles = False
    orientation = Orientation.ANGLES
    for pair in pairs:
        match pair:
            case ("F", "TCP") | ("AXIS", "POS"):
                pass
            case "F", "CONT":
                note(Wording("NC220", "function_tcpm_f_cont_feeds"), Severity.ERROR)
            case "AXIS", "SPAT":
                spatial_angles = True
            case "PATHCTRL", ("AXIS" | "VECTOR"):
                orientation = Orientation.GREAT_CIRCLE if pair[1] == "VECTOR" else Orientation.ANGLES
            case _:
                note(Wording("NC220", "tcpm_word_not_simulated", words=tuple(pair)), Severity.ERROR)
    if len(names) % 2:
        note(Wording("NC215", "tcpm_unexpected", found=names[-1]), Severity.ERROR)
    control.judge_within_compensation("FUNCTION TCPM")
    control.switch_tcp_by("FUNCTION TCPM", on=True)
    control.set_tcp(True)
    control.limit_compensating_feed(None)
    control.spatial_angles_active = spatial_angles
    control.angles = [0.0, 0.0, 0.0]
    control.say_tool_axis()
    control.set_orientation(orientation)


def store_rotary_angles(parameters: Parameters, control: HeidenhainControl, rotary: tuple[float, float] | None) -> None:
    """Store the rotary position of a plane in Q120 (A), Q121 (B) and Q122 (C)."""
    if rotary is None:
        return
    found = dict(zip(control.rotary_names, rotary, strict=False))
    for number, name in zip((120, 121, 122), "ABC", strict=True):
        parameters[f"Q{number}"] = found.get(name, 0.0)
