"""Settings of a post that ``verify`` is told again: what it takes, what it refuses, and what its faults name."""

from collections.abc import Mapping
from pathlib import Path

import pytest

import trunnion
from trunnion.jobs.inputs.control_settings import written_control
from trunnion.jobs.inputs.run_settings import RUN_SETTINGS
from trunnion.options.words import PROOF_SETTINGS

_POCKET = """TOOL PATH/POCKET,TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/0.0,0.0,0.0,1.0,0.0,0.0,0.0,1.0,0.0
LOAD/TOOL,1,ADJUST,2
SPINDL/RPM,3000,CLW
RAPID
GOTO/0.0,0.0,30.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/0.0,0.0,-1.0
{left}GOTO/20.0,0.0,-1.0
GOTO/20.0,30.0,-1.0
{off}GOTO/10.0,30.0,-1.0
RAPID
GOTO/10.0,30.0,30.0
END-OF-PATH
"""
_EDGE = _POCKET.format(left="", off="")
_COMPENSATED = _POCKET.format(left="CUTCOM/LEFT\n", off="CUTCOM/OFF\n")

_CASES = [
    ("yl569", _EDGE, {"edge_from": "adjust"}, "tool"),
    ("matsuura_mx330", _COMPENSATED, {"radius_offset": "30"}, "compensation"),
    ("haas_umc750", _COMPENSATED, {"radius_offset": "30"}, "compensation"),
    ("dmu65", _EDGE, {"delta_length": "0.2"}, "tool"),
]


@pytest.mark.parametrize(("machine", "text", "settings", "key"), _CASES)
def test_what_post_has_proven_verify_proves_with_the_same_settings(
    machine: str, text: str, settings: Mapping[str, str], key: str, tmp_path: Path
) -> None:
    source = tmp_path / "part.cls"
    source.write_text(text, encoding="utf-8")
    program = tmp_path / "part.nc"
    trunnion.post(source, machine=machine, settings=settings, output=program)
    assert trunnion.verify(program, machine=machine, cl=source, settings=settings).passed
    found = trunnion.verify(program, machine=machine, cl=source)
    failed = {check.key: check.summary for check in found.checks if check.state == "FAIL"}
    assert set(failed) == {key}
    (name, value), *_ = settings.items()
    assert f"posted with {name}={value}, repeat that (--set {name}={value})" in failed[key]


def test_settings_without_which_the_proof_is_the_same_are_refused(tmp_path: Path) -> None:
    program = tmp_path / "part.nc"
    program.write_text("%\nM30\n%\n", encoding="utf-8")
    with pytest.raises(trunnion.InputError, match="keep_rotary is not a setting that the proof needs"):
        trunnion.verify(program, machine="haas_umc750", settings={"keep_rotary": "on"})
    with pytest.raises(trunnion.InputError, match="edge_from is not a setting of Haas"):
        trunnion.verify(program, machine="haas_umc750", settings={"edge_from": "adjust"})


def test_settings_to_repeat_are_settings_of_posts() -> None:
    names = ("matsuura_mx330", "haas_umc750", "yl569", "dmu65", "hs664rt")
    controls = [written_control(trunnion.load_machine(name)) for name in names]
    known = {key for control in controls if control for key in control.settings}
    assert set(PROOF_SETTINGS) <= known | set(RUN_SETTINGS)
