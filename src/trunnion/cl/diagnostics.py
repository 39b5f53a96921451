"""Errors and remarks about a file, collected while it is read."""

from dataclasses import replace

from trunnion.errors import InputError, Problem, Severity, kind_of, warning
from trunnion.messages import Wording

#: More problems than this are counted, not listed.
MAX_LISTED = 100


class StatementError(Exception):
    """A statement that cannot be used; the interpreter of the file adds its line."""

    def __init__(self, wording: Wording) -> None:
        super().__init__(wording)
        self.wording = wording


class Diagnostics:
    """Errors and remarks of one file: at most ``MAX_LISTED`` of each, the first of each further kind, and the number of
    the others.
    """

    def __init__(self, file: str) -> None:
        self.file = file
        self._lists: dict[Severity, list[Problem]] = {severity: [] for severity in Severity}
        self._more = dict.fromkeys(Severity, 0)
        self._repeated: dict[tuple[str, str], int] = {}
        self._kinds = set[tuple[str, ...]]()

    def error(self, line: int, wording: Wording) -> None:
        """Note a problem that makes the file unusable."""
        self._add(Problem(self.file, line, wording))

    def remark(self, line: int, wording: Wording) -> None:
        """Note something that the user should know; what is said of many lines is listed once, with their number."""
        said = wording.what, wording.cure
        times = self._repeated[said] = self._repeated.get(said, 0) + 1
        if times == 1:
            self._add(warning(self.file, line, wording))

    def fatal(self, line: int, wording: Wording) -> InputError:
        """Return this error with all earlier ones as an exception: the file cannot be read any further."""
        self.error(line, wording)
        return InputError(self._listed(Severity.ERROR))

    def nothing_known(self, wording: Wording) -> InputError:
        """Return this error of the whole file as an exception, with the first of the others: they are alike."""
        first = self._listed(Severity.ERROR)[:1]
        return InputError((Problem(self.file, 0, wording), *first))

    def raise_errors(self) -> None:
        """Raise the errors, if there are any.

        Raises ``InputError`` with all of them.
        """
        if self._lists[Severity.ERROR]:
            raise InputError(self._listed(Severity.ERROR))

    @property
    def has_errors(self) -> bool:
        """Whether there was an error."""
        return bool(self._lists[Severity.ERROR])

    @property
    def remarks(self) -> tuple[Problem, ...]:
        """The remarks in the order of their lines."""
        return self._listed(Severity.WARNING)

    def _add(self, problem: Problem) -> None:
        listed, kind = self._lists[problem.severity], (problem.severity, *kind_of(problem.wording))
        if len(listed) < MAX_LISTED or kind not in self._kinds:
            listed.append(problem)
            self._kinds.add(kind)
        else:
            self._more[problem.severity] += 1

    def _with_count(self, problem: Problem) -> Problem:
        times = self._repeated.get((problem.what, problem.cure), 1)
        repeated = problem.severity is Severity.WARNING and times > 1
        return replace(problem, wording=problem.wording.within("repeated", count=times)) if repeated else problem

    def _listed(self, severity: Severity) -> tuple[Problem, ...]:
        problems = sorted(map(self._with_count, self._lists[severity]), key=lambda problem: problem.line)
        if self._more[severity]:
            problems.append(
                Problem(self.file, 0, Wording("CL180", "more", more=self._more[severity]), severity=severity)
            )
        return tuple(problems)
