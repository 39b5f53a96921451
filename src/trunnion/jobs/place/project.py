"""A set-up of a project as it is placed."""

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from typing import Literal

from trunnion.errors import InputError, Problem, argument_problem, warning
from trunnion.jobs.inputs.arguments import checked_angles
from trunnion.jobs.inputs.bodies import MeshLike, read_mesh
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.settings import SettingValue
from trunnion.jobs.inputs.simulation_input import SimulationInput, leaves_stock_to_cl
from trunnion.jobs.place.bodies import BodiesInput, stock_mesh
from trunnion.jobs.project.file import load_project
from trunnion.jobs.project.named_files import project_inputs
from trunnion.jobs.project.project import PostedSetup, Project
from trunnion.messages import Wording
from trunnion.model.clamping import Clamping
from trunnion.records import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class PlacedSetup:
    """What a project states of the part that is placed; all as ``trunnion.place`` takes it.

    read      all files that the project leads to, none of which may be written over
    problems  warnings: what of it does not count here
    bodies    stock, part, fixtures and tools, as they lie in the workpiece frame of the set-up; the stock as it is
              before the first one
    """

    files: tuple[str, ...]
    machine: str
    settings: Mapping[str, SettingValue]
    read: tuple[FilePath, ...]
    problems: tuple[Problem, ...] = ()
    bodies: BodiesInput = field(default_factory=BodiesInput)


def placed_setup(project: Path, name: str | None = None, *, has_zero: bool = False) -> PlacedSetup:
    """Return the CL files, the machine, the settings of a set-up, the zero among them, and what is clamped and cuts
    there.

    has_zero  the zero of the part as it is drawn is given, in place of the project's

    Raises ``InputError`` if the project cannot be read, has hooks, or it is not clear which set-up is meant.
    """
    loaded = load_project(project)
    if loaded.hooks:
        raise InputError(Problem(str(project), 0, Wording("PLC160", "project_with_hooks")))
    setup = _setup(loaded, project, name)
    settings = dict(setup.settings)
    angles, problems = checked_angles(*setup.angles), list[Problem]()
    if Clamping(*angles).is_turned and settings.pop("zero", None) is not None and not has_zero:
        problems.append(warning(str(project), 0, Wording("PLC330", "zero_of_turned_part", clamping=Clamping(*angles))))
    bodies = _bodies(loaded.simulation, loaded.posted.index(setup), problems)
    return PlacedSetup(setup.cl, setup.machine, settings, tuple(project_inputs(loaded)), tuple(problems), bodies)


def _bodies(given: SimulationInput, number: int, problems: list[Problem]) -> BodiesInput:
    """Return what stands on the table in a set-up of a project: as poses have brought it there, not yet turned."""
    own = given.setups[number]
    stock: MeshLike | None = given.stock or None
    if number and leaves_stock_to_cl(stock):
        stock = None  # which the CL files of another set-up state
    part: MeshLike | None = None
    for k, setup in enumerate(given.setups[: number + 1]):
        pose = setup.pose if k else None
        if pose is not None:
            stock = None if stock is None else stock_mesh(stock, problems).moved(pose.matrix)
            part = None if part is None else read_mesh(part, "part", problems).moved(pose.matrix)
        part = part if setup.part is None else setup.part
    unit: Literal["mm", "inch"] | None = "mm" if own.unit == "mm" else "inch" if own.unit == "inch" else None
    return BodiesInput(tuple(own.fixtures), part, stock, tuple(own.tools), own.tool_libraries, unit)


def _setup(loaded: Project, project: Path, name: str | None) -> PostedSetup:
    """Return the set-up of a name, or the only one."""
    found = [each for each in loaded.setups if name is None or each.name == name]
    if len(found) == 1:
        return found[0]
    names = tuple(each.name for each in loaded.setups)
    if name is None:
        raise InputError(Problem(str(project), 0, Wording("PLC170", "several_setups", count=len(found), names=names)))
    raise InputError(argument_problem("setup", Wording("PLC170", "no_such_setup", wanted=repr(name), names=names)))
