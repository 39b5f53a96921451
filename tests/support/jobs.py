"""Jobs for tests that plan a program step by step."""

from collections.abc import Mapping

from trunnion.controls import Control
from trunnion.jobs.post.post_job import PostJob
from trunnion.machines import Machine
from trunnion.output.capabilities import control_capabilities
from trunnion.planning import PlanOptions


def post_job(
    machine: Machine,
    control: Control,
    options: PlanOptions | None = None,
    settings: Mapping[str, str] | None = None,
    *,
    force: bool = False,
) -> PostJob:
    """A job with the capabilities of the control under these settings."""
    given = settings or {}
    capabilities = control_capabilities(control, given)
    return PostJob(machine, control, capabilities, options or PlanOptions(), given, force=force)
