"""What a verification found, as values; text, HTML and JSON are made of it elsewhere."""

from dataclasses import dataclass

from trunnion.arrays import Floats, Lines
from trunnion.machines import Machine
from trunnion.model.run import Run


@dataclass(frozen=True, slots=True)
class Place:
    """One place of a program: line of the NC file (from 1), N number (-1: none), and line of a CL file (0: none).

    ``value`` is what was found there, in the unit of the check, and ``text`` says it in words.
    """

    nc_line: int
    number: int
    value: float
    text: str
    cl_file: str = ""
    cl_line: int = 0


@dataclass(frozen=True, slots=True)
class Check:
    """One question that was put to a program, and its answer.

    key       stable name, such as ``tip`` or ``travel``; each has a section in docs/checks.md
    title     the question in a few words
    passed    False: the program must not run as it is
    summary   the answer in one line: the worst value, where it is, and what is allowed
    worst     the worst value in ``unit``, None where the check does not measure
    limit     what is allowed, None where nothing is
    places    the worst places, worst first
    """

    key: str
    title: str
    passed: bool
    summary: str
    worst: float | None = None
    limit: float | None = None
    unit: str = ""
    places: tuple[Place, ...] = ()


@dataclass(frozen=True, slots=True)
class OperationRows:
    """The rows ``first`` to ``end`` (left out) of a run that belong to one operation of a CL file.

    What leads to an operation (home, tool change, placing) belongs to it, the way home at last to the last one.
    """

    name: str
    tool: str
    cl_file: str
    first: int
    end: int


@dataclass(frozen=True, slots=True, eq=False)
class Verification:
    """Everything that was found out about one program.

    Columns have one row a motion of ``run``, or none at all if nobody asked for them.

    seconds   (n,)   float64   time that the row takes (``trunnion.verification.kinematics.run_time``)
    tip_feed  (n,)   float64   speed of the tip over the part, mm/min
    cl_line   (n,)   int32     line of the CL file that the row answers to, 0 where there is none

    ``operations`` share the rows among them; none without CL files.
    """

    program: str
    machine: Machine
    run: Run
    checks: tuple[Check, ...]
    seconds: Floats
    tip_feed: Floats
    cl_line: Lines
    operations: tuple[OperationRows, ...] = ()

    @property
    def passed(self) -> bool:
        """Whether every check was passed."""
        return all(check.passed for check in self.checks)
