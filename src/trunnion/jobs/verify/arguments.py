"""Arguments of a verification, checked before any work."""

import math
from typing import Final

from trunnion.controls.setting_rules import tool_number
from trunnion.errors import InputError, argument_problem, setting_problem
from trunnion.jobs.arguments import VerifyArguments
from trunnion.jobs.inputs.arguments import check_choice, check_paths, check_whole, checked_angles, wrong_argument
from trunnion.jobs.inputs.hooked import no_cl_files
from trunnion.jobs.inputs.settings import as_texts, check_tolerance
from trunnion.messages import Wording, phrase
from trunnion.options.words import PROOF_SETTINGS

#: How far the tip may be off its CL point, mm.
DEFAULT_TOLERANCE: Final = 0.001


def checked(given: VerifyArguments) -> VerifyArguments:
    """Return the arguments as the stages take them.

    Raises ``InputError`` for the first that makes no sense, or that changes CL files where there are none.
    """
    has_cl = not isinstance(given["cl"], tuple | list) or bool(given["cl"])
    check_choice("frame", given["frame"], ("first", "absolute"))
    check_choice("feed", given["feed"], ("programmed", "fastest"))
    feed_limit = _feed_limit(given)
    if given["feed"] == "fastest" and not has_cl:
        raise InputError(argument_problem("feed", Wording("ARG130", "fastest_feed_without_cl")))
    if given["units"] is not None:
        check_choice("units", given["units"], ("mm", "inch"))
    tool = _tool(given["tool"])
    edge = None if given["edge"] is None else check_whole("edge", given["edge"], 1)
    for name in ("tolerance", "span", "span_tip", "recorded_tolerance"):
        check_tolerance(name, given.get(name), optional=name.startswith("span"))
    hooks = check_paths("hooks", given["hooks"])
    if hooks and not has_cl:
        raise no_cl_files()
    turn, tilt = checked_angles(given["turn"], given["tilt"])
    if (turn or tilt) and not has_cl:
        raise InputError(argument_problem("turn" if turn else "tilt", Wording("ARG130", "clamping_without_cl")))
    return {
        **given, "feed_limit": feed_limit, "settings": _settings(given), "tool": tool, "edge": edge, "hooks": hooks,
        "turn": turn, "tilt": tilt,
    }  # fmt: skip


def angles_of(given: VerifyArguments) -> tuple[float, float]:
    """Return turn and tilt of the part, degrees."""
    return given["turn"] or 0.0, given["tilt"] or 0.0


def _feed_limit(given: VerifyArguments) -> float | None:
    """Return a feed limit, checked."""
    limit = given["feed_limit"]
    if limit is None:
        return None
    if given["feed"] != "fastest":
        raise InputError(argument_problem("feed_limit", Wording("ARG130", "only_with_fastest_feed")))
    if isinstance(limit, bool) or not isinstance(limit, int | float) or not 0.0 < limit < math.inf:
        raise InputError(argument_problem("feed_limit", Wording("ARG220", "no_feed_limit", value=repr(limit))))
    return float(limit)


def _settings(given: VerifyArguments) -> dict[str, str]:
    """Return the settings of the post as texts; ``expected`` checks their values."""
    texts = as_texts(given["settings"])
    wording = Wording("ARG210", "not_of_proof", allowed=PROOF_SETTINGS)
    if problems := [setting_problem(key, wording) for key in texts if key not in PROOF_SETTINGS]:
        raise InputError(problems)
    return texts


def _tool(tool: object) -> str:
    """Return the tool that is called in place of the CL file's, as a run names it; empty for none."""
    text = str(tool).strip('"') if isinstance(tool, str | int) and not isinstance(tool, bool) else None
    if text is None or tool_number(text) == 0 or text.startswith("-"):
        raise wrong_argument("tool", tool, phrase("give_tool"))
    return text
