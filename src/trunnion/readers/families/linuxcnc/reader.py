"""The reader of LinuxCNC programs."""

import re
from typing import Final

from trunnion.readers.families.linuxcnc.control import PARAMETER, LinuxcncControl, settings_of
from trunnion.readers.families.linuxcnc.interpreter import LinuxcncInterpreter
from trunnion.readers.families.linuxcnc.words import TABLE, is_own_word
from trunnion.readers.program.call_words import CallWords
from trunnion.readers.program.family_reader import FamilyReader
from trunnion.readers.program.raw_text import NUMBER, RS274_COMMENT, RS274_VALUE, raw_words
from trunnion.readers.program.work_offsets import WorkOffsetWords, g_word

#: G54 to G59 are 54 to 59, G59.1 to G59.3 are 591 to 593.
WORK_OFFSETS: Final = WorkOffsetWords(
    "G54 to G59, or G59.1 to G59.3",
    re.compile(r"G(5[4-9])|G59\.([1-3])"),
    lambda numbers: numbers[0] or 590 + (numbers[1] or 0),
    lambda value: f"G{value / 10:g}" if value > 590 else g_word(value),
    lambda n: 53 + n if n <= 6 else 584 + n if n <= 9 else 0,
)

#: Parameters up to 5000 and named ones are the program's. M48 to M53 switch overrides.
RAW_WORDS: Final = raw_words(
    (RS274_COMMENT, r"\([ \t]*(?:MSG|PRINT|DEBUG)[ \t]*,[^()]*\)"),
    (
        r"N[0-9]+",
        rf"#(?:[0-9]{{1,3}}|[1-4][0-9]{{3}}|<[ \t]*[A-Z][A-Z0-9_ ]*>)[ \t]*=[ \t]*{RS274_VALUE}",
        rf"G0*4[ \t]*P{NUMBER}",
        r"G(?:0*[0-3]|17|20|21|40|49|5[4-9]|59\.[123]|80|90|91|9[345])",
        rf"[FS]{NUMBER}",
        r"T[0-9]+",
        rf"M0*(?:6[2-8]|1[0-9]{{2}})(?:[ \t]*[PELQ]{NUMBER})*",
        r"M0*(?P<m>[0-9]+)",
    ),
    range(48, 54),
)

READER: Final = FamilyReader(
    LinuxcncInterpreter,
    TABLE.without_path,
    WORK_OFFSETS,
    is_own_word,
    uses_length_numbers=True,
    raw_words=RAW_WORDS,
    words_of=lambda machine: TABLE.without_path_by(settings_of(machine)[1]),
    compensation_style=lambda _: LinuxcncControl.compensation_style,
    check_reading=settings_of,
    variables=PARAMETER,
    variable_form=str.lower,
    call_words=CallWords(
        rb"^[ \t]*O[ \t]*<?[ \t]*([^>\n\t ]+?)[ \t]*>?[ \t]*call(?![a-z])",
        rb"^[ \t]*O[ \t]*(?:<[^>\n]*>|[0-9]+)[ \t]*endsub(?![a-z])",
        programs=rb"(?<![A-Z])[GXYZABCTSF][ \t]*[-+.#\[0-9]|^[ \t]*O[^\n]*call",
        remarks=rb"\([^()\n]*\)|;[^\n]*",
        bodies=rb"^[ \t]*O[ \t]*(?:<[^>\n]*>|[0-9]+)[ \t]*(?:sub|(endsub))(?![a-z])[^\n]*",
    ),
)
