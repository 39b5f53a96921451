"""How the characters of a program become bytes, on every control: encodings, line ends, capitals, numbers, lists."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.posting import FOOT, HEAD
from trunnion.errors import InputError, Problem, Severity
from trunnion.model.toolpath import Tool
from trunnion.output.tool_calls import tool_text
from trunnion.transliteration import spelled

MACHINES = ["yl569", "dmu65", "matsuura_mx330", "xyzac_trt", "hs664rt"]

#: Controls whose programs may have any characters.
ANY = ["yl569", "dmu65", "xyzac_trt", "hs664rt"]

NAME = "Größe 轮毂"


def posted(folder: Path, machine: str, cl: str, **settings: str) -> trunnion.PostResult:
    """A program that is proven, from a file and read back from a file."""
    source = folder / "part.cls"
    source.write_text(cl, encoding="utf-8")
    result = trunnion.post(source, machine=machine, output=folder / f"{machine}.nc", settings=settings)
    assert result.passed
    return result


def with_name(name: str, text: str = "") -> str:
    """CL text of an operation of this name, with a text for the operator."""
    said = f"DISPLY/{text}\n" if text else ""
    return HEAD.replace("OP1", name).replace("SPINDL", f"{said}SPINDL") + FOOT


def warnings(result: trunnion.PostResult) -> list[str]:
    return [each.what for each in result.problems if each.severity is Severity.WARNING and "is written" in each.what]


@pytest.mark.third
@pytest.mark.parametrize("machine", ANY)
@pytest.mark.parametrize("encoding", ["utf-8", "ascii", "latin-1", "gbk"])
def test_a_program_is_written_and_read_in_its_encoding(machine: str, encoding: str, tmp_path: Path) -> None:
    result = posted(tmp_path, machine, with_name(NAME, NAME), encoding=encoding)
    data = (tmp_path / f"{machine}.nc").read_bytes()
    expected = spelled(NAME, encoding)
    assert expected.encode(encoding) in data
    assert result.text == data.decode(encoding)
    run = result.run
    assert run is not None
    assert run.encoding == encoding
    texts = [comment.text for comment in run.comments] + [str(event.value) for event in run.events]
    assert any(expected in text for text in texts), texts
    assert bool(warnings(result)) == (expected != NAME)
    assert all(repr(expected) in each for each in warnings(result))


@pytest.mark.parametrize("machine", MACHINES)
def test_lines_end_as_the_setting_says(machine: str, tmp_path: Path) -> None:
    plain = posted(tmp_path, machine, with_name("OP1", "TEXT"), times="on", operation_list="on").text
    program = tmp_path / f"{machine}.nc"
    result = posted(tmp_path, machine, with_name("OP1", "TEXT"), times="on", operation_list="on", line_ends="crlf")
    data = program.read_bytes()
    assert plain is not None
    assert data == plain.replace("\n", "\r\n").encode()
    assert result.run is not None
    assert not any("\r" in comment.text for comment in result.run.comments)


@pytest.mark.parametrize("machine", MACHINES)
def test_comments_have_capitals_and_blocks_stay(machine: str, tmp_path: Path) -> None:
    settings = {"times": "on", "operation_list": "on", "tool_list": "on"}
    plain = posted(tmp_path, machine, with_name("schlicht.", "bitte messen"), **settings).text
    result = posted(tmp_path, machine, with_name("schlicht.", "bitte messen"), comments="capitals", **settings)
    text = result.text
    assert plain is not None
    assert text is not None
    assert text.upper() == plain.upper()
    assert "SCHLICHT." in text
    assert "schlicht" not in text
    assert "BITTE MESSEN" in text
    comments = re.findall(r"\(.*?\)|;.*|^(?:N?\d+ )?\* - .*", text, re.MULTILINE)
    assert comments
    assert not [each for each in comments if each != each.upper()]


def test_code_keeps_its_small_letters(tmp_path: Path) -> None:
    text = posted(tmp_path, "yl569", with_name("op"), comments="capitals").text
    assert text is not None
    assert "DEF REAL _camtolerance" in text
    cl = with_name("op").replace("TOOL,D10", "TOOL,d10;fein")
    text = posted(tmp_path, "yl569", cl, comments="capitals", tool_call="name").text
    assert text is not None
    assert 'T="d10;fein"' in text


HOSTILE = [
    "../../x", "CON", "a:b", "a;b G0 Z-99", "a) G0 Z-99", 'a" G0 Z-99', "%", "a~", "x" * 300, "a\u202eb", "a. ",
    "\x85G0 Z-99", "\u2028G0 Z-99", "a\\b", "$$", "\N{FULLWIDTH RIGHT PARENTHESIS} G0 Z-99", "~", "轮毂", ".",
    "NUL.txt", "/etc/x", "\u202e",
]  # fmt: skip


@pytest.mark.parametrize("machine", MACHINES)
def test_no_name_leaves_its_comment_or_the_folder(machine: str, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    settings = {"encoding": "ascii", "operation_list": "on", "tool_list": "on"}
    named = [with_name(name, name).replace("TOOL,D10", f"TOOL,D10{name}") for name in HOSTILE]
    run = posted(folder, machine, "".join(named), **settings).run
    assert run is not None
    assert not run.errors
    plain = posted(folder, machine, "".join(with_name(f"OP{k}", "TEXT") for k in range(len(HOSTILE))), **settings).run
    assert plain is not None
    assert run.tip.tolist() == plain.tip.tolist()
    assert {path.name for path in tmp_path.iterdir()} == {"out"}


def test_subprograms_have_safe_names(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    result = posted(folder, "yl569", "".join(map(with_name, HOSTILE)), programs="operations")
    assert len({path.name.upper() for path in result.subprograms}) == len(HOSTILE)
    for path in result.subprograms:
        assert path.parent == folder
        assert re.fullmatch(r"[A-Z]{2}[A-Z0-9_]{0,22}\.spf", path.name), path.name
        assert path.stem not in ("CON", "NUL")
        assert path.is_file()
    assert any(path.stem == "LUNGU" for path in result.subprograms)


def problems_of(folder: Path, cl: str, machine: str = "yl569", **settings: str) -> list[Problem]:
    source = folder / "part.cls"
    source.write_text(cl, encoding="utf-8")
    with pytest.raises(InputError) as caught:
        trunnion.post(source, machine=machine, settings=settings)
    return list(caught.value.problems)


def test_capitals_that_an_encoding_lacks_stay_small(tmp_path: Path) -> None:
    text = posted(tmp_path, "yl569", with_name("lǎng ß µ ÿ"), encoding="gbk", comments="capitals").text
    assert text is not None
    assert "LǎNG SS U Y" in text
    latin = posted(tmp_path, "yl569", with_name("maß µ ÿ é"), encoding="latin-1", comments="capitals").text
    assert latin is not None
    assert "MASS µ ÿ É" in latin
    for encoding, wanted in (("utf-8", "GRÖSSE FI"), ("latin-1", "GRÖSSE FI"), ("ascii", "GROESSE FI")):
        assert wanted in (
            posted(tmp_path, "yl569", with_name("GRÖßE ﬁ"), encoding=encoding, comments="capitals").text or ""
        )


def test_no_line_of_klartext_ends_in_a_byte_that_continues_it(tmp_path: Path) -> None:
    assert "\u769b".encode("gbk").endswith(b"~")
    posted(tmp_path, "dmu65", with_name("A\u769b", "turn\u769b"), encoding="gbk", title="B\u769b")
    lines = (tmp_path / "dmu65.nc").read_bytes().splitlines()
    assert not [line for line in lines if line.endswith(b"~") and not line.decode("gbk").endswith("~")]
    assert sum(line.endswith(b"\xb0~.") for line in lines) >= 3


def test_a_tool_is_never_called_by_another_name(tmp_path: Path) -> None:
    cl = with_name("OP1").replace("TOOL,D10", "TOOL,FRÄSER")
    (problem,) = problems_of(tmp_path, cl, encoding="ascii", tool_call="name")
    assert "the tool \"FRÄSER\" is called by a name that the program cannot have: ascii has no 'Ä'" in problem.what
    assert "tool_call=number" in problem.cure
    result = posted(tmp_path, "yl569", cl, encoding="latin-1", tool_call="name")
    assert result.text is not None
    assert 'T="FRÄSER"' in result.text


def test_an_inserted_text_is_not_changed(tmp_path: Path) -> None:
    cl = with_name("OP1").replace("SPINDL", "INSERT/;Größe\nSPINDL")
    (problem,) = problems_of(tmp_path, cl, encoding="ascii")
    assert "INSERT/;Größe goes into the program as it is, and ascii has no 'ö'" in problem.what
    text = posted(tmp_path, "yl569", cl, encoding="latin-1", comments="capitals").text
    assert text is not None
    assert ";Größe" in text


def definition(folder: Path, lines: str) -> Path:
    """The YL569 with changes to its control."""
    path = folder / "own.toml"
    path.write_text(f'extends = "yl569"\nname = "Own"\n{lines}', encoding="utf-8")
    return path


def test_a_definition_states_the_form_of_its_texts(tmp_path: Path) -> None:
    machine = definition(tmp_path, '[control.settings]\nencoding = "gbk"\nline_ends = "crlf"\ncomments = "capitals"\n')
    # This name in GBK is valid UTF-8 too: only the definition tells which it is.
    source = tmp_path / "part.cls"
    source.write_text(with_name("\u5b66"), encoding="utf-8")
    result = trunnion.post(source, machine=machine, output=tmp_path / "a.mpf")
    data = (tmp_path / "a.mpf").read_bytes()
    assert "\u5b66".encode("gbk") in data
    assert data.count(b"\r\n") == data.count(b"\n") > 10
    assert b";INITIAL MOVE" in data
    assert result.passed
    run = trunnion.read_program(tmp_path / "a.mpf", machine=machine)
    assert any("\u5b66" in comment.text for comment in run.comments)
    assert not any(
        "\u5b66" in comment.text for comment in trunnion.read_program(tmp_path / "a.mpf", machine="yl569").comments
    )


def test_what_a_definition_writes_must_be_in_its_encoding(tmp_path: Path) -> None:
    machine = definition(tmp_path, '[control.phases]\ncut = ";Zerspanung für Größe"\n')
    source = tmp_path / "part.cls"
    source.write_text(HEAD.replace("FEDRAT", "PAINT/COLOR,31\nFEDRAT") + FOOT, encoding="utf-8")
    with pytest.raises(InputError, match=r"writes ';Zerspanung für Größe': ascii has no 'ü'.*encoding=utf-8"):
        trunnion.post(source, machine=machine, settings={"encoding": "ascii"})
    assert trunnion.post(source, machine=machine, settings={"encoding": "latin-1"}).passed


def test_fanuc_comments_are_ascii_and_nothing_is_lost_in_silence(tmp_path: Path) -> None:
    result = posted(tmp_path, "matsuura_mx330", with_name("Größe 100% ab"))
    assert result.text is not None
    assert "(OPERATION GROESSE 100- AB)" in result.text
    assert "?" not in result.text
    assert any("ascii has no 'ö'" in each for each in warnings(result))
    (problem,) = problems_of(tmp_path, with_name("OP1"), "matsuura_mx330", encoding="utf-8")
    assert problem.cure.startswith("write ascii")


def numbers_of(text: str | None) -> list[int]:
    assert text is not None
    return [int(number) for number in re.findall(r"^N(\d+) ", text, re.MULTILINE)]


TWO = with_name("OP1") + with_name("OP2")


@pytest.mark.parametrize("machine", ["yl569", "matsuura_mx330", "xyzac_trt", "hs664rt"])
def test_operations_alone_have_numbers(machine: str, tmp_path: Path) -> None:
    every = numbers_of(posted(tmp_path, machine, TWO, numbers="on").text)
    found = numbers_of(posted(tmp_path, machine, TWO, numbers="operations").text)
    assert len(every) > 10
    assert found == every[:2]
    assert not numbers_of(posted(tmp_path, machine, TWO, numbers="off").text)


def test_a_definition_numbers_some_blocks(tmp_path: Path) -> None:
    every = definition(tmp_path, "[control.block_numbers]\nstart = 5\nstep = 5\nhighest = 15\nevery = 4\n")
    source = tmp_path / "part.cls"
    source.write_text(TWO, encoding="utf-8")
    result = trunnion.post(source, machine=every)
    assert result.passed
    assert result.text is not None
    lines = result.text.splitlines()
    numbered = [line for k, line in enumerate(lines) if k % 4 == 0]
    assert [line.split(" ", 1)[0] for line in numbered[:5]] == ["N5", "N10", "N15", "N5", "N10"]
    assert len(numbers_of(result.text)) == len(numbered)
    operations = definition(tmp_path, '[control.block_numbers]\nstart = 1\nstep = 1\nat = "operations"\n')
    assert numbers_of(trunnion.post(source, machine=operations).text) == [1, 2]
    assert len(numbers_of(trunnion.post(source, machine=operations, settings={"numbers": "on"}).text)) > 10


def test_klartext_numbers_every_block(tmp_path: Path) -> None:
    (problem,) = problems_of(tmp_path, TWO, "dmu65", numbers="operations")
    assert "numbers is operations" in problem.what
    path = tmp_path / "own.toml"
    path.write_text('extends = "dmu65"\nname = "Own"\n[control.block_numbers]\nevery = 2\n', encoding="utf-8")
    source = tmp_path / "part.cls"
    with pytest.raises(InputError, match="every is given, and numbers without a letter"):
        trunnion.post(source, machine=path)


@pytest.mark.parametrize("machine", MACHINES)
def test_operations_are_listed_with_times_extents_feeds_and_speeds(machine: str, tmp_path: Path) -> None:
    second = (
        with_name("OP2")
        .replace("4000", "1500")
        .replace("FOOT", "")
        .replace("END-OF-PATH", "FEDRAT/MMPM,125.5\nGOTO/10.0,-7.25,5.0\nEND-OF-PATH")
    )
    result = posted(tmp_path, machine, with_name("OP1") + second, operation_list="on")
    assert result.text is not None
    head = result.text[:1500]
    plain = re.sub(r"(?m)^(?:N?\d+ )?(?:; ?|\( ?)?(.*?)(?: ?\))?$", r"\1", head).upper()
    listed = plain[plain.index("OPERATION LIST") :].split("\n")
    assert listed[1] == "1 OP1 T1"
    assert re.fullmatch(r"[\d.]+ S(?: \+ RAPIDS)?, S4000, F500", listed[2]), listed
    assert listed[3] == "X0 TO 10, Y0, Z5 TO 50"
    assert listed[4] == "2 OP2 T1"
    assert re.fullmatch(r"[\d.]+ S(?: \+ RAPIDS)?, S1500, F125.5 TO 500", listed[5]), listed
    assert listed[6] == "X0 TO 10, Y-7.25 TO 0, Z5 TO 50"
    times = [float(listed[k].split(" ")[0]) for k in (2, 5)]
    assert times == pytest.approx([float(f"{each:.1f}") for each in _seconds(result)])
    without = posted(tmp_path, machine, TWO, operation_list="on", times="off").text
    assert without is not None
    assert re.search(r"S4000, F500", without)
    assert not re.search(r"\d+\.\d+ s, S4000", without, re.IGNORECASE)


def _seconds(result: trunnion.PostResult) -> list[float]:
    assert result.verification is not None
    found = result.verification
    return [float(found.seconds[each.first : each.end].sum()) for each in found.operations]


def test_a_list_in_inches_counts_in_inches(tmp_path: Path) -> None:
    cl = with_name("OP1").replace("GOTO/10.0,", "GOTO/25.4,").replace("TOOL PATH", "UNITS/MM\nTOOL PATH")
    text = posted(tmp_path, "matsuura_mx330", cl, operation_list="on", units="inch", cl_units="mm").text
    assert text is not None
    assert "(X0 TO 1, Y0, Z0.1969 TO 1.9685)" in text
    assert "F19.68503937" in text


def test_the_length_of_flutes_is_no_number_of_flutes() -> None:
    assert tool_text("5", Tool(name="D10", kind="MILL", diameter=10.0, flute_length=60.0)).endswith("flute length 60")
