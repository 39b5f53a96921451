"""The simulation of a program while it is posted: what it finds becomes checks of the proof.

In:     what ``trunnion.post`` was given as ``simulation``, the run of the program and its toolpaths.
Out:    the result of the simulation, and its checks.
"""

import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final, TypeAlias

from trunnion.definitions.messages import meant_word
from trunnion.errors import InputError, Problem, Severity, argument_problem, key_subject
from trunnion.jobs.arguments import with_present_names
from trunnion.jobs.inputs.arguments import check_path, checked_angles
from trunnion.jobs.inputs.bodies import fixture_files, fixture_meshes
from trunnion.jobs.inputs.reading import FilePath, as_machine
from trunnion.jobs.inputs.simulation_input import SetupInput, SimulationInput, leaves_stock_to_cl
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.jobs.observer import Observer
from trunnion.jobs.project.file import is_project, read_project
from trunnion.jobs.project.named_files import library_files, project_files
from trunnion.jobs.simulate.result import SimulationResult
from trunnion.jobs.simulate.steps import simulate_setups
from trunnion.machines import Machine
from trunnion.messages import Wording, phrase, word_said
from trunnion.model.clamping import Clamping, are_one_angle, number
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.options.groups import BODIES, CUTTING
from trunnion.options.kinds import FileIn
from trunnion.options.option import Level
from trunnion.simulation.body_names import body_said
from trunnion.simulation.finding import What
from trunnion.simulation.meshes import TriangleMesh, load_mesh
from trunnion.simulation.setup_findings import SimulationFinding
from trunnion.simulation.stock.solids import is_mesh, stock_shape
from trunnion.simulation.turned_parts import as_clamped
from trunnion.verification import Check, Place
from trunnion.wording import position

#: Arguments of ``simulate`` by their names, or the path of a project file.
SimulationLike: TypeAlias = Mapping[str, Any] | FilePath

#: Those that it takes: of the whole simulation, and of its set-up.
_STATED: Final = (*BODIES, *CUTTING)
_WHOLE: Final = tuple(each.name for each in _STATED if each.level is Level.WHOLE)
_OF_SETUP: Final = tuple(each.name for each in _STATED if each.level is not Level.WHOLE)

#: Places that a check keeps.
_MOST_PLACES: Final = 50


def simulation_input(given: SimulationLike, machine: Machine, radius_register: str | None = None) -> SimulationInput:
    """Return what is to be simulated; programs, and how the part is clamped, are known later, as is stock of CL files.

    radius_register  setting of the post, where the project does not state it

    Raises ``InputError`` if it names what is none, or the project has several set-ups or is for another machine.
    """
    given = with_present_names(given) if isinstance(given, Mapping) else {"project": given}
    project = given.get("project")
    stated = {name: value for name, value in given.items() if name != "project"}
    for name in stated:
        if name not in (*_WHOLE, *_OF_SETUP):
            names = ("project", *_WHOLE, *_OF_SETUP)
            near = meant_word(str(name), names)
            raise InputError(
                argument_problem(
                    "simulation",
                    Wording("SIM110", "unknown_but_near", name=repr(name), near=near)
                    if near
                    else Wording("SIM110", "unknown", name=repr(name), known=names),
                )
            )
    stated = {name: value for name, value in stated.items() if value is not None and value != () and value != []}
    if project is None:
        base = SimulationInput("", [SetupInput((), machine)])
    else:
        base = _of_project(check_path("simulation", project), machine, stated)
    own = {name: stated[name] for name in _OF_SETUP if name in stated}
    setup = replace(base.setups[0], machine=machine, **own)
    setup = replace(setup, radius_register=setup.radius_register or radius_register)
    found = replace(base, setups=[setup], **{name: stated[name] for name in _WHOLE if name in stated})
    if isinstance(found.stock, str) and not leaves_stock_to_cl(found.stock) and not is_mesh(found.stock):
        stock_shape(found.stock)  # what cannot be is told before any work
    return found


