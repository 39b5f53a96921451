"""What is stated of a program besides its definition: values of variables, what words do; and what stands behind."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError
from trunnion.jobs.simulate.report import write_simulation_report
from trunnion.verification import Verification
from trunnion.verification.standing import Verdict

#: A program that calls a macro which nobody knows, and reads a variable that it does not set, by machine.
PROGRAMS = {
    "matsuura_mx330": (
        "%\nO1\nG21 G17 G40 G49 G69 G80 G90 G94\nT1 M6\nG54 G0 X0. Y0. S900 M3\nG43 H1 Z9.\nG65 P9810 Z9.\n"
        "G1 Z-#100 F300.\nG0 Z9.\nG49\nM30\n%\n",
        "#100",
        "G65 P9810",
    ),
    "haas_umc750": (
        "%\nO00001\nG21 G17 G40 G49 G69 G80 G90 G94\nT1 M6\nG54 G0 X0. Y0. S900 M3\nG43 H1 Z9.\nG65 P9810 Z9.\n"
        "G1 Z-#150 F300.\nG0 Z9.\nG49\nM30\n%\n",
        "#150",
        "G65 P9810",
    ),
    "yl569": ("G71 G17 G40 G90 G94\nT1 M6\nG54 D1 G0 X0 Y0 S900 M3\nL9810\nG1 Z=-R5 F300\nG0 Z9\nM30\n", "R5", "L9810"),
    "dmu65": (
        "0 BEGIN PGM A MM\n1 TOOL CALL 1 Z S900\n2 L X+0 Y+0 R0 FMAX M3\n3 CYCL DEF 392 TOUCH ~\n   Q1=2 ;A\n"
        "4 L Z-Q13 R0 F300\n5 L Z+9 R0 FMAX\n6 M30\n7 END PGM A MM\n",
        "Q13",
        "CYCL DEF 392",
    ),
}


def verified(machine: str, folder: Path, *, strict: bool = False, behind: str = "") -> Verification:
    text, variable, word = PROGRAMS[machine]
    program = folder / "a.nc"
    program.write_text(text + behind)
    return trunnion.verify(
        program, machine=machine, settings={variable: 2}, assume={word: "moves nothing"}, strict=strict
    )


@pytest.mark.parametrize("machine", PROGRAMS)
def test_a_program_is_read_around_what_is_stated_and_the_verdict_names_it(machine: str, tmp_path: Path) -> None:
    text, variable, word = PROGRAMS[machine]
    program = tmp_path / "a.nc"
    program.write_text(text)
    assert trunnion.read_program(program, machine=machine).errors
    found = verified(machine, tmp_path)
    assert found.run.errors == ()
    assert min(found.run.tip[:, 2]) == -2.0
    assert found.standing.verdict is not Verdict.PASSED
    assert found.standing.stated == (f"{word} moves nothing (stated)", f"{variable} = 2 (stated)")
    assert f"stands on: {word} moves nothing (stated), {variable} = 2 (stated)" in found.standing.told


@pytest.mark.parametrize("machine", PROGRAMS)
def test_strict_refuses_what_only_the_call_states(machine: str, tmp_path: Path) -> None:
    _, variable, word = PROGRAMS[machine]
    answer = next(check.summary for check in verified(machine, tmp_path, strict=True).checks if check.key == "basis")
    assert f"only this call states: {word} moves nothing (stated), {variable} = 2 (stated)" in answer


def test_a_definition_that_states_it_is_named_too_and_strict_takes_it(tmp_path: Path) -> None:
    text, variable, word = PROGRAMS["matsuura_mx330"]
    program, ours = tmp_path / "a.nc", tmp_path / "ours.toml"
    program.write_text(text)
    ours.write_text(
        f'extends = "matsuura_mx330"\n[control.known]\n"{word}" = "comes back"\n'
        f'[control.reading.variables]\n"{variable}" = 2\n'
    )
    found = trunnion.verify(program, machine=str(ours), strict=True)
    assert found.standing.stated == ("G65 P9810 comes back (stated)", "#100 = 2 (stated)")
    assert "only this call" not in next(check.summary for check in found.checks if check.key == "basis")
    other = trunnion.verify(program, machine=str(ours), settings={variable: 3}, assume={word: "moves nothing"})
    assert other.standing.stated == (
        "G65 P9810 moves nothing (stated; the definition has comes back)",
        "#100 = 3 (stated; the definition has 2)",
    )
    same = trunnion.verify(program, machine=str(ours), settings={variable: 2})
    assert same.standing.stated == found.standing.stated


@pytest.mark.parametrize(
    ("settings", "assume", "fault"),
    [
        ({"R5": 2}, None, "is not a setting that the proof needs"),
        ({"#100": "two"}, None, "which a variable holds"),
        (None, {"G65 P9810": "jumps"}, "has no effect 'jumps'"),
        (None, {"G81": "no effect"}, "a word of the control itself"),
        (None, {"G65": "no effect"}, "a word of the control itself"),
        (None, {"X": "no effect"}, "a word of the control itself"),
    ],
)
def test_what_cannot_be_stated_is_an_error_of_the_argument(
    settings: dict[str, float | str] | None, assume: dict[str, str] | None, fault: str, tmp_path: Path
) -> None:
    program = tmp_path / "a.nc"
    program.write_text(PROGRAMS["matsuura_mx330"][0])
    with pytest.raises(InputError) as refused:
        trunnion.verify(program, machine="matsuura_mx330", settings=settings, assume=assume)
    assert fault in str(refused.value)
    assert not any(problem.file == "(given)" for problem in refused.value.problems)


@pytest.mark.parametrize(
    ("machine", "text", "name", "stated"),
    [
        ("yl569", "G71 G90\nG0 X0 Y0 Z9\nG1 Z=-_DEPTH F9\nM30\n", "_depth", "_DEPTH"),
        ("yl569", "G71 G90\nG0 X0 Y0 Z9\nG1 Z=-_depth F9\nM30\n", "_Depth", "_DEPTH"),
        ("yl569", "G71 G90\nG0 X0 Y0 Z9\nG1 Z=-R5 F9\nM30\n", "r5", "R5"),
        ("yl569", "G71 G90\nG0 X0 Y0 Z9\nG1 Z=-DEPTHS[1] F9\nM30\n", "depths[1]", "DEPTHS[1]"),
        ("xyzac_trt", "G21 G90\nG0 X0 Y0 Z9\nG1 Z-#<_Depth> F9\nM2\n", "#<_DEPTH>", "#<_depth>"),
        ("dmu65", "BEGIN PGM A MM\nTOOL CALL 1 Z S9\nL Z-Q13 F9\nM30\nEND PGM A MM\n", "q13", "Q13"),
    ],
)
def test_a_name_is_stated_in_letters_of_either_case_where_the_control_reads_both(
    machine: str, text: str, name: str, stated: str, tmp_path: Path
) -> None:
    program = tmp_path / "a.nc"
    program.write_text(text)
    found = trunnion.verify(program, machine=machine, settings={name: 2})
    assert found.run.errors == ()
    assert found.run.tip[-1, 2] == -2.0
    assert found.standing.stated == (f"{stated} = 2 (stated)",)
    if name.lower() != name.upper():
        with pytest.raises(InputError, match="which has a value already"):
            trunnion.verify(program, machine=machine, settings={name: 2, stated: 3})


@pytest.mark.parametrize("name", ["spindel", "depth", "program_number", "spindle"])
def test_a_setting_is_no_variable_of_a_control(name: str, tmp_path: Path) -> None:
    program = tmp_path / "a.mpf"
    program.write_text("G71 G90\nG0 X0 Y0 Z9\nM30\n")
    if name == "spindle":
        assert trunnion.verify(program, machine="yl569", settings={name: 2}).standing.stated == ()
        return
    with pytest.raises(InputError, match="is not a setting that the proof needs"):
        trunnion.verify(program, machine="yl569", settings={name: 2})


def test_diff_convert_simulate_and_view_take_them(tmp_path: Path) -> None:
    text, variable, word = PROGRAMS["matsuura_mx330"]
    program = tmp_path / "a.nc"
    program.write_text(text)
    on = {"machine": "matsuura_mx330", "settings": {variable: 2}, "assume": {word: "moves nothing"}}
    same = trunnion.diff(program, program, **on)  # type: ignore[arg-type]
    assert same.same
    stated = (f"{word} moves nothing (stated)", f"{variable} = 2 (stated)")
    assert same.stated == stated
    converted = trunnion.convert(program, to_cl=True, **on)  # type: ignore[arg-type]
    assert converted.text
    assert converted.stated == stated
    trunnion.write_view(program, output=tmp_path / "a.html", **on)  # type: ignore[arg-type]
    cut = trunnion.simulate(
        program,
        stock="box:9,9,9,-4,-4,-9",
        tools=["1=flat:2,length=50,flutes=20"],
        cell=1.0,
        **on,  # type: ignore[arg-type]
    )
    assert cut.operations
    assert cut.stated == stated
    told = f"stands on: {', '.join(stated)}"
    assert told in cut.told
    write_simulation_report(cut, tmp_path / "cut.html")
    assert all(told in (tmp_path / page).read_text(encoding="utf-8") for page in ("a.html", "cut.html"))
    with pytest.raises(InputError, match="no variable of the control of matsuura_mx330"):
        trunnion.diff(program, program, machine="matsuura_mx330", settings={"R5": 2})


@pytest.mark.parametrize("machine", PROGRAMS)
def test_words_behind_the_end_are_a_remark_and_a_second_end_is_an_error(machine: str, tmp_path: Path) -> None:
    words, end = ("9 L X+5 R0 FMAX\n", "9 M30\n") if machine == "dmu65" else ("G0 X5.\n", "M30\n")

    def noted(behind: str) -> list[str]:
        text = PROGRAMS[machine][0]
        if machine == "dmu65":
            text, behind = text.replace("7 END", f"{behind}8 END"), ""
        program = tmp_path / "a.nc"
        program.write_text(text + behind)
        found = trunnion.verify(
            program,
            machine=machine,
            settings={PROGRAMS[machine][1]: 2},
            assume={PROGRAMS[machine][2]: "moves nothing"},
        )
        told = [str(each.severity) for each in found.run.diagnostics if each.code == "NC161"]
        assert found.standing.warnings == told.count("warning")
        return told

    assert noted("") == []
    assert noted(words) == ["warning"]
    assert noted(words + end) == ["error"]


@pytest.mark.parametrize("machine", PROGRAMS)
def test_what_a_call_states_for_nothing_is_warned_of(machine: str, tmp_path: Path) -> None:
    text, variable, word = PROGRAMS[machine]
    program, (other, unknown) = tmp_path / "a.nc", (variable[:-1] + "7", word[:-1] + "9")
    program.write_text(text)
    found = trunnion.verify(
        program,
        machine=machine,
        settings={variable: 2, other: 3},
        assume={word: "moves nothing", unknown: "moves nothing"},
    )
    told = [each.wording.parameter("word") for each in found.remarks if each.code == "NC228"]
    assert told == [unknown, other]
    assert found.standing.warnings == 2
    assert found.standing.stated == (f"{word} moves nothing (stated)", f"{variable} = 2 (stated)")


def test_a_comparison_names_what_neither_program_needs(tmp_path: Path) -> None:
    text, variable, word = PROGRAMS["matsuura_mx330"]
    program, other = tmp_path / "a.nc", tmp_path / "b.nc"
    program.write_text(text)
    other.write_text(text.replace(variable, "2."))
    settings = {variable: 2.0, "#107": 3.0}
    found = trunnion.diff(program, other, machine="matsuura_mx330", settings=settings, assume={word: "moves nothing"})
    assert found.same, found.first
    assert found.not_needed == ("#107",)
    assert next(iter(found.lines())).startswith("same")
    assert "#107 is stated, and neither program needs it" in list(found.lines())[-1]


def test_a_call_may_be_stated_without_a_blank(tmp_path: Path) -> None:
    text, variable, word = PROGRAMS["matsuura_mx330"]
    program = tmp_path / "a.nc"
    program.write_text(text)
    for written in (word, word.replace(" ", "")):
        found = trunnion.verify(
            program, machine="matsuura_mx330", settings={variable: 2}, assume={written: "moves nothing"}
        )
        assert not found.run.errors
        assert not found.remarks


def test_a_value_beyond_its_limits_is_an_error_of_the_variable(tmp_path: Path) -> None:
    program = tmp_path / "a.nc"
    program.write_text(PROGRAMS["matsuura_mx330"][0])
    with pytest.raises(InputError) as refused:
        trunnion.verify(program, machine="matsuura_mx330", settings={"#100": 1e308})
    (problem,) = refused.value.problems
    assert problem.subject is not None
    assert (problem.subject.kind, problem.subject.name) == ("setting", "#100")
    assert "control.reading" not in str(problem)


def test_a_variable_in_small_letters_is_not_said_to_count_for_nothing(tmp_path: Path) -> None:
    program = tmp_path / "a.ngc"
    program.write_text("G21 G90 G17 G94 G54\nG0 X#<_depth>\nM2\n")
    found = trunnion.verify(program, machine="xyzac_trt", settings={"#<_depth>": 2})
    assert [each.word for each in found.run.stated] == ["#<_depth>"]
    assert not [each for each in found.remarks if each.code == "NC228"]
