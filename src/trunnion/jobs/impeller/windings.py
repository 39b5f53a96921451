"""Warnings about steps round an impeller whose tilt winds rotary axes up, or has them rewind in the cut."""

from collections.abc import Iterator, Sequence

from trunnion.errors import Problem, warning
from trunnion.impeller.steps import ROUND_STEPS, MachiningStep
from trunnion.machines import Machine
from trunnion.messages import Wording
from trunnion.model.motion import Motion
from trunnion.model.toolpath import Message
from trunnion.planning.rotary_positions import wound_turns


def winding_problems(file: str, step: MachiningStep, motions: Sequence[Motion], machine: Machine) -> Iterator[Problem]:
    """Yield a warning if the tilt of a step round the part costs rewinds or whole turns back home.

    file     the definition of the impeller
    motions  of the step, as they were planned
    """
    if step.kind not in ROUND_STEPS or step.tilt <= 0.0:
        return
    events = [event for motion in motions for event in motion.operation.events]
    rewinds = sum(isinstance(event, Message) and event.text.startswith("Rewind: ") for event in events)
    wound = max((turns for motion in motions for _, turns in wound_turns(machine, motion.rotary)), default=0.0)
    if rewinds and wound:
        wording = Wording(
            "IMP334", "rewinds_and_turns_back_home", step=step.name, tilt=step.tilt, rewinds=rewinds, turns=wound
        )
    elif rewinds:
        wording = Wording("IMP334", "rewinds", step=step.name, tilt=step.tilt, rewinds=rewinds)
    elif wound:
        wording = Wording("IMP334", "turns_back_home", step=step.name, tilt=step.tilt, turns=wound)
    else:
        return
    yield warning(file, step.line, wording)
