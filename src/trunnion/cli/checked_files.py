"""``trunnion check`` of files that are no definition of a machine or a control: what they are, and every mistake.

In:     a file.
Out:    what it is in a line, once its loader has read all of it.
"""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final, TypeAlias

from trunnion.cli.wording import part
from trunnion.definitions import LocatedValue, load_table, own_keys
from trunnion.errors import InputError, Problem, Severity
from trunnion.machines.loading import machine_library
from trunnion.messages import Wording
from trunnion.records import dataclass
from trunnion.results import to_data

#: What a file has, and warnings.
_Checked: TypeAlias = tuple[Wording, tuple[Problem, ...]]

#: The line by which a file names its schema.
_SCHEMA: Final = re.compile(r"\s*#:schema \S*trunnion-([a-z]+)\.schema\.json\s*$", re.MULTILINE)

#: Ends of the names of tool libraries of other systems.
_LIBRARIES: Final = (".json", ".fctb", ".fctl", ".tbl", ".tools")


@dataclass(frozen=True, slots=True)
class CheckedFile:
    """A file that was read: of which ``kind`` it is, what it has, and warnings."""

    file: str
    kind: str
    said: Wording
    remarks: tuple[Problem, ...] = ()


def _project(path: Path) -> _Checked:
    from trunnion.jobs.project.file import load_project, read_project

    table = load_table(path, machine_library(), kind="project")
    posts = _has_key(table.content, "cl") and not _has_key(table.content, "programs")  # a typo of output is a mistake
    if not (posts or _has_key(table.content, "output")):
        simulated = read_project(path)
        return part("checked_simulated_project", count=len(simulated.setups)), ()
    found = load_project(path)
    programs = ", ".join(posted.output.name for posted in found.posted if posted is not None)
    return part("checked_project", count=len(found.posted), programs=programs), ()


def _has_key(content: LocatedValue, key: str) -> bool:
    inner = content.value
    if isinstance(inner, dict):
        return key in inner or any(_has_key(each, key) for each in inner.values())
    return isinstance(inner, list) and any(_has_key(each, key) for each in inner if isinstance(each, LocatedValue))


def _tools(path: Path) -> _Checked:
    from trunnion.simulation.tools.library import read_tools

    is_table = path.suffix.lower() == ".tbl"
    # Whatever the unit is, the lines of a table are right or wrong.
    found = read_tools(path, "mm" if is_table else "")
    unknown = Problem(str(path), 0, Wording("SIM175", "unit_not_known"), Severity.WARNING)
    remarks = (unknown,) if is_table else ()
    count = len(found.tools) + len(found.diameters)
    if found.unusable:
        return part("checked_tools_some", count=count, unusable=len(found.unusable)), remarks
    return part("checked_tools", count=count), remarks


def _impeller(path: Path) -> _Checked:
    from trunnion.jobs.impeller.models import load_impeller

    found = load_impeller(path)
    return part("checked_impeller", count=found.definition.number), found.remarks


def _nodes(path: Path) -> _Checked:
    from trunnion.twin.recording.nodes import load_nodes

    return part("checked_nodes", count=len(load_nodes(path).columns)), ()


def _batch(path: Path) -> _Checked:
    from trunnion.batch.jobs_file import load_batch

    return part("checked_batch", count=len(load_batch(path).jobs)), ()


#: How each kind is read, and keys at the top of which one tells it; of the first that has one.
_KINDS: Final[dict[str, tuple[Callable[[Path], _Checked], frozenset[str]]]] = {
    "impeller": (_impeller, frozenset({"hub", "blade"})),
    "batch": (_batch, frozenset({"job"})),
    "nodes": (_nodes, frozenset({"columns", "namespace"})),
    "project": (_project, frozenset({"setup", "simulation", "programs", "output", "stock", "machine"})),
    "tools": (_tools, frozenset({"tool"})),
}

#: Keys that none of these has.
_OF_DEFINITIONS: Final = frozenset({"axis", "spindle", "control", "facts", "workpiece", "family", "templates"})


def checked_file(name: str) -> CheckedFile | None:
    """Read a file of a kind other than machine and control; None if it is none.

    Raises ``InputError`` with every mistake in it.
    """
    kind = _kind(Path(name))
    if kind is None:
        return None
    said, remarks = _KINDS[kind][0](Path(name))
    return CheckedFile(name, kind, said, remarks)


def _kind(path: Path) -> str | None:
    try:
        if not path.is_file():
            return None
        if path.suffix.lower() in _LIBRARIES:
            return "tools"
        stated = _SCHEMA.match(path.read_text(encoding="utf-8-sig"))
        keys = own_keys(path)
    except (InputError, OSError, ValueError):
        return None  # what is wrong is told by the loader of definitions
    if stated is not None and stated[1] in _KINDS:
        return stated[1]
    if keys & _OF_DEFINITIONS:
        return None
    return next((kind for kind, (_, marks) in _KINDS.items() if keys & marks), None)


def checked_data(found: CheckedFile) -> dict[str, Any]:
    """Return it as data."""
    return {"schema": 1, "file": Path(found.file).as_posix(), "kind": found.kind, "text": found.said.what} | {
        "remarks": to_data(found.remarks)
    }
