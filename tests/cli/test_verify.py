"""``trunnion verify``, and the proof at the end of ``trunnion post``."""

import json
import re
from collections.abc import Callable
from html import escape
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

import pytest

from tests.support.locations import YL569
from tests.support.machines import machine_without_tcp
from trunnion.cli import main
from trunnion.model.operation_start import OperationStart
from trunnion.model.template_passage import TemplatePassage
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import SubprogramOutput

PROGRAM = YL569 / "3_blade_finish.expected.mpf"
CL = YL569 / "3_blade_finish.cls"

Capture = pytest.CaptureFixture[str]


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
    assert [line.split()[0] for line in out.splitlines() if " ok " in line or "  not checked  " in line] == [
        "offset", "span", "travel", "speed", "acceleration", "rpm", "turns", "modal", "words",
    ]  # fmt: skip
    assert out.splitlines()[-1].startswith(
        "Passed in part: 7 of 21 checks; 14 not checked; no CL file: path, feeds, speeds and tools are compared with"
        " nothing; stands on "
    )


def test_a_wrong_program_has_exit_code_1_and_names_both_lines(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    wrong = tmp_path / "wrong.mpf"
    wrong.write_text(PROGRAM.read_text(encoding="utf-8").replace("X47.2619 ", "X47.3619 "), encoding="utf-8")
    code, out, _ = verify(capfd, wrong, "--cl", CL)
    assert code == 1
    assert f"{wrong}:52 (N520), {CL}:20: the tip is 0.100000 mm off: X47.36190 for 47.26190 [tip]" in out
    assert verify(capfd, wrong, "--cl", CL, "--tolerance", "0.2")[0] == 0


def test_a_main_program_is_proven_with_its_subprogram_where_that_is_named(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    lines = PROGRAM.read_text(encoding="utf-8").splitlines()
    sub, main_program = tmp_path / "BLADE.SPF", tmp_path / "main.mpf"
    sub.write_text("\n".join([*lines[:-1], "M17"]), encoding="utf-8")
    main_program.write_text('EXTCALL("BLADE.SPF")\nM30', encoding="utf-8")
    code, out, _ = verify(capfd, main_program, "--cl", CL)
    assert code == 1
    assert f"{main_program}:1: unknown word or missing subprogram BLADE.SPF: it is not executed" in out
    code, out, _ = verify(capfd, main_program, "--subprograms", sub, "--cl", CL)
    assert code == 0
    wrong = sub.read_text(encoding="utf-8").replace("X47.2619 ", "X47.3619 ")
    sub.write_text(wrong, encoding="utf-8")
    code, out, _ = verify(capfd, main_program, "--subprograms", sub, "--cl", CL)
    assert code == 1
    assert f"{sub}:52 (N520), {CL}:20: the tip is 0.100000 mm off" in out


def test_what_the_cl_file_does_not_say_can_be_said(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    text = PROGRAM.read_text(encoding="utf-8")
    other = tmp_path / "other.mpf"
    other.write_text(text.replace("T=2", "T=7").replace("G54", "G55").replace("D1", "D3"), encoding="utf-8")
    assert verify(capfd, other, "--cl", CL)[0] == 1
    assert verify(capfd, other, "--cl", CL, "--tool", "7", "--work-offset", "G55", "--edge", "3")[0] == 0
    assert verify(capfd, PROGRAM, "--span", "1")[0] == 1


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["nothing.mpf"], "nothing.mpf"),
        ([str(PROGRAM), "--cl", "nothing.cls"], "nothing.cls"),
        ([str(PROGRAM), "--work-offset", "first"], "'first'"),
        ([str(PROGRAM), "--zero", "1,2"], "--zero: error: is '1,2'"),
        ([str(PROGRAM), "--report", "page.pdf"], ".html"),
    ],
)
def test_what_cannot_be_used_has_exit_code_2(
    arguments: list[str], word: str, capfd: pytest.CaptureFixture[str]
) -> None:
    code, _, err = verify(capfd, *arguments)
    assert code == 2
    assert word in err


