"""``trunnion check --program``: the keys under which the programs of a machine read best."""

from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.jobs.describe.reading_keys import proposed_reading

FANUC = "%\nO1\nG21 G17 G40 G80 G90 G94\nT1 M6\nG54 G0 X0. Y0. S900 M3\nG43 H1 Z9.\n"
END = "G0 Z9.\nG49\nM30\n%\n"


@pytest.mark.parametrize(
    ("machine", "text", "keys"),
    [
        ("matsuura_mx330", FANUC + "G1 X5. F9.\n" + END, {}),
        ("matsuura_mx330", FANUC + "G1 X5. F9. *\nX7.*\n" + END, {"block_ends": ["*"]}),
        ("matsuura_mx330", FANUC + "G1 X5. F9. ; FIRST\nX7. 'LAST\n" + END, {"more_comments": [";", "'"]}),
        ("matsuura_mx330", FANUC + "G1 X5. F9.\nG2 X7. Y2. I7. J0.\n" + END, {"arc_centres": "absolute"}),
        ("matsuura_mx330", FANUC + "G1 X5. F9. (A (B))\n" + END, {"nested_comments": "counted"}),
        (
            "matsuura_mx330",
            FANUC + "G1 X-40. Y50. F9.\nG3 X-30. Y40. I-40 J40\n" + END,
            {"arc_centres": "absolute", "whole_numbers": "calculator"},
        ),
        ("matsuura_mx330", FANUC + "G1 N5 X5. F9.\n" + END, {"numbers_anywhere": "anywhere"}),
        ("matsuura_mx330", FANUC + "G1 X5. F500000\n" + END, {"whole_feeds": "increments"}),
        ("matsuura_mx330", FANUC + "G1 X5. F500000.\n" + END, {}),
        ("matsuura_mx330", FANUC.replace("G21 ", "") + "G1 X5. F.5\nX6. F.75\n" + END, {"units": "inch"}),
        ("matsuura_mx330", FANUC + "G1 X5. F.5\n" + END, {}),
        ("matsuura_mx330", FANUC.replace("G21 ", "") + "G95 G1 X5. F.05\n" + END, {}),
        ("yl569", "G90\nG0 X0 Y0 Z9\nG1 X5 F.5\nM30\n", {"units": "inch"}),
        ("xyzac_trt", "G90 G94\nG0 X0 Y0 Z9\nG1 X5 F.5\nM2\n", {"units": "inch"}),
        ("xyzac_trt", ":12\nG21 G90 G94\nG1 X5 F9\nM2\n", {"program_numbers": [":"]}),
        ("yl569", "G71 G90\nG1 X5 F9 ! FIRST\nM30\n", {"more_comments": ["!"]}),
    ],
)
def test_keys_are_proposed_that_the_text_can_tell(
    machine: str, text: str, keys: dict[str, object], tmp_path: Path
) -> None:
    program = tmp_path / "a.nc"
    program.write_text(text)
    found = proposed_reading(program, trunnion.load_machine(machine))
    assert found.keys == keys
    assert found.after <= found.before
    assert len(found.why) == len(keys)


def test_why_feeds_are_plausible_is_said(tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text(FANUC.replace("G21 ", "") + "G1 X5. F.5\nX6. F.75\n" + END)
    found = proposed_reading(program, trunnion.load_machine("matsuura_mx330"))
    assert (found.before[2], found.after[2]) == (2, 0)
    assert list(found.lines())[1:] == [
        "[control.reading]",
        'units = "inch"  # 2 feeds with which no machine cuts before, 0 with it',
    ]


def test_the_proposal_is_toml_to_copy_and_changes_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, ours = tmp_path / "a.nc", tmp_path / "ours.toml"
    program.write_text(FANUC + "G1 X5. F9. *\n" + END)
    ours.write_text('extends = "matsuura_mx330"\nname = "Ours"\n')
    before = ours.read_text()
    assert main(["check", str(ours), "--program", str(program)]) == 0
    said = capsys.readouterr().out
    assert '[control.reading]\nblock_ends = ["*"]  # 1 error before, 0 with it' in said
    assert ours.read_text() == before
    ours.write_text(before + said[said.index("[control.reading]") :])
    assert trunnion.read_program(program, machine=str(ours)).errors == ()


def test_a_subprogram_is_named_before_what_is_proposed(tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text("O77\nG91 G1 X1. F100.\nM99\n")
    lines = list(proposed_reading(program, trunnion.load_machine("matsuura_mx330")).lines())
    assert lines[0].startswith("this looks like a subprogram, by M99 in line 3; give the program that calls it")
    program.write_text(FANUC + "G1 X5. F9.\n" + END)
    assert len(list(proposed_reading(program, trunnion.load_machine("matsuura_mx330")).lines())) == 1


def test_a_foreign_program_is_named_before_what_is_proposed(tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text("%PART,MX--\nN10 G90\n#RTCP ON\nN20 X5 F9\n#RTCP OFF\nM30\n")
    lines = list(proposed_reading(program, trunnion.load_machine("matsuura_mx330")).lines())
    assert lines[0].startswith("this looks like a Fagor program, by #RTCP in line 3")


def test_data_are_refused_and_not_counted_as_errors(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "a.nc"
    program.write_bytes(bytes(range(256)))
    assert main(["check", "matsuura_mx330", "--program", str(program)]) == 2
    said = capsys.readouterr()
    assert "[NC110]" in said.err
    assert not said.out
