"""What a view can show: an NC program, CL files that are posted for it, or a set-up of a project.

In:     files by their names.
Out:    a program that has been run and verified, with its text; the arguments that a project states.
"""

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from trunnion.cl import is_cl_file
from trunnion.cl.sources import cl_sources
from trunnion.controls import load_control
from trunnion.controls.vocabulary import RADIUS_REGISTER_SETTING
from trunnion.encoding import decode
from trunnion.errors import InputError, Problem, warning
from trunnion.jobs.arguments import PostArguments
from trunnion.jobs.inputs.arguments import check_paths, checked_angles, is_stream
from trunnion.jobs.inputs.control_settings import rapid_feed_of
from trunnion.jobs.inputs.hooked import hooked_toolpaths
from trunnion.jobs.inputs.reading import ToolpathLike, as_run, as_toolpaths, cl_reading
from trunnion.jobs.inputs.settings import Settings, as_texts
from trunnion.jobs.inputs.simulation_input import SetupInput
from trunnion.jobs.observer import Observer
from trunnion.jobs.post.posting import post_beside
from trunnion.jobs.project.file import read_project
from trunnion.jobs.project.keys import OF_PROJECT, OF_SETUP
from trunnion.jobs.registry import JOBS
from trunnion.jobs.verify.verifying import verify
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.clamped_toolpaths import stated_clamping
from trunnion.model.clamping import Clamping
from trunnion.model.toolpath import Toolpath
from trunnion.options.words import CL_SETTINGS, FRAME_SETTING
from trunnion.placing.program_heads import stated_place
from trunnion.records import dataclass
from trunnion.simulation.stock.solids import CL_STOCK
from trunnion.verification import Verification, restore_rapids

#: Arguments of a view that a set-up of a project states; and those of the project as a whole.
_VIEWED: Final = {each.name for each in JOBS["view"].options}
_OF_SETUP: Final = tuple(each.name for each in OF_SETUP if each.name in _VIEWED)
_OF_PROJECT: Final = tuple(each.name for each in OF_PROJECT if each.name in _VIEWED)


@dataclass(frozen=True, slots=True, eq=False)
class ViewedProgram:
    """A program that is shown.

    verification  of its run, with columns
    texts         of its files, in the order of the run's
    toolpaths     what it was made from, as far as that is known
    cl_texts      of the CL files among them, by the names that operations have for them
    """

    verification: Verification
    texts: tuple[str, ...]
    toolpaths: Sequence[Toolpath]
    cl_texts: Mapping[str, str]


def view_program(
    files: Sequence[Path],
    machine: Machine,
    *,
    given: Mapping[str, Any],
    settings: Settings | None,
    observer: Observer,
) -> ViewedProgram:
    """Read and verify a program, or post CL files as one, also where it must not run: its head then says why.

    Raises ``InputError`` when a file cannot be used, no reader knows the control, or CL files and NC programs stand
    together.
    """
    subprograms, hooks = check_paths("subprograms", given["subprograms"]), check_paths("hooks", given["hooks"])
    are_cl = [is_cl_file(file) for file in files]
    if any(are_cl):
        if not all(are_cl):
            other = files[are_cl.index(False)]
            raise InputError(Problem(str(other), 0, Wording("PAG112", "no_cl_file_as_others")))
        stated: PostArguments = {
            "settings": _with_register(settings, given["radius_register"]),
            "subprograms": subprograms, "hooks": hooks, "strict": given["strict"],
        }  # fmt: skip
        return _posted(files, machine, stated, observer)
    cl, texts_of_settings = given["cl"], as_texts(settings)
    if not {*CL_SETTINGS, FRAME_SETTING}.issuperset(texts_of_settings) or (texts_of_settings and not cl):
        raise InputError(Problem(str(files[0]), 0, Wording("PAG111", "settings_for_program")))
    others = [*files[1:], *subprograms]
    run = restore_rapids(as_run(files[0], machine, others), rapid_feed_of(machine))
    unused = [file for file in files[1:] if str(file) not in run.files]
    if unused:
        raise InputError(Problem(str(unused[0]), 0, Wording("PAG113", "never_called", program=files[0].name)))
    read = as_toolpaths(cl, observer, cl_reading(texts_of_settings, given["strict"]))
    toolpaths = hooked_toolpaths(read, machine, hooks)
    verification = verify(
        run, machine=machine, cl=toolpaths, radius_register=given["radius_register"], observer=observer
    )
    observer.problems([Problem(each.file, each.line, each.wording) for each in run.errors])
    texts = tuple(decode(Path(file).read_bytes(), run.encoding) for file in run.files)
    return ViewedProgram(verification, texts, toolpaths, _cl_texts(cl))


