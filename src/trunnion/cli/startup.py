"""``trunnion post``, begun before all of it is imported: the first CL file is read meanwhile, beside it.

What reads CL files is imported first, which is half of all. The kernel that goes over the file needs no interpreter, so
that importing the other half takes no time of its own.
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
        coming = read_toolpaths(arguments.files, dict(arguments.settings).get("units"), arguments.strict, executor)
        from trunnion.cli.post import post

        return post(arguments, coming)
