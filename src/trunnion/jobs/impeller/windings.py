"""Warnings about steps round an impeller whose tilt winds rotary axes up, or has them rewind in the cut."""

from collections.abc import Iterator, Sequence

from trunnion.errors import Problem, Severity
from trunnion.impeller.steps import ROUND_STEPS, MachiningStep
from trunnion.machines import Machine
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Message
from trunnion.planning.rotary_positions import wound_turns
from trunnion.wording import counted


def winding_problems(file: str, step: MachiningStep, motions: Sequence[Motion], machine: Machine) -> Iterator[Problem]:
    """Yield a warning if the tilt of a step round the part costs rewinds or whole turns back home.

    Parameters
    ----------
    file
        The definition of the impeller.
    motions
        Of the step, as they were planned.
    """
    if step.kind not in ROUND_STEPS or step.tilt <= 0.0:
        return
    events = [event for motion in motions for event in motion.operation.events]
    rewinds = sum(isinstance(event, Message) and event.text.startswith("Rewind: ") for event in events)
    wound = max((turns for motion in motions for _, turns in wound_turns(machine, motion.rotary)), default=0.0)
    costs = [f"{counted(rewinds, 'rewind')} in the cut"] if rewinds else []
    costs += [f"{wound:.0f} turns back home"] if wound else []
    if costs:
        what = f"{step.name}: tilt_deg = {step.tilt:g} turns a rotary axis with every turn of the helix, and costs "
        cure = "tilt_deg = 0 costs none of it"
        yield Problem(file, step.line, what + " and ".join(costs), cure, Severity.WARNING, code="IMP334")
