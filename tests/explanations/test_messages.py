"""Messages of every kind end with the code of their kind, whatever made them, and data hold it."""

import json
from pathlib import Path

import pytest

import trunnion
from trunnion.cli import main
from trunnion.errors import Problem, Severity
from trunnion.messages import foreign
from trunnion.reporting.content import refused_content

HEAD = """TOOL PATH/ONE,TOOL,D10
TLDATA/MILL,10,0,75,0,0
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
FEDRAT/MMPM,300
RAPID
GOTO/0,0,50,0,0,1
"""


def written(folder: Path, *lines: str) -> Path:
    """A CL file with these lines within its operation."""
    path = folder / "part.cls"
    path.write_text(HEAD + "".join(f"{line}\n" for line in lines), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("lines", "code"),
    [
        (("GOTO/5,0,5",), "CL130"),
        (("GOTO/5,0,5", "END-OF-PATH", "GOTO/5,0,5"), "CL350"),
        (("GOTO/5,x,5", "END-OF-PATH"), "CL310"),
        (("GOTO/1e9,0,5", "END-OF-PATH"), "CL360"),
        (("GOTO/5,0,5,0,0,2", "END-OF-PATH"), "CL540"),
        (("CIRCLE/0,0,0,0,0,2,5", "GOTO/5,0,5", "END-OF-PATH"), "CL570"),
        (("FEDRAT/MMPM,-1", "GOTO/5,0,5", "END-OF-PATH"), "CL710"),
        (("SPINDL/RPM,0,CLW", "GOTO/5,0,5", "END-OF-PATH"), "CL730"),
        (("CYCLE/DRILL,STEP", "GOTO/5,0,5", "END-OF-PATH"), "CL820"),
        (("COPY/1,TRANSL,1,0,0", "GOTO/5,0,5", "END-OF-PATH"), "CL480"),
        (("TLON", "GOTO/5,0,5", "END-OF-PATH"), "CL250"),
    ],
)
def test_a_statement_that_cannot_be_used_has_the_code_of_its_kind(
    lines: tuple[str, ...], code: str, tmp_path: Path
) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.read_cl(written(tmp_path, *lines))
    first = caught.value.problems[0]
    assert first.code == code
    assert str(first).endswith(f" [{code}]")


def test_what_is_only_counted_has_a_code_too(tmp_path: Path) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.read_cl(written(tmp_path, *["GOTO/5,x,5"] * 200, "END-OF-PATH"))
    assert {problem.code for problem in caught.value.problems} == {"CL180", "CL310"}
    assert str(caught.value).count("and 100 more [CL180]") == 1


def test_unknown_statements_have_the_code_of_what_they_may_do(tmp_path: Path) -> None:
    remarks = trunnion.read_cl(written(tmp_path, "CLAMP/ON", "SHOPEV/1", "GOTO/5,0,5", "END-OF-PATH")).remarks
    assert {remark.what.split()[0]: remark.code for remark in remarks} == {"CLAMP": "CL210", "SHOPEV": "CL220"}


def test_remarks_as_data_have_their_codes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["info", str(written(tmp_path, "SHOPEV/1", "GOTO/5,0,5", "END-OF-PATH")), "--json"]) == 0
    assert '"code": "CL220"' in capsys.readouterr().out


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ('extends = "yl56"\n', "DEF210"),
        ("extends = yl569\n", "DEF130"),
        ('extends = "yl569"\nbogus = 1\n', "DEF320"),
        ('extends = "yl569"\nname = 5\n', "DEF330"),
        ('extends = "yl569"\n[[axis]]\nname = "B"\ndirection = [0, 0, 0]\n', "DEF420"),
        ('extends = "yl569"\n[control.templates]\nprogram_end = "M30 {bogus}"\n', "DEF510"),
    ],
)
def test_a_mistake_in_a_definition_has_the_code_of_its_kind(text: str, code: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.describe_machine(path)
    assert code in {problem.code for problem in caught.value.problems}, str(caught.value)


@pytest.mark.parametrize(
    ("machine", "lines", "code"),
    [
        ("hs664rt", ("FEDRAT/MMPR,0.1", "GOTO/5,0,5", "END-OF-PATH"), "CTL330"),  # what a family cannot express
        ("yl569", ("CYCLE/DRILL,RAPTO,3,MMPM,100", "GOTO/5,0,5", "CYCLE/OFF", "END-OF-PATH"), "PLN610"),  # a cycle
        ("yl569", ("GOTO/5,0,5,0,0.1,-0.9949874", "END-OF-PATH"), "PLN120"),  # a pose
        ("yl569", ("GOTO/12345678,0,5,0,0,1", "END-OF-PATH"), "CL360"),
    ],
)
def test_a_refused_post_says_the_code_of_why(machine: str, lines: tuple[str, ...], code: str, tmp_path: Path) -> None:
    with pytest.raises(trunnion.TrunnionError) as caught:
        trunnion.post(written(tmp_path, *lines), machine=machine, output=tmp_path / "part.nc")
    assert code in {problem.code for problem in caught.value.problems}, str(caught.value)
    assert not (tmp_path / "part.nc").exists()


@pytest.mark.parametrize("arguments", [["post"], ["post", "--bogus"], ["post", "a", "--set", "x"], ["impeller"], []])
def test_a_usage_error_ends_with_its_code(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(arguments) if arguments else main([])
    assert ended.value.code == 2
    assert capsys.readouterr().err.endswith(" [ARG120]\n")


def test_the_report_of_a_refused_program_has_codes() -> None:
    problems = [
        Problem("a.cls", 3, foreign("wrong", "right", "CL310")),
        Problem("a.cls", 4, foreign("odd"), Severity.WARNING),
    ]
    (check,) = refused_content(trunnion.load_machine("yl569"), "a.mpf", problems[:1]).checks
    assert [place.told for place in check.places] == ["wrong; right [CL310]"]


def test_explanations_as_data(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", "CL310", "--json"]) == 0
    (found,) = json.loads(capsys.readouterr().out)
    assert found["code"] == "CL310"
    assert found["subject"] == "cl"
