"""Arguments that single files would be refused for, one like the other: judged once, before any work."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from trunnion.batch.patterns import pattern_fault
from trunnion.batch.worker_task import Action
from trunnion.errors import InputError, Problem, argument_problem
from trunnion.jobs.convert.converting import check_conversion_settings
from trunnion.jobs.inputs.arguments import check_whole
from trunnion.jobs.post.post_job import prepare
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase
from trunnion.options.words import MOST_TILES
from trunnion.simulation.stock.solids import CL_STOCK, check_cell, is_mesh, stock_shape
from trunnion.simulation.tools.text import parse_tool

#: Diameters for tools that state none, which CL files may state, mm: a tool is wrong if it is with each.
_DIAMETERS: Final = (None, 10.0, 1000.0)


def check_tiles(action: Action, tiles: object) -> int:
    """Judge the number of tasks among which each file of a folder is divided.

    Raises ``InputError`` if there is no such number, or the action is not divided.
    """
    count = check_whole("tiles", tiles, 1)
    if count > MOST_TILES:
        raise InputError(argument_problem("tiles", Wording("ARG140", "is", count=count, most_tiles=MOST_TILES)))
    if count > 1 and action is not Action.SIMULATE:
        raise InputError(argument_problem("tiles", Wording("ARG130", "simulations")))
    return count


def beside_fault(name: str) -> Wording | None:
    """Return what is wrong with the name of a file that goes with each input; None if it can be used.

    >>> beside_fault("{folder}/{stem}.cls"), str(beside_fault("{name}.cls")), str(beside_fault("*.cls"))
    (None, 'has { or } elsewhere than in {folder} and {stem}', 'is a pattern')
    """
    if fault := pattern_fault(name.replace("{folder}/", "", 1) or name):
        return fault
    rest = name.replace("{folder}", "").replace("{stem}", "")
    if "{" in rest or "}" in rest:
        return phrase("braces_elsewhere")
    return phrase("pattern") if "*" in rest or "?" in rest else None


def check_to_cl(said: Mapping[str, Any], machine: Machine | None) -> None:
    """Judge the settings of a conversion to CL files.

    Raises ``InputError`` with what a conversion does not take.
    """
    if machine is not None:
        check_conversion_settings(prepare(machine, said.get("settings")), to_cl=True)


def check_simulation(said: Mapping[str, Any]) -> None:
    """Judge stock, cells and tools of a simulation, as far as that takes no file.

    Raises ``InputError`` with all that is wrong.
    """
    problems: list[Problem] = []
    for text in said.get("tools", ()):
        problems += _tool_faults(str(text))
    stock = str(said["stock"])
    try:
        if stock == CL_STOCK:
            pass  # each file has its own
        elif not is_mesh(stock):
            shape = stock_shape(stock)
            if (cell := said.get("cell")) is not None:
                check_cell(shape, cell)
        elif not Path(stock).is_file():
            problems.append(argument_problem("stock", Wording("FIL110", "names_no_such", stock=stock)))
    except InputError as error:
        problems += error.problems
    if problems:
        raise InputError(problems)


def _tool_faults(text: str) -> tuple[Problem, ...]:
    number = text.partition("=")[0].strip()
    found: list[tuple[Problem, ...]] = []
    for diameter in _DIAMETERS:
        try:
            is_known = diameter is not None and number.isdecimal() and number.isascii() and len(number) < 10
            parse_tool(text, {int(number): diameter} if is_known and diameter is not None else {})
        except InputError as error:
            found.append(tuple(error.problems))
        else:
            return ()
    return found[0]
