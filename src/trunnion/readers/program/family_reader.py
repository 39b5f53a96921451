"""What a family of controls contributes to reading: one record, in the module ``reader`` of the family's folder."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from pathlib import Path
from typing import Any

from trunnion.compensation.styles import UNKNOWN_STYLE
from trunnion.machines import Machine
from trunnion.readers.control.iso_m_codes import COOLANTS
from trunnion.readers.program.call_words import CallWords
from trunnion.readers.program.interpreter import Interpreter
from trunnion.readers.program.raw_text import NO_RAW_WORDS, RawWords
from trunnion.readers.program.settings import no_reading
from trunnion.readers.program.subprograms import Subprograms, callable_files
from trunnion.readers.program.work_offsets import WorkOffsetWords
from trunnion.records import dataclass

#: Comments in parentheses, or from a semicolon to the end of the line: languages of the RS274 kind.
RS274_COMMENTS = rb"\([^)\n]*\)|;[^\n]*"


@dataclass(frozen=True, slots=True, eq=False)
class FamilyReader:
    """The reader of one family of controls.

    interpreter          runs a program on a machine
    words_without_path   words, as written without leading zeros, that the path does not depend on
    comments             regular expression of comments and texts, in which words mean nothing
    work_offsets         how programs select work offsets
    uses_length_numbers  programs select the tool length by a number (H); it is the column ``Run.edge``
    raw_words            the words that may stand in raw text
    is_own_word          whether a declared word, in capitals, begins with one that the control has itself
    offsets_of           makes ``work_offsets`` for controls of the family that have other words; None: all have these
    words_of             makes ``words_without_path`` for controls of the family that have other words
    smoothing            regular expression of calls and definitions, besides words, that set how the control follows
                         the path; None: there are none
    lost_smoothing       kind of the event that such a cycle makes -> its name, and the settings that stand for it
    compensation_style   how a control compensates the radius in a plane, a key of ``STYLES``; 0: not known
    check_reading        raises InputError for what is wrong in ``[control.reading]``; by default any key is
    variables            what variables are called of which values can be stated; None: there are none
    variable_form        how a name of a variable is written here that the control reads in small letters and capitals
    call_words           how programs call others; None: none does
    coolants             M codes of coolants that all controls of the family have: ``OFF``, ``FLOOD`` or ``MIST``
    """

    interpreter: type[Interpreter[Any]]
    words_without_path: frozenset[str]
    work_offsets: WorkOffsetWords
    is_own_word: Callable[[str], bool]
    comments: bytes = RS274_COMMENTS
    uses_length_numbers: bool = False
    raw_words: RawWords = NO_RAW_WORDS
    offsets_of: Callable[[Machine], WorkOffsetWords] | None = None
    words_of: Callable[[Machine], frozenset[str]] | None = None
    smoothing: re.Pattern[str] | None = None
    lost_smoothing: Mapping[str, tuple[str, str]] = field(default_factory=dict)
    compensation_style: Callable[[Machine], int] = lambda _: UNKNOWN_STYLE
    check_reading: Callable[[Machine], object] = no_reading
    variables: re.Pattern[str] | None = None
    variable_form: Callable[[str], str] = str
    call_words: CallWords | None = None
    coolants: Mapping[int, str] = field(default_factory=lambda: COOLANTS)

    def variable(self, name: str) -> str:
        """Return how a variable is called of which a value is stated under a name; empty: it is the name of none.

        Letters of the other case count where nothing else is called so: settings are words in small letters.
        """
        if self.variables is None:
            return ""
        form = name if self.variables.fullmatch(name) else self.variable_form(name)
        is_setting = form != name and name.isidentifier() and not name.startswith("_") and not name[1:].isdigit()
        return form if self.variables.fullmatch(form) and not is_setting else ""

    def callable_files(self, files: Iterable[Path]) -> tuple[Path, ...]:
        """Return the files whose names programs can call, the first of each name."""
        return callable_files(files, self.interpreter.suffixes, self.interpreter.prefix)

    def call_name(self, name: str) -> str:
        """Return the name of a file, or of a call, as calls are compared: without folder, ending and prefix."""
        named = Subprograms((), self.interpreter.suffixes, self.interpreter.prefix)
        key = named.key(name)
        bare = name if key is None else key[0]
        return bare if self.call_words is None else self.call_words.name(bare)

    def called(self, text: bytes) -> frozenset[str]:
        """Return the names of what a text calls, as ``call_name`` gives them."""
        return frozenset() if self.call_words is None else frozenset(map(self.call_name, self.call_words.called(text)))
