"""The reader of Klartext programs, of an iTNC 530 and a TNC 640 alike."""

import re
from typing import Final

from trunnion.readers.families.heidenhain.control import HeidenhainControl
from trunnion.readers.families.heidenhain.interpreter import HeidenhainInterpreter
from trunnion.readers.families.heidenhain.own_words import is_own_word
from trunnion.readers.families.heidenhain.settings import VARIABLE, variables_of
from trunnion.readers.families.heidenhain.words import (
    M_CALL,
    M_CALL_MODAL,
    M_COOLANTS,
    M_FEED_AT_TIP,
    M_FEED_IN_DEGREES,
    M_NOT_SHORTEST,
    M_NOT_SIMULATED,
    M_SHORTEST,
    M_WITHOUT_PATH_EFFECT,
)
from trunnion.readers.program.call_words import ENDS, CallWords
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.raw_text import NUMBER, raw_words
from trunnion.readers.program.work_offsets import WorkOffsetWords, first_number

#: The number of a preset, as cycle 247 has it.
WORK_OFFSETS: Final = WorkOffsetWords(
    "the number of a preset, such as 1",
    re.compile(r"(?:PRESET )?([0-9]{1,4})"),
    first_number,
    lambda value: f"preset {value}",
    lambda n: n if n <= 9999 else 0,
    plain=True,
)

#: Parameters that no cycle of the control takes.
_PARAMETER: Final = r"Q(?:[0-9]{1,2}|1[6-9][0-9]{2}|[LR][0-9]{1,3})"
_VALUE: Final = rf"(?:{NUMBER}|[-+]?{_PARAMETER})"

#: What M words of cycles, of the way of rotary axes and of their feed do shows only in later motions.
RAW_WORDS: Final = raw_words(
    (r";.*", r"\*[ \t]*-.*"),
    (
        rf"(?:FN[ \t]*0[ \t]*:?[ \t]*)?{_PARAMETER}[ \t]*=[ \t]*{_VALUE}(?:[ \t]*[-+*/][ \t]*{_VALUE})*",
        r"(?:L|R0|FMAX|STOP)(?![A-Z])",
        rf"F[ \t]*{NUMBER}",
        r"M[ \t]*0*(?P<m>[0-9]+)",
    ),
    {*M_WITHOUT_PATH_EFFECT, *M_NOT_SIMULATED}
    | {M_CALL, M_CALL_MODAL, M_SHORTEST, M_NOT_SHORTEST, M_FEED_AT_TIP, M_FEED_IN_DEGREES},
)

READER: Final = FamilyReader(
    HeidenhainInterpreter,
    frozenset(f"M{code}" for code in M_WITHOUT_PATH_EFFECT),
    WORK_OFFSETS,
    is_own_word,
    comments=rb";[^\n]*|^\d+ \*[^\n]*",
    raw_words=RAW_WORDS,
    smoothing=re.compile(r"CYCL[ \t]+DEF[ \t]+32(?![0-9])"),
    lost_smoothing={"cycle32": ("cycle 32", "see the setting tolerance=…")},
    compensation_style=lambda _: HeidenhainControl.compensation_style,
    check_reading=variables_of,
    variables=VARIABLE,
    variable_form=str.upper,
    call_words=CallWords(
        rb"(?:(?:CALL|SEL)[ \t]+PGM|PGM[ \t]+CALL|12\.1[ \t]+PGM)[ \t]+\"?([^\"\s]+)",
        rb"END[ \t]+PGM(?![A-Z])",
        programs=ENDS + rb"|TOOL[ \t]+CALL|BLK[ \t]+FORM",
    ),
    coolants=M_COOLANTS,
)
