"""``trunnion verify``, and the proof at the end of ``trunnion post``."""

import json
from pathlib import Path

import pytest

from tests.paths import YL569
from trunnion.cli import main

PROGRAM = YL569 / "3_blade_finish.expected.mpf"
CL = YL569 / "3_blade_finish.cls"


def verify(capfd: pytest.CaptureFixture[str], *arguments: str | Path) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of ``trunnion verify`` on the YL569."""
    code = main(["verify", *map(str, arguments), "--machine", "yl569"])
    return code, *capfd.readouterr()


def test_a_good_program_has_one_line_a_check_and_exit_code_0(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, err = verify(capfd, PROGRAM, "--cl", CL)
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert [line.split()[:2] for line in lines[:3]] == [["order", "ok"], ["tip", "ok"], ["axis", "ok"]]
    assert f"{PROGRAM}:111 (N1110): half-way the tool axis is 3.56063 degrees off the great circle [span]" in lines


def test_it_also_looks_at_a_program_alone(capfd: pytest.CaptureFixture[str]) -> None:
    code, out, _ = verify(capfd, PROGRAM)
    assert code == 0
    assert [line.split()[0] for line in out.splitlines() if " ok " in line] == [
        "offset", "span", "travel", "speed", "acceleration", "modal", "words",
    ]  # fmt: skip


def test_a_wrong_program_has_exit_code_1_and_names_both_lines(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / "wrong.mpf"
    wrong.write_text(PROGRAM.read_text(encoding="utf-8").replace("X47.2619 ", "X47.3619 "), encoding="utf-8")
    code, out, _ = verify(capfd, wrong, "--cl", CL)
    assert code == 1
    assert f"{wrong}:52 (N520), {CL}:20: the tip is 0.100000 mm off: X47.36190 for 47.26190 [tip]" in out
    assert verify(capfd, wrong, "--cl", CL, "--tolerance", "0.2")[0] == 0


def test_what_the_cl_file_does_not_say_can_be_said(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = PROGRAM.read_text(encoding="utf-8")
    other = tmp_path / "other.mpf"
    other.write_text(text.replace("T=2", "T=7").replace("G54", "G55").replace("D1", "D3"), encoding="utf-8")
    assert verify(capfd, other, "--cl", CL)[0] == 1
    assert verify(capfd, other, "--cl", CL, "--tool", "7", "--offset", "G55", "--edge", "3")[0] == 0
    assert verify(capfd, PROGRAM, "--span", "1")[0] == 1


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["nothing.mpf"], "nothing.mpf"),
        ([str(PROGRAM), "--cl", "nothing.cls"], "nothing.cls"),
        ([str(PROGRAM), "--offset", "first"], "'first'"),
        ([str(PROGRAM), "--zero", "1,2"], "zero is '1,2'"),
        ([str(PROGRAM), "--report", "page.pdf"], ".html"),
    ],
)
def test_what_cannot_be_used_has_exit_code_2(
    arguments: list[str], word: str, capfd: pytest.CaptureFixture[str]
) -> None:
    code, _, err = verify(capfd, *arguments)
    assert code == 2
    assert word in err


def test_a_machine_whose_programs_cannot_be_read_yet_says_so(capfd: pytest.CaptureFixture[str]) -> None:
    assert main(["verify", str(PROGRAM), "--machine", "dmu65"]) == 2
    assert "cannot be read yet" in capfd.readouterr().err


def test_a_report_holds_the_same_checks(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("trunnion.report")
    report = tmp_path / "report.json"
    assert verify(capfd, PROGRAM, "--cl", CL, "--report", report)[0] == 0
    assert "tip" in json.dumps(json.loads(report.read_text(encoding="utf-8")))


# The end of ``trunnion post``


def machine_without_tcp(folder: Path) -> Path:
    """The YL569 with an approach that forgets TRAORI."""
    file = folder / "forgetful.toml"
    file.write_text(
        'extends = "yl569"\n[control.templates]\napproach_five_axis = """\n'
        ";Initial Move\nG0 {primary_word} {secondary_word}\n{work_offset}\nORIWKS\nORIAXES\n"
        '"""\n',
        encoding="utf-8",
    )
    return file


def test_post_refuses_a_program_that_does_something_else_and_writes_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    machine, target = machine_without_tcp(tmp_path), tmp_path / "out" / "p.mpf"
    target.parent.mkdir()
    code = main(["post", str(CL), "--machine", str(machine), "--output", str(target)])
    out, err = capfd.readouterr()
    assert (code, out, list(target.parent.iterdir())) == (1, "", [])
    assert "tip           FAIL" in err
    assert "no program is written; --force writes it" in err
    assert f"{target}:" in err
    assert main(["post", str(CL), "--machine", str(machine), "--output", "-"]) == 1
    assert capfd.readouterr().out == ""


def test_force_writes_it_and_its_head_names_the_checks(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    machine, target = machine_without_tcp(tmp_path), tmp_path / "p.mpf"
    assert main(["post", str(CL), "--machine", str(machine), "--output", str(target), "--force"]) == 0
    lines = target.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("N10 ;MUST NOT RUN AS IT IS, written by --force: tool tip against the CL points: ")
    assert sum(line.endswith(" M30") for line in lines) == 1


def test_post_says_what_it_proved_with_half_the_last_digit_allowed(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    both = [str(YL569 / "1_contour_rough.cls"), str(YL569 / "2_hub_rough.cls")]
    assert main(["post", *both, "--machine", "yl569", "--output", str(tmp_path / "p.mpf"), "--set=tool=7"]) == 0
    err = capfd.readouterr().err
    assert "FAIL" not in err
    assert "82 points in their order" in err
    assert "allowed 0.0000" in err or "allowed 0.000500" in err
