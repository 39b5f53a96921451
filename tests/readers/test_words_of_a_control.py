"""Words that a control has in place of its family's: TCP above all, stated for the writer and for the proof apart."""

from pathlib import Path

import pytest

import trunnion
from trunnion.errors import InputError
from trunnion.model.run import Run

FIVE_AXIS = """TOOL PATH/A,TOOL,T1
TLDATA/MILL,10.0,0.0,50.0,0.0,0.0
MSYS/0,0,0,1,0,0,0,1,0
LOAD/TOOL,1
SPINDL/RPM,1000,CLW
RAPID
GOTO/0,0,50,0,0.5,0.8660254
FEDRAT/MMPM,100
GOTO/0,0,5,0,0.5,0.8660254
GOTO/10,0,5,0,0.6,0.8
RAPID
GOTO/10,0,50,0,0.6,0.8
END-OF-PATH
"""

#: The machine, its words for TCP in the writer, the same for the proof, and what must be in the program.
WRITTEN = {
    "matsuura_mx330": ('tcp_on = "G234"', 'G234 = "G43.4"', "G234 H1"),
    "xyzac_trt": ('tcp_on = "M128"\ntcp_off = "M129"', 'M128 = "M428"\nM129 = "M429"', "M128\n"),
    "hs664rt": ('tcp_on = "G98"\ntcp_off = "G99"', 'G98 = "G196"\nG99 = "G197"', "G98\n"),
}
USUAL = {
    "matsuura_mx330": '"G43.4" = "unknown"',
    "xyzac_trt": 'M428 = "unknown"',
    "hs664rt": 'G196 = "unknown"',
}
RULES = {"hs664rt": '[control.setting_rules]\ntcp_on = { one_of = ["G98"] }\ntcp_off = { one_of = ["G99"] }\n'}


def machine(folder: Path, base: str, settings: str, words: str) -> Path:
    file = folder / "machine.toml"
    rules = RULES.get(base, "") if settings else ""
    file.write_text(
        f'extends = "{base}"\n[control.settings]\n{settings}\n[control.reading.words]\n{words}\n{rules}',
        encoding="utf-8",
    )
    return file


@pytest.mark.parametrize("base", WRITTEN)
def test_words_for_tcp_are_data_that_writer_and_proof_have_apart(base: str, tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(FIVE_AXIS)
    settings, words, text = WRITTEN[base]
    posted = trunnion.post(tmp_path / "part.cls", machine=machine(tmp_path, base, settings, words))
    assert posted.passed
    assert text in (posted.text or "")
    for alone in ((settings, ""), ("", USUAL[base])):
        with pytest.raises(trunnion.TrunnionError):
            trunnion.post(tmp_path / "part.cls", machine=machine(tmp_path, base, *alone))


def test_a_control_without_tool_vectors_refuses_them(tmp_path: Path) -> None:
    file = machine(tmp_path, "matsuura_mx330", 'tcp_on_vector = ""', "")
    (tmp_path / "part.cls").write_text(FIVE_AXIS)
    assert trunnion.post(tmp_path / "part.cls", machine=file).passed
    with pytest.raises(InputError, match="orientation") as error:
        trunnion.post(tmp_path / "part.cls", machine=file, settings={"orientation": "vector"})
    assert "no TCP that takes the tool axis as a vector" in str(error.value)


HEAD = "%\nO0001\nG21 G90 G94\nT5 M6\nG54 S500 M3\nG43 H5 G0 X0. Y0. Z50.\n"


def read(folder: Path, words: str, lines: str) -> Run:
    (folder / "part.nc").write_text(f"{HEAD}{lines}\nM30\n%\n")
    return trunnion.read_program(folder / "part.nc", machine=machine(folder, "matsuura_mx330", "", words))


def test_a_word_has_the_meaning_that_the_control_gives_it(tmp_path: Path) -> None:
    assert [str(error) for error in read(tmp_path, "", "G154 P3").errors] != []
    run = read(tmp_path, 'G154 = "G54.1"\nM16 = "M6"', "G154 P3\nG0 X1. Y1.\nT7 M16\nG43 H7 Z60.")
    assert run.errors == ()
    assert run.tools[int(run.tool[-1])] == "7"


def test_a_word_that_the_control_does_not_have_is_an_error(tmp_path: Path) -> None:
    run = read(tmp_path, 'G81 = "unknown"\nM97 = "unknown"', "G81 X0. Y0. Z-5. R2. F100.\nG80\nM97 P5")
    assert {error.wording.what for error in run.errors} >= {"unknown word G81", "unknown word M97"}


@pytest.mark.parametrize(
    ("line", "what"),
    [
        ('G1 = "G0"', "is no word that could mean another"),
        ('X1 = "G0"', "is no word that could mean another"),
        ('G234 = "TCP"', "is 'TCP'"),
        ('G234 = "M428"', "is 'M428'"),
        ("G234 = 4", "text"),
    ],
)
@pytest.mark.parametrize("base", WRITTEN)
def test_mistakes_are_told_with_their_line(base: str, line: str, what: str, tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(f'extends = "{base}"\n[control.reading.words]\n{line}\n')
    (tmp_path / "part.nc").write_text("M30\n")
    with pytest.raises(InputError, match=what) as error:
        trunnion.read_program(tmp_path / "part.nc", machine=file)
    assert error.value.problems[0].line == 3
