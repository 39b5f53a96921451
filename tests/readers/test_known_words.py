"""Words that a definition declares: macros, probing calls and codes of the machine's builder."""

from pathlib import Path

import pytest

import trunnion
from tests.support.program_heads import HEADS
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.errors import InputError
from trunnion.jobs.verify.program_warnings import program_warnings
from trunnion.model.run import Run
from trunnion.readers import known_words

PLUNGE = (
    "TOOL PATH/A,TOOL,T1\nTLDATA/MILL,10.0,0.0,50.0,0.0,0.0\nMSYS/0,0,0,1,0,0,0,1,0\nLOAD/TOOL,1\n"
    "SPINDL/RPM,1000,CLW\nRAPID\nGOTO/0,0,50,0,0,1\nFEDRAT/MMPM,100\nGOTO/0,0,5\nRAPID\nGOTO/0,0,50\nEND-OF-PATH\n"
)


def read(folder: Path, base: str, lines: str, *known: str) -> Run:
    """A program for a machine whose definition declares words."""
    machine = folder / "machine.toml"
    machine.write_text("\n".join([f'extends = "{base}"', "[control.known]", *known, ""]))
    (folder / "part.nc").write_text(HEADS[base].format(lines=lines))
    return trunnion.read_program(folder / "part.nc", machine=machine)


@pytest.mark.parametrize(
    ("base", "lines", "key"),
    [
        ("mikron_600u", "CYCL DEF 392 3D-ROT. ~\n  Q240=+2 ~\n  Q402=+1", '"CYCL DEF 392"'),
        ("mikron_600u", "7 CYCL DEF 392.0 X\n8 CYCL DEF 392.1 Q1", '"CYCL DEF 392"'),
        ("mikron_600u", "L X+0 M202(0.0024)", "M202"),
        ("mikron_600u", "M202(0.0024)", "M202"),
        ("mikron_600u", "CALL PGM TNC:\\MESS\\ROT.H", '"CALL PGM TNC:\\\\MESS\\\\ROT.H"'),
        ("matsuura_mx330", "G187 P3 E0.02", "G187"),
        ("matsuura_mx330", "N10 M98 P9001", '"M98 P9001"'),
        ("matsuura_mx330", "G65 P9810 X1. Z-5. F100.", '"G65 P9810"'),
        ("yl569", "N10 L9906", "L9906"),
        ("yl569", "CYCLE977(1,2,3)", "CYCLE977"),
        ("xyzac_trt", "o<probe> call [1]", '"O<PROBE> CALL"'),
        ("hs664rt", "G901 P3", "G901"),
    ],
)
def test_a_declared_word_is_understood_and_moves_nothing(base: str, lines: str, key: str, tmp_path: Path) -> None:
    if not key.startswith('"O<'):
        assert read(tmp_path, base, lines).errors != (), "nobody else understands it"
        run = read(tmp_path, base, lines, f'{key} = "comes back"')
        assert run.errors == (), [str(error) for error in run.errors]
        assert run.tip[-1].tolist() == [0.0, 0.0, 5.0]


@pytest.mark.parametrize("base", HEADS)
def test_a_word_of_the_builder_that_nobody_declares_is_named_once(base: str, tmp_path: Path) -> None:
    words = ("M161", "M162") if base == "xyzac_trt" else ("M61", "M88")
    lines = "\n".join([*words, words[0]])
    run = read(tmp_path, base, lines)
    assert run.errors == ()
    told = [each for each in run.diagnostics if each.code == "NC225"]
    assert [each.text.split()[0] for each in told] == list(words)
    check = {each.key: each for each in trunnion.verify(run, machine=run.machine).checks}["words"]
    assert check.passed
    assert check.summary.startswith(f"every word is known but those of the machine: {', '.join(words)}")
    assert [place.code for place in check.places][:2] == ["NC225", "NC225"]
    declared = read(tmp_path, base, lines, *(f'{word} = "no effect: ours"' for word in words))
    assert not [each for each in declared.diagnostics if each.code == "NC225"]
    check = {each.key: each for each in trunnion.verify(declared, machine=declared.machine).checks}["words"]
    assert check.summary.split(";")[0] == "every word is known"  # a Fanuc is told of its G43, too


