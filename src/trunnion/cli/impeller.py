"""``trunnion impeller``: an impeller from measured points."""

import argparse
from pathlib import Path
from typing import Final

from trunnion.api.impellers import load_impeller, model_impeller
from trunnion.cli.results import as_json, print_result
from trunnion.simulation.meshes import check_mesh_name, save_mesh
from trunnion.wording import one_line

_DECIMALS: Final = 6


def model(arguments: argparse.Namespace) -> int:
    """Make the mesh of an impeller, and say how good it is."""
    if arguments.output is not None:
        check_mesh_name(arguments.output)
    impeller = load_impeller(arguments.file)
    definition = impeller.definition
    found = model_impeller(impeller, tolerance=arguments.tolerance)
    if arguments.output is not None:
        points = {Path(table.file) for table in definition.sections}
        save_mesh(found.mesh, arguments.output, inputs=[arguments.file, *points])
    facets = len(found.mesh.faces)
    low, high = found.mesh.bounds.tolist()
    if arguments.json:
        data = {
            "schema": 1,
            "name": definition.name,
            "blades": definition.number,
            "splitters": 0 if impeller.splitter is None else definition.number,
            "volume_mm3": round(found.volume, _DECIMALS),
            "facets": facets,
            "deviation_mm": round(found.deviation, _DECIMALS),
            "extents": [low, high],
        }
        print_result(as_json(data))
        return 0
    splitters = "" if impeller.splitter is None else f" and {definition.number} splitters"
    size = " x ".join(f"{b - a:.3f}" for a, b in zip(low, high, strict=True))
    lines = (
        f"{definition.name}: {definition.number} blades{splitters}, {size} mm",
        f"volume {found.volume:.1f} mm³, {facets} facets, a closed solid",
        f"facets are at most {found.deviation:.4f} mm off the exact surfaces, {arguments.tolerance:g} mm were asked",
    )
    print_result(*map(one_line, lines))
    return 0