def test_a_machine_whose_programs_cannot_be_read_yet_says_so(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    machine = tmp_path / "strange.toml"
    machine.write_text('extends = "hs664rt"\n[control]\nfamily = "strange"\n', encoding="utf-8")
    assert main(["verify", str(PROGRAM), "--machine", str(machine)]) == 2
    assert "cannot be read yet" in capfd.readouterr().err


@pytest.mark.parametrize("suffix", [".json", ".html"])
@pytest.mark.parametrize("with_cl", [True, False])
def test_a_report_holds_the_same_checks(
    suffix: str, with_cl: bool, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    report = tmp_path / f"report{suffix}"
    cl: list[str | Path] = ["--cl", CL] if with_cl else []
    code, out, _ = verify(capfd, PROGRAM, *cl, "--report", report)
    assert code == 0
    assert_reported(report, [line for line in out.splitlines() if " ok " in line])


def assert_reported(report: Path, lines: list[str]) -> None:
    """A report, page or data, says what the lines of the checks say, and has the columns of every motion."""
    text = report.read_text(encoding="utf-8")
    keys, _, summaries = zip(*(line.split(maxsplit=2) for line in lines), strict=True)
    told = [re.sub("; checked [0-9]+ of [0-9]+ motions.*", "", each) for each in summaries]
    assert len(keys) >= 7
    if report.suffix == ".html":
        assert "✗ failed" not in text
        assert all(escape(summary) in text for summary in summaries)
        return
    said = json.loads(text)
    made = [(check["key"], check["summary"]) for check in said["checks"] if check["state"] == "ok"]
    assert made == list(zip(keys, told, strict=True))
    assert {len(column) for column in said["columns"].values()} == {said["motions"]} == {154}
    assert any(said["columns"]["cl_line"]) == ("tip" in keys)


# The end of ``trunnion post``


CHECKS = [
    "order", "tip", "axis", "kind", "feed", "spindle", "tool", "coolant", "compensation",
    "stops", "offset", "home", "holes", "span", "travel",
    "speed", "acceleration", "rpm", "turns", "modal", "words",
]  # fmt: skip


def post(*arguments: str | Path) -> int:
    """Exit code of ``trunnion post``."""
    return main(["post", *map(str, arguments)])


def spoil(monkeypatch: pytest.MonkeyPatch, change: Callable[[bytes], bytes]) -> None:
    """Let the writer write something else than it was told."""

    def wrong(
        program: Program,
        sink: BinaryIO,
        advance: Callable[[int], None] | None = None,
        subprograms: SubprogramOutput | None = None,
        passages: list[TemplatePassage] | None = None,
    ) -> tuple[OperationStart, ...]:
        assert subprograms is None
        assert not passages
        whole = BytesIO()
        starts = write_program(program, whole, advance)
        changed = change(whole.getvalue())
        assert changed != whole.getvalue()
        sink.write(changed)
        return starts

    monkeypatch.setattr("trunnion.jobs.post.writing.write_program", wrong)


def without_a_block(text: bytes) -> bytes:
    """The program without the block N600, which cuts."""
    return re.sub(rb"(?m)^N600 .*\n", b"", text)


@pytest.mark.parametrize("output", ["p.mpf", "-"])
def test_post_ends_with_one_line_a_check(output: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    target = output if output == "-" else tmp_path / output
    assert post(CL, "--machine", "yl569", "--output", target) == 0
    lines = capfd.readouterr().err.splitlines()
    proven = [line for line in lines if " ok " in line or "  not checked  " in line]
    assert [line.split()[0] for line in proven] == CHECKS
    (standing,) = [line for line in lines if line.startswith("Passed in part: 19 of 21 checks; 2 not checked; ")]
    assert "147 points in their order" in proven[0]
    unmeasured = [line for line in lines if ": not measured: " in line]
    assert [line.partition(":")[0] for line in unmeasured] == ["home", "travel, speed"]
    others = [line for line in lines if line not in (*proven, standing, *unmeasured)]
    assert others == ([] if output == "-" else [lines[-1]])


def test_no_program_is_too_long_to_be_proven(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    text = CL.read_text(encoding="utf-8").splitlines(keepends=True)
    first = next(k for k, line in enumerate(text) if line.startswith("GOTO/") and "FEDRAT" in "".join(text[:k]))
    cl = tmp_path / "long.cls"
    tail = [line for line in text[first:] if not line.startswith("GOTO/")]
    points = [f"GOTO/{k % 90:.4f},{k % 70:.4f},5.0000,0.0000000,0.0000000,1.0000000\n" for k in range(310_000)]
    cl.write_text("".join([*text[:first], *points, *tail]), encoding="utf-8")
    target = tmp_path / "p.mpf"
    assert post(cl, "--machine", "yl569", "--output", target) == 0
    err = capfd.readouterr().err
    proven = [line for line in err.splitlines() if " ok " in line or "  not checked  " in line]
    assert [line.split()[0] for line in proven] == CHECKS
    assert "warning: more than" not in err
    last = re.findall(rb"(?m)^N\d+ .*X.*\n", target.read_bytes())[-2]
    spoil(monkeypatch, lambda text: text.replace(last, b"", 1))
    target.unlink()
    assert post(cl, "--machine", "yl569", "--output", target) == 1
    assert not target.exists()


def test_a_program_that_lacks_a_block_is_refused_with_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    spoil(monkeypatch, without_a_block)
    target = tmp_path / "p.mpf"
    target.write_bytes(b"the old one")
    assert post(CL, "--machine", "yl569", "--output", target) == 1
    out, err = capfd.readouterr()
    assert (out, target.read_bytes(), len(list(tmp_path.iterdir()))) == ("", b"the old one", 1)
    assert "order         FAIL  N610: no block goes to this CL point" in err
    assert f"{target}:60 (N610), {CL}:31: no block goes to this CL point [order]" in err
    assert err.splitlines()[-1] == (
        f"{CL}: error: the program fails its proof: N610: no block goes to this CL point (order); "
        "no program is written: correct the lines above, and post again; --force writes it only to look at it [CTL910]"
    )
    assert post(CL, "--machine", "yl569", "--output", "-") == 1
    assert capfd.readouterr().out == ""
    assert post(CL, "--machine", "yl569", "--output", target, "--force", "--edited", "replace") == 1
    assert "order" not in target.read_text(encoding="utf-8")
    assert target.read_text(encoding="utf-8").startswith(
        "N10 ;MUST NOT RUN AS IT IS, written by --force: every CL point has its block, every block its point: N610"
    )


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        (b"X47.2619 ", b"X47.2620 ", "tip"),
        (b"C11.03423", b"C11.03425", "axis"),
        (b"F250.", b"F251.", "feed"),
        (b"S2500", b"S2501", "spindle"),
        (b"T=2", b"T=3", "tool"),
        (b"G54", b"G55", "offset"),
        (b"M30", b"M5", "modal"),
        (b" TRAORI", b" TRAORY", "words"),
        (b"SUPA G0 Z=_Z_HOME D0", b"SUPA G0 Z=_Z_HOME-1 D0", "home"),
    ],
)
def test_whatever_the_writer_does_wrong_post_refuses(
    old: bytes,
    new: bytes,
    key: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    spoil(monkeypatch, lambda text: text.replace(old, new, 1))
    assert post(CL, "--machine", "yl569", "--output", tmp_path / "p.mpf") == 1
    assert list(tmp_path.iterdir()) == []
    assert re.search(rf"(?m)^{key} +FAIL ", capfd.readouterr().err)


@pytest.mark.parametrize("suffix", [".json", ".html"])
def test_post_reports_what_it_proved(suffix: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    report = tmp_path / f"report{suffix}"
    assert post(CL, "--machine", "yl569", "--output", tmp_path / "p.mpf", "--report", report) == 0
    assert_reported(report, [line for line in capfd.readouterr().err.splitlines() if " ok " in line])


def test_a_refused_program_has_its_report_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    spoil(monkeypatch, without_a_block)
    report = tmp_path / "report.json"
    assert post(CL, "--machine", "yl569", "--output", tmp_path / "p.mpf", "--report", report) == 1
    said = json.loads(report.read_text(encoding="utf-8"))
    assert [check["key"] for check in said["checks"] if check["state"] == "FAIL"] == ["order"]
    assert [path.name for path in tmp_path.iterdir()] == ["report.json"]


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ([CL, "--output", "p.mpf", "--report", "page.pdf"], ".html"),
        ([CL, YL569 / "2_hub_rough.cls", "--output", ".", "--report", "r.json"], "is one file for 2 programs"),
    ],
)
def test_a_report_that_cannot_be_is_said_before_any_work(
    arguments: list[str | Path],
    word: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert post(*arguments, "--machine", "yl569") == 2
    assert word in capfd.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_post_refuses_a_program_that_does_something_else_and_writes_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    machine, target = machine_without_tcp(tmp_path), tmp_path / "out" / "p.mpf"
    target.parent.mkdir()
    code = main(["post", str(CL), "--machine", str(machine), "--output", str(target)])
    out, err = capfd.readouterr()
    assert (code, out, list(target.parent.iterdir())) == (1, "", [])
    assert "tip           FAIL" in err
    assert "--force writes it only to look at it" in err
    assert f"{target}:" in err
    assert main(["post", str(CL), "--machine", str(machine), "--output", "-"]) == 1
    assert capfd.readouterr().out == ""


def test_force_writes_it_and_its_head_names_the_checks(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    machine, target = machine_without_tcp(tmp_path), tmp_path / "p.mpf"
    assert main(["post", str(CL), "--machine", str(machine), "--output", str(target), "--force"]) == 1
    lines = target.read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("N10 ;MUST NOT RUN AS IT IS, written by --force: 1. tool tip against the CL points: ")
    assert sum("MUST NOT RUN" in line for line in lines) == 1
    assert sum(line.endswith(" M30") for line in lines) == 1


def test_post_says_what_it_proved_with_half_the_last_digit_allowed(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    both = [str(YL569 / "1_contour_rough.cls"), str(YL569 / "2_hub_rough.cls")]
    assert (
        main(["post", *both, "--machine", "yl569", "--output", str(tmp_path / "p.mpf"), "--set=tool=7,CAVITY_MILL:6"])
        == 0
    )
    err = capfd.readouterr().err
    assert "FAIL" not in err
    assert "82 points in their order" in err
    assert "allowed 0.0000" in err or "allowed 0.000500" in err


def test_a_program_for_another_control_is_asked_after_first(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "part.h"
    lines = "".join(f"{k} L X+{k} Y+0 FMAX\n" for k in range(1, 9))
    program.write_text(f"0 BEGIN PGM PART MM\n{lines}9 END PGM PART MM\n", encoding="utf-8")
    code, out, _ = verify(capfd, program)
    assert code == 1
    marks = "by 0 BEGIN PGM in line 1 and 1 L X+ in line 2"
    assert f"{program}:1: this looks like a Heidenhain Klartext program, {marks}; name the machine that runs it" in out


@pytest.mark.parametrize("machine", ["yl569", "haas_umc750", "dmu65"])
def test_a_cl_file_in_place_of_a_program_is_refused_as_one(machine: str, tmp_path: Path, capfd: Capture) -> None:
    named = "is a CL file, and no NC program; post it, and give the program [NC112]"
    for arguments in (
        ["verify", str(CL), "--machine", machine],
        ["diff", str(CL), str(CL), "--machine", machine],
        ["convert", str(CL), "--machine", machine, "--to-machine", "yl569", "--output", str(tmp_path / "new.mpf")],
    ):
        assert main(arguments) == 2
        assert capfd.readouterr().err == f"{CL}: error: {named}\n"


def test_an_empty_file_is_refused_as_post_refuses_it(tmp_path: Path, capfd: Capture) -> None:
    empty, page = tmp_path / "empty.mpf", tmp_path / "page.html"
    empty.write_text("")
    for arguments in (["verify", str(empty)], ["view", str(empty), "--output", str(page)]):
        assert main([*arguments, "--machine", "yl569"]) == 2
        assert capfd.readouterr().err.startswith(f"{empty}: error: the file is empty; ")
    assert not page.exists()


def test_places_of_checks_that_were_not_made_are_under_no_passed_check(capfd: Capture) -> None:
    code, out, _ = verify(capfd, PROGRAM)
    lines = out.splitlines()
    passed, unjudged = lines.index("passed; the worst places:"), lines.index("not checked; what is known:")
    places = [place for place in lines if place.startswith(f"{PROGRAM}:")]
    assert code == 0
    assert passed < unjudged
    assert {place.endswith("[travel]") for place in places if lines.index(place) > unjudged} == {True}
    assert not [place for place in lines[:unjudged] if place.endswith("[travel]")]