def test_post_and_verify_warn_of_words_of_the_builder_once(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "part.cls").write_text(PLUNGE)
    machine = tmp_path / "machine.toml"
    machine.write_text('extends = "matsuura_mx330"\n[control.templates]\nbefore_operation = "M61\\nM88\\nM61"\n')
    part, program = str(tmp_path / "part.cls"), str(tmp_path / "part.nc")
    assert main(["post", part, "--machine", str(machine), "--output", program]) == 0
    lines = [line.split(" ")[-1] for line in Path(program).read_text().splitlines()]
    expected = [
        f"{program}:{lines.index(word) + 1}: warning: {word} belongs to the machine: what it does is not known;"
        " look it up, and declare it in [control.known] [NC225]"
        for word in ("M61", "M88")
    ]
    assert [line for line in capsys.readouterr().err.splitlines() if "belongs to the machine" in line] == expected
    assert main(["verify", program, "--machine", str(machine), "--cl", part]) == 0
    assert [line for line in capsys.readouterr().err.splitlines() if "belongs to the machine" in line] == expected
    posted = trunnion.post(part, machine=machine, output=program)
    assert [each.code for each in posted.problems] == ["NC225", "NC225"]
    assert posted.passed


def test_of_many_words_of_the_builder_the_first_are_told(tmp_path: Path) -> None:
    run = read(tmp_path, "matsuura_mx330", "\n".join(f"M{number}" for number in range(301, 330)))
    told = [each for each in program_warnings(run) if each.code != "NC351"]
    assert [each.what.split()[0] for each in told[:20]] == [f"M{number}" for number in range(301, 321)]
    assert [each.what for each in told[20:]] == ["9 more words belong to the machine"]
    assert told[20].line == told[19].line + 1


@pytest.mark.parametrize("base", HEADS)
def test_effects_are_those_that_the_definition_names(base: str, tmp_path: Path) -> None:
    run = read(tmp_path, base, "M77", 'M77 = "spindle off, coolant flood, stop"')
    assert run.errors == ()
    assert (int(run.spindle[0]), int(run.spindle[-1])) == (1, 0)
    assert [event.kind for event in run.events if event.kind in ("stop", "coolant")] == ["coolant", "stop"]
    assert not [event for event in run.events if event.kind == "m"]


def test_a_macro_changes_the_tool_that_it_names(tmp_path: Path) -> None:
    run = read(tmp_path, "matsuura_mx330", "G65 P9000 T7", '"G65 P9000" = "tool change"')
    assert run.tools[int(run.tool[-1])] == "7"
    run = read(tmp_path, "matsuura_mx330", "T8 M106", 'M106 = "tool change"')
    assert run.tools[int(run.tool[-1])] == "8"


def test_a_macro_may_come_back_at_home_and_with_tcp_off(tmp_path: Path) -> None:
    lines = "G43.4 H5\nG65 P9000\nG0 X0. Y0. Z50."
    run = read(tmp_path, "matsuura_mx330", lines, '"G65 P9000" = "tcp off, comes back home"')
    assert run.errors == ()
    assert int(run.machine_frame.sum()) == 1
    assert not run.tcp[-1]


@pytest.mark.parametrize(
    ("line", "understood"),
    [
        ("G90 G64 G150 G17", True),
        ("G90 G0150 M9 (G150 P1)", True),
        ("N7 G90 (a) G150", True),
        ("G90 G150 X90.", False),  # X may be meant for the word
        ("G90 G150 P2", False),
        ("G90 G150.1", False),
        ("G90 G1500", False),
        ("G90 G151", False),
    ],
)
def test_a_code_without_effect_may_stand_among_other_codes_alone(line: str, understood: bool, tmp_path: Path) -> None:
    run = read(tmp_path, "xyzac_trt", line, 'G150 = "no effect"', 'G151 = "comes back"')
    assert (run.errors == ()) is understood
    if understood:
        assert [str(event.value) for event in run.events if event.kind == "known"] == ["G150"]


