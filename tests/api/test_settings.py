"""Settings of a post: what they may be, whether they come from the command line or from a script."""

from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.cli import main

CL = YL569 / "2_hub_rough.cls"
PROGRAM = YL569 / "2_hub_rough.expected.mpf"


@pytest.mark.parametrize(
    "zero",
    [(1.0, 2.0, float("nan")), "0,0,inf", "-inf,0,0", "nan,0,0", (0.0, 0.0, 1e9), "0,0,-1e300", (0.0, 0.0), "1,2,3,4"],
)
@pytest.mark.filterwarnings("error")
def test_a_workpiece_zero_is_three_finite_lengths(zero: object) -> None:
    with pytest.raises(trunnion.InputError, match="zero is"):
        trunnion.post(CL, machine="yl569", settings={"zero": zero})  # type: ignore[dict-item]
    with pytest.raises(trunnion.InputError, match="zero is"):
        trunnion.verify(PROGRAM, machine="yl569", zero=zero)  # type: ignore[arg-type]
    with pytest.raises(trunnion.InputError, match="zero is"):
        trunnion.convert(PROGRAM, machine="yl569", to_cl=True, zero=zero)  # type: ignore[arg-type]


@pytest.mark.parametrize("length", [float("nan"), float("inf"), "nan", -1.0, 1e9])
def test_a_tool_length_is_finite(length: object) -> None:
    with pytest.raises(trunnion.InputError, match="tool_length is"):
        trunnion.verify(PROGRAM, machine="yl569", tool_length=length)  # type: ignore[arg-type]


def test_the_command_refuses_an_endless_workpiece_zero(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = tmp_path / "p.mpf"
    code = main(["post", str(CL), "--machine", "yl569", "--set", "zero=0,0,inf", "--output", str(output)])
    assert (code, output.exists()) == (2, False)
    assert "zero is '0,0,inf'" in capsys.readouterr().err


def test_a_run_keeps_the_setup_with_which_it_was_read() -> None:
    """Its slides were computed with the workpiece zero and the tool length of its machine."""
    run = trunnion.read_program(PROGRAM, machine="yl569")
    for setup in ({"zero": (0, 0, 5000)}, {"tool_length": 100.0}, {"subprograms": ["sub.spf"]}):
        with pytest.raises(trunnion.InputError, match="already been read"):
            trunnion.verify(run, machine="yl569", **setup)
    with pytest.raises(trunnion.InputError, match="was read for"):
        trunnion.verify(run, machine="dmu65")
    with pytest.raises(trunnion.InputError, match="was read for"):
        trunnion.diff(run, PROGRAM, machine="dmu65", to_machine="yl569")
