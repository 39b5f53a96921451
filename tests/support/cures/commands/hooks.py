"""Cures of messages about hooks: files of Python that change CL files."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569 --hooks shop.py"
_HEAD: Final = "from dataclasses import replace\\nfrom trunnion.hooks import *\\n"
_IN_PLACE: Final = "feed = operation.moves.feed; feed.setflags(write=True); feed *= 0.8"


def _file(message: str, text: str, old: str, new: str) -> Cure:
    """A file of hooks with which a file is posted, and what stands in place of a part of it."""
    code = text.replace("\n", "\\n")
    return script(message, f'write shop.py "{_HEAD}{code}\\n"\n{_POST}', old.replace("\n", "\\n"), new)


def _on(message: str, hook: str, given: str, old: str, new: str) -> Cure:
    """A hook that returns something, and what it returns in place of it."""
    return _file(message, f"def on_{hook}({hook}, context):\n    return {given}", old, new)


def _at(message: str, place: str, given: str, old: str, new: str) -> Cure:
    """A function at a place of output that returns something, and what it returns in place of it."""
    return _file(message, f"def at_{place}(place):\n    return {given}", old, new)


_KNIFE: Final = f"write shop.py 'def at_retract(place):\\n    return \";刀\"\\n'\n{_POST} --set encoding=latin-1"
_CYCLE: Final = "CYCLE/DRILL,FEDTO,-9,RAPTO,3,MMPM,99\\nGOTO/50,0,0\\nCYCLE/OFF\\nEND-OF-PATH"


CURES: Final = (
    script("HOK110 no_python_file",
           f"write shop.txt 'def on_block(block, context):\\n    return None\\n'\n{_POST[:-2]}txt",
           "shop.txt", "shop.py"),
    _file("HOK110 file_no_hooks", "x = 5", "x = 5", "def on_block(block, context):\\n    return None"),
    _file("HOK110 no_hook", "def on_zzzzzzz(block, context):\n    return None", "on_zzzzzzz", "on_block"),
    _file("HOK110 no_hook_but_near", "def on_blok(block, context):\n    return None", "on_blok", "on_block"),
    _file("HOK110 takes_other_arguments", "def on_block(block):\n    return None", "(block)", "(block, context)"),
    _file("HOK120 file_fails", "x = 1 / 0\ndef on_block(block, context):\n    return None", "1 / 0", "1"),
    _file("HOK120 file_fails", "x = 1 / 0\ndef on_block(block, context):\n    return None", " --hooks shop.py", ""),
    _on("HOK120 function_fails", "block", "1 / 0", "1 / 0", "None"),
    _on("HOK120 function_fails", "block", "1 / 0", " --hooks shop.py", ""),
    _on("HOK130 value_type", "event", "5", "return 5", "return None"),
    _on("HOK130 value_type", "event", "5", "return 5", "return [event]"),
    _on("HOK130 no_event", "operation", "replace(operation, events=(*operation.events, 77))",
        "77", "Message(0, 0, 'A')"),
    _on("HOK130 operation_type", "operation", "replace(operation, moves=5)", "moves=5", "moves=operation.moves"),
    _on("HOK132 event_row", "operation", "replace(operation, events=(*operation.events, Message(999, 0, 'A')))",
        "999", "2"),
    _on("HOK132 event_row_block", "block", "Message(block.row + 2, 0, 'A')", "block.row + 2", "block.row"),
    _on("HOK132 event_row_block", "block", "Message(block.row + 2, 0, 'A')", "block.row + 2", "block.row + 1"),
    _on("HOK132 with", "block", "Message(block.row, 0, 'A' + chr(10) + 'B')", " + chr(10)", ""),
    _on("HOK132 operation", "operation",
        "replace(operation, moves=replace(operation.moves, feed=operation.moves.feed[:1]))",
        "operation.moves.feed[:1]", "operation.moves.feed * 0.8"),
    _file("HOK135 changes_operation_place", f"def on_operation(operation, context):\n    {_IN_PLACE}", _IN_PLACE,
          "return replace(operation, moves=replace(operation.moves, feed=operation.moves.feed * 0.8))"),
    script("PLN620 step_number_below", "edit part.cls END-OF-PATH "
           "'CYCLE/DRILL,DEEP,FEDTO,-9,RAPTO,3,STEP,4,1,1,MMPM,99\\nGOTO/50,0,0\\nCYCLE/OFF\\nEND-OF-PATH'\n"
           f"write shop.py \"{_HEAD}def on_event(event, context):\\n    if isinstance(event, CycleOn):\\n"
           "        return replace(event, values=(*event.values[:2], ('STEP', (4.0, -1.0, 1.0)), *event.values[3:]))\\n"
           f"    return event\\n\"\n{_POST} --set cycles=off", "-1.0, 1.0", "1.0, 1.0"),
    _at("HOK170 place_type", "retract", "5", "return 5", "return None"),
    _at("HOK170 place_type", "retract", "5", "return 5", "return replace(place, lines=(';A',))"),
    _at("HOK170 other_value", "retract", "replace(place, name='A')", "name='A'", "lines=(';A',)"),
    _at("HOK170 many_lines", "retract", "[';A'] * 2000", "2000", "1000"),
    _at("HOK170 long_line", "retract", "';' + 'A' * 2000", "2000", "20"),
    _at("HOK170 control_character", "retract", "[';A' + chr(10) + ';B']", " + chr(10) + ", ", "),
    _at("HOK170 no_words_here", "retract", "{'X': 1}", "{'X': 1}", "';A'"),
    _at("HOK170 word_name", "linear", "{1: place.words['feed']}", "{1:", "{'feed':"),
    _at("HOK170 word_value", "linear", "{'feed': 'A'}", "'A'", "place.words['feed']"),
    _at("HOK170 unknown_word", "linear", "{'Q': place.words['feed']}", "'Q'", "'feed'"),
    _at("HOK170 unknown_word", "linear", "{'Q': None}", "'Q'", "'turns'"),
    _at("HOK170 unknown_word", "linear", "{'feeed': None}", "'feeed'", "'turns'"),
    _at("HOK170 word_beyond", "linear", "{'feed': 999999999}", "999999999", "place.words['feed']"),
    script("HOK170 letter_lacking",
           _KNIFE, "刀", "A"),
    script("HOK170 letter_lacking",
           _KNIFE,
           "encoding=latin-1", "encoding=utf-8"),
    script("HOK170 no_cycle", f"edit part.cls END-OF-PATH '{_CYCLE}'\n"
           f"write shop.py 'def at_cycle(place):\\n    return {{\"RAPTO\": -3.0}}\\n'\n{_POST}", "-3.0", "3.0"),
    _on("HOK160 hooks_leave_out", "operation", "[]", "[]", "None"),
)  # fmt: skip
