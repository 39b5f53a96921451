"""``trunnion impeller``: an impeller from measured points."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from trunnion.cli.results import show
from trunnion.cli.simulate import simulation_lines
from trunnion.cli.terminal import Terminal
from trunnion.errors import InputError, argument_problem
from trunnion.impeller.impeller import Impeller
from trunnion.jobs.impeller.cutting import CutStep, ImpellerCut, cut_impeller
from trunnion.jobs.impeller.models import load_impeller, model_impeller, write_impeller_step
from trunnion.jobs.job import Given
from trunnion.jobs.simulate.data import simulation_data
from trunnion.simulation.meshes import STEP_ENDINGS, TriangleMesh, check_mesh_name, save_mesh
from trunnion.wording import counted, format_duration

_DECIMALS: Final = 6

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
        what = f"is not for {given.step}"
        raise InputError([argument_problem(name, what, "leave it out", code="ARG130") for name in wrong])
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
    parts = {"facets": facets}
    show(given, lambda: _model_data(impeller, found.volume, parts, found.deviation, found.mesh), lines)
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
    parts = {"faces": found.faces}
    show(given, lambda: _model_data(impeller, found.volume, parts, found.deviation, found.mesh), lines)
    return 0


def _model_data(
    impeller: Impeller, volume: float, parts: dict[str, int], deviation: float, mesh: TriangleMesh
) -> dict[str, object]:
    """A model as data; ``parts`` counts what it consists of."""
    definition = impeller.definition
    return {
        "schema": 1,
        "name": definition.name,
        "blades": definition.number,
        "splitters": 0 if impeller.splitter is None else definition.number,
        "volume_mm3": round(volume, _DECIMALS),
        **parts,
        "deviation_mm": round(deviation, _DECIMALS),
        "extents": mesh.bounds.tolist(),
    }


def _head(impeller: Impeller, mesh: TriangleMesh) -> str:
    """What it is, and how large."""
    definition = impeller.definition
    splitters = "" if impeller.splitter is None else f" and {definition.number} splitters"
    low, high = mesh.bounds.tolist()
    size = " x ".join(f"{b - a:.3f}" for a, b in zip(low, high, strict=True))
    return f"{definition.name}: {definition.number} blades{splitters}, {size} mm"


def cut(given: Given) -> int:
    """Machine an impeller; 0 if its program is proven, and what was simulated has no finding."""
    missing = [name for name in ("machine", "output") if getattr(given, name) is None]
    if missing:
        cures = {"machine": "name the machine that runs the program", "output": "name a folder"}
        raise InputError([argument_problem(name, "is missing", cures[name], code="ARG130") for name in missing])
    found = cut_impeller(given.file, **given.arguments("file", "tolerance"), observer=Terminal())
    show(given, lambda: _cut_data(found), _cut_lines(found))
    return 0 if found.passed else 1


def _cut_lines(found: ImpellerCut) -> Iterator[str]:
    """What was made, step by step."""
    for step in found.steps:
        yield _step_line(step)
    yield f"{found.result.output}: {counted(sum(step.points for step in found.steps), 'point')}"
    if found.simulation is not None:
        yield from simulation_lines(found.simulation)


def _step_line(step: CutStep) -> str:
    """A step: its operations, its time, and how near the tool comes to the part."""
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


def _cut_data(found: ImpellerCut) -> dict[str, object]:
    """The same as data."""
    return {
        "schema": 1,
        "name": found.impeller.definition.name,
        "passed": found.passed,
        "program": str(found.result.output),
        "subprograms": [str(file) for file in found.result.subprograms],
        "cl_files": [str(file) for file in found.cl_files],
        "steps": [
            {
                "name": step.step.name,
                "kind": step.step.kind,
                "operations": len(step.seconds),
                "cl_file": str(step.cl_file),
                "programs": [str(file) for file in step.programs],
                "points": step.points,
                "minutes": round(step.minutes, _DECIMALS),
                "published_minutes": step.step.published_minutes or None,
                "clearances": [
                    {"part": one.part, "body": one.body, "mm": round(one.distance, _DECIMALS), "at": one.centre}
                    for one in step.clearance
                ],
                "before": {
                    "form_mm": round(step.before.form, _DECIMALS),
                    "hub_mm": round(step.before.hub, _DECIMALS),
                    "blades_mm": None if step.before.blades is None else round(step.before.blades, _DECIMALS),
                },
                "flanks": [
                    {"overcut_mm": round(over, _DECIMALS), "undercut_mm": round(under, _DECIMALS)}
                    for over, under in step.flanks
                ],
            }
            for step in found.steps
        ],
        "remarks": [
            {"file": r.file, "line": r.line, "what": r.what, "cure": r.cure, "code": r.code} for r in found.remarks
        ],
        "checks": {check.key: check.passed for check in found.result.checks},
        "simulation": None if found.simulation is None else simulation_data(found.simulation),
    }
