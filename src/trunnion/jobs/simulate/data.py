"""A simulation as data for JSON; the schema is in ``docs/simulation.md``."""

import math
from dataclasses import asdict
from typing import Final

from trunnion.jobs.simulate.result import SimulationResult
from trunnion.simulation.setup_findings import AirCut, BlockRemoval, NearMiss, SimulationFinding
from trunnion.simulation.stock.deviation import Excess

_DECIMALS: Final = 6


def simulation_data(found: SimulationResult) -> dict[str, object]:
    """A simulation as data; the schema is in ``docs/simulation.md``."""
    return {
        "schema": 1,
        "passed": found.passed,
        "programs": list(found.programs),
        "machine": found.machine,
        "turn_deg": _number(found.turn),
        "tilt_deg": _number(found.tilt),
        "cell_mm": _number(max(found.cell)),
        "cells_mm": _numbers(found.cell),
        "accuracy_mm": _number(found.accuracy),
        "limit_mm": _number(found.limit),
        "removed_mm3": _number(found.removed),
        "left": _excess(found.left),
        "gouge": _excess(found.gouge),
        "pairs_checked": found.pairs,
        "setups": [_setup(each) for each in found.setups],
        "collisions": [_finding(each) for each in found.findings],
        "near": [_near(each) for each in found.near],
        "air": [_air(each) for each in found.air],
        "operations": [
            {
                "file": each.file, "tool": each.tool, "line": each.line, "last_line": each.last_line,
                "removed_mm3": _number(each.removed), "gouged_mm3": _number(each.gouged),
                "seconds": _number(each.seconds), "air_mm": _number(each.air), "findings": each.findings,
                "blocks": _blocks(each.blocks),
                "setup": each.setup or None,
            }
            for each in found.operations
        ],
        "remarks": [
            asdict(each) | {"severity": str(each.severity), "setup": one.setup or None}
            for one in found.setups or (found,) for each in one.remarks
        ],
        "seconds": _number(found.seconds),
    }  # fmt: skip


def _blocks(blocks: BlockRemoval) -> dict[str, object]:
    return {
        "line": blocks.line.tolist(),
        "removed_mm3": [round(each, _DECIMALS) for each in blocks.removed.tolist()],
        "mm3_per_min": [None if math.isnan(each) else round(each, _DECIMALS) for each in blocks.rate.tolist()],
    }


def _setup(found: SimulationResult) -> dict[str, object]:
    return {
        "name": found.setup, "machine": found.machine, "programs": list(found.programs), "passed": found.passed,
        "cells_mm": _numbers(found.cell), "removed_mm3": _number(found.removed), "left": _excess(found.left),
        "gouge": _excess(found.gouge), "turn_deg": _number(found.turn), "tilt_deg": _number(found.tilt),
    }  # fmt: skip


def _finding(finding: SimulationFinding) -> dict[str, object]:
    return {
        "kind": finding.kind, "between": list(finding.between), "file": finding.file, "line": finding.line,
        "block": _block(finding.block), "last_line": finding.last_line, "last_block": _block(finding.last_block),
        "cl_line": finding.cl_line or None, "cl_file": finding.cl_file or None,
        "seconds": _number(finding.seconds), "depth_mm": _number(finding.depth),
        "place": _numbers(finding.place), "setup": finding.setup or None,
    }  # fmt: skip


def _near(each: NearMiss) -> dict[str, object]:
    return {
        "between": list(each.between), "file": each.file, "line": each.line, "block": _block(each.block),
        "last_line": each.last_line, "last_block": _block(each.last_block), "seconds": _number(each.seconds),
        "distance_mm": _number(each.distance), "place": _numbers(each.place),
        "setup": each.setup or None,
    }  # fmt: skip


def _air(each: AirCut) -> dict[str, object]:
    return {
        "file": each.file, "line": each.line, "block": _block(each.block), "last_line": each.last_line,
        "last_block": _block(each.last_block), "length_mm": _number(each.length),
        "setup": each.setup or None,
    }  # fmt: skip


def _block(number: int) -> int | None:
    """An N number; a block without one has none."""
    return number if number >= 0 else None


def _excess(excess: Excess | None) -> dict[str, object] | None:
    if excess is None:
        return None
    places = [{"place": _numbers(each.at), "depth_mm": _number(each.thickness)} for each in excess.places]
    return {"largest_mm": _number(excess.largest), "volume_mm3": _number(excess.volume), "places": places}


def _numbers(values: tuple[float, ...]) -> list[float]:
    return [_number(value) for value in values]


def _number(value: float) -> float:
    return round(float(value), _DECIMALS) + 0.0
