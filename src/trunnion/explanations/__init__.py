"""What each code of a message, and each check, means: data that ``trunnion explain`` and the docs print.

The files of ``library`` hold a table for each code or check: ``title`` is what is wrong in a few words, ``means`` what
has been found, ``matters`` what it would do at the machine, ``cure`` what to do about it.
"""

import tomllib
from dataclasses import dataclass
from functools import cache
from importlib.resources import files
from typing import Final

#: The files of ``library`` in the order of the docs, and what each is about.
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
def explanations() -> dict[str, Explanation]:
    """Return every code and check with its explanation, in the order of the docs."""
    found: dict[str, Explanation] = {}
    for subject in SUBJECTS:
        text = files(__name__).joinpath("library", f"{subject}.toml").read_text(encoding="utf-8")
        for code, entry in tomllib.loads(text).items():
            assert code not in found, code
            found[code] = Explanation(code, subject, **entry)
    return found
