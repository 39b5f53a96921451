"""Lines of text as a control can read them: letters of its encoding, capitals in comments, and no line too long."""

import re
from collections.abc import Sequence

from trunnion.controls.family_writer import FamilyWriter
from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.output.blocks.block_writer import BLOCK_NUMBER_BYTES
from trunnion.output.program import Program
from trunnion.output.shared.lines import divided_comment
from trunnion.transliteration import lacking


class LineTexts:
    """Makes the lines of a program; ``file`` is where what is wrong comes from."""

    def __init__(self, program: Program) -> None:
        self._control = program.control
        self._family: FamilyWriter = program.control.family
        self._encoding = program.text_form.encoding
        self._capitals = program.effective_setting("comments") == "capitals"

    def whole(self, lines: Sequence[str], file: str, at: int = 0, *, as_they_are: bool) -> list[str]:
        """Return lines that the control can read; long comments continue in the next one.

        They come from a file, at its line ``at`` if that is known.

        Raises ``InputError`` if another line is too long, or has a character that the program's encoding lacks.
        """
        lines = lines if as_they_are else self.spelled(lines, file, at)
        room = self._control.longest_line - BLOCK_NUMBER_BYTES
        family = self._family
        lines = [
            piece
            for line in lines
            for piece in divided_comment(line, room, family.LINE_COMMENTS, family.escape_comment)
        ]
        lines = [self._ended(line) for line in lines]
        for line in lines:
            if len(line.encode()) > room:
                raise InputError(
                    Problem(
                        file,
                        at,
                        Wording(
                            "CTL120",
                            "line_more_bytes",
                            longest_line=self._control.longest_line,
                            control=self._control.name,
                            line=line[:60],
                        ),
                    )
                )
        return lines

    def _ended(self, line: str) -> str:
        """Return a line, with a point behind a character whose last byte the control would take for the continuation
        sign.
        """
        sign = self._control.continued
        if not sign or line.isascii() or line.endswith(sign):
            return line
        return f"{line}." if line.encode(self._encoding).endswith(sign.encode(self._encoding)) else line

    def spelled(self, lines: Sequence[str], file: str, at: int = 0) -> list[str]:
        """Lines of a definition, with values that are spelled already, as the program has them."""
        for line in lines:
            if letter := lacking(line, self._encoding):
                raise InputError(
                    Problem(
                        file,
                        at,
                        Wording(
                            "CTL810",
                            "definition_writes_no",
                            control=self._control.name,
                            line=repr(line),
                            encoding=self._encoding,
                            letter=repr(letter),
                        ),
                    )
                )
        return [self._family.COMMENTS.sub(self._in_capitals, line) for line in lines] if self._capitals else list(lines)

    def _in_capitals(self, comment: re.Match[str]) -> str:
        """Return a comment without small letters, but those whose capital is lacking in the encoding; of ß it is SS."""
        if comment[1] is None:
            return comment[0]
        capitals = ((each, each if each in "µμ" else each.upper()) for each in comment[0])  # M is another unit
        return "".join(
            big if big.isascii() or (len(big) == 1 and not lacking(big, self._encoding)) else small
            for small, big in capitals
        )
