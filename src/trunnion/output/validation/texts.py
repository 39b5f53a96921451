"""Names and texts that the encoding of a program cannot hold, or that fill many lines of it."""

from collections.abc import Iterator
from contextlib import suppress
from typing import Final

from trunnion.errors import InputError, Problem, warning
from trunnion.messages import Wording, phrase
from trunnion.model.toolpath import Insert, Message, Operation, Stop
from trunnion.output.program import Program
from trunnion.output.tool_calls import ToolCalls
from trunnion.transliteration import lacking, spelled

#: A text of more lines is told; its beginning is shown up to this many letters.
_MANY_LINES: Final = 20
_SHOWN: Final = 40


def text_problems(program: Program) -> list[Problem]:
    """Return a warning for each text that is transliterated or long, and an error for one that must stay as it is."""
    encoding, found = program.text_form.encoding, dict[str, Problem]()
    for kind, text, file, line in (*_texts(program), *_settings(program)):
        written = spelled(text, encoding)
        if written != text and text not in found:
            wording = _transliterated(program, kind, text, written)
            found[text] = warning(file, line, wording)
    return [*found.values(), *_long(program), *_called(program), *_inserted(program)]


def _long(program: Program) -> Iterator[Problem]:
    """Texts of messages and stops that fill many lines, each once."""
    told = set[str]()
    for motion in program.motions:
        for event in motion.operation.events:
            text = event.text if isinstance(event, Message | Stop) else ""
            if len(text) <= _MANY_LINES or text in told:
                continue
            told.add(text)
            count = len(program.control.family.comment(text))
            if count > _MANY_LINES:
                shown = repr(f"{text[:_SHOWN]}…")
                wording = Wording("CTL815", "fills_lines", text=shown, count=count)
                yield warning(program.file_of(motion.operation), event.line, wording)


def _transliterated(program: Program, kind: Wording, text: str, written: str) -> Wording:
    """Return what becomes of a text; another encoding helps only where this one lacks a letter, and the control takes
    others.
    """
    said: dict[str, object] = {"kind": kind, "text": repr(text), "written": repr(written)}
    encoding = program.text_form.encoding
    letter = lacking(text, encoding)
    if not letter:
        return Wording("CTL810", "unseen_characters_left_out", **said)
    said |= {"encoding": encoding, "letter": repr(letter)}
    family_only = program.control.family.SETTING_CHOICES.get("encoding")
    return Wording("CTL810", "only_encoding_lacks_letter" if family_only else "encoding_lacks_letter", **said)


def _missing(program: Program, text: str) -> Wording | str:
    encoding = program.text_form.encoding
    letter = lacking(text, encoding)
    return phrase("no", encoding=encoding, letter=repr(letter)) if letter else phrase("characters_nobody_sees")


def _texts(program: Program) -> Iterator[tuple[Wording, str, str, int]]:
    """Yield what is printed of operations: what it is (a phrase), the text, CL file and line."""
    fields = _printed(program)
    lists_tools = program.effective_setting("tool_list") == "on"
    lists_operations = program.effective_setting("operation_list") == "on"
    for motion in program.motions:
        operation = motion.operation
        place = program.file_of(operation), operation.line
        if motion.starts_operation and ("operation" in fields or lists_operations):
            yield phrase("the_operation"), operation.name, *place
        if motion.starts_operation and ("tool_name" in fields or lists_tools):
            yield phrase("the_tool"), operation.tool.name, *place
        if motion.starts_operation and ("tool_holder" in fields or lists_tools):
            yield phrase("the_holder"), operation.tool.holder, *place
        for event in operation.events:
            if isinstance(event, Message | Stop) and event.text:
                yield phrase("the_text"), event.text, place[0], event.line


def _settings(program: Program) -> Iterator[tuple[Wording, str, str, int]]:
    """Yield settings that templates print."""
    fields = _printed(program)
    for values in (program.settings, *program.own_settings.values()):
        for key, text in values.items():
            if key in fields:
                yield phrase("the_setting", name=key), text, program.file, 0


def _printed(program: Program) -> set[str]:
    return {name for template in program.control.templates.values() for name, _ in template.fields()}


def _called(program: Program) -> Iterator[Problem]:
    """Tools that are called by a name which would be another one."""
    calls: dict[str, Operation] = {}
    with suppress(InputError):  # what a tool is called by is another check
        calls = {call: operation for call, _, operation in reversed(ToolCalls(program).calls)}
    for call, operation in calls.items():
        if program.spelled(call) != call:
            yield Problem(
                program.file_of(operation),
                operation.line,
                Wording("CTL820", "tool_called_name", call=call, missing=_missing(program, call)),
            )


def _inserted(program: Program) -> Iterator[Problem]:
    """Texts that go into the program as they are."""
    encoding = program.text_form.encoding
    for motion in program.motions:
        for event in motion.operation.events:
            if isinstance(event, Insert) and (letter := lacking(event.text, encoding)):
                yield Problem(
                    program.file_of(motion.operation),
                    event.line,
                    Wording(
                        "CTL820", "insert_goes_into", event=event.text.strip(), encoding=encoding, letter=repr(letter)
                    ),
                )
