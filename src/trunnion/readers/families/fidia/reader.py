"""The reader of Fidia NC15 programs."""

import re
from typing import Final

from trunnion.readers.families.fidia.control import settings_of
from trunnion.readers.families.fidia.interpreter import FidiaInterpreter
from trunnion.readers.families.fidia.words import OFFSET_BASE, TABLE
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.raw_text import NUMBER, RS274_COMMENT, raw_words
from trunnion.readers.program.work_offsets import WorkOffsetWords

#: G55 with the number of the offset; the column counts from 501.
WORK_OFFSETS: Final = WorkOffsetWords(
    "G55 O1 to G55 O99",
    re.compile(r"G55 O([0-9]{1,2})"),
    lambda numbers: OFFSET_BASE + numbers[0] if numbers[0] else 0,
    lambda value: f"G55 O{value - OFFSET_BASE}",
    lambda n: OFFSET_BASE + n if n <= 99 else 0,
)

RAW_WORDS: Final = raw_words(
    (RS274_COMMENT,),
    (
        r"N[0-9]+",
        r"G(?:0*[0-3]|17|40|70|71|80|90|91)",
        rf"[FS]{NUMBER}",
        r"M0*(?P<m>[0-9]+)",
    ),
)

READER: Final = FamilyReader(
    FidiaInterpreter,
    TABLE.without_path,
    WORK_OFFSETS,
    TABLE.is_own,
    raw_words=RAW_WORDS,
    words_of=lambda machine: TABLE.without_path_by(settings_of(machine).words),
    check_reading=settings_of,
)
