"""Every mistake of a machine's definition at once: of its axes, its control, its words for readers and CL files."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from trunnion.controls import load_control
from trunnion.definitions import Table, in_order
from trunnion.errors import InputError, Problem
from trunnion.jobs.inputs.cl_statements import check_statements
from trunnion.machines import Machine, load_machine, shipped_machines
from trunnion.machines.loading import read_machine
from trunnion.readers import check_reading


def machine_problems(table: Table, key: str) -> list[Problem]:
    """Return every mistake of a machine's definition, in the order of files and lines.

    table  of ``load_table`` or ``load_draft``, unread
    key    short name of the machine
    """

    def fresh() -> Table:
        return Table(table.content, table.path, list(table.problems), sources=table.sources)

    def control() -> Table:
        return fresh().table("control")

    def read_control() -> None:
        """Read the control's part, unless it only names a family."""
        if control().keys() not in ([], ["family"]):
            load_control(control())

    return all_problems(
        (
            lambda: read_machine(fresh(), key),
            read_control,
            lambda: check_reading(stand_in(key, control())),
            lambda: check_statements(stand_in(key, control())),
            lambda: check_statements(read_machine(fresh(), key)),
        ),
        table.sources,
    )


def all_problems(checks: Iterable[Callable[[], object]], sources: Sequence[str] = ()) -> list[Problem]:
    """Return the problems that all checks raise together, each once, those in shipped files last.

    sources  of the definition, as ``in_order`` takes them
    """
    problems: dict[Problem, None] = {}
    for check in checks:
        try:
            check()
        except InputError as error:
            problems |= dict.fromkeys(error.problems)
    return in_order(problems, sources)


def stand_in(file: str, control: Table) -> Machine:
    """Return a machine with a control: what a definition says to readers can be judged although its axes are wrong."""
    return replace(load_machine(shipped_machines()[0]), key=file, name=file, control=control, files=())
