"""Records that pages of the viewer and the builder show as lines, and what is said of them in the words of who asks."""

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, TypeAlias

from trunnion.errors import Problem
from trunnion.machines.machine import Vector
from trunnion.messages import Wording, Words
from trunnion.model.run import Run
from trunnion.records import dataclass
from trunnion.results import Figure, to_data
from trunnion.verification.results import Check

#: A text of data, or what is said in the words of who asks.
Said: TypeAlias = str | Wording | Problem


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
    text: Said = ""
    place: Annotated[Vector | None, Figure(is_optional=True)] = None

    @staticmethod
    def at(run: Run, kind: str, row: int, text: Said = "", place: Vector | None = None) -> "Mark":
        """Return what stands at the block of a row."""
        line, file = (int(run.line[row]), int(run.file[row])) if len(run) else (0, 0)
        return Mark(kind, row, line, file, text, place)


def said(shown: Any, words: Words) -> Any:
    """Return what a page shows as data for JSON: wordings, problems, checks and marks as they are said.

    shown  mappings and sequences of them, of numbers and texts, and of functions of the words
    """
    match shown:
        case Wording():
            return shown.text("what", words)
        case Problem():
            return replace(shown, file=Path(shown.file).name).line_of_text(words)
        case Check():
            state = shown.state
            return {"key": shown.key, "state": str(state), "said": state.said(words), "summary": shown.said(words)}
        case Mark():
            return to_data(replace(shown, text=said(shown.text, words)))
        case Mapping():
            return {key: said(each, words) for key, each in shown.items()}
        case list() | tuple():
            return [said(each, words) for each in shown]
        case _ if callable(shown):
            return said(shown(words), words)
    return shown


def checks_data(checks: Iterable[Check], words: Words) -> list[dict[str, Any]]:
    """Return checks as a page lists them, for JSON."""
    found: list[dict[str, Any]] = said(list(checks), words)
    return found


def problem_text(problem: Problem, words: Words) -> str:
    """Return what is wrong and how to correct it, with its code: the page shows the place and the severity."""
    line = problem.wording.with_cure()
    return (line.within("with_code", code=problem.code) if problem.code else line).text("what", words)
