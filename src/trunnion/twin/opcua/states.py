"""What the program does, in the words of each specification."""

from datetime import UTC, datetime, timedelta
from typing import Any, Final

from asyncua import ua

from trunnion.twin.nodesets import MACHINE_TOOL, MACHINERY
from trunnion.twin.opcua.machine_tool import ITEM_STATES, JOB_STATES, PROGRAM_STATES
from trunnion.twin.opcua.space import Space
from trunnion.twin.playback import Playback, PlayState

#: CncChannelProgramStatus, CncChannelStatus, then chanStatus and progStatus of a SINUMERIK, and states of OPC 40501-1.
_WORDS: Final = {
    PlayState.READY: (0, 2, 0, 5, "Initializing", "NotExecuting"),
    PlayState.RUNNING: (1, 0, 1, 3, "Running", "Executing"),
    PlayState.HELD: (3, 1, 2, 2, "Interrupted", "NotExecuting"),
    PlayState.STOPPED: (3, 1, 2, 2, "Interrupted", "NotExecuting"),
    PlayState.ENDED: (0, 2, 0, 5, "Ended", "NotExecuting"),
}

_AUTOMATIC: Final = 2  # CncOperationMode

#: A year: nobody predicts further.
_FAR: Final = 365 * 86400.0


def states_of(playback: Playback, space: Space, wall: float, begun: float) -> dict[str, Any]:
    """Return the values of the names ``state.*``; the wall time now, and when the twin was switched on."""
    program, channel, sinumerik_channel, sinumerik_program, name, item = _WORDS[playback.state]
    found: dict[str, Any] = {
        "state.mode": _AUTOMATIC,
        "state.program": program,
        "state.channel": channel,
        "state.sinumerik_channel": sinumerik_channel,
        "state.sinumerik_program": sinumerik_program,
        "state.hold": playback.state is PlayState.HELD,
        "state.override": playback.override,
        "state.completed": playback.completed,
        "state.runs_planned": 0 if playback.loop else 1,
        "state.runs_are_planned": not playback.loop,
        "state.text": playback.state.value,
        "state.hours": int((wall - begun) / 3600.0),
        "state.end": _predicted(playback, wall),
    }
    for what, uri, states, state in (
        ("program_machine", MACHINE_TOOL, PROGRAM_STATES, name),
        ("job", MACHINE_TOOL, JOB_STATES, name),
        ("item", MACHINERY, ITEM_STATES, item),
    ):
        node, number = states[state]
        found[f"state.{what}.text"] = ua.LocalizedText(state, "en")
        found[f"state.{what}.id"] = ua.NodeId(node, space.index(uri))
        found[f"state.{what}.number"] = number
    return found


def _predicted(playback: Playback, wall: float) -> datetime | None:
    """When the program ends, to the second; a standing program ends that much later, and one at override 0 never."""
    remaining = playback.remaining()
    if not remaining <= _FAR:
        return None
    return datetime.fromtimestamp(0, UTC) + timedelta(seconds=round(wall + remaining))
