"""CYCLE800: the tilted plane of its sixteen values."""

import numpy as np

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.control.affine_map import AffineMap, rotation_matrix
from trunnion.readers.families.sinumerik.block import Call
from trunnion.readers.families.sinumerik.control import SinumerikControl
from trunnion.readers.families.sinumerik.settings import settings_of
from trunnion.readers.families.sinumerik.words import SWIVEL_DIRECTIONS, SWIVEL_RETRACTS, SWIVEL_STYLES

#: _FR: back along the tool by the way _FR_I, mm.
_BY_WAY = 5.0

#: Larger values are mistakes of the program.
MAX_ARGUMENT = 1e7


def rotation_axes(mode: int) -> list[int] | None:
    """Return the axes of the three rotations of ``_MODE``, 0 for X; None if its angles mean something else.

    Bits 1 and 0 give the axis of the first rotation, 3 and 2 of the second, 5 and 4 of the third (01 X, 10 Y, 11 Z);
    bits 7 and 6 are 00 for rotations one after another.
    """
    if mode >> 6:
        return None
    axes = [(mode >> shift) & 3 for shift in (0, 2, 4)]
    return None if 0 in axes else [axis - 1 for axis in axes]


def swivel(control: SinumerikControl, call: Call) -> None:
    """Execute a call of CYCLE800."""
    note = control.note
    control.judge_within_compensation("CYCLE800")
    control.add_event("cycle800", ",".join(call.argument_texts))
    texts = [value if isinstance(value, str) else None for value in call.arguments]
    if not call.arguments or (len(texts) > 1 and texts[1] == "0"):
        control.set_plane(None)
        return
    if len(call.arguments) > 16:
        note(Wording("NC215", "cycle800_arguments", given=len(call.arguments)), Severity.ERROR)
        return
    numbers = [value if isinstance(value, float) else 0.0 for value in call.arguments]
    numbers += [0.0] * (16 - len(numbers))
    retract, _, style, mode = numbers[:4]
    before, angles, after, direction = numbers[4:7], numbers[7:10], numbers[10:13], numbers[13]
    control.say_mode("swivel data", f"{texts[1] or 'none'}, _FR {retract:g}")
    if any(abs(value) > MAX_ARGUMENT for value in numbers):
        note(Wording("NC215", "cycle800_numbers_no_machine_not"), Severity.ERROR)
        return
    wanted = (
        ("_FR", retract, SWIVEL_RETRACTS),
        ("_ST", style % 10, SWIVEL_STYLES),
        ("_DIR", direction, SWIVEL_DIRECTIONS),
    )
    for name, value, known in wanted:
        if value not in known:
            note(Wording("NC215", "cycle800_control_knows", name=name, value=value, known=known), Severity.ERROR)
    if (plane := numbers[15] % 10) and plane != 3 - control.plane_axis:
        note(
            Wording("NC215", "cycle800_other_plane", plane=numbers[15], word=f"G{19 - control.plane_axis}"),
            Severity.ERROR,
        )
    if control.modal.edge.current == 0:
        note(Wording("NC340", "cycle800_works_tool_length_d0"), Severity.ERROR)
    if retract == _BY_WAY and numbers[14] <= 0.0:
        note(Wording("NC215", "cycle800_retracts_into_part", way=numbers[14]), Severity.ERROR)
    if retract:
        note(Wording("NC224", "cycle800_retracts_first_fr_not", retract=retract), Severity.WARNING)
    origin = control.length_unit * np.array(before)
    offset = control.length_unit * np.array(after)
    linear = np.eye(3)
    direct = None
    axes = rotation_axes(int(mode))
    if int(mode) >> 6 == 3:
        # The values are those of the first and the second rotary axis of the swivel data.
        names = settings_of(control.machine).swivel_axes
        rotary = tuple(control.machine.names[k] for k in control.machine.own_rotary)
        if names not in (rotary, rotary[::-1]):
            note(Wording("NC224", "cycle800_direct_axes_unknown", mode=mode), Severity.ERROR)
        direct = (angles[0], angles[1]) if names != rotary[::-1] else (angles[1], angles[0])
    elif axes is None:
        note(Wording("NC220", "cycle800_mode_not_simulated", mode=mode), Severity.ERROR)
        return
    else:
        for axis, angle in zip(axes, angles, strict=True):
            linear = linear @ rotation_matrix(axis, angle)
    frame = AffineMap(linear, origin)
    if direct is None:
        frame = frame.compose(AffineMap(np.eye(3), offset))
    control.swivel(frame, add=int(style) % 10 == 1, direction=direction, direct=direct)
    if direct is not None and offset.any():
        note(Wording("NC220", "cycle800_direct_angles_offset_after"), Severity.ERROR)
