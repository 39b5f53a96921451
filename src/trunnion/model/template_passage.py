"""Where in a program the text of a template stands that is not Trunnion's own, which its writer knows."""

from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class TemplatePassage:
    """The lines that a template of the user's definition, or a function of theirs, has written at one place.

    file      name of the subprogram they are in, empty for the program itself
    line      of the first, counted from 1
    texts     its lines, as the template printed them
    template  its name
    title     what messages call it: a phrase
    source    file and line where it stands
    """

    file: str
    line: int
    texts: tuple[str, ...]
    template: str
    title: Wording
    source: tuple[str, int]

    def text_at(self, file: str, line: int) -> str | None:
        """Return what stands in a line of a file; None if that is none of these."""
        k = line - self.line
        return self.texts[k] if file == self.file and 0 <= k < len(self.texts) else None
