"""``trunnion impeller``: an impeller from measured points."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.simulate import simulation_lines
from trunnion.cli.terminal import Terminal
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
from trunnion.wording import counted, format_duration

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
        f"volume {found.volume:.1f} mm³, {facets} facets, a closed solid",
        f"facets are at most {found.deviation:.4f} mm off the exact surfaces, {tolerance:g} mm were asked",
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
        f"volume {found.volume:.1f} mm³, {found.faces} faces, a valid closed solid; its mesh has "
        f"{found.mesh.volume:.1f} mm³",
        f"faces are at most {found.deviation:.4f} mm off the exact surfaces, {tolerance:g} mm were asked",
    )
    show(given, lambda: _model_data(impeller, found), lines)
    return 0


def _model_data(impeller: Impeller, found: ImpellerModel | ImpellerSolid) -> dict[str, object]:
    """Return a model as data."""
    return {"schema": 1, **to_data(impeller), **to_data(found)}


def _head(impeller: Impeller, mesh: TriangleMesh) -> str:
    """Return what it is, and how large."""
    definition = impeller.definition
    splitters = "" if impeller.splitter is None else f" and {definition.number} splitters"
    low, high = mesh.bounds.tolist()
    size = " x ".join(f"{b - a:.3f}" for a, b in zip(low, high, strict=True))
    return f"{definition.name}: {definition.number} blades{splitters}, {size} mm"


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
    yield f"{found.result.output}: {counted(sum(step.points for step in found.steps), 'point')}"
    if found.simulation is not None:
        yield from simulation_lines(found.simulation)


def _explained_time(step: CutStep) -> Iterator[str]:
    """Yield where the time goes, and what would give the published one."""
    times = step.times
    leads, rest = (format_duration(60.0 * minutes) for minutes in (times.leads, times.rest))
    passes = f" in {times.passes} passes" if times.passes > 1 else ""
    yield (
        f"  of it {format_duration(60.0 * times.cuts)} for {times.cut / 1000.0:.1f} m of cuts at "
        f"{step.step.feed:g} mm/min{passes}, {leads} for leads and links, {rest} for rapids and all else"
    )
    if other := setting_for_published(step.step, times):
        minutes = format_duration(60.0 * other.minutes)
        yield f"  with stepover_mm = {other.stepover:g}: {other.passes} passes, which take about {minutes}"


def _step_line(step: CutStep) -> str:
    """Return a step: its operations, its time, and how near the tool comes to the part."""
    count = len(step.seconds)
    time = format_duration(60.0 * step.minutes)
    parts = [f"{step.step.name}: {counted(step.points, 'point')}, {f'{count} x ' if count > 1 else ''}{time}"]
    if step.step.published_minutes:
        parts.append(f"published {format_duration(60.0 * step.step.published_minutes)}")
    parts += map(str, step.clearance)
    for over, under in step.flanks:
        parts.append(f"a flank {over:.4f} mm too deep and {under:.4f} mm left at most")
    if step.programs:
        names = list(dict.fromkeys((step.programs[0].name, step.programs[-1].name)))
        parts.append(f"in {' to '.join(names)}")
    return ", ".join(parts)
