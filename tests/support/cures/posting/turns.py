"""Cures of messages about rotary axes in a cut: rewinds, poles, limits on the way, and what is planned without TCP."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, marked, post
from tests.support.cures.posting.rows import by_definition, by_settings, defined, on_machine
from tests.support.locations import ROOT
from tests.support.posting import CLEAR, FOOT, LEANING

_CA: Final = "generic_head_head_ca"
_BC: Final = "generic_head_table_bc"
_FEED: Final = "FEDRAT/MMPM,500.0\n"


def _towards(tilt: float, azimuth: float) -> str:
    t, a = math.radians(tilt), math.radians(azimuth)
    return f"{math.sin(t) * math.cos(a):.9f},{math.sin(t) * math.sin(a):.9f},{math.cos(t):.9f}"


def round_part(turns: float, tilt: float = 40.0, points: int = 18) -> list[str]:
    """A cut round a part, the tool leaning outwards."""
    found = []
    for k in range(round(points * turns) + 1):
        axis = [float(number) for number in _towards(tilt, 100.0 + k * 360.0 / points).split(",")]
        tip = ",".join(f"{40.0 * part:.6f}" for part in axis)
        found.append(f"GOTO/{tip},{_towards(tilt, 100.0 + k * 360.0 / points)}")
    return found


def first_cut(lines: list[str]) -> str:
    """The beginning of an operation whose first cut is the first line, reached along the tool."""
    return CLEAR.replace("GOTO/0.0,0.0,50.0,0.0,0.0,1.0", lines[0]) + _FEED


_WOUND: Final = first_cut(round_part(2.8)) + "\n".join(round_part(2.8)) + "\n"
_LONG: Final = first_cut(round_part(5.0)) + "\n".join(round_part(5.0)) + "\n"

_NARROW: Final = """extends = "generic_head_table_bc"
[[axis]]
name = "C"
endless = false
limits_deg = [-95, 95]
[[axis]]
name = "B"
limits_deg = [-110, 110]
"""
#: Past the pole, so near that C would have to be too fast.
_PAST: Final = [f"GOTO/{0.5 * k:.3f},0,0,{math.sin(math.radians(0.05 * k)):.9f},0.0034906,1" for k in range(-60, 61)]
_FLIP: Final = [f"GOTO/{k},0,0,{_towards(40.0, azimuth)}" for k, azimuth in enumerate((60.0, 70.0, 110.0))]
_ARC: Final = CLEAR + _FEED + "GOTO/235,-20,0\nCIRCLE/235,0,0,0,0,1,20\nGOTO/235,20,0\n"


def _across(tilt: float, azimuth: float) -> str:
    """A cut whose tool axis goes past the pole in one step."""
    lines = [f"GOTO/0,0,0,{_towards(tilt, 0.0)}", f"GOTO/30,0,0,{_towards(tilt, azimuth)}"]
    return first_cut(lines) + "\n".join(lines) + "\n"


def _limited(message: str, name: str) -> Cure:
    """Arcs that become lines, of which fewer may be."""
    posted = defined(LEANING + "CIRCLE/20,0,5,0,0.6,0.8,10\nGOTO/30,0,5,0.0,0.6,0.8\n" + FOOT)

    def limited(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        with patch(f"trunnion.planning.{name}", 20):
            return posted(definition, settings, folder)

    return marked(message, limited, 'extends = "yl569"', "+ [control.arcs]\nchord_tolerance = 1")


_WAY: Final = (
    first_cut([f"GOTO/0,0,0,{_towards(40.0, 60.0)}"])
    + f"GOTO/0,0,0,{_towards(40.0, 60.0)}\nGOTO/30,0,0,{_towards(40.0, 120.0)}\n"
)
_SHORT: Final = first_cut(round_part(0.1)) + "\n".join(round_part(0.1)) + "\n"


def _wound(message: str, extended: str, axis: str) -> Cure:
    """A path round a part on a machine of whose table this is said, and one that does not go round."""
    machine = on_machine(f'extends = "{extended}"\n[[axis]]\nname = "C"\n{axis}\n')
    first, *others = round_part(2.8)
    return marked(message, machine, first, *(f"- {line}" for line in others), head=first_cut([first]), foot=FOOT)


_U_V_W: Final = (
    (ROOT / "src/trunnion/machines/library" / "generic_head_table_bc.toml")
    .read_text(encoding="utf-8")
    .replace('"X"', '"U"')
    .replace('"Y"', '"V"')
    .replace('"Z"', '"W"')
)


def _renamed(definition: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    machine = folder / "named.toml"
    machine.write_text(definition, encoding="utf-8")
    return post(str(machine))(_SHORT + FOOT, {"tcp": "off", "zero": "0,0,100", "tool_length": "50"}, folder)


_OBLIQUE: Final = f'extends = "{_BC}"\n[spindle]\ndirection = [0, 0.6, 0.8]\n'
_TIGHT: Final = f'extends = "{_CA}"\n[[axis]]\nname = "Y"\nlimits_mm = [-170, 170]\n'


def _without_reason(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Post a path with a rewind for which no axis limit is found."""
    with patch("trunnion.planning.poses.decision_log.first_limit_hit", return_value=None):
        return post(_CA)(text, settings, folder)


