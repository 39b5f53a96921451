"""Notices at the head of a program that hold for every program that is made of it.

In:     the head of a program, and its toolpath, in which comments have become messages.
Out:    both without these notices, and their texts for the head of another program.
"""

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from trunnion.controls.family_writer import FamilyWriter
from trunnion.controls.vocabulary import ENTRY_NOTICE, FORCED_NOTICE, HOOKS_NOTICE
from trunnion.model.clamping_notices import PLACED_NOTICES, head_comments
from trunnion.model.toolpath import Message, Operation, Toolpath

_OF_HEADS: Final = (FORCED_NOTICE, HOOKS_NOTICE, *PLACED_NOTICES)

#: What stands around the text of a comment.
_AROUND: Final = "();{} "


def take_notices(toolpath: Toolpath, family: FamilyWriter) -> tuple[Toolpath, tuple[str, ...]]:
    """Return a toolpath without the notices of hooks that changed its motion, and these notices.

    ``family`` is that of the program's control: it says where long comments go on in the next line.
    """
    found = dict[str, None]()
    operations = []
    for operation in toolpath.operations:
        taken = set[int]()
        for messages, text in _notices(operation, family):
            taken.update(map(id, messages))
            found[text] = None
        events = tuple(event for event in operation.events if id(event) not in taken)
        operations.append(replace(operation, events=events) if taken else operation)
    return replace(toolpath, operations=tuple(operations)), tuple(found)


def with_whole_notices(toolpath: Toolpath, family: FamilyWriter) -> Toolpath:
    """Return a toolpath with each notice of hooks as one message, as a post takes it from a CL file."""
    operations = []
    for operation in toolpath.operations:
        whole = dict[int, Message | None]()
        for messages, text in _notices(operation, family):
            whole |= dict.fromkeys(map(id, messages[1:]))
            whole[id(messages[0])] = replace(messages[0], text=text)
        events = tuple(kept for event in operation.events if (kept := whole.get(id(event), event)) is not None)
        operations.append(replace(operation, events=events) if whole else operation)
    return replace(toolpath, operations=tuple(operations))


def _is_notice(event: object) -> bool:
    if not isinstance(event, Message) or event.display:
        return False
    return event.text.strip().upper().startswith(HOOKS_NOTICE)


def without_notices(lines: Iterable[tuple[int, str]], family: FamilyWriter) -> list[tuple[int, str]]:
    """Return the lines of a head, by their numbers, without those that are notices of this program, and no title."""
    lines = list(lines)
    taken = {*_lines_of(lines, _OF_HEADS, family), *entry_lines(lines, family)}
    return [(number, text) for number, text in lines if number not in taken]


def entry_lines(lines: Iterable[tuple[int, str]], family: FamilyWriter) -> set[int]:
    """Return the lines of a head that say what the operator enters for radius compensation, by their numbers."""
    return _lines_of(head_comments(lines), (ENTRY_NOTICE.upper(),), family)


def _lines_of(lines: Iterable[tuple[int, str]], beginnings: tuple[str, ...], family: FamilyWriter) -> set[int]:
    """Return the numbers of lines that have one of some capitals, and of those that go on with them."""
    found, notice = set[int](), ""
    for number, text in lines:
        own = text.strip(_AROUND)
        begins = any(each in text.upper() for each in beginnings)
        notice = own if begins else notice and _joined(notice, own, family)
        if notice:
            found.add(number)
    return found


def _notices(operation: Operation, family: FamilyWriter) -> list[tuple[list[Message], str]]:
    """Return the messages that are notices, each with those that go on with it, and the text of all of them."""
    notices: list[tuple[list[Message], str]] = []
    for message in operation.events:
        if not isinstance(message, Message) or message.display:
            continue
        text = message.text.strip()
        if _is_notice(message):
            notices.append(([message], text))
        elif notices and message.line == notices[-1][0][-1].line + 1:
            messages, before = notices[-1]
            if joined := _joined(before, text, family):
                notices[-1] = ([*messages, message], joined)
    return notices


def _joined(before: str, after: str, family: FamilyWriter) -> str:
    """Return the text of two comments if the second goes on with the first, as the family would write it; else
    empty.
    """
    written = [_text(line) for line in family.comment(before)]
    for between in ("", " "):
        lines = [_text(line) for line in family.comment(before + between + after)]
        if len(lines) > len(written) and lines[: len(written)] == written:
            return before + between + after
    return ""


def _text(comment: str) -> str:
    return comment.strip(_AROUND)
