"""``trunnion post`` reads its first CL file in a thread while the planner, the writers and the readers are imported.

Reading first and importing afterwards lengthens the post of a million points by a tenth (2.60 to 2.86 s on the machine
where this was measured).
"""

import argparse
from concurrent.futures import ThreadPoolExecutor

from trunnion.cli.cl_files import read_toolpaths
from trunnion.jit import compile_ahead, is_first_run


def run(arguments: argparse.Namespace) -> int:
    """Post every CL file."""
    if is_first_run():  # compiling takes longer than all else: the second process should begin at once
        from trunnion.api import kernels

        compile_ahead(kernels.POSTING)
    with ThreadPoolExecutor(1) as executor:
        given = dict(arguments.settings)
        coming = read_toolpaths(
            arguments.files, given.get("cl_units"), arguments.strict, executor, given.get("dialect"),
            given.get("spline_tolerance", ""),
        )  # fmt: skip
        from trunnion.cli.post import post

        return post(arguments, coming)
