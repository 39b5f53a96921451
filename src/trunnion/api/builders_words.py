"""Warnings of M and H words of the machine's builder that a program has and its definition does not declare.

In:     a program that was run, and the words that the definition of its control states as its own.
Out:    a warning for each word, where it stands first.
"""

from collections.abc import Mapping
from typing import Final

from trunnion.controls import Control
from trunnion.errors import Problem, Severity
from trunnion.model.run import Run

_CODE: Final = "NC225"

#: Words that are told one by one; a program of which there are more is hardly one for this machine.
_MOST_TOLD: Final = 20


def stated_words(control: Control, settings: Mapping[str, str]) -> frozenset[str]:
    """The words that a definition states for coolant, and in settings such as that of rigid tapping."""
    return frozenset((*(f"M{number}" for number in control.coolant.values()), *settings.values()))


def builders_words(run: Run, stated: frozenset[str] = frozenset()) -> list[Problem]:
    """Return the warnings but for words that are stated; the reader has noted each word once."""
    noted = [each for each in run.diagnostics if each.code == _CODE and each.text.partition(" ")[0] not in stated]
    cure = "look it up, and declare it in [control.known]"
    told = [
        Problem(each.file or run.files[0], each.line, each.text, cure, Severity.WARNING, code=_CODE)
        for each in noted[:_MOST_TOLD]
    ]
    if len(noted) > _MOST_TOLD:
        what = f"{len(noted) - _MOST_TOLD} more words belong to the machine"
        cure = "see that the program is for this machine"
        told.append(Problem(run.files[0], noted[_MOST_TOLD].line, what, cure, Severity.WARNING, code=_CODE))
    return told
