"""Radius compensation works in a plane: it must be across the tool, in what is posted and in what is read."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.verifying import CL_FOOT
from trunnion.cli import main

Post = Callable[..., tuple[int, str, Path]]

#: A wall along Y, with the tool along X.
SIDE = """TOOL PATH/POCK,TOOL,EM
TLDATA/MILL,10,0,80,0,0
MSYS/0,0,0,1,0,0,0,1,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,7,ADJUST,7
SPINDL/RPM,3000,CLW
RAPID
GOTO/60,-20,0,1,0,0
FEDRAT/MMPM,300
GOTO/30,-20,0
CUTCOM/{words}
GOTO/30,0,0
GOTO/30,20,0
GOTO/30,20,10
CUTCOM/OFF
GOTO/30,30,10
RAPID
GOTO/60,30,10
"""
PLANE_MACHINES = ["yl569", "matsuura_mx330", "hs664rt", "xyzac_trt"]


@pytest.fixture
def post(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Post:
    """Posts the wall; returns exit code, messages, and where the program is."""

    def run(machine: str, words: str, *settings: str) -> tuple[int, str, Path]:
        cl, program = tmp_path / "wall.cls", tmp_path / "wall.nc"
        cl.write_text(SIDE.format(words=words) + CL_FOOT, encoding="utf-8")
        sets = [part for setting in settings for part in ("--set", setting)]
        code = main(["post", str(cl), "--machine", machine, "--output", str(program), *sets])
        found = capsys.readouterr()
        return code, found.out + found.err, program

    return run


@pytest.mark.parametrize("machine", PLANE_MACHINES)
def test_a_plane_along_the_tool_is_refused(machine: str, post: Post) -> None:
    code, said, program = post(machine, "LEFT", "mode=tcp")
    assert code != 0
    assert "wall.cls:12: error: CUTCOM in XYPLAN with TCP" in said
    assert ("mode=OPERATION:tilted" in said) is (machine != "xyzac_trt")  # LinuxCNC has no tilted planes
    assert not program.exists()


def test_the_plane_across_the_tool_is_taken(post: Post) -> None:
    code, said, _ = post("yl569", "LEFT,YZPLAN", "mode=tcp")
    assert code == 0, said


def test_klartext_offsets_by_delta_values_under_m128(
    post: Post, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, said, _ = post("dmu65", "LEFT", "mode=tcp")
    assert code != 0
    assert "wall.cls:12: error: CUTCOM with TCP" in said
    assert "mode=OPERATION:tilted" in said
    code, _, program = post("dmu65", "OFF", "mode=tcp")
    assert code == 0
    text = program.read_text(encoding="utf-8")
    for old, new in ((" F300", " RL F300"), (" M128", " M128\nRR")):
        changed = tmp_path / "changed.h"
        changed.write_text(text.replace(old, new, 1), encoding="utf-8")
        main(["verify", str(changed), "--machine", "dmu65"])
        assert "by the delta values DR" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("machine", "on", "words"),
    [
        ("yl569", "TRAORI", {"G41": 1, "CUT3DC\nG41": 0, "G19 G41": 0, "G18 G41": 1}),
        ("matsuura_mx330", "G43.4 H7", {"G41 D7": 1, "G41.2 D7": 0, "G19 G41 D7": 0}),
        ("hs664rt", "G196", {"G41": 1, "G19 Q1 G41": 0}),
        ("xyzac_trt", "M428", {"G41": 1, "G19 G41": 0}),
    ],
)
def test_a_program_that_offsets_along_the_tool_is_a_fault(
    machine: str, on: str, words: dict[str, int], post: Post, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, _, program = post(machine, "OFF", "mode=tcp")
    assert code == 0
    text = program.read_text(encoding="utf-8")
    assert on in text
    for word, faults in words.items():
        changed = tmp_path / "changed.nc"
        # Straight before the first cut under TCP.
        lines = text.splitlines(keepends=True)
        at = next(k for k, line in enumerate(lines) if re.search(r"F300\b", line))
        changed.write_text(
            "".join([*lines[: at + 1], word + "\n", *lines[at + 1 : at + 3], "G40\n", *lines[at + 3 :]]),
            encoding="utf-8",
        )
        main(["verify", str(changed), "--machine", machine])
        assert ("to which the tool is not perpendicular" in capsys.readouterr().out) is bool(faults), word
