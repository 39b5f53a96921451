"""What was found wrong or odd while reading a file, collected until the end."""

from trunnion.errors import InputError, Problem, Severity

#: More problems than this are counted, not listed.
MAX_LISTED = 100


class StatementError(Exception):
    """A statement that cannot be used; the line is added by the one who knows it."""

    def __init__(self, what: str, cure: str) -> None:
        super().__init__(what)
        self.what = what
        self.cure = cure


class Diagnostics:
    """Errors and remarks of one file, of each at most ``MAX_LISTED`` and a count of the rest."""

    def __init__(self, file: str) -> None:
        self.file = file
        self._lists: dict[Severity, list[Problem]] = {severity: [] for severity in Severity}
        self._more = dict.fromkeys(Severity, 0)

    def error(self, line: int, what: str, cure: str = "") -> None:
        """Note something that makes the file unusable."""
        self._add(Problem(self.file, line, what, cure, Severity.ERROR))

    def remark(self, line: int, what: str, cure: str = "") -> None:
        """Note something that the user should know of."""
        self._add(Problem(self.file, line, what, cure, Severity.WARNING))

    def fatal(self, line: int, what: str, cure: str = "") -> InputError:
        """Return all errors so far with this one as an exception: nothing more can be read."""
        self.error(line, what, cure)
        return InputError(self._listed(Severity.ERROR))

    def raise_errors(self) -> None:
        """Raise the errors, if there are any."""
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
        listed = self._lists[problem.severity]
        if len(listed) < MAX_LISTED:
            listed.append(problem)
        else:
            self._more[problem.severity] += 1

    def _listed(self, severity: Severity) -> tuple[Problem, ...]:
        problems = sorted(self._lists[severity], key=lambda problem: problem.line)
        if self._more[severity]:
            problems.append(Problem(self.file, 0, f"and {self._more[severity]} more", "", severity))
        return tuple(problems)
