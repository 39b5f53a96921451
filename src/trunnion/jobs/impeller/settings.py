"""What the steps of an impeller say of themselves in a program: its name, and method and stock of each operation."""

from collections.abc import Iterable, Mapping

from trunnion.controls.definition import Control
from trunnion.impeller.machining import StepPaths
from trunnion.impeller.steps import MachiningStep
from trunnion.model.machining_method import machining_method


def program_settings(control: Control, name: str, stem: str) -> dict[str, str]:
    """Return settings of the run: title, the program's name where it has one, subprograms and TCP where the control has
    them.

    name  of the impeller
    stem  of the file of the main program
    """
    found = {"title": name}
    own_name = control.settings.get("program", "")
    if own_name and not own_name.isdigit():
        found["program"] = stem
    if control.subprograms is not None:
        found["programs"] = "operations"
    if control.tcp:
        found["mode"] = "tcp"  # links are proven clear as straight lines, which a way through home and a plane is not
    return found


def operation_settings(
    steps: Iterable[StepPaths], control: Control, given: Mapping[str, str], own: Mapping[str, Mapping[str, str]]
) -> dict[str, dict[str, str]]:
    """Return settings of single operations, by their names: method and stock, where the control has these settings.

    given  settings that the user has made for all operations: they stay
    own    and those for single ones
    """
    found = {name: dict(values) for name, values in own.items()}
    for one in steps:
        for name in one.names:
            values = {"method": _method(one.step, name), "stock": f"{stock_left(one.step):g}"}
            kept = {key: text for key, text in values.items() if key in control.settings and not given.get(key)}
            found[name] = {**kept, **found.get(name, {})}
    return found


def stock_left(step: MachiningStep) -> float:
    """Return what a step is to leave, mm: the most, where it leaves one allowance on blades and another one on
    the hub.
    """
    return max(step.allowance, step.hub_allowance)


def _method(step: MachiningStep, operation: str) -> str:
    """Return the kind of a step, in words that mean the method of its tolerances and name: what they mean decides a
    mode.
    """
    kind, method = step.kind.upper(), machining_method(operation, step.tolerance, step.tolerance)
    if method == "ROUGH":
        kind = kind.replace("FINISHING", "").replace("FINISH", "").strip()
    return kind if method in kind else f"{method}: {kind}"
