"""``trunnion post`` reads its first CL file in a thread while the planner, the writers and the readers are imported.

Reading first and importing afterwards lengthens the post of a million points by a tenth (2.60 to 2.86 s on the machine
where this was measured).
"""

from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import trunnion.jit
from trunnion.cl.open_cycles import open_cycles
from trunnion.cl.read import ClReading
from trunnion.cli.cl_files import begin_reading, spline_tolerance
from trunnion.jobs.job import Given

if TYPE_CHECKING:  # imported while the first CL file is read
    from trunnion.files import OutputGroup
    from trunnion.jobs.observer import Observer


def post_files(given: Given, group: "OutputGroup | None" = None, observer: "Observer | None" = None) -> int:
    """Post every CL file; programs appear with those of the group, if there is one."""
    if trunnion.jit.is_first_run():  # compiling takes longer than all else: the second process should begin at once
        from trunnion.jobs import kernels

        trunnion.jit.compile_ahead(kernels.POSTING)
    executor = ThreadPoolExecutor(1)
    try:
        settings = dict(given.settings)
        within = spline_tolerance(settings.get("spline_tolerance", ""))
        how = ClReading(
            settings.get("cl_units"), settings.get("dialect"), given.strict, within, settings.get("cutcom"),
            open_cycles(settings.get("open_cycle", "")),
        )  # fmt: skip
        coming = begin_reading(given.cl, how, executor)
        from trunnion.cli.post import post

        return post(given, coming, group, observer)
    finally:
        executor.shutdown(wait=False, cancel_futures=True)  # it may wait for stdin, which nobody needs any more
