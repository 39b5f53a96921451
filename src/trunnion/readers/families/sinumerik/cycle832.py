"""CYCLE832: within what tolerance the control may smooth the path.

With a machining type the cycle, as the control has it, programs continuous path (G64, G642 or G645, with a compressor),
whatever G60 stands before it; off, the control goes back to its settings. What a machine's builder puts into CUST_832
is not known here.
"""

from typing import Final

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.readers.families.sinumerik.block import Call
from trunnion.readers.families.sinumerik.control import SinumerikControl
from trunnion.readers.families.sinumerik.words import (
    CONSTANTS,
    SMOOTHING_ORIENTATION,
    SMOOTHING_SURFACES,
    SMOOTHING_TYPES,
)
from trunnion.readers.program.word_values import GREATEST_TURN, orientation_fault

#: The cycle takes no more values.
_MOST_ARGUMENTS: Final = 3


def smooth(control: SinumerikControl, call: Call) -> None:
    """Execute a call: within the first value; the ones of the second are the machining type, 0 for off."""
    values = zip(call.argument_texts, call.arguments, strict=True)
    control.add_event("cycle832", tuple(text if text in CONSTANTS else value for text, value in values))
    tolerance, mode, orientation = (*call.arguments, None, None, None)[:3]
    turn = orientation if isinstance(orientation, float) else 0.0
    if len(call.arguments) > _MOST_ARGUMENTS or turn < 0.0:
        control.note(Wording("NC215", "cycle832_takes_tolerance_mode_tolerance"), Severity.ERROR)
    if turn > GREATEST_TURN:
        control.note(orientation_fault("CYCLE832", turn), Severity.ERROR)
    if isinstance(mode, float) and not _is_mode(mode):
        control.note(Wording("NC215", "cycle832_mode_control_does_not", mode=mode), Severity.ERROR)
    given = tolerance if isinstance(tolerance, float) else 0.0
    if given < 0.0 or (given == 0.0 and isinstance(mode, float) and int(mode) % 10):
        control.note(Wording("NC215", "cycle832_smooths_within_give_first", given=given), Severity.ERROR)
    control.say_mode("CYCLE832", f"mode {mode:g}" if isinstance(mode, float) and mode else "off")
    control.add_tolerance(given * control.length_unit)
    is_on = isinstance(mode, float) and _is_mode(mode) and int(mode) % 10 > 0
    control.add_orientation_tolerance(turn if is_on else 0.0)
    control.smooth(is_on)


def _is_mode(mode: float) -> bool:
    """Whether a mode is one that the control has."""
    if not 0.0 <= mode == int(mode):
        return False
    rest, kind = divmod(int(mode), 10)
    surfaces, rest = divmod(rest, 100_000)
    older = rest > 9  # digits of older software, which say what else is switched
    known = kind in SMOOTHING_TYPES and surfaces in SMOOTHING_SURFACES and rest % 10 in SMOOTHING_ORIENTATION
    return known and not (older and surfaces)