def simulated_as_clamped(given: SimulationInput, clamping: Clamping) -> SimulationInput:
    """Return what is simulated with a part that is clamped so.

    Raises ``InputError`` if a project states that it is clamped otherwise.
    """
    setup = given.setups[0]
    for name, angle in (("turn", clamping.turn), ("tilt", clamping.tilt)):
        wanted = getattr(setup, name)
        if wanted is not None and not are_one_angle(wanted, angle):
            file, line, key = setup.places[name]
            raise InputError(
                Problem(
                    file,
                    line,
                    Wording(
                        "SIM113", "clamped_otherwise", angle=number(wanted), clamped=number(angle), name=name
                    ).of_key(key),
                    subject=key_subject(key),
                )
            )
    return replace(given, setups=[replace(setup, turn=clamping.turn, tilt=clamping.tilt)])


def simulated_bodies(given: SimulationInput) -> Iterator[tuple[str, TriangleMesh]]:
    """Yield what the program is simulated with: ``stock``, ``part`` and ``fixture``, each with its mesh as clamped.

    Meshes are read again, and nothing is told of them: the simulation has done it.
    """
    turn = Clamping(*checked_angles(given.setups[0].turn, given.setups[0].tilt)).rotation
    for kind, mesh in _drawn_bodies(given):
        yield kind, as_clamped(mesh, turn)


def _drawn_bodies(given: SimulationInput) -> Iterator[tuple[str, TriangleMesh]]:
    setup = given.setups[0]
    yield "stock", stock_shape(given.stock).as_mesh()
    if setup.part is not None:
        yield "part", setup.part if isinstance(setup.part, TriangleMesh) else load_mesh(setup.part)
    yield from (("fixture", mesh) for mesh in fixture_meshes(setup.fixtures, []))


def _of_project(path: Path, machine: Machine, stated: Mapping[str, Any]) -> SimulationInput:
    """Return a project, whose programs are not looked at: the one that is posted is simulated."""
    if not is_project(path):
        raise InputError(Problem(str(path), 0, Wording("SIM112", "no_project_of_simulation")))
    found = read_project(path, ("nc", "machine", *stated))
    if len(found.setups) > 1:
        raise InputError(Problem(str(path), 0, Wording("SIM112", "several_setups", count=len(found.setups))))
    setup = found.setups[0]
    if setup.machine and as_machine(setup.machine).key != machine.key:
        file, line, key = setup.places["machine"]
        raise InputError(
            Problem(
                file,
                line,
                Wording("SIM113", "other_machine", machine=as_machine(setup.machine).key, posted=machine.key).of_key(
                    key
                ),
                subject=key_subject(key),
            )
        )
    asked = set_up_machine(machine, setup.zero, setup.tool_length)
    for name, own, wanted in (
        ("zero", (machine.workpiece_zero, machine.zeros), (asked.workpiece_zero, asked.zeros)),
        ("tool_length", (machine.tool_length, machine.tool_lengths), (asked.tool_length, asked.tool_lengths)),
    ):
        if wanted != own:
            file, line, key = setup.places[name]
            stated = getattr(setup, name)
            value = ",".join(f"{number:g}" for number in stated) if isinstance(stated, tuple) else f"{stated}"
            raise InputError(
                Problem(
                    file,
                    line,
                    Wording(
                        "SIM113",
                        "not_of_the_post" if own == (None, {}) else "other_than_of_the_post",
                        name=name,
                        value=value,
                    ).of_key(key),
                    subject=key_subject(key),
                )
            )
    if setup.until is not None:
        file, line, key = found.places["until"]
        raise InputError(
            Problem(
                file,
                line,
                Wording("SIM113", "only_to_a_block", block=setup.until).of_key(key),
                subject=key_subject(key),
            )
        )
    return replace(found, setups=[replace(setup, zero=None, tool_length=None)])


def simulation_files(given: SimulationLike) -> list[FilePath]:
    """Return the files that a simulation reads, none of which may be written over."""
    given = with_present_names(given) if isinstance(given, Mapping) else {"project": given}
    project = None if given.get("project") is None else check_path("simulation", given["project"])
    named: list[FilePath] = [] if project is None else [project, *project_files([project], ("nc",))]
    for option in (each for each in _STATED if isinstance(each.kind, FileIn)):
        value = given.get(option.name)
        several = [value] if isinstance(value, str | os.PathLike) or not isinstance(value, Iterable) else value
        files = [each for each in several if isinstance(each, str | os.PathLike)]
        leads = getattr(option.kind, "leads", "")
        named += library_files(files) if leads == "library" else fixture_files(files) if leads == "fixture" else files
    return named


