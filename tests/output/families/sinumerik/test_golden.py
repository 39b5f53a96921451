"""Programs that ran on the YL569, byte for byte."""

import pytest

from tests.support.locations import HEADS, YL569
from tests.support.program_text import motion_part
from tests.support.proof import unproven
from trunnion.cli import main


def posted(name: str, capfdbinary: pytest.CaptureFixture[bytes], *extra: str) -> bytes:
    """The program of a golden CL file, through the command line."""
    head = [f"--set={key}={value}" for key, value in HEADS.get(name, {}).items()]
    code = main(["post", str(YL569 / f"{name}.cls"), "--machine", "yl569", "--output", "-", *head, *extra])
    out, err = capfdbinary.readouterr()
    assert (code, unproven(err.decode())) == (0, "")
    return out


@pytest.mark.parametrize("name", HEADS)
def test_a_five_axis_program_is_the_one_that_ran_byte_for_byte(
    name: str, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    assert posted(name, capfdbinary) == (YL569 / f"{name}.expected.mpf").read_bytes()


def test_a_three_axis_program_with_arcs_is_the_one_that_ran_between_its_typed_head_and_foot(
    capfdbinary: pytest.CaptureFixture[bytes],
) -> None:
    expected = (YL569 / "1_contour_rough.expected.mpf").read_bytes()
    assert motion_part(posted("1_contour_rough", capfdbinary)) == motion_part(expected)


def test_the_same_input_gives_the_same_bytes_and_no_date(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    first, second = (posted("1_contour_rough", capfdbinary) for _ in range(2))
    assert first == second
    assert b"DATE" not in first


@pytest.mark.parametrize(
    ("method", "mode"),
    [
        ("METHOD", "_ORI_ROUGH"),
        ("MILL_SEMI_FINISH", "_ORI_SEMIFIN"),
        ("MILL_FINISH", "_ORI_FINISH"),
        ("x", "_ORI_ROUGH"),
    ],
)
def test_cycle832_follows_the_method(method: str, mode: str, capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    program = posted("2_hub_rough", capfdbinary, f"--set=method={method}").decode()
    assert f"CYCLE832(_camtolerance,{mode},1)" in program
    assert f'MSG("{method}")' in program
    assert f";TECHNOLOGY: {method}" in program


def test_settings_replace_what_the_file_says(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    program = posted(
        "2_hub_rough", capfdbinary, "--set=tool=7", "--set=tolerance=0.02", "--set=stock=0.3", "--set=work_offset=G55"
    ).decode()
    for line in ("T=7\n", "_camtolerance=.02\n", ";Stock : 0.300000\n", "G55\n"):
        assert line in program


def test_a_tool_can_be_called_by_its_name(capfdbinary: pytest.CaptureFixture[bytes]) -> None:
    assert 'T="UGT0203_004"\n' in posted("2_hub_rough", capfdbinary, "--set=tool_call=name").decode()
