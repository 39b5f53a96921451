"""What readers find odd in a program."""

from trunnion.errors import Severity
from trunnion.messages import Wording
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """Something in a program that the reader does not know, does not simulate or finds odd; ``line`` counts from 1."""

    line: int
    wording: Wording
    severity: Severity = Severity.ERROR
    file: str = ""

    @property
    def text(self) -> str:
        """What it says, with its cure."""
        return self.wording.with_cure().what

    @property
    def code(self) -> str:
        """Of what kind it is, such as ``NC211``."""
        return self.wording.code

    def __str__(self) -> str:
        """Return ``file:line: severity: text [code]``."""
        code = f" [{self.code}]" if self.code else ""
        return f"{self.file}:{self.line}: {self.severity}: {self.text}{code}"
