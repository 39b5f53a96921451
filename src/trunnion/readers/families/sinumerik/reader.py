"""The reader of Sinumerik 840D programs."""

import re
from typing import Final

from trunnion.readers.families.sinumerik.control import SinumerikControl
from trunnion.readers.families.sinumerik.interpreter import SinumerikInterpreter
from trunnion.readers.families.sinumerik.own_words import is_own_word
from trunnion.readers.families.sinumerik.settings import VARIABLE, settings_of
from trunnion.readers.families.sinumerik.words import (
    FEED_GROUP,
    G_WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT,
    WITHOUT_PATH_EFFECT_CALLS,
    WITHOUT_PATH_EFFECT_VALUES,
)
from trunnion.readers.program.call_words import CallWords
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.raw_text import NUMBER, raw_words
from trunnion.readers.program.work_offsets import WorkOffsetWords, first_number, g_word

#: G54 to G57 and G505 to G599.
WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G57, or G505 to G599",
    re.compile(r"G(5[4-7]|5(?:0[5-9]|[1-9][0-9]))"),
    first_number,
    g_word,
    lambda n: 53 + n if n <= 4 else 500 + n if n <= 99 else 0,
)

_VALUE: Final = rf"(?:{NUMBER}|[-+]?R[0-9]+)"

#: M40 to M45 choose a gear; what a gear turns at is known to the machine only.
RAW_WORDS: Final = raw_words(
    (r";.*", r'MSG[ \t]*\([ \t]*(?:"[^"]*")?[ \t]*\)'),
    (
        r"N[0-9]+",
        rf"R[0-9]+[ \t]*=[ \t]*{_VALUE}(?:[ \t]*[-+*/][ \t]*{_VALUE})*",
        rf"H[0-9]*=?{NUMBER}",
        r"G(?:0*[0-4]|17|40|5[4-7]|500|50[5-9]|5[1-9][0-9]|70|71|700|710|90|91|9[345]|97)",
        rf"[FS]=?{NUMBER}",
        r"D[0-9]+",
        r"T=?[0-9]+",
        r"M0*(?P<m>[0-9]+)",
        r"(?:STOPRE|TRAORI|TRAFOOF)(?![A-Z_(\[])",
    ),
    range(40, 46),
)

READER: Final = FamilyReader(
    SinumerikInterpreter,
    WITHOUT_PATH_EFFECT
    | WITHOUT_PATH_EFFECT_VALUES
    | WITHOUT_PATH_EFFECT_CALLS
    | {f"G{code}" for code in G_WITHOUT_PATH_EFFECT}
    | {FEED_GROUP},
    WORK_OFFSETS,
    is_own_word,
    comments=rb';[^\n]*|"[^"\n]*"',
    raw_words=RAW_WORDS,
    smoothing=re.compile(r"ORI[A-Z]+|CYCLE832"),
    lost_smoothing={"cycle832": ("CYCLE832", "see setting cycle832=… and tolerance=…")},
    compensation_style=lambda _: SinumerikControl.compensation_style,
    check_reading=settings_of,
    variables=VARIABLE,
    variable_form=str.upper,
    call_words=CallWords(
        rb"(?<![A-Z0-9_$])(L[0-9]{1,9}|[A-Z_]{2}[A-Z0-9_]*)(?![A-Z0-9_])",
        rb"(?<![A-Z0-9_])(?:M[ \t]*0*17(?![0-9.=])|RET(?![A-Z0-9_])|PROC(?![A-Z0-9_]))",
    ),
)
