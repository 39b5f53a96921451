"""Reading two programs that are compared, each with the workpiece zero and the tool length that it needs.

In:     both programs, their machines and the arguments of the comparison.
Out:    their runs, and what they stand on.

Without TCP the axes of a program bring the tip to its points with one zero and one length only. Comments of the program
state them, or somebody does. A cut with TCP needs neither.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.control_settings import rapid_feed_of
from trunnion.jobs.inputs.reading import FilePath, as_run
from trunnion.jobs.inputs.stated_setup import LengthLike, ZeroLike, set_up_machine
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.run import Run
from trunnion.placing.program_heads import place_without_tcp
from trunnion.records import dataclass
from trunnion.verification import restore_rapids
from trunnion.verification.comparison import cuts_by_place


@dataclass(frozen=True, slots=True, eq=False)
class ComparedProgram:
    """One of two programs, as it is given; ``names`` are those of the arguments that give it and its subprograms."""

    program: FilePath | Run
    machine: Machine
    subprograms: Sequence[FilePath]
    names: tuple[str, str]

    def run(self, machine: Machine | None = None) -> Run:
        """Return its run, with lines at the feed of rapids as rapids; on another set-up of its machine if given."""
        machine = machine or self.machine
        return restore_rapids(as_run(self.program, machine, self.subprograms, self.names), rapid_feed_of(machine))

    def as_it_says(self, machine: Machine) -> Machine:
        """Return a set-up of its machine with the zero and the length that the program itself states, if any."""
        stated = None if isinstance(self.program, Run) else place_without_tcp(Path(self.program))
        if stated is None:
            return machine
        zero, length = stated
        return replace(machine, workpiece_zero=zero, zeros={}, tool_length=length, tool_lengths={})


@dataclass(frozen=True, slots=True, eq=False)
class BothRuns:
    """Two runs, and the zeros and lengths that their cuts stand on, for who reads the result."""

    one: Run
    two: Run
    stands_on: tuple[str, ...] = ()

    def refuse_unknown(self) -> None:
        """Refuse what nobody can judge: one program has TCP, the other never, and its zero or its length is unknown.

        Raises ``InputError`` of the other one.
        """
        with_tcp = [run.state.tcp.column().any() for run in (self.one, self.two)]
        if with_tcp[0] == with_tcp[1]:
            return
        other = self.two if with_tcp[0] else self.one
        if cuts_by_place(other):
            raise InputError(Problem(other.files[0], 0, Wording("PLC340", "place_of_cuts")))


def read_both(
    one: ComparedProgram, two: ComparedProgram, zero: ZeroLike | None, tool_length: LengthLike | None
) -> BothRuns:
    """Return the runs of both programs.

    zero, tool_length  for both; what a program that needs them states itself comes first. None: only that
    """
    programs = (one, two)
    runs = one.run(), two.run()
    by_place = [cuts_by_place(run) for run in runs]
    if not any(by_place) and zero is None and tool_length is None:
        return BothRuns(*runs)
    given = [set_up_machine(each.machine, zero, tool_length) for each in programs]
    machines = [
        program.as_it_says(machine) if needed else machine
        for program, machine, needed in zip(programs, given, by_place, strict=True)
    ]
    if not all(by_place) and zero is None and tool_length is None:  # one stands on nothing: beside the other then
        source = machines[by_place.index(True)]
        at = by_place.index(False)
        machines[at] = replace(machines[at], workpiece_zero=source.workpiece_zero, tool_length=source.tool_length)
    placed = one.run(machines[0]), two.run(machines[1])
    return BothRuns(
        *placed, tuple(map(_stands_on, (run for run, needed in zip(placed, by_place, strict=True) if needed)))
    )


def _stands_on(run: Run) -> str:
    """Return which zero and which length the cuts of a program stand on."""
    machine, values = run.machine, list[Wording]()
    if machine.zeros:
        values.append(Wording("comparison", "zeros"))
    elif machine.workpiece_zero is not None:
        values.append(Wording("comparison", "zero", values=tuple(f"{value:g}" for value in machine.workpiece_zero)))
    if machine.tool_lengths:
        values.append(Wording("comparison", "lengths"))
    elif machine.tool_length is not None:
        values.append(Wording("comparison", "length", length=machine.tool_length))
    return str(Wording("comparison", "placed", program=run.files[0], values=tuple(values)))
