"""What each code of a message, and each check, means: data that ``trunnion explain`` and the docs print.

The files in the folder ``explanations`` of each language of ``trunnion.messages`` hold a table for each code or check:
``title`` is what is wrong in a few words, ``means`` what has been found, ``matters`` what it would do at the machine,
``cure`` what to do about it.
"""

from functools import cache
from typing import Final

from trunnion.messages import ENGLISH, catalogue, said_in
from trunnion.records import dataclass

#: The files in the order of the docs, and what each is about.
SUBJECTS: Final = {
    "arguments": "Arguments and settings",
    "files": "Files",
    "cl": "CL files",
    "definitions": "Definitions",
    "planning": "Planning",
    "controls": "What a control cannot do",
    "projects": "Projects and tests",
    "hooks": "Hooks",
    "programs": "Reading programs",
    "checks": "Checks",
    "capability": "What machines reach, and how exactly",
    "conversion": "Conversion",
    "placing": "Placing parts",
    "simulation": "Simulation, tools and meshes",
    "impeller": "Impellers and curves",
    "twin": "Twin and recordings",
    "pages": "Viewer and builder",
    "batch": "Batches",
}


@dataclass(frozen=True, slots=True)
class Explanation:
    """What a code or a check means.

    code     such as ``CL110``, or the name of a check, such as ``tip``
    subject  what it belongs to, a key of ``SUBJECTS``
    title    in a few words
    means    what has been found
    matters  what it would do at the machine, or to the work
    cure     what to do
    """

    code: str
    subject: str
    title: str
    means: str
    matters: str
    cure: str


@cache
def explanations(language: str = ENGLISH) -> dict[str, Explanation]:
    """Return every code and check with its explanation, in the order of the docs; English where there is no other."""
    found: dict[str, Explanation] = {}
    for subject in SUBJECTS:
        file = f"explanations/{subject}"
        for code, entry in catalogue(ENGLISH, file).items():
            assert code not in found, code
            said = {name: said_in(language, file, code, name) for name in entry}
            found[code] = Explanation(code, subject, **said)
    return found
