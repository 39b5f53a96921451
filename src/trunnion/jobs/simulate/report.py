"""The report of a simulation: a page or data.

In:     ``SimulationResult``.
Out:    ``SimulationContent``, or the file.
"""

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from typing import Any, Final

import numpy as np

from trunnion.arrays import Floats
from trunnion.files import atomic_file
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import check_report_name
from trunnion.jobs.simulate.result import SimulationResult, bodies_stand_lines, travel_lines
from trunnion.messages import LIBRARY, Words
from trunnion.model.clamping import Clamping, number
from trunnion.reporting.remarks import remark_groups
from trunnion.reporting.simulation_content import (
    DeviationBin,
    SimulationContent,
    StockState,
)
from trunnion.reporting.simulation_page import render_simulation_page
from trunnion.reporting.text import clean
from trunnion.results import as_json, to_data
from trunnion.simulation.meshes.picture import picture
from trunnion.simulation.stock.deviation import Excess
from trunnion.simulation.stock.surface import stock_surface
from trunnion.simulation.stock.surface_points import SurfacePoints, surface_points
from trunnion.simulation.stock.vertex_deviation import vertex_deviation

#: From where the stock is seen: azimuth and elevation, degrees.
_VIEWS: Final = {"from above": (-60.0, 35.0), "from below, from the other side": (120.0, -35.0)}

#: Width and height of a picture.
_SIZE: Final = (640, 480)

#: Bins of the deviation on each side of what the design wants.
_BINS: Final = 8

#: Colours from 0 to 1: as the design wants it, and what is left and missing, a little and the most.
_SOUND: Final = np.array([0.77, 0.77, 0.77])
_LEFT: Final = np.array([[0.62, 0.78, 0.95], [0.08, 0.30, 0.80]])
_MISSING: Final = np.array([[1.0, 0.70, 0.40], [0.85, 0.05, 0.10]])


def write_simulation_report(
    found: SimulationResult, file: FilePath, inputs: Iterable[FilePath] = (), words: Words = LIBRARY
) -> None:
    """Write what a simulation found: a page that works offline (``.html``), or data (``.json``).

    Raises ``InputError`` when the name ends otherwise, the file cannot be written, or it is one of ``inputs``.
    """
    place = check_report_name(file)
    read = [*inputs, *(each for each in found.programs if Path(each).is_file())]
    with atomic_file(place, inputs=read) as sink:
        if Path(place.name).suffix.lower() == ".json":
            data = _cleaned(to_data(found))
            sink.write((as_json(data) + "\n").encode())
        else:
            sink.writelines(render_simulation_page(simulation_content(found), words))


def simulation_content(found: SimulationResult) -> SimulationContent:
    """Return what the report of a simulation shows."""
    cell = " × ".join(f"{width:.4g}" for width in found.cell)
    facts = (
        ("machine", found.machine),
        ("fact_removed", f"{found.removed:.1f} mm³"),
        ("fact_cells", f"{cell} mm"),
        ("fact_accuracy", f"{found.accuracy:.4g} mm"),
        ("fact_limit", f"{found.limit:.4g} mm"),
        ("fact_setups", ", ".join(each.setup for each in found.setups)),
        ("fact_clamped", "; ".join(filter(None, map(_clamped, found.setups or (found,))))),
    )
    return SimulationContent(
        title=clean(", ".join(dict.fromkeys(Path(program).name for program in found.programs))),
        verdict=found.outcome,
        facts=tuple((name, clean(value)) for name, value in facts if value),
        findings=tuple(sorted(found.findings, key=lambda finding: -finding.depth)),
        near=found.near,
        operations=found.operations,
        states=tuple(_state(each) for each in found.setups or (found,)),
        remarks=partial(_remarks, found),
        data=_cleaned(to_data(found)),
        not_checked=found.not_judged,
        grounds=tuple(each.changed(clean) for each in found.grounds.wordings()),
    )


def _remarks(found: SimulationResult, words: Words) -> tuple[str, ...]:
    """Return what was taken for granted or broken off, each thing once with its count."""
    groups = (group.line_in(words) for group in remark_groups(found.remarks))
    return (*groups, *bodies_stand_lines(found, words), *travel_lines(found, words))


def _clamped(found: SimulationResult) -> str:
    """How the part of a set-up is clamped; empty: as it is drawn."""
    if not Clamping(found.turn, found.tilt).is_turned:
        return ""
    name = f"{found.setup}: " if found.setup else ""
    return f"{name}tilted {number(found.tilt)}°, then turned {number(found.turn)}°; places are those of the drawing"


def _state(found: SimulationResult) -> StockState:
    """Return the stock that a set-up has left, in pictures and numbers."""
    simulated = found.simulation
    stock, part = simulated.stock, simulated.model.part
    lattice = stock.lattice
    design = None
    if part is not None:
        design = part.spans(lattice, 0), part.spans(lattice, 1), part.spans(lattice, 2)
    points = surface_points(stock, design)
    return StockState(
        name=clean(found.setup),
        removed=found.removed,
        left=_largest(found.left),
        gouge=_largest(found.gouge),
        deviation=tuple(_bins(points, found.limit)),
        pictures=tuple(_pictures(found, points)),
    )


def _largest(excess: Excess | None) -> tuple[float, float] | None:
    return None if excess is None else (excess.largest, excess.volume)


def _pictures(found: SimulationResult, points: SurfacePoints) -> Iterable[tuple[str, bytes]]:
    mesh = stock_surface(found.simulation.stock) if len(points.place) else None
    if mesh is None or not len(mesh.faces):
        return
    colours = None
    if points.deviation is not None:
        off = vertex_deviation(points, mesh.vertices, found.simulation.stock.lattice)
        colours = _colours(off, found.limit)
    for name, (azimuth, elevation) in _VIEWS.items():
        yield name, picture(mesh, colours=colours, azimuth=azimuth, elevation=elevation, size=_SIZE)


def _colours(off: Floats, limit: float) -> Floats:
    """Return the colour of each deviation, (n, 3); full for the greatest."""
    colours = np.tile(_SOUND, (len(off), 1))
    for sign, (little, most) in ((1.0, _LEFT), (-1.0, _MISSING)):
        own = np.flatnonzero(sign * off > limit)
        if len(own):
            share = (np.abs(off[own]) / np.abs(off[own]).max())[:, None]
            colours[own] = (1.0 - share) * little + share * most
    return colours


def _bins(points: SurfacePoints, limit: float) -> Iterable[DeviationBin]:
    """Yield the surface by its deviation, from what is missing to what is left."""
    if points.deviation is None:
        return
    off, area = points.deviation, points.area
    least, most = min(float(off.min(initial=0.0)), 0.0), max(float(off.max(initial=0.0)), 0.0)
    edges: list[float] = []
    if least < -limit:
        edges += np.linspace(least, -limit, _BINS + 1)[:-1].tolist()
    edges += [-limit, limit]
    if most > limit:
        edges += np.linspace(limit, most, _BINS + 1)[1:].tolist()
    which = np.clip(np.searchsorted(edges, off, side="left") - 1, 0, len(edges) - 2)
    areas = np.bincount(which, area, len(edges) - 1)
    for k, value in enumerate(areas.tolist()):
        yield DeviationBin(edges[k], edges[k + 1], value)


def _cleaned(value: Any) -> Any:
    """Return data without characters that no file can hold."""
    if isinstance(value, dict):
        return {key: _cleaned(each) for key, each in value.items()}
    if isinstance(value, list):
        return list(map(_cleaned, value))
    return clean(value) if isinstance(value, str) else value
