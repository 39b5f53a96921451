"""``trunnion impeller``: an impeller from measured points."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.simulate import simulation_lines
from trunnion.cli.terminal import Terminal
from trunnion.cli.wording import in_words, line
from trunnion.errors import InputError, argument_problem
from trunnion.impeller.impeller import Impeller
from trunnion.impeller.model import ImpellerModel
from trunnion.impeller.solid.making import ImpellerSolid
from trunnion.jobs.impeller.cut import CutStep, ImpellerCut
from trunnion.jobs.impeller.cutting import cut_impeller
from trunnion.jobs.impeller.models import load_impeller, model_impeller, write_impeller_step
from trunnion.jobs.impeller.step_times import setting_for_published
from trunnion.jobs.job import Given
from trunnion.messages import Wording
from trunnion.results import to_data
from trunnion.simulation.meshes import STEP_ENDINGS, TriangleMesh, check_mesh_name, save_mesh
from trunnion.wording import format_duration

#: Width of the facets' errors where none is stated, mm.
_TOLERANCE: Final = 0.01

#: The same of the faces of a STEP file, mm.
_OF_FACES: Final = 0.005

#: Options of the other step.
_OF_CUT: Final = ("machine", "operations", "cell", "settings")
_OF_MODEL: Final = ("tolerance",)


def run(given: Given) -> int:
    """Carry out a step; options of the other one are refused."""
    is_model = given.step == "model"
    wrong = [name for name in (_OF_CUT if is_model else _OF_MODEL) if getattr(given, name) not in (None, [])]
    if wrong:
        raise InputError(
            [argument_problem(name, Wording("ARG130", "not_for_this_step", step=given.step)) for name in wrong]
        )
    return model(given) if is_model else cut(given)


def model(given: Given) -> int:
    """Make an impeller a mesh or a solid, and say how good it is."""
    if given.output is not None:
        check_mesh_name(given.output, STEP_ENDINGS)
        if Path(given.output).suffix.lower() in STEP_ENDINGS:
            return _solid(given)
    tolerance = _TOLERANCE if given.tolerance is None else given.tolerance
    impeller = load_impeller(given.file)
    Terminal().problems(impeller.remarks)
    found = model_impeller(impeller, tolerance=tolerance)
    if given.output is not None:
        save_mesh(found.mesh, given.output, inputs=impeller.definition.files)
    facets = len(found.mesh.faces)
    lines = (
        _head(impeller, found.mesh),
        line("closed_solid", volume=found.volume, facets=facets),
        line("facets_off", deviation=found.deviation, tolerance=tolerance),
    )
    show(given, lambda: _model_data(impeller, found), lines)
    return 0


def _solid(given: Given) -> int:
    """Write a STEP file."""
    tolerance = _OF_FACES if given.tolerance is None else given.tolerance
    impeller = load_impeller(given.file)
    Terminal().problems(impeller.remarks)
    found = write_impeller_step(impeller, given.output, tolerance=tolerance)
    lines = (
        _head(impeller, found.mesh),
        line("valid_solid", volume=found.volume, faces=found.faces, mesh=found.mesh.volume),
        line("faces_off", deviation=found.deviation, tolerance=tolerance),
    )
    show(given, lambda: _model_data(impeller, found), lines)
    return 0


def _model_data(impeller: Impeller, found: ImpellerModel | ImpellerSolid) -> dict[str, object]:
    """Return a model as data."""
    return {"schema": 1, **to_data(impeller), **to_data(found)}


def _head(impeller: Impeller, mesh: TriangleMesh) -> str:
    """Return what it is, and how large."""
    definition = impeller.definition
    low, high = mesh.bounds.tolist()
    size = " x ".join(f"{b - a:.3f}" for a, b in zip(low, high, strict=True))
    variant = "blades_and_size" if impeller.splitter is None else "blades_splitters_and_size"
    return line(variant, name=definition.name, count=definition.number, size=size)


def cut(given: Given) -> int:
    """Machine an impeller; 0 if its program is proven, and what was simulated has no finding."""
    missing = [name for name in ("machine", "output") if getattr(given, name) is None]
    if missing:
        raise InputError(
            [
                argument_problem(
                    name, Wording("ARG130", "missing_machine_of_program" if name == "machine" else "missing_folder")
                )
                for name in missing
            ]
        )
    found = cut_impeller(given.file, **given.arguments("file", "tolerance"), observer=Terminal())
    show(given, lambda: found, _cut_lines(found))
    return 0 if found.passed else 1


def _cut_lines(found: ImpellerCut) -> Iterator[str]:
    """Yield what was made, step by step."""
    for step in found.steps:
        yield _step_line(step)
        yield from _explained_time(step)
    points = sum(step.points for step in found.steps)
    yield line("points_of_file", file=str(found.result.output), count=points)
    if found.simulation is not None:
        yield from simulation_lines(found.simulation)


def _explained_time(step: CutStep) -> Iterator[str]:
    """Yield where the time goes, and what would give the published one."""
    times = step.times
    leads, rest = (format_duration(60.0 * minutes) for minutes in (times.leads, times.rest))
    cuts, metres = format_duration(60.0 * times.cuts), times.cut / 1000.0
    told = {"cuts": cuts, "metres": metres, "feed": step.step.feed, "leads": leads, "rest": rest}
    yield "  " + (
        line("time_explained_in_passes", **told, passes=times.passes)
        if times.passes > 1
        else line("time_explained", **told)
    )
    if other := setting_for_published(step.step, times):
        minutes = format_duration(60.0 * other.minutes)
        told = {"key": other.key, "value": other.value, "time": minutes}
        yield "  " + (line("with_passes", **told, passes=other.passes) if other.passes else line("with_value", **told))


def _step_line(step: CutStep) -> str:
    """Return a step: its operations, its time, and how near the tool comes to the part."""
    count = len(step.seconds)
    time = format_duration(60.0 * step.minutes)
    time = f"{count} x {time}" if count > 1 else time
    parts = [line("step_time", name=step.step.name, count=step.points, time=time)]
    if step.step.published_minutes:
        parts.append(line("published_time", time=format_duration(60.0 * step.step.published_minutes)))
    parts += [in_words(each.said) for each in step.clearance]
    for over, under in step.flanks:
        parts.append(line("flank_off", over=over, under=under))
    if step.programs:
        names = list(dict.fromkeys((step.programs[0].name, step.programs[-1].name)))
        parts.append(
            line("in_program", program=names[0])
            if len(names) == 1
            else line("in_programs", first=names[0], last=names[1])
        )
    return line("listed", parts=tuple(parts))
