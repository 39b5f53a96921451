"""The reader of Fanuc 30i and 31i programs."""

from typing import Final

from trunnion.readers.families.fanuc.interpreter import FanucInterpreter
from trunnion.readers.families.fanuc.settings import VARIABLE, settings_of
from trunnion.readers.families.fanuc.words import TABLE, is_own_word
from trunnion.readers.families.fanuc.work_offsets import WORK_OFFSETS, offsets_of
from trunnion.readers.program.call_words import CallWords
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.raw_text import NUMBER, RS274_COMMENT, RS274_VALUE, raw_words

#: Common variables are the program's; those from 1000 on are the control's. M48 and M49 switch overrides.
#: How many blocks are read ahead (G103) moves nothing, and a control that has another G103 refuses it in the proof.
RAW_WORDS: Final = raw_words(
    (RS274_COMMENT,),
    (
        r"N[0-9]+",
        rf"#(?:[0-9]|[12][0-9]|3[0-3]|1[0-9]{{2}}|[5-9][0-9]{{2}})[ \t]*=[ \t]*{RS274_VALUE}",
        rf"G0*4[ \t]*[PXU]{NUMBER}",
        r"G(?:0*[0-3]|17|20|21|40|49|5[4-9]|69|80|90|91|9[345])",
        r"G103(?:[ \t]*P[0-9]+)?",
        rf"[FS]{NUMBER}",
        r"T[0-9]+",
        r"M0*(?P<m>[0-9]+)",
    ),
    (48, 49),
)

READER: Final = FamilyReader(
    FanucInterpreter,
    TABLE.without_path,
    WORK_OFFSETS,
    is_own_word,
    uses_length_numbers=True,
    raw_words=RAW_WORDS,
    offsets_of=offsets_of,
    words_of=lambda machine: TABLE.without_path_by(settings_of(machine).words),
    compensation_style=lambda machine: settings_of(machine).compensation_style,
    check_reading=settings_of,
    variables=VARIABLE,
    call_words=CallWords(
        rb"(?<![A-Z])(?:M[ \t]*0*98|G[ \t]*0*6[56])(?![0-9.])[^\n]{0,200}?P[ \t]*([0-9]{1,12})(?![.0-9])",
        rb"(?<![A-Z])M[ \t]*0*99(?![0-9])",
        remarks=rb"\([^()\n]*\)",
        numbered=True,
    ),
)
