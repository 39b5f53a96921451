"""LinuxCNC's tool table: numbers and diameters of tools, and nothing of their form.

A line is ``T3 P3 D10.0 Z+95.2 ;comment``, in the unit of the machine, which is not in the file.
"""

import re
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.simulation.tools.library.library import ToolLibrary, UnusableTool
from trunnion.simulation.tools.sizes import GREATEST

_WORD: Final = re.compile(r"([A-Za-z])([+-]?(?:\d{1,12}(?:\.\d{0,20})?|\.\d{1,20}))", re.ASCII)

#: The number of the tool in a line that is not understood.
_TOOL: Final = re.compile(r"(?<!\S)[Tt](\d{1,9})(?!\S)", re.ASCII)

#: Letters that a line may have: tool, pocket, diameter, offsets of the axes, angles and orientation of a lathe tool.
_LETTERS: Final = frozenset("TPDXYZABCUVWIJQ")


def read_tool_table(file: str, text: str, unit: float) -> ToolLibrary:
    """Return the diameters of a tool table.

    file  for messages
    text  of the table
    unit  mm to a unit of the table

    LinuxCNC skips a line that it does not understand: the tool of such a line cannot be used, and the others can.

    Raises ``InputError`` if no line is one of a tool table, with every mistake and its line.
    """
    diameters: dict[int, float] = {}
    seen: set[int] = set()
    unusable: list[UnusableTool] = []
    for line, content in enumerate(text.split("\n"), 1):
        content = content.partition(";")[0]
        words, fault = _words(content)
        if fault is None and words:
            number, diameter = int(words["T"]), words.get("D", 0.0) * unit
            if number in seen:
                fault = Wording("SIM151", "tool_twice", number=number)
            elif not 0.0 <= diameter <= GREATEST:
                fault = Wording("SIM174", "tool_diameter", number=number, words=words["D"])
            elif diameter:
                diameters[number] = diameter
            seen.add(number)
        if fault is not None:
            called = _TOOL.search(content)
            unusable.append(UnusableTool(int(called[1]) if called else None, "", (Problem(file, line, fault),)))
    if unusable and not seen:
        raise InputError([problem for tool in unusable for problem in tool.problems])
    for tool in unusable:
        diameters.pop(-1 if tool.number is None else tool.number, None)
    return ToolLibrary(file, unusable=tuple(unusable), diameters=diameters)


def _words(line: str) -> tuple[dict[str, float], Wording | None]:
    """Return the words of a line, and what is wrong with it; none of both for an empty one."""
    words: dict[str, float] = {}
    for part in line.split():
        match = _WORD.fullmatch(part)
        letter = match[1].upper() if match else ""
        if not match or letter not in _LETTERS:
            return {}, Wording("SIM174", "no_word", word=part[:40])
        if letter in words:
            return {}, Wording("SIM174", "letter_twice", letter=letter)
        words[letter] = float(match[2])
    if words and ("T" not in words or words["T"] < 0.0 or words["T"] != int(words["T"])):
        return {}, Wording("SIM174", "no_number_of_tool")
    return words, None
