"""Reading the toolpaths of a post: with normals, hooks, and the part as it is clamped.

In:     CL files, a job and hooks.
Out:    the toolpaths as they are planned, and the job with what its program says of them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from trunnion.controls.vocabulary import HOOKS_NOTICE
from trunnion.jobs.inputs.stated_rapids import stated_notices
from trunnion.jobs.post.operation_setups import setup_notices, with_operation_setups
from trunnion.jobs.post.post_job import PostJob
from trunnion.model.clamped_toolpaths import clamped_after, stated_clamping, turned_toolpaths
from trunnion.model.clamping_notices import clamped_notices
from trunnion.model.toolpath import Message, Toolpath
from trunnion.output.template_values import STOCK

if TYPE_CHECKING:
    from trunnion.hooks.calling import Hooks


def as_clamped(
    toolpaths: list[Toolpath], job: PostJob, hooks: "Hooks | None", angles: tuple[float, float], *, is_placed: bool
) -> tuple[list[Toolpath], PostJob]:
    """Toolpaths of the part as it is clamped, and the job with the notices that the head of the program has of it.

    Raises ``InputError`` if a CL file states that it is clamped otherwise.
    """
    stated = stated_clamping(toolpaths)
    clamping = clamped_after(stated, angles, toolpaths[0].file)
    job = _with_stated_stock(toolpaths, job)
    toolpaths, carried = _without_notices(toolpaths, job)
    toolpaths = turned_toolpaths(toolpaths, *angles, absolute=job.options.absolute_frame)
    if job.stock is not None and {**job.control.settings, **job.settings}.get("blank") == STOCK:
        from trunnion.jobs.post.block_forms import corners_of_stock  # few programs have a block form

        job = replace(job, blank=corners_of_stock(job.stock, clamping))
    job = with_operation_setups(toolpaths, job)
    notices: tuple[str, ...] = ()
    if is_placed or stated is not None or not clamping.is_as_drawn:
        notices = (*clamped_notices(clamping), *setup_notices(job, toolpaths))
    job = replace(job, notices=(*notices, *stated_notices(toolpaths, job.settings), *carried), clamping=clamping)
    if hooks is not None:
        decisions = tuple(hooks.decisions) if job.options.explain else ()
        job = replace(job, notices=(*job.notices, *hooks.notices), decisions=decisions)
    if job.simulation is not None:
        from trunnion.jobs.simulate.posted import simulated_as_clamped

        job = replace(job, simulation=simulated_as_clamped(job.simulation, clamping))
    return toolpaths, job


def _with_stated_stock(toolpaths: Sequence[Toolpath], job: PostJob) -> PostJob:
    """Return the job with the stock that its CL files state, where nothing else states one."""
    if not any(toolpath.stock for toolpath in toolpaths) and job.simulation is None:
        return job
    from trunnion.jobs.inputs.simulation_input import leaves_stock_to_cl, with_decided_stock  # few posts know stock

    is_absolute = job.options.absolute_frame
    if job.simulation is not None:
        simulation = with_decided_stock(job.simulation, toolpaths, is_absolute=is_absolute)
        return replace(job, simulation=simulation, stock=simulation.stock, stock_from=simulation.stock_from)
    if not leaves_stock_to_cl(job.stock):
        return job
    from trunnion.simulation.stock.stated_stock import stated_stock

    stated = stated_stock(toolpaths, absolute=is_absolute)
    return job if stated is None else replace(job, stock=stated.stock, stock_from=stated.file)


def _without_notices(toolpaths: Sequence[Toolpath], job: PostJob) -> tuple[list[Toolpath], tuple[str, ...]]:
    """Toolpaths without the notices of hooks that they were converted with, and these for the head of the program."""
    operations = (operation for toolpath in toolpaths for operation in toolpath.operations)
    texts = (event.text for operation in operations for event in operation.events if isinstance(event, Message))
    if not any(text.strip().upper().startswith(HOOKS_NOTICE) for text in texts):
        return list(toolpaths), ()
    from trunnion.conversion import take_notices  # few CL files have some

    taken = [take_notices(toolpath, job.control.family) for toolpath in toolpaths]
    return [toolpath for toolpath, _ in taken], tuple(dict.fromkeys(text for _, found in taken for text in found))
