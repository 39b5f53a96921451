"""Functions at places of output: what they write and change, what is refused at their line, what the proof judges."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

import trunnion
from tests.support import places_page
from tests.support.locations import DOCS, TESTS, YL569
from trunnion.controls.places import OUTPUT_PLACES
from trunnion.controls.vocabulary import OPERATION_VALUES, TOOL_VALUES
from trunnion.hooks import OperationValues, ToolValues

SHOP = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8").replace("BORHED/40.5,DEEP\n", "")
HUB = YL569 / "2_hub_rough.cls"
HOLES = SHOP.replace("END-OF-PATH", "CYCLE/DRILL,FEDTO,-9,RAPTO,3,MMPM,99\nGOTO/50,0,0\nCYCLE/OFF\nEND-OF-PATH", 1)

#: A machine of each family, and how its comments are written.
FAMILIES = {
    "yl569": ";{}", "mikron_600u": "; {}", "dmu65": "; {}", "hs664rt": "({})", "matsuura_mx330": "({})",
    "haas_umc750": "({})", "xyzbc_trt": "({})",
}  # fmt: skip


@pytest.fixture
def part(tmp_path: Path) -> Path:
    file = tmp_path / "part.cls"
    file.write_text(SHOP, encoding="utf-8")
    return file


def functions(folder: Path, text: str) -> Path:
    """A file of functions, which begin in line 2."""
    file = folder / "shop.py"
    file.write_text("from dataclasses import replace\n" + text, encoding="utf-8")
    return file


def lines(cl: Path, text: str, folder: Path, machine: str = "yl569", **settings: str) -> list[str]:
    """The lines of a proven program without their numbers."""
    result = trunnion.post(cl, machine=machine, hooks=[functions(folder, text)], settings=settings)
    assert result.passed
    assert result.text is not None
    return [re.sub(r"^N?\d+ ", "", line) for line in result.text.splitlines()]


def problem(cl: Path, text: str, folder: Path, machine: str = "yl569") -> trunnion.Problem:
    with pytest.raises(trunnion.TrunnionError) as caught:
        trunnion.post(cl, machine=machine, hooks=[functions(folder, text)])
    return next(each for each in caught.value.problems if each.severity is trunnion.Severity.ERROR)


def failed(cl: Path, text: str, folder: Path, machine: str = "yl569") -> tuple[set[str], str]:
    """The checks that a program with such functions fails, and the message."""
    with pytest.raises(trunnion.ProofFailedError) as caught:
        trunnion.post(cl, machine=machine, hooks=[functions(folder, text)])
    return {check.key for check in caught.value.result.checks if not check.passed}, str(caught.value)


EVERYWHERE = "".join(
    f"def {place.function}(place):\n    return [*place.lines, COMMENT.format('{place.name.upper()}')]\n"
    for place in OUTPUT_PLACES
    if place.function
)


@pytest.mark.parametrize("machine", FAMILIES)
def test_each_place_takes_the_lines_of_its_function(machine: str, tmp_path: Path) -> None:
    file = tmp_path / "holes.cls"
    file.write_text(HOLES, encoding="utf-8")
    comment = FAMILIES[machine]
    preselect = "off" if machine == "hs664rt" else "on"
    found = lines(file, f"COMMENT = {comment!r}\n{EVERYWHERE}", tmp_path, machine, tool_list="on", preselect=preselect)
    wanted = {
        "program_start", "tool_list", "before_operation", "operation_start", "tool_change", "same_tool", "preselect",
        "approach", "after_approach", "engage", "first_cut", "rapid", "linear", "cycle", "coolant", "stop", "retract",
        "operation_end", "after_operation", "program_end",
    } - ({"preselect"} if preselect == "off" else set())  # fmt: skip
    text = "\n".join(found)
    assert {name for name in wanted if comment.format(name.upper()) not in text} == set()


@pytest.mark.parametrize("machine", FAMILIES)
def test_functions_that_change_nothing_change_no_byte(machine: str, part: Path, tmp_path: Path) -> None:
    names = [place.function for place in OUTPUT_PLACES if place.function]
    quiet = "".join(f"def {name}(place):\n    return {('place', 'None')[k % 2]}\n" for k, name in enumerate(names))
    asked = trunnion.post(part, machine=machine, hooks=[functions(tmp_path, quiet)])
    assert asked.text == trunnion.post(part, machine=machine).text


def test_the_same_functions_make_the_same_bytes_and_are_asked_once(part: Path, tmp_path: Path) -> None:
    text = (
        "SEEN = []\n"
        "def at_tool_change(place):\n    SEEN.append(place.tool.call)\n    return [*place.lines, f';{len(SEEN)}']\n"
        "def at_operation_end(place):\n    SEEN.append('end')\n    return [*place.lines, f';END {len(SEEN)}']\n"
        "def at_retract(place):\n    return f';CUT FOR {place.operation.time}'\n"
    )
    first = lines(part, text, tmp_path)
    assert first == lines(part, text, tmp_path)
    assert [line for line in first if re.fullmatch(r";(END )?\d", line)] == [";1", ";END 2", ";3", ";END 4", ";END 5"]
    assert [line for line in first if line.startswith(";CUT FOR ")]


def test_the_record_has_the_values_of_templates(part: Path, tmp_path: Path) -> None:
    assert tuple(each.name for each in fields(ToolValues)) == TOOL_VALUES
    assert {each.name for each in fields(OperationValues)} == set(OPERATION_VALUES)
    text = (
        "from trunnion.hooks import Kind, Phase\n"
        "def at_first_cut(place):\n"
        "    if place.operation.number == 1:\n"
        "        o, t = place.operation, place.tool\n"
        "        assert (o.name, o.mode, o.coolant, o.spindle_speed) == ('ROUGH TOP', 'three_axis', 'FLOOD', 4000.0)\n"
        "        assert (t.call, t.diameter, t.kind, len(place.tools)) == ('1', 10.0, 'MILL', 2)\n"
        "        assert place.fields['operation'] == 'ROUGH TOP' and place.settings == {'title': 'A'}\n"
        "        assert place.next_tool.call == '2' and place.machine and place.name == place.template == 'first_cut'\n"
        "        return ';SEEN'\n"
        "def at_linear(place):\n"
        "    if place.operation.number == 1 and place.row == 2:\n"
        "        assert place.kind is Kind.LINEAR and place.phase is Phase.CUT and place.feed == 500.0\n"
        "        assert place.tip == (10.0, 0.0, 0.0) and place.axis == (0.0, 0.0, 1.0) and not place.per_rev\n"
        "        assert place.words['X'] == 10.0 and place.words['feed'] == 500.0\n"
        "        return ';MOVED'\n"
        "def at_stop(place):\n    assert (place.number, place.text) == (0, 'turn the part')\n"
        "def at_coolant(place):\n    assert {place.kind: 8, 'OFF': 9}[place.kind] == place.words['coolant']\n"
    )
    found = lines(part, text, tmp_path, title="A")
    assert found.index(";SEEN") < found.index(";MOVED")


def test_words_that_are_the_same_for_the_machine_pass_the_proof(part: Path, tmp_path: Path) -> None:
    plain = lines(part, "def at_rapid(place):\n    return None\n", tmp_path)
    found = lines(part, "def at_linear(place):\n    return {'coolant': 8} if place.row == 3 else None\n", tmp_path)
    assert [line for line in found if line not in plain] == []
    assert found == plain, "the coolant was on"


@pytest.mark.parametrize(
    ("words", "checks"),
    [
        ("{'X': -place.tip[0]}", {"tip"}),
        ("replace(place, words={**place.words, 'Z': place.words['Z'] + 0.1}) if 'Z' in place.words else None", {"tip"}),
        ("{'primary': place.words['primary'] + 1.0} if 'primary' in place.words else None", {"axis"}),
        ("{'feed': 9000}", {"feed"}),
        ("{'feed': None}", {"feed", "modal"}),
        ("{'coolant': 8}", {"coolant"}),
        ("{'spindle': 4}", {"spindle"}),
    ],
)
@pytest.mark.parametrize("machine", FAMILIES)
@pytest.mark.third
def test_the_proof_fails_changed_words_and_names_the_function(
    machine: str, words: str, checks: set[str], tmp_path: Path
) -> None:
    keys, message = failed(HUB, f"def at_linear(place):\n    return {words}\n", tmp_path, machine)
    assert keys & checks
    assert "at_linear has changed words of" in message
    assert "shop.py:2" in message


def test_cycles_and_coolants_are_changed_by_their_numbers(tmp_path: Path) -> None:
    file = tmp_path / "holes.cls"
    file.write_text(HOLES, encoding="utf-8")
    keys, message = failed(file, "def at_cycle(place):\n    return {'FEDTO': -3.0}\n", tmp_path)
    assert keys == {"holes"}
    assert "at_cycle has changed words of the program" in message
    keys, message = failed(file, "def at_coolant(place):\n    return {'coolant': 26}\n", tmp_path)
    assert keys == {"coolant"}
    assert "at_coolant" in message


@pytest.mark.parametrize(
    ("machine", "off"),
    [
        ("yl569", "TRAFOOF"), ("yl569", "G18"), ("yl569", "ORIMKS"), ("mikron_600u", "M129"), ("mikron_600u", "M127"),
        ("dmu65", "FUNCTION RESET TCPM"), ("matsuura_mx330", "G49"), ("haas_umc750", "G49"), ("xyzbc_trt", "M429"),
        ("matsuura_mx330", "%"), ("xyzbc_trt", "(half"), ("yl569", "M5"), ("yl569", "G1 X5 Z-20"), ("dmu65", "L Z-20"),
    ],
)  # fmt: skip
def test_what_changes_a_mode_or_moves_is_refused_at_the_function(machine: str, off: str, tmp_path: Path) -> None:
    found = problem(HUB, f"def at_engage(place):\n    return {off!r}\n", tmp_path, machine)
    assert (Path(found.file).name, found.line, found.code) == ("shop.py", 2, "CTL457")
    assert found.what.startswith(f"at_engage writes {off} at ")


def test_a_mode_that_the_path_does_not_show_is_refused_in_a_function_too(part: Path, tmp_path: Path) -> None:
    for place in ("after_approach", "stop"):
        for word in ("CYCLE832(0.5,_FINISH,1)", "G18"):
            text = f"def at_{place}(place):\n    return [*place.lines, {word!r}]\n"
            found = problem(part, text, tmp_path)
            assert (Path(found.file).name, found.line, found.code) == ("shop.py", 2, "CTL457")
    assert lines(part, "def at_stop(place):\n    return [*place.lines, 'G18', 'G17']\n", tmp_path)


def test_a_block_that_fails_the_proof_is_told_with_its_function(part: Path, tmp_path: Path) -> None:
    keys, message = failed(part, "def at_program_start(place):\n    return [*place.lines, 'G1 X5 F9']\n", tmp_path)
    assert "order" in keys
    assert "written by at_program_start" in message
    assert "shop.py:2" in message


@pytest.mark.parametrize(
    ("body", "line", "code", "what"),
    [
        ("raise ValueError('no tool')", 3, "HOK120", "ValueError: no tool"),
        ("raise SystemExit(0)", 3, "HOK120", "SystemExit"),
        ("return 5", 2, "HOK170", "type int"),
        ("return [5]", 2, "HOK170", "type list"),
        ("return {'M0'}", 2, "HOK170", "type set"),
        ("return b'M0'", 2, "HOK170", "type bytes"),
        ("return replace(place, words=5)", 2, "HOK170", "type int"),
        ("return replace(place, machine='x')", 2, "HOK170", "another machine"),
        ("return {'Q': 1}", 2, "HOK170", "the word Q"),
        ("return {'X': 'a'}", 2, "HOK170", "X = 'a'"),
        ("return {'X': float('nan')}", 2, "HOK170", "X = nan"),
        ("return {'X': True}", 2, "HOK170", "X = True"),
        ("return {'X': 1e8}", 2, "HOK170", "X = 1e+08"),
        ("return {1: 2}", 2, "HOK170", "1 as the name"),
        ("return 'a\\rM30'", 2, "HOK170", "control character"),
        ("return ['A\\nM30']", 2, "HOK170", "control character"),
        ("return 'Z' * 5000", 2, "HOK170", "5000 letters"),
        ("return ['M61'] * 5000", 2, "HOK170", "5000 lines"),
        ("return 'M30'", 2, "CTL457", "ends the program"),
        ("return ';' + 'Z' * 999", 2, "", ""),
    ],
)
def test_what_a_function_does_wrong_is_told_at_its_line(
    body: str, line: int, code: str, what: str, part: Path, tmp_path: Path
) -> None:
    text = f"def at_linear(place):\n    {body}\n"
    if not code:
        assert lines(part, text, tmp_path)
        return
    found = problem(part, text, tmp_path)
    assert (Path(found.file).name, found.line, found.code) == ("shop.py", line, code)
    assert what in found.what


def test_letters_that_the_program_cannot_have_are_told_at_the_function(part: Path, tmp_path: Path) -> None:
    file = functions(tmp_path, "def at_first_cut(place):\n    return ';刀位'\n")
    assert ";刀位" in (trunnion.post(part, machine="yl569", hooks=[file]).text or "")
    with pytest.raises(trunnion.InputError, match="latin-1 has no '刀'") as caught:
        trunnion.post(part, machine="yl569", hooks=[file], settings={"encoding": "latin-1"})
    assert (Path(caught.value.problems[0].file).name, caught.value.problems[0].line) == ("shop.py", 2)


def test_files_of_functions_are_asked_one_after_the_other(part: Path, tmp_path: Path) -> None:
    files = []
    for k in (1, 2):
        files.append(tmp_path / f"{k}.py")
        text = f"def at_first_cut(place):\n    return [*place.lines, ';{k}']\n"
        files[-1].write_text(text + f"def at_linear(place):\n    return {{'feed': {k}}}\n", encoding="utf-8")
    with pytest.raises(trunnion.ProofFailedError, match="moves with 2 mm/min"):
        trunnion.post(part, machine="yl569", hooks=files)
    for file in files:
        file.write_text(file.read_text(encoding="utf-8").partition("def at_linear")[0], encoding="utf-8")
    text = trunnion.post(part, machine="yl569", hooks=files).text or ""
    assert re.search(r"N\d+ ;1\nN\d+ ;2\n", text)


def test_templates_have_the_same_places(part: Path, tmp_path: Path) -> None:
    file = tmp_path / "ours.toml"
    templates = (
        'engage = ";ENGAGE {operation}"\ncoolant = ";COOLANT {kind}"\n'
        'linear = ";{phase} TO {x:coordinate} F{feed:feed}"\n'
        'cycle = ";CYCLE {kind}"\n'
        "rapid = '''\n{% if z > 40 %}\n;HIGH\n{% endif %}\n'''\n"
    )
    head = 'schema = 1\nextends = "yl569"\nname = "Ours"\n[control.templates]\n'
    part.write_text(HOLES, encoding="utf-8")
    file.write_text(head + templates, encoding="utf-8")
    found = [line.split(" ", 1)[1] for line in (trunnion.post(part, machine=file).text or "").splitlines()]
    for line in (";ENGAGE ROUGH TOP", ";COOLANT FLOOD", ";CUT TO 10. F500.", ";HIGH", ";CYCLE DRILL"):
        assert line in found


def test_the_tables_of_the_pages_are_complete() -> None:
    for path, text in places_page.pages().items():
        assert path.read_text(encoding="utf-8") == text, "python -m tests.support.places_page"


def test_the_functions_of_the_page_do_what_it_says(part: Path, tmp_path: Path) -> None:
    page = (DOCS / "hooks.md").read_text(encoding="utf-8").partition("## Functions at places of output")[2]
    sample = page.partition("```py\n")[2].partition("```")[0]
    file = tmp_path / "shop.py"
    file.write_text(sample, encoding="utf-8")
    text = trunnion.post(part, machine="yl569", hooks=[file]).text or ""
    for line in (";TOOL 1 D10", ";CUTS ROUGH TOP FOR ", ";POSTED BY HALL 2"):
        assert line in text