CURES: Final = (
    Cure("PLN210", "rotary_axes_would", _without_reason, _WOUND + FOOT, ({"rewind": "insert"},), {"rewind": "none"}),
    by_settings("PLN210 cut", {"rewind": "insert"}, _WOUND, _CA, rewind="none"),
    Cure("PLN220", "one_rewind", post(_CA), _WOUND + FOOT, ({"rewind": "none"},), refuses=True),
    Cure("PLN220", "rewinds_of_time", post(_CA), _LONG + FOOT, ({"rewind": "none"},), refuses=True),
    Cure(
        "PLN220",
        "rewinds",
        post(_CA),
        _LONG.replace("MMPM,500.0", "MMPR,0.1") + FOOT,
        ({"rewind": "none"},),
        refuses=True,
    ),
    by_settings(
        "PLN230 retract_rewind", {"clearance": "50"}, _WOUND, _CA, zero="0,0,100", tool_length="50", clearance="1800"
    ),
    by_settings(
        "PLN230 tool_must_rewind",
        {"clearance": "50"},
        first_cut(round_part(2.8, 89.5)) + "\n".join(round_part(2.8, 89.5)) + "\n",
        _CA,
        clearance="plane:90",
    ),
    marked(
        "PLN230 rewind_within_cutter",
        post(_CA),
        *round_part(0.2),
        "- CUTCOM/LEFT",
        *round_part(2.8)[4:-2],
        "- CUTCOM/OFF",
        *round_part(2.8)[-2:],
        head=first_cut(round_part(2.8)),
        foot=FOOT,
    ),
    marked(
        "PLN130 rotary_axes_flip",
        on_machine(_NARROW),
        *_FLIP[:2],
        f"+ GOTO/1,0,0,{_towards(40.0, 90.0)}",
        _FLIP[2],
        head=first_cut(_FLIP),
        foot=FOOT,
    ),
    by_definition(
        "PLN420 definition_no_rapid",
        'extends = "hs664rt"',
        *(f'+ [[axis]]\nname = "{name}"\nrapid_deg_min = 5000' for name in "CA"),
        text=LEANING,
        pole="lean",
    ),
    by_settings(
        "PLN410 no_lean",
        {"pole_angle": "0.2"},
        first_cut(_PAST).replace("500", "4000") + "\n".join(_PAST) + "\n",
        _BC,
        pole="lean",
        pole_angle="0.1",
    ),
    by_definition(
        "PLN310 not_supported_but",
        'extends = "hs664rt"',
        '+ [control]\nfeed_without_tcp = "all_axes"',
        '+ [control.reading]\nfeed_without_tcp = "all_axes"',
        text=LEANING,
        tcp="off",
        zero="0,0,0",
    ),
    _limited("PLN550 arcs_operation_become", "linearization.arc_chords.MOST_LINES"),
    _limited("PLN550 too_many_lines", "preparation.MOST_LINES"),
    by_settings("PLN120 on_arc", {"zero": "-10,0,0"}, _ARC, zero="0,0,0", tool_length="0"),
    by_settings(
        "PLN140 step_cut_tool_axis",
        {"axis_tolerance": "1"},
        _across(0.3, 150.0),
        _CA,
        tcp="off",
        zero="0,0,0",
        tool_length="50",
        axis_tolerance="0.001",
    ),
    by_settings("PLN140 step_cut_tool", {"axis_tolerance": "2"}, _across(2.0, 138.0).replace("OP1", "FINISH"), _CA),
    _wound("PLN240 axis_ends", _BC, "endless = false\nlimits_deg = [-9000, 9000]"),
    _wound("PLN240 axis_ends_turns_from", "hs664rt", 'endless = false\nlimits_deg = [-9000, 9000]\noutput = "none"'),
    by_definition(
        "PLN240 axis_ends_turns",
        'extends = "hs664rt"',
        "[[axis]]",
        'name = "C"',
        '- output = "none"',
        '+ output = "0..360"',
        text=_WOUND,
    ),
    Cure(
        "PLN540",
        "without_tcp_control",
        on_machine(_OBLIQUE),
        _SHORT + FOOT,
        ({"tcp": "on"},),
        {"tcp": "off", "zero": "0,0,100", "tool_length": "50"},
    ),
    Cure("PLN540", "without_tcp_words", _renamed, _U_V_W, (('"U"', '"X"'), ('"V"', '"Y"'), ('"W"', '"Z"'))),
    Cure(
        "PLN120",
        "on_the_way",
        on_machine(_TIGHT),
        _WAY + FOOT,
        ({"zero": "0,-23,0"},),
        {"tcp": "off", "zero": "0,0,0", "tool_length": "50"},
    ),
)
