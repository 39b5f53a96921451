"""``trunnion machines`` and ``trunnion check``."""

from collections.abc import Sequence
from pathlib import Path, PurePath
from typing import Any, Final

from trunnion.cli.checked_files import checked_data, checked_file
from trunnion.cli.controls import control_lines
from trunnion.cli.machine.machine_text import machine_data, machine_lines, machine_list
from trunnion.cli.printing import print_result, tell_problem
from trunnion.cli.results import show
from trunnion.cli.wording import line, problem_line, spoken
from trunnion.controls import load_control
from trunnion.controls.definition_files import is_control_file, load_control_table
from trunnion.controls.loading import shipped_controls, with_control
from trunnion.definitions import load_table
from trunnion.definitions.messages import meant_word
from trunnion.definitions.resolved import resolved_text
from trunnion.definitions.source_lines import LocatedValue
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.describe.controls import describe_control
from trunnion.jobs.describe.definition_checks import all_problems, machine_problems, stand_in
from trunnion.jobs.describe.machines import describe_machine
from trunnion.jobs.inputs.arguments import check_path
from trunnion.jobs.inputs.cl_statements import check_statements
from trunnion.jobs.job import Given
from trunnion.machines import load_machine, shipped_machines
from trunnion.machines.loading import machine_library
from trunnion.messages import Wording
from trunnion.readers import check_reading
from trunnion.results import to_data
from trunnion.schemas import first_line

#: What a list says of a machine.
_OF_LIST: Final = ("key", "name", "description", "axes")


def machines(given: Given) -> int:
    """List the shipped machines, or print one definition as its file has it, or with all that it extends."""
    if given.resolved and not given.name:
        raise InputError(argument_problem("resolved", Wording("ARG130", "resolved_without_machine")))
    if given.name and given.json is not None:
        load_machine(given.name)
        definition = with_control(load_table(given.name, machine_library(), kind="machine"))
        show(given, lambda: _plain_data(definition), [resolved_text(definition, spoken())])
        return 0
    if given.resolved:
        load_machine(given.name)
        table = load_table(given.name, machine_library(), kind="machine")
        print_result(resolved_text(with_control(table), spoken()), end="")
        return 0
    if given.name:
        load_machine(given.name)
        folder = machine_library()
        shipped_file = folder.joinpath(f"{given.name}.toml")
        source = shipped_file if shipped_file.is_file() else Path(given.name)
        text = source.read_text(encoding="utf-8")
        if source is shipped_file:  # the schema of what is saved of it lies beside that
            text = first_line("machine") + text.partition("\n")[2]
        print_result(text, end="")
        return 0
    found = [load_machine(key) for key in shipped_machines()]
    show(given, lambda: to_data(found, only=_OF_LIST), machine_list(found))
    return 0


def check(given: Given) -> int:
    """Validate the definition of a machine with its control, or of a control, and show what it means; or another file.

    Every mistake comes at once.
    """
    if given.program is not None:
        load_machine(given.file)  # which refuses a file of another kind
    other = checked_file(given.file)
    if other is not None:
        _tell(other.remarks)
        show(given, lambda: checked_data(other), [line("file_good_as", file=given.file, what=other.said)])
        return 0
    if given.file in shipped_controls() or is_control_file(Path(given.file)):
        _check_control_file(given.file)
        control = describe_control(given.file)
        _tell(control.remarks)
        good = line("file_good", file=given.file)
        show(given, lambda: control, [good, "", *control_lines(control)])
        return 0
    _check_is_known(given.file)
    key = PurePath(given.file).name.removesuffix(".toml")
    _raise(machine_problems(load_table(given.file, machine_library(), kind="machine"), key))
    found = describe_machine(given.file)
    _tell(found.remarks)
    good = line("file_good", file=given.file)
    if given.program is None:
        show(given, lambda: machine_data(found), [good, "", *machine_lines(found)])
        return 0
    from trunnion.jobs.describe.reading_keys import proposed_reading  # few definitions are checked with a program

    proposal = proposed_reading(check_path("program", given.program), load_machine(given.file))
    show(given, lambda: machine_data(found) | {"reading": proposal.keys}, [good, "", *proposal.lines(spoken())])
    return 0


def _tell(remarks: Sequence[Problem]) -> None:
    for remark in remarks:
        tell_problem(problem_line(remark))


def _raise(problems: Sequence[Problem]) -> None:
    if problems:
        raise InputError(problems)


def _check_control_file(file: str) -> None:
    """Raise every mistake of a control's own file, the words that it declares for readers among them."""
    table = load_control_table(file)
    machine = stand_in(file, table)
    checks = (lambda: load_control(table), lambda: check_reading(machine), lambda: check_statements(machine))
    _raise(all_problems(checks, table.sources))


def _check_is_known(name: str) -> None:
    """Raise ``InputError`` for a name of no shipped definition, and of no file of a kind that is checked."""
    known = [*shipped_machines(), *shipped_controls()]
    if name in known or name.endswith(".toml"):
        return
    if Path(name).exists():
        raise InputError(Problem(name, 0, Wording("DEF140", "nothing_to_check")))
    near = f"{name}.toml" if Path(f"{name}.toml").is_file() else meant_word(name, known)
    raise InputError(
        Problem(
            name,
            0,
            Wording("DEF110", "nothing_shipped_but_near", near=near, known=tuple(known))
            if near
            else Wording("DEF110", "nothing_shipped", known=tuple(known)),
        )
    )


def _plain_data(located: LocatedValue) -> Any:
    """Return the values of a definition, without their places."""
    value = located.value
    if isinstance(value, dict):
        return {key: _plain_data(each) for key, each in value.items()}
    if isinstance(value, list):
        return [_plain_data(each) if isinstance(each, LocatedValue) else each for each in value]
    return value
