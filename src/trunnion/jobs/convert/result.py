"""What was converted, as a record for scripts and data."""

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, ClassVar

from trunnion.errors import Problem, Severity
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.result_output import written_text
from trunnion.model.toolpath import Toolpath
from trunnion.records import dataclass
from trunnion.reporting.remarks import remark_data
from trunnion.results import FIRST, Figure
from trunnion.wording import counted


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class ConvertResult:
    """A program, or a CL file, that was converted.

    toolpath  what it makes the tool do
    settings  what it states and a toolpath has no place for, as ``trunnion.post`` takes it
    problems  warnings: what is not carried over; errors: what was not understood and ``force`` overruled
    posted    the program for the other machine with its proof; None: the result is a CL file
    stated    words and variables that the program relies on, with what somebody has stated of them
    output    file of the result; None: it was not written to a file
    """

    SCHEMA: ClassVar[int] = 2

    toolpath: Annotated[
        Toolpath,
        Figure("operations", take=lambda toolpath: len(toolpath.operations), after="output"),
        Figure("points", take=lambda toolpath: sum(len(each.moves) for each in toolpath.operations)),
    ]
    settings: Annotated[Mapping[str, str], Figure(after="points")]
    problems: Annotated[tuple[Problem, ...], Figure("remarks", after="posted", take=remark_data)]
    posted: Annotated[PostResult | None, Figure(after="settings")]
    output: Path | None
    _memory: io.BytesIO | None
    stated: Annotated[tuple[str, ...], Figure(is_optional=True, none=(), after="settings")] = ()

    def __repr__(self) -> str:
        """Return what matters in a notebook."""
        result = counted(len(self.toolpath.operations), "operation") if self.posted is None else repr(self.posted)
        return f"ConvertResult({result})"

    @property
    @Figure(after=FIRST)
    def passed(self) -> bool:
        """Whether all was understood and, with another machine, the program is proven and may run there."""
        understood = all(problem.severity is not Severity.ERROR for problem in self.problems)
        return understood and (self.posted is None or self.posted.passed)

    @property
    def text(self) -> str | None:
        """The CL file or the program; None where it went to a stream."""
        return written_text(self.output, self._memory)
