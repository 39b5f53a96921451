"""Cures of messages about what a machine reaches, and what its errors do."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import trunnion
from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.reading import ended
from tests.support.simulating import HEAD, SLOT
from trunnion.capability.reach import reach_remarks
from trunnion.errors import Problem
from trunnion.jobs.inputs.stated_setup import set_up_machine
from trunnion.machines import load_machine

_STILL: Final = HEAD + "M5\nM30\n"


def _sensed(**fixed: Any) -> Trial:
    """Return what tells how far the tip of a program is off; settings are arguments."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "part.ngc").write_text(text, encoding="utf-8")
        heard: list[Problem] = []
        given: dict[str, Any] = {**fixed, **settings}
        return ended(
            lambda: heard.extend(trunnion.sensitivity(folder / "part.ngc", machine="xyzac_trt", **given).remarks), heard
        )

    return tried


def _assumed(*, placed: bool) -> Trial:
    """Return what says what a reach assumes of the machine of a definition."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        (folder / "ours.toml").write_text(text, encoding="utf-8")
        machine = set_up_machine(load_machine(folder / "ours.toml"), settings.get("zero"), settings.get("tool_length"))
        return Outcome(tuple(reach_remarks(machine, placed)), True)

    return tried


_KNOWN: Final = {"zero": "0,0,-100", "tool_length": "60"}
_HEAD_TABLE: Final = 'extends = "generic_head_table_bc"\n'
_NO_LIMITS: Final = 'extends = "ucp800"\n'
_LIMITS: Final = "".join(f'[[axis]]\nname = "{name}"\nlimits_mm = [-400, 400]\n' for name in "XYZ")

CURES: Final = (
    Cure("RCH110", "nothing_cut", _sensed(**_KNOWN), _STILL, ((_STILL, SLOT),)),
    Cure("RCH120", "places_not_understood", _sensed(**_KNOWN), SLOT.replace("N60", "G777\nN60"), (("G777\n", ""),)),
    Cure("RCH130", "zero_taken", _sensed(), SLOT, ({"zero": "0,0,-100"},)),
    Cure("RCH140", "length_taken", _sensed(), SLOT, ({"tool_length": "60"},)),
    Cure("RCH140", "", _sensed(), SLOT, (), cured_by=_sensed(**_KNOWN)),
    Cure("RCH140", "tool_length_not", _assumed(placed=False), _HEAD_TABLE, ({"tool_length": "60"},)),
    Cure("RCH130", "workpiece_zero_not", _assumed(placed=True), _HEAD_TABLE, ({"zero": "0,0,-100"},)),
    Cure(
        "RCH140",
        "tool_length_not_known",
        _assumed(placed=True),
        _HEAD_TABLE,
        ({"tool_length": "60"},),
        {"zero": "0,0,-100"},
    ),
    Cure("RCH210", "no_limits_stated", _assumed(placed=False), _NO_LIMITS, ((_NO_LIMITS, _NO_LIMITS + _LIMITS),)),
)
