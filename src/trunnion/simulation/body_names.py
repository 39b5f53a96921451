"""What results call bodies, in the language of who reads them."""

import re
from typing import Final

from trunnion.messages import Wording, phrase, word_said

#: A part of a tool, and the tool: both are named by the library, where nobody has given the part another name.
_PART_OF_TOOL: Final = re.compile(r"(cutter|shank|holder)( piece \d+)? of (.+)", re.DOTALL)
_TOOL: Final = re.compile(r"tool (\S+)")


def body_said(name: str) -> Wording:
    """Return the name of a body: of a tool or a part of it, of a shipped machine, or as somebody gave it."""
    if found := _PART_OF_TOOL.fullmatch(name):
        part, piece, tool = found.groups()
        number = phrase("piece_of_section", section=word_said(part), number=piece.split()[-1]) if piece else None
        return phrase("section_of_tool", section=number or word_said(part), tool=body_said(tool))
    if found := _TOOL.fullmatch(name):
        return phrase("tool_as_body", name=found[1])
    return word_said(name)
