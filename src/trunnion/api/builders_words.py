"""Warnings of M and H words of the machine's builder that a program has and its definition does not declare.

In:     a program that was run.
Out:    a warning for each word, where it stands first.
"""

from typing import Final

from trunnion.errors import Problem, Severity
from trunnion.model.run import Run

_CODE: Final = "NC225"

#: Words that are told one by one; a program of which there are more is hardly one for this machine.
_MOST_TOLD: Final = 20


def builders_words(run: Run) -> list[Problem]:
    """Return the warnings; the reader has noted each word once."""
    noted = [each for each in run.diagnostics if each.code == _CODE]
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
