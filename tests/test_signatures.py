"""No function takes more than six things: what belongs together is a record, and options come by their names."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from tests.support.locations import ROOT

MOST: Final = 6

#: How functions are marked that Numba compiles: their parameters are arrays and numbers, and a record costs there.
KERNELS: Final = ("kernel", "inner", "inlined")

#: Functions of before, each with as many as it has: none may be added, and one that is mended leaves the list.
STILL_LONGER: Final = {
    "batch/cluster.py:__init__": 7,
    "batch/jobs_file.py:_judged": 7,
    "cl/assemble.py:_inverse_to_per_minute": 8,
    "cl/read.py:read_source": 7,
    "cl/text_format.py:__call__": 8,
    "definitions/table.py:text": 7,
    "errors.py:__init__": 7,
    "impeller/flank/fit.py:_step": 7,
    "impeller/flank/milling.py:mill_flank": 8,
    "impeller/paths/axis_regions.py:_reach": 8,
    "impeller/paths/channel_roughing.py:channel_roughing": 8,
    "impeller/paths/hub_finish.py:hub_finish": 7,
    "impeller/paths/linking.py:_leave": 7,
    "impeller/paths/linking.py:link_passes": 8,
    "impeller/paths/toolpaths.py:operation_of": 7,
    "jobs/inputs/reading.py:_read": 7,
    "model/axis_positions.py:resolve_rotary": 7,
    "output/holes/hole_blocks.py:write_holes": 7,
    "output/holes/hole_groups.py:write_hole_groups": 7,
    "output/holes/holes_under_tcp.py:write_holes_under_tcp": 7,
    "planning/linearization/intermediate_points.py:divide_path": 8,
    "readers/control/arcs.py:_from_chord": 7,
    "readers/registry.py:run_program": 9,
    "simulation/collisions/checking.py:check_collisions": 8,
    "simulation/cutting/removal.py:measure": 11,
    "simulation/findings.py:_runs": 7,
    "simulation/setup_findings.py:_operation": 7,
    "simulation/simulator.py:_measured": 7,
    "twin/serving.py:serve_program": 7,
    "viewer/content.py:view_content": 7,
}


def is_kernel(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether Numba compiles a function."""
    return any(ast.unparse(each).startswith(KERNELS) for each in function.decorator_list)


def longer(file: Path) -> Iterator[tuple[str, int]]:
    """Functions of a file that take more than six things, with how many."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or is_kernel(node):
            continue
        given = [each.arg for each in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
        count = len(given) - (given[:1] in (["self"], ["cls"]))
        if count > MOST:
            yield f"{file.relative_to(ROOT / 'src' / 'trunnion').as_posix()}:{node.name}", count


def test_no_function_takes_more_than_six_things() -> None:
    found = dict(each for file in (ROOT / "src" / "trunnion").rglob("*.py") for each in longer(file))
    assert found == STILL_LONGER
