"""Texts that are longer than a line of the control: comments are divided, and nothing of them is lost."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.controls import load_control
from trunnion.machines import load_machine
from trunnion.output.shared.lines import divided_comment, split_text

LONG = "-".join(f"NAME{k}" for k in range(60))


@pytest.mark.parametrize("machine", ["dmu65", "xyzac_trt"])
def test_every_text_is_divided(machine: str, tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    name, tool = re.findall(r"TOOL PATH/(\w+),TOOL,(\w+)", HEAD)[0]
    text = HEAD.replace(f"TOOL PATH/{name},TOOL,{tool}", f"TOOL PATH/OP{LONG},TOOL,T{LONG}") + "PPRINT/P" + LONG + "\n"
    cl.write_text(text + FOOT, encoding="utf-8")
    settings = {"title": "TITLE" + LONG, "part": "PART" + LONG, "date": "DATE" + LONG}
    result = trunnion.post(cl, machine=machine, settings=settings)
    assert result.passed
    lines = (result.text or "").splitlines()
    most = load_control(load_machine(machine).control).longest_line
    assert max(len(line.encode()) for line in lines) <= most
    comments = "".join(re.sub(r"^[N0-9]* ?(; |\* - )", "", line) for line in lines if re.match(r"[N0-9]* ?[;*] ", line))
    for word in ("OP", "T", "P", *(["TITLE", "PART", "DATE"])):
        assert word + LONG in comments, word


def test_only_comments_are_divided_and_only_long_ones() -> None:
    assert divided_comment("L X+1 ; SHORT", 5, ("; ",)) == ["L X+1 ; SHORT"]
    assert divided_comment("; SHORT", 7, ("; ",)) == ["; SHORT"]
    assert divided_comment("* - ABCDEF", 7, ("; ", "* - ")) == ["* - ABC", "; DEF"]
    assert split_text("äö", 2) == ["ä", "ö"]


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
@pytest.mark.parametrize(("statement", "told"), [("STOP/", True), ("PPRINT/", True), ("PPRINT/turn", False)])
def test_a_text_that_fills_many_lines_is_written_whole_and_told(
    machine: str, statement: str, told: bool, tmp_path: Path
) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + statement + ("turn it " * 2000 if told else "") + "\n" + FOOT, encoding="utf-8")
    result = trunnion.post(cl, machine=machine)
    assert result.passed
    assert [problem.line for problem in result.problems if problem.code == "CTL815"] == (
        [HEAD.count("\n") + 1] if told else []
    )
