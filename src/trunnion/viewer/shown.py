"""Records that pages of the viewer and the builder show as lines; ``to_data`` makes their JSON."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any

from trunnion.machines.machine import Vector
from trunnion.model.run import Run
from trunnion.results import Figure, to_data
from trunnion.verification.results import Check


@dataclass(frozen=True, slots=True)
class Mark:
    """Something at a row of a program: an event, what a check, a reader or a simulation finds, or a difference.

    kind  of the event, key of the check, or kind of the finding
    row   of the run, or that before which it stands
    line  in the file of this number
    place in workpiece coordinates, mm; None: it has none
    """

    kind: str
    row: int
    line: int
    file: int
    text: str = ""
    place: Annotated[Vector | None, Figure(is_optional=True)] = None

    @staticmethod
    def at(run: Run, kind: str, row: int, text: str = "", place: Vector | None = None) -> "Mark":
        """Return what stands at the block of a row."""
        line, file = (int(run.line[row]), int(run.file[row])) if len(run) else (0, 0)
        return Mark(kind, row, line, file, text, place)


@dataclass(frozen=True, slots=True)
class _ShownCheck:
    """A check as a page lists it."""

    key: str
    state: str
    summary: str


def checks_data(checks: Iterable[Check]) -> list[dict[str, Any]]:
    """Return checks as a page lists them, for JSON."""
    found: list[dict[str, Any]] = to_data([_ShownCheck(each.key, each.state, each.told) for each in checks])
    return found