def simulate_posted(
    given: SimulationInput, run: Run | None, toolpaths: Sequence[Toolpath], observer: Observer
) -> SimulationResult:
    """Simulate the program that was posted; its run has the names of files as messages call them.

    Raises ``InputError`` if nobody reads it, a file cannot be used, or nothing says the form of a tool.
    """
    if run is None:
        raise InputError(argument_problem("simulation", Wording("SIM115", "program_not_read")))
    setup = replace(given.setups[0], programs=(run,), machine=run.machine, cl=toolpaths, cl_is_turned=True)
    return simulate_setups(replace(given, setups=[setup]), observer)


def simulation_checks(found: SimulationResult) -> tuple[Check, ...]:
    """Return the questions that a simulation answers, as checks of a proof."""
    of_removal = [each for each in found.findings if each.kind not in (What.BODY, What.GOUGE)]
    hits = [each for each in found.findings if each.kind == What.BODY]
    broken = [remark for remark in found.remarks if remark.severity is Severity.ERROR]
    checks = [
        _check(found, "removal", of_removal, broken),
        _check(found, "collision", hits, ()),
    ]
    if found.gouge is not None:
        gouges = [each for each in found.findings if each.kind == What.GOUGE]
        checks.append(_gouge_check(found, gouges))
    return tuple(checks)


def _check(
    found: SimulationResult, key: str, findings: Sequence[SimulationFinding], broken: Sequence[Problem]
) -> Check:
    missing = _cuts_missing(found)
    passed = not findings and not broken
    deepest = max((each.depth for each in findings), default=None)
    answer: Wording | None = None
    if findings:
        worst = max(findings, key=lambda each: each.depth)
        first = min(findings, key=lambda each: each.seconds).first_line
        numbers = {"count": len(findings), "depth": worst.depth, "first": first}
        answer = Wording("removal", "findings", **numbers, worst=_words(worst))
    elif broken:
        answer = broken[0].wording
    elif key == "removal":
        answer = Wording("removal", "good", volume=found.removed)
        for note in (found.stock_said, found.meanings_said):
            answer = answer if note is None else Wording("removal", "with_note", answer=answer, note=note)
    elif found.pairs:
        answer = Wording("collision", "good", pairs=found.pairs)
        if found.not_checked:
            missing = (*missing, phrase("collisions_not_checked", why=found.not_checked))
    else:
        missing = (phrase("no_bodies"),)
    places = (*_places(findings), *(Place(each.line, -1, math.nan, each.wording, code=each.code) for each in broken))
    return Check(key, passed, answer, deepest, 0.0 if key == "collision" else found.limit, "mm", places, missing)


def _gouge_check(found: SimulationResult, findings: Sequence[SimulationFinding]) -> Check:
    assert found.gouge is not None
    largest = found.gouge.largest
    passed = not findings and largest <= found.limit
    missing = {"largest": largest, "volume": found.gouge.volume}
    answer = Wording("gouge", "missing", **missing)
    if found.left is not None and found.left.largest > found.limit:
        answer = Wording("gouge", "missing_and_left", **missing, left=found.left.largest)
    if findings:
        worst = max(findings, key=lambda each: each.depth)
        answer = Wording("gouge", "missing_by", **missing, line=worst.line, count=len(findings))
    return Check("gouge", passed, answer, largest, found.limit, "mm", tuple(_places(findings)), _cuts_missing(found))


def _cuts_missing(found: SimulationResult) -> tuple[Wording, ...]:
    """Return that it is not known what is cut under radius compensation; nothing where it is."""
    why = found.cuts_unknown
    return (phrase("cuts_not_checked", why=why),) if why else ()


def _places(findings: Sequence[SimulationFinding]) -> Iterator[Place]:
    for each in sorted(findings, key=lambda finding: -finding.depth)[:_MOST_PLACES]:
        said = Wording("removal", "finding", what=_words(each), depth=each.depth, place=position(each.place))
        if each.among is not None:
            said = Wording("removal", "in_stretch", finding=said, stretch=each.among)
        yield Place(each.line, each.block, each.depth, said, each.cl_file, each.cl_line if each.cl_file else 0)


def _words(finding: SimulationFinding) -> Wording:
    one, other = map(body_said, finding.between)
    what = phrase("finding_between", kind=word_said(finding.kind), one=one, other=other)
    return what if finding.when is None else phrase("with_skipped", skipped=finding.when, what=what)
