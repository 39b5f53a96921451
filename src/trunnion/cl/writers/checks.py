"""What a CL file cannot hold of a toolpath."""

import re
from collections.abc import Iterable, Iterator
from typing import Final

import numpy as np

from trunnion.arrays import Flags
from trunnion.encoding import EncodingDetector
from trunnion.errors import Problem
from trunnion.messages import Wording
from trunnion.model.arcs import ARC_POINT_TOLERANCE
from trunnion.model.toolpath import (
    CutterComp,
    CycleOff,
    CycleOn,
    From,
    Insert,
    LoadTool,
    Message,
    Operation,
    SetMode,
    Stop,
    Toolpath,
    UnknownStatement,
)

_CONTINUATION: Final = re.compile(r"\$[ \t\r]*(?:\$\$[^\n]*)?\n[ \t]*")


def joined(text: str) -> str:
    """Return a statement with its continuation lines as one line."""
    return _CONTINUATION.sub("", text)


def called(operation: Operation) -> str:
    """Return what messages call the tool of an operation: by its name, or by its number where it has none."""
    numbers = (event.number for event in operation.events if isinstance(event, LoadTool) and event.number is not None)
    number = next(numbers, None)
    return f"tool {operation.tool.name or number}" if operation.tool.name or number is not None else "its tool"


def rows_with_own_feed(operation: Operation) -> Flags:
    """(n,) bool: holes of cycles that have a feed, so that the modal one does not count."""
    found = np.zeros(len(operation.moves), np.bool_)
    for event in sorted(operation.events, key=lambda event: event.row):
        if isinstance(event, CycleOn):
            found[event.row :] = any(word in ("MMPM", "MMPR") for word, _ in event.values)
        elif isinstance(event, CycleOff):
            found[event.row :] = False
    return found


def problems_of(toolpath: Toolpath, comments: Iterable[str]) -> list[Problem]:
    """Everything that keeps a toolpath from being written."""
    found = [problem for operation in toolpath.operations for problem in _operation_problems(toolpath.file, operation)]
    texts = {"part name": toolpath.part, **{f"comment {text!r}": text for text in comments}}
    found += [_bad_text(toolpath.file, 0, what) for what, text in texts.items() if not _is_one_line(text)]
    if not toolpath.operations:
        found.append(Problem(toolpath.file, 0, Wording("CL140", "no_operation")))
    return found


def is_detected_as_utf8(toolpath: Toolpath, comments: Iterable[str]) -> bool:
    """Whether a reader detects the texts as UTF-8; a few letters of some alphabets look like Chinese in GBK."""
    texts = [toolpath.part, *comments]
    texts += [text for operation in toolpath.operations for _, _, text in _texts(operation)]
    detector = EncodingDetector()
    detector.add("\n".join(texts).encode())
    return detector.encoding() == "utf-8"


def _operation_problems(file: str, operation: Operation) -> Iterator[Problem]:
    yield from (_bad_text(file, line, what) for line, what, text in _texts(operation) if not _is_one_line(text))
    yield from _arc_problems(file, operation)
    for event in operation.events:
        if isinstance(event, CutterComp) and event.contour:
            yield Problem(file, event.line, Wording("CL910", "points_of_contour", side=event.side))


def _arc_problems(file: str, operation: Operation) -> Iterator[Problem]:
    arcs, moves = operation.arcs, operation.moves
    starts = {event.row: event.tip for event in operation.events if isinstance(event, From)}
    for index, row in enumerate(arcs.row.tolist()):
        start = starts.get(row) or (tuple(moves.tip[row - 1].tolist()) if row else None)
        if start is None:
            yield Problem(
                file, int(moves.line[row]), Wording("CL910", "operation_begins_arc", operation=operation.name)
            )
            continue
        offsets = np.array([start, moves.tip[row]]) - arcs.centre[index]
        across = np.linalg.norm(np.cross(offsets, arcs.normal[index]), axis=1)
        off = float(np.max(np.abs(across - arcs.radius[index])))
        if off > ARC_POINT_TOLERANCE:
            yield Problem(
                file,
                int(moves.line[row]),
                Wording("CL910", "end_arc_lies", off=off, arc_point_tolerance=ARC_POINT_TOLERANCE),
            )


def _texts(operation: Operation) -> Iterator[tuple[int, str, str]]:
    """Line, meaning and content of each text of an operation."""
    yield operation.line, "operation name", operation.name
    yield operation.line, "tool name", operation.tool.name
    for event in operation.events:
        if isinstance(event, Stop | Message | Insert | UnknownStatement):
            text = joined(event.text) if isinstance(event, UnknownStatement) else event.text
            yield event.line, f"text of {type(event).__name__}", text
        elif isinstance(event, SetMode | CycleOn):
            for word in event.words if isinstance(event, SetMode) else event.mode:
                yield event.line, "word", word


def _is_one_line(text: str) -> bool:
    return not any(ord(character) < 32 or ord(character) == 127 for character in text.replace("\t", " "))


def _bad_text(file: str, line: int, what: str) -> Problem:
    return Problem(file, line, Wording("CL910", "line_break_control", subject=what))