def test_words_in_comments_and_longer_words_are_others(tmp_path: Path) -> None:
    run = read(tmp_path, "matsuura_mx330", "(M77)\nM770\nM7", 'M77 = "stop"')
    assert not [event for event in run.events if event.kind == "stop"]


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('M60 = "explodes"', "has no effect 'explodes'"),
        ('M60 = "spindle clockwise, spindle off"', "'spindle clockwise' and 'spindle off'"),
        ('M60 = "no effect, stop"', "'no effect' and 'stop'"),
        ('M60 = "coolant flood, coolant off"', "'coolant flood' and 'coolant off'"),
        ('"é" = "stop"', "is no word of a program"),
        ("M60 = 3", "text"),
    ],
)
def test_mistakes_are_told_with_their_line(line: str, what: str, tmp_path: Path) -> None:
    machine = tmp_path / "machine.toml"
    machine.write_text(f'extends = "yl569"\n[control.known]\n{line}\n')
    with pytest.raises(InputError, match=what) as error:
        known_words(trunnion.load_machine(machine))
    assert error.value.problems[0].line == 3


def test_a_template_may_hold_a_declared_word(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(PLUNGE)
    machine = tmp_path / "machine.toml"
    text = load_control(trunnion.load_machine("matsuura_mx330").control).templates["tool_change"]
    lines = "\n".join([*text.lines, "G65 P9810", "G187 P1"])
    first = load_control(trunnion.load_machine("matsuura_mx330").control).templates["first_tool"]
    start = "\n".join([*first.lines, "G65 P9810", "G187 P1"])
    body = f"[control.templates]\ntool_change = '''\n{lines}\n'''\nfirst_tool = '''\n{start}\n'''\n"
    machine.write_text(f'extends = "matsuura_mx330"\n{body}')
    with pytest.raises(trunnion.RefusedError):
        trunnion.post(tmp_path / "part.cls", machine=machine)
    machine.write_text(
        f'extends = "matsuura_mx330"\n{body}[control.known]\nG187 = "no effect"\n"G65 P9810" = "comes back"\n'
    )
    posted = trunnion.post(tmp_path / "part.cls", machine=machine)
    assert posted.passed
    assert "G187 P1" in (posted.text or "")


def test_a_template_may_call_a_file_that_exists_already(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(PLUNGE)
    machine, macro = tmp_path / "machine.toml", tmp_path / "O9001"
    lines = load_control(trunnion.load_machine("matsuura_mx330").control).templates["first_tool"].lines
    text = "\n".join([*lines, "M98 P9001"])
    machine.write_text(f"extends = \"matsuura_mx330\"\n[control.templates]\nfirst_tool = '''\n{text}\n'''\n")
    macro.write_text("%\nO9001\nG4 P100\nM99\n%\n")
    with pytest.raises(trunnion.RefusedError):
        trunnion.post(tmp_path / "part.cls", machine=machine)
    assert trunnion.post(tmp_path / "part.cls", machine=machine, subprograms=[macro]).passed
    target = str(tmp_path / "part.nc")
    words = [
        "post",
        str(tmp_path / "part.cls"),
        "--machine",
        str(machine),
        "--output",
        target,
        "--subprograms",
        str(macro),
    ]
    assert main(words) == 0


@pytest.mark.parametrize("base", [name for name in HEADS if name != "hs664rt"])
def test_a_declared_word_switches_tcp_on_in_every_language(base: str, tmp_path: Path) -> None:
    assert not read(tmp_path, base, "M77").tcp[-1]
    run = read(tmp_path, base, "M77", 'M77 = "tcp on"')
    assert run.errors == ()
    assert run.tcp[-1]
