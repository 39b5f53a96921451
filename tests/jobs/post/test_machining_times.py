"""Machining times in the comments of a program are those of its report."""

import json
import re
from pathlib import Path

import pytest

import trunnion
from trunnion.jobs.post.machining_times import new_time_token
from trunnion.verification.text import time_lines
from trunnion.wording import format_duration

OPERATION = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10,0,75,0,0
MSYS/0,0,0,1,0,0,0,1,0
INTOL/0.01
OUTTOL/0.01
LOAD/TOOL,{tool}
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0,1
FEDRAT/MMPM,200
{rows}END-OF-PATH
"""

HOLES = "CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-20,STEP,5,MMPM,120\nGOTO/0,0,0\nGOTO/30,0,0\n"
PLANES = HOLES + "GOTO/10,0,0,0.6,0,0.8\nCYCLE/OFF\n"
CUT = "GOTO/0,0,5\nDELAY/2.5\nGOTO/90,0,5\n"
TEXT = "".join(
    OPERATION.format(name=f"OP{k}", tool=k, rows=rows)
    for k, rows in enumerate([CUT, HOLES + "CYCLE/OFF\n", PLANES], start=1)
)


@pytest.mark.parametrize("settings", [{}, {"cycles": "off"}, {"programs": "operations"}])
def test_times_in_comments_agree_with_the_report(settings: dict[str, str], tmp_path: Path) -> None:
    cl, report = tmp_path / "part.cls", tmp_path / "report.json"
    cl.write_text(TEXT, encoding="utf-8")
    result = trunnion.post(cl, machine="dmu65", output=tmp_path / "PART.h", settings=settings, report=report)
    assert result.passed
    said = json.loads(report.read_text(encoding="utf-8"))
    seconds = [operation["seconds"] for operation in said["operations"]]
    assert sum(seconds) == pytest.approx(said["time"]["seconds"])
    text = "".join(file.read_text(encoding="utf-8") for file in (tmp_path / "PART.h", *result.subprograms))
    found = re.findall(r"; machining time (.+) of (.+) \+ rapids", text)
    assert found == [(format_duration(each), format_duration(sum(seconds))) for each in seconds]
    assert "ZZTIME" not in text
    assert min(seconds) > 10.0


@pytest.mark.parametrize("machine", ["dmu65", "matsuura_mx330", "yl569", "xyzac_trt"])
def test_no_name_of_a_cl_file_becomes_a_time(machine: str, tmp_path: Path) -> None:
    names = "ZZTIME00000001", "ZZTIME00000000"
    text = OPERATION.format(name=names[0], tool=1, rows=CUT).replace("TOOL,D10", f"TOOL,{names[1]}")
    (tmp_path / "part.cls").write_text(text, encoding="utf-8")
    settings = {"operation_list": "on", "tool_list": "on"}
    found = trunnion.post(tmp_path / "part.cls", machine=machine, settings=settings).text
    assert found is not None
    assert all(found.count(name) >= 1 for name in names)
    assert set(re.findall(r"[A-Z]{6,}\d{7,}", found)) == set(names), "every token has become a time"


def test_tokens_of_two_programs_differ() -> None:
    tokens = {new_time_token() for _ in range(50)}
    assert len(tokens) == 50
    assert all(re.fullmatch("[A-Z]{7}", each) for each in tokens)


def test_a_dwell_at_the_end_of_an_operation_is_part_of_it(tmp_path: Path) -> None:
    cl, times = tmp_path / "part.cls", []
    for dwell in ("", "DELAY/7\n"):
        cl.write_text(
            OPERATION.format(name="OP1", tool=1, rows=CUT + dwell) + OPERATION.format(name="OP2", tool=1, rows=CUT)
        )
        text = trunnion.post(cl, machine="dmu65", columns=False).text
        assert text is not None
        times.append([60 * int(m or 0) + float(s) for m, s in re.findall(r"machining time (?:(\d+):)?([\d.]+)", text)])
    (one, other), (longer, same) = times
    assert longer - one == pytest.approx(7.0, abs=1.0)
    assert same == other


def test_a_program_in_memory_has_its_times(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(TEXT, encoding="utf-8")
    text = trunnion.post(cl, machine="dmu65", columns=False).text
    assert text is not None
    assert len(re.findall(r"machining time [\d.:]+ (?:s|min) of [\d.:]+ (?:s|min) \+ rapids\n", text)) == 3
    assert "END PGM" in text.splitlines()[-1]


def test_a_control_without_colons_in_comments_has_words_for_times(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(OPERATION.format(name="OP1", tool=1, rows=CUT.replace("2.5", "75.5")), encoding="utf-8")
    text = trunnion.post(
        cl, machine="haas_umc750", settings={"times": "on", "operation_list": "on"}, columns=False
    ).text
    assert text is not None
    assert re.search(r"\(MACHINING TIME 1 MIN \d+ S OF 1 MIN \d+ S \+ RAPIDS\)", text)
    assert re.search(r"\(1 MIN \d+ S \+ RAPIDS, S1000, F200\)", text)


@pytest.mark.parametrize(("machine", "left_out"), [("dmu65", " + rapids"), ("yl569", "")])
def test_a_time_says_that_it_counts_no_rapids_where_their_speed_is_not_stated(
    machine: str, left_out: str, tmp_path: Path
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(OPERATION.format(name="OP1", tool=1, rows=CUT), encoding="utf-8")
    posted = trunnion.post(cl, machine=machine, settings={"times": "on"})
    assert posted.text is not None
    assert posted.verification is not None
    own, total = re.findall(r"machining time(?: :)? (.+) of (.+)\n", posted.text, re.IGNORECASE)[0]
    assert f"{own}{left_out}" == total
    assert own.endswith(" s")
    line, *_ = time_lines(posted.verification)
    assert ("without" in line and line.endswith("motions whose time is not known")) == bool(left_out)


def test_a_template_with_the_time_of_the_operation_alone_says_that_it_counts_no_rapids(tmp_path: Path) -> None:
    machine, cl = tmp_path / "ours.toml", tmp_path / "part.cls"
    cl.write_text(OPERATION.format(name="OP1", tool=1, rows=CUT), encoding="utf-8")
    machine.write_text(
        'extends = "dmu65"\nname = "Ours"\n[control]\nextends = "heidenhain_tnc640"\n'
        "[control.templates]\noperation_start = '; takes {time}'\n",
        encoding="utf-8",
    )
    text = trunnion.post(cl, machine=machine, columns=False).text
    assert text is not None
    assert re.search(r"; takes [\d.]+ s \+ rapids\n", text)