def _with_register(settings: Settings | None, radius_register: str | None) -> Settings | None:
    """Return the settings of a post, with what its registers of the radius hold where that is stated."""
    return {**as_texts(settings), RADIUS_REGISTER_SETTING: radius_register} if radius_register else settings


def bodies_not_clamped_so(file: Path, toolpaths: Sequence[Toolpath]) -> list[Problem]:
    """Return a warning where a program is for a part that is clamped turned: a view shows bodies as they are given."""
    stated = stated_clamping(toolpaths) if is_cl_file(file) else stated_place(file).clamping
    if stated is None or stated.is_as_drawn:
        return []
    return [warning(str(file), 0, Wording("PAG116", "bodies_clamped_otherwise", clamping=stated))]


def _posted(files: Sequence[Path], machine: Machine, stated: PostArguments, observer: Observer) -> ViewedProgram:
    result = post_beside(files, machine, {**stated, "force": True}, observer=observer)
    text = result.text
    if result.verification is None or text is None:
        raise InputError(Problem(str(files[0]), 0, Wording("PAG114", "control_without_reader")))
    name = f"{files[0].stem}{load_control(machine.control).extension}"
    run = result.verification.run
    verification = replace(result.verification, program=name, run=replace(run, files=(name, *run.files[1:])))
    more = tuple(decode(Path(file).read_bytes(), run.encoding) for file in run.files[1:])
    return ViewedProgram(verification, (text, *more), result.toolpaths, _cl_texts(files))


def _cl_texts(cl: ToolpathLike | Iterable[ToolpathLike]) -> dict[str, str]:
    """Return the texts of CL files that are named, also of those in archives; a stream has been read and has none."""
    named = [cl] if isinstance(cl, str | os.PathLike | Toolpath) or is_stream(cl) else cl
    paths = [Path(each) for each in named if isinstance(each, str | os.PathLike)]
    return {source.name: decode(source.open().read()) for path in paths for source in cl_sources(path)}


def of_project(path: Path, setup: str | None, given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the arguments of a view that a project states for one of its set-ups, with those that are given instead.

    path   the project
    setup  name or number of the set-up, from 1; None: the only one
    given  arguments of ``trunnion.write_view``; empty ones are not given

    Raises ``InputError`` if the project cannot be read, or does not have the set-up, or it has several programs.
    """
    stated = {name: value for name, value in given.items() if value not in (None, (), [], "")}
    project = read_project(path, tuple(stated))
    chosen, number = _setup(path, project.setups, setup)
    programs = list(chosen.programs)
    if Clamping(*checked_angles(chosen.turn, chosen.tilt)).is_turned:
        raise InputError(
            Problem(
                str(path),
                0,
                Wording("PAG115", "clamped_turned_in_setup", setup=chosen.name)
                if chosen.name
                else Wording("PAG115", "clamped_turned"),
            )
        )
    if len(programs) != 1:
        raise InputError(
            Problem(
                str(path),
                0,
                Wording("PAG112", "several_programs_in_setup", count=len(programs), setup=chosen.name)
                if chosen.name
                else Wording("PAG112", "several_programs", count=len(programs)),
            )
        )
    found = {name: getattr(chosen, name) for name in _OF_SETUP} | {name: getattr(project, name) for name in _OF_PROJECT}
    if number:  # what an earlier set-up leaves is known to the simulation of all of them only
        found |= dict.fromkeys(_OF_PROJECT)
    found["stock"] = found["stock"] or (None if number else CL_STOCK)
    return {**given, **found, **stated, "nc": programs}


def _setup(path: Path, setups: Sequence[SetupInput], wanted: str | None) -> tuple[SetupInput, int]:
    names = [each.name or str(number) for number, each in enumerate(setups, 1)]
    if wanted is None and len(setups) > 1:
        raise InputError(
            Problem(str(path), 0, Wording("PAG112", "several_setups", count=len(setups), names=tuple(names)))
        )
    for number, (each, name) in enumerate(zip(setups, names, strict=True)):
        if wanted in (None, name, str(number + 1)):
            return each, number
    raise InputError(Problem(str(path), 0, Wording("PAG112", "no_such_setup", wanted=wanted, names=tuple(names))))
