"""Texts of a shop in programs: at which places they stand, what is refused, and what is said again behind them."""

import math
import re
import subprocess
import sys
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import TESTS
from tests.support.posting import FOOT, HEAD

SHOP = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8").replace("BORHED/40.5,DEEP\n", "")
LEVEL_ONLY = SHOP.partition("END-OF-PATH\n")[0] + "END-OF-PATH\n"
KNOWN = '[control.known]\nM61 = "no effect"\nM88 = "no effect"\n'


def machine(folder: Path, templates: str, more: str = "", extends: str = "yl569") -> Path:
    file = folder / "ours.toml"
    head = f'schema = 1\nextends = "{extends}"\nname = "Ours"\n{more}\n[control.templates]\n'
    file.write_text(head + templates, encoding="utf-8")
    return file


def program(
    folder: Path, templates: str, cl: str = SHOP, more: str = "", extends: str = "yl569", **settings: str
) -> list[str]:
    """The lines of a proven program, without block numbers."""
    (folder / "part.cls").write_text(cl, encoding="utf-8")
    result = trunnion.post(folder / "part.cls", machine=machine(folder, templates, more, extends), settings=settings)
    assert result.passed
    assert result.text is not None
    return [re.sub(r"^N\d+ ", "", line) for line in result.text.splitlines()]


def refusal(folder: Path, templates: str, cl: str = SHOP, more: str = "", extends: str = "yl569") -> trunnion.Problem:
    with pytest.raises(trunnion.TrunnionError) as caught:
        program(folder, templates, cl, more, extends)
    return caught.value.problems[0]


STOP = """'''
MSG("{text}")
M{number}
'''"""

EVERYWHERE = """
tool_list = ";LIST{% for each in tools %} T{{ each }}{% endfor %}"
before_operation = ";BEFORE {operation_number}"
after_operation = ";AFTER {operation_number}"
same_tool = ";SAME {tool}"
preselect = ";NEXT {next_tool}"
after_approach = ";THERE"
first_cut = ";FIRST CUT"
retract = ";HOME"
event_PPRINT = ";SAYS {text}"
stop = ";STOPS: {text}\\nM{number}"
"""


def test_each_place_has_its_text(tmp_path: Path) -> None:
    lines = program(tmp_path, EVERYWHERE, tool_list="on", preselect="on")
    found = [
        line for line in lines if re.match(r";(LIST|BEFORE|AFTER|SAME|NEXT|THERE|FIRST CUT|HOME|SAYS|STOPS)", line)
    ]
    assert found == [
        ";LIST T1 T2",
        ";BEFORE 1", ";NEXT 2", ";THERE", ";FIRST CUT", ";SAYS check the clamps (3x)", ";HOME", ";AFTER 1",
        ";BEFORE 2", ";THERE", ";FIRST CUT", ";STOPS: turn the part", ";HOME", ";AFTER 2",
        ";BEFORE 3", ";SAME 2", ";THERE", ";FIRST CUT", ";HOME", ";AFTER 3",
    ]  # fmt: skip
    assert lines[lines.index(";FIRST CUT") - 1].startswith("Z5.")
    assert lines[lines.index(";STOPS: turn the part") + 1] == "M0"


def test_between_two_planes_of_an_operation_stands_a_text(tmp_path: Path) -> None:
    holes = "CYCLE/DRILL,RAPTO,3,FEDTO,-5,MMPM,100\nGOTO/0,0,20,0,0.6,0.8\nGOTO/0,0,20,0.6,0,0.8\nCYCLE/OFF\n"
    cl = HEAD.partition("FEDRAT")[0] + holes + FOOT
    lines = program(tmp_path, "between_planes = ';TURNS'\nafter_approach = ';THERE'\nfirst_cut = ';FIRST'", cl)
    found = [line for line in lines if line in (";TURNS", ";THERE", ";FIRST")]
    assert found.count(";TURNS") == found.count(";THERE") - 1 >= 1
    assert found.count(";FIRST") == 1


def test_a_text_stands_before_the_tool_draws_back_to_rewind(tmp_path: Path) -> None:
    lean, points = math.radians(40.0), []
    for k in range(160):
        turn = math.radians(7.0 * k)
        axis = (math.sin(lean) * math.cos(turn), math.sin(lean) * math.sin(turn), math.cos(lean))
        tip = (40.0 * axis[0], 40.0 * axis[1], 40.0 * axis[2] + 0.02 * k)
        points.append("GOTO/" + ",".join(f"{value:.9f}" for value in (*tip, *axis)))
    start = HEAD.partition("GOTO")[0]
    cl = "\n".join([start.rstrip(), points[0], "FEDRAT/MMPM,500.0", *points[1:], FOOT])
    lines = program(tmp_path, "rewind = ';UNWINDS'\nevent_PPRINT = ';NOT THIS'", cl, extends="generic_head_head_ca")
    assert lines.count(";UNWINDS") == 1
    assert lines[lines.index(";UNWINDS") + 1].startswith(";Rewind: ")
    assert ";NOT THIS" not in lines


@pytest.mark.parametrize(
    ("text", "following"),
    [(";LOOK", "X20."), ('MSG("LOOK")', "X20."), ("F500", "X20. F500."), ("M61", "")],
)
def test_behind_a_text_only_what_it_may_have_changed_is_said_again(tmp_path: Path, text: str, following: str) -> None:
    lines = program(tmp_path, f"event_PPRINT = '{text}'", more=KNOWN)
    behind = next(line for line in lines[lines.index(text) + 1 :] if not line.startswith(";"))
    if following:
        assert behind == following
    else:
        assert {"G1", "X20.", "Y0.0", "Z0.0", "F500."} <= set(behind.split())


@pytest.mark.parametrize(
    ("place", "text", "what"),
    [
        ("first_cut", "G91", "elsewhere"), ("retract", "G0 Z-20", "moves the machine"),
        ("event_PPRINT", "M30", "ends the program"), ("first_cut", "G55", "work offset"),
        ("event_PPRINT", "OVR=10", "OVR"), ("first_cut", "M77 G64", "G64"), ("retract", ";A\\nG700", ""),
        ("event_PPRINT", ";A\\nG0 X99", "moves the machine"), ("first_cut", "M5", "spindle"),
        ("first_cut", "TRAFOOF\\n{{ 'G9' ~ 1 }}", "elsewhere"),
    ],
)  # fmt: skip
def test_a_text_within_an_operation_that_bends_the_program_is_refused_at_its_template(
    tmp_path: Path, place: str, text: str, what: str
) -> None:
    problem = refusal(tmp_path, f'{place} = "{text}"')
    assert (problem.file, problem.what.startswith(f"template {place} writes ")) == (str(tmp_path / "ours.toml"), True)
    assert what in problem.what


@pytest.mark.parametrize(
    ("place", "text"),
    [
        ("before_operation", "G1 X500 Y20 Z-30 F100"), ("same_tool", "BUILDERS_MACRO(1)"), ("after_approach", "G58 X5"),
        ("after_operation", "G1 X500 Y20 Z-30 F100"), ("after_approach", "G91"), ("same_tool", "T=9\\nM6"),
    ],
)  # fmt: skip
def test_a_text_between_operations_that_bends_the_program_fails_the_proof(
    tmp_path: Path, place: str, text: str
) -> None:
    with pytest.raises(trunnion.RefusedError):
        program(tmp_path, f'{place} = "{text}"')


def test_a_stop_without_its_m_code_is_refused(tmp_path: Path) -> None:
    assert "does not stop the program" in refusal(tmp_path, 'stop = "{% if text == 1 %}M{{ number }}{% endif %}"').what
    assert refusal(tmp_path, 'stop = ";M0"').what.startswith("template stop does not stop")


AUXFUN = SHOP.replace("PPRINT/check the clamps (3x)", "AUXFUN/61,FAST")


def test_a_statement_that_is_not_known_has_the_text_of_its_template(tmp_path: Path) -> None:
    template = """event_AUXFUN = "M{{ numbers[0] }}{{ ';FAST' if 'FAST' in words else ';SLOW' }}" """
    assert "M61;FAST" in program(tmp_path, template, AUXFUN, KNOWN)
    assert "AUXFUN" in refusal(tmp_path, "", AUXFUN, KNOWN).what
    # What is said of the statement with its words comes first.
    with_entry = KNOWN + '[control.statements]\n"AUXFUN/FAST" = ""\n'
    assert "M61" not in program(tmp_path, 'event_AUXFUN = "M{number}"', AUXFUN, with_entry)


@pytest.mark.parametrize(
    ("templates", "what", "line"),
    [
        ("first_cut = '''\n;A\n{% if presure %}\n;B\n{% endif %}\n'''", "{presure}", 8),
        ('first_cut = "{{ tool.diametr }}"', ".diametr", 6),
        ('first_cut = "{{ tool.diameter | coordinat }}"', "coordinat", 6),
        ('first_cut = "{{ text }}"', "{text}", 6),
        ('first_cut = "{% if tool %}{tool"', "without its {% endif %}", 6),
        ('first_cut = "{{ tool }} {tool"', "brace", 6),
        ('first_cut = "{{ tool }} [[A"', "brace", 6),
        ('frist_cut = "A"', "is not a key", 6),
        ('event_SPINDL = "A"', "is a statement that is read", 6),
        ('event_auxfun = "A"', "is not in capitals", 6),
    ],
)
def test_a_mistake_in_a_template_is_told_with_its_line(tmp_path: Path, templates: str, what: str, line: int) -> None:
    problem = refusal(tmp_path, templates)
    assert what in problem.what
    assert (problem.file, problem.line) == (str(tmp_path / "ours.toml"), line)


def test_a_misspelt_name_is_asked_for(tmp_path: Path) -> None:
    more = '[control.settings]\npressure = ""\n'
    problem = refusal(tmp_path, 'first_cut = "{% if presure %}A{% endif %}"', more=more)
    assert problem.cure.startswith('did you mean "pressure"?')
    assert "first_cut" in refusal(tmp_path, 'frist_cut = "A"').cure


def test_no_text_of_a_cl_file_ends_a_comment(tmp_path: Path) -> None:
    cl = SHOP.replace("check the clamps (3x)", "a) M30 (b").replace("DRILL SIDE", "X) M30 (Y")
    templates = """
event_PPRINT = "({{ text }})"
before_operation = "({% for each in operations %}{{ each.name }}, {% endfor %}{{ operation | lower | upper }})"
"""
    lines = program(tmp_path, templates, cl, extends="matsuura_mx330")
    assert "(A] M30 [B)" in lines
    assert not [line for line in lines[:-3] if "M30" in re.sub(r"\([^()]*\)", "", line)]


def test_no_text_of_a_cl_file_ends_a_message(tmp_path: Path) -> None:
    cl = SHOP.replace("turn the part", 'a") M30 MSG("b').replace("check the clamps (3x)", 'c") M30 MSG("d')
    templates = f"""
stop = {STOP}
event_PPRINT = 'MSG("{{{{ text }}}}")'
before_operation = 'MSG("{{{{ operation }}}}")'
"""
    lines = program(tmp_path, templates, cl)
    assert "MSG(\"a') M30 MSG('b\")" in lines
    assert "MSG(\"c') M30 MSG('d\")" in lines


def test_a_number_beyond_its_format_is_told_at_the_template(tmp_path: Path) -> None:
    for place in ("first_cut", "before_operation"):
        problem = refusal(tmp_path, f'{place} = ";{{{{ tool.diameter * 99999999 | coordinate }}}}"')
        assert (problem.file, problem.line) == (str(tmp_path / "ours.toml"), 6)


def test_a_program_in_inches_prints_lengths_in_inches(tmp_path: Path) -> None:
    text = "(D{{ tool.diameter }} {{ (tool.diameter + 15.4) | coordinate }} Z{50.8:coordinate})"
    settings = {"cl_units": "mm", "units": "inch"}
    lines = program(tmp_path, f'before_operation = "{text}"', extends="matsuura_mx330", **settings)
    assert "(D0.393701 1. Z2.)" in lines


def test_an_operation_end_with_conditions_switches_the_coolant_off_once(tmp_path: Path) -> None:
    end = """operation_end_three_axis = '''
SUPA G0 Z=_Z_HOME D0
SUPA G0 X=_X_HOME Y=_Y_HOME {primary}=_{primary}_HOME {secondary}=_{secondary}_HOME D{edge}
{% if operation.coolant %}
M9
{% endif %}
CYCLE832()
M5
'''"""
    assert program(tmp_path, end).count("M9") == 1


def test_a_program_with_texts_converts_back(tmp_path: Path) -> None:
    templates = """
first_cut = '''
{% if operation.coolant %}
M{{ 80 + 8 }}
{% endif %}
'''
before_operation = ';OPERATION {{ operation | upper }}'
"""
    program(tmp_path, templates, more=KNOWN)
    ours = tmp_path / "ours.toml"
    trunnion.post(tmp_path / "part.cls", machine=ours, output=tmp_path / "part.mpf")
    result = trunnion.convert(tmp_path / "part.mpf", machine=ours, to_cl=True, output=tmp_path / "back.cls")
    text = (tmp_path / "back.cls").read_text(encoding="utf-8")
    assert result.passed
    assert text.count("INSERT/M88") == 1
    assert [line.split(",")[0] for line in text.splitlines() if line.startswith("TOOL PATH/")] == [
        "TOOL PATH/ROUGH TOP", "TOOL PATH/DRILL SIDE", "TOOL PATH/FINISH SIDE",
    ]  # fmt: skip


def test_shipped_definitions_start_without_the_template_language() -> None:
    code = "import sys, trunnion; trunnion.describe_control('sinumerik_840d'); print('jinja2' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"


@pytest.mark.parametrize("extends", ["yl569", "dmu65", "matsuura_mx330"])
def test_a_text_that_stops_and_starts_the_spindle_in_the_cut_is_refused(tmp_path: Path, extends: str) -> None:
    problem = refusal(tmp_path, 'event_PPRINT = "M5\\nM3"', extends=extends)
    assert "it switches the spindle" in problem.what
    program(tmp_path, 'event_PPRINT = "M3"', extends=extends)


def test_a_subprogram_without_its_return_is_not_proven(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(SHOP, encoding="utf-8")
    for foot in ("%", "(END)"):
        ours = machine(tmp_path, f'subprogram_end = "{foot}"', extends="matsuura_mx330")
        settings = {"programs": "operations"}
        with pytest.raises(trunnion.RefusedError, match="without M99"):
            trunnion.post(tmp_path / "part.cls", machine=ours, output=tmp_path / "out.nc", settings=settings)


def test_a_tool_that_cannot_be_called_is_told_also_where_a_text_prints_it(tmp_path: Path) -> None:
    cl = "\n".join(line for line in SHOP.splitlines() if not line.startswith("LOAD/TOOL")) + "\n"
    assert refusal(tmp_path, "event_PPRINT = '{# #}'", cl, extends="matsuura_mx330").code == "CTL130"


@pytest.mark.parametrize("place", ["event_PPRINT", "first_cut", "before_operation", "after_approach"])
@pytest.mark.parametrize("text", ["; WATCH ~", "* - WATCH ~"])
def test_a_comment_that_takes_the_next_line_into_its_block_is_refused(tmp_path: Path, place: str, text: str) -> None:
    with pytest.raises(trunnion.TrunnionError, match="~"):
        program(tmp_path, f'{place} = "{text}"', extends="dmu65")


@pytest.mark.parametrize("extends", ["yl569", "dmu65"])
@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_the_text_of_a_stop_ends_no_line(tmp_path: Path, extends: str, encoding: str) -> None:
    cl = SHOP.replace("STOP/turn the part", "STOP/A\u0085M30\u2028M30\u202eB")
    assert cl != SHOP
    lines = program(tmp_path, 'stop = ";STOPS: {text}\\nM{number}"', cl, extends=extends, encoding=encoding)
    assert [line[line.index("A") :] for line in lines if "STOPS" in line] == ["A M30 M30B"]


def test_a_rotation_that_is_left_on_at_the_end_is_refused(tmp_path: Path) -> None:
    turned, back = "after_operation = 'G68 X0 Y0 R5.'\n", "before_operation = 'G69'\n"
    with pytest.raises(trunnion.RefusedError, match="ends with G68 on"):
        program(tmp_path, turned + back, extends="matsuura_mx330")


DIVIDED = pytest.mark.parametrize("programs", ["one", "operations"])


@DIVIDED
@pytest.mark.parametrize(("text", "code"), [("GOTO 10", "NC140"), ("WHILE [1 EQ 1] DO1", "NC142")])
def test_a_text_that_cannot_be_followed_is_told_with_its_template(
    tmp_path: Path, text: str, code: str, programs: str
) -> None:
    with pytest.raises(trunnion.InputError) as caught:
        post_to_file(tmp_path, f'before_operation = """\n(HERE)\n{text}\n"""', programs)
    (problem,) = caught.value.problems
    definition = tmp_path / "ours.toml"
    assert f"{text}: written by template before_operation ({definition}:7)" in problem.what
    assert problem.code == code
    name = str(tmp_path / "part.nc") if programs == "one" else "O1001.nc"
    assert problem.file == name


@DIVIDED
def test_a_block_that_fails_the_proof_is_told_with_its_template(tmp_path: Path, programs: str) -> None:
    with pytest.raises(trunnion.ProofFailedError) as caught:
        post_to_file(tmp_path, 'before_operation = "G0 X55."', programs)
    definition = tmp_path / "ours.toml"
    assert f"N20 is written by template before_operation ({definition}:6)" in caught.value.problems[0].what
    (order,) = [check for check in caught.value.result.checks if check.key == "order"]
    assert "(G0 X55.: written by template before_operation" in order.places[0].text
    assert {place.nc_file for place in order.places} == (
        {""} if programs == "one" else {"O1001.nc", "O1002.nc", "O1003.nc"}
    )


@pytest.mark.parametrize("text", ["G81", "G83", "G98 G81"])
def test_a_cycle_without_words_in_a_text_fails_the_proof(tmp_path: Path, text: str) -> None:
    with pytest.raises(trunnion.ProofFailedError) as caught:
        post_to_file(tmp_path, f'before_operation = "{text}"', "one")
    (words,) = [check for check in caught.value.result.checks if not check.passed]
    assert (words.key, words.places[0].code) == ("words", "NC218")
    assert f"({text}: written by template before_operation" in words.places[0].text


def test_what_a_text_breaks_further_down_is_told_with_the_template_above(tmp_path: Path) -> None:
    with pytest.raises(trunnion.ProofFailedError) as caught:
        post_to_file(tmp_path, 'before_operation = "G91"', "one")
    told = caught.value.problems[0].what
    assert f"is that of template before_operation ({tmp_path / 'ours.toml'}:6)" in told


def post_to_file(folder: Path, templates: str, programs: str) -> None:
    (folder / "part.cls").write_text(SHOP, encoding="utf-8")
    definition = machine(folder, templates, extends="matsuura_mx330")
    settings = {"programs": programs}
    trunnion.post(folder / "part.cls", machine=definition, output=folder / "part.nc", settings=settings)


def test_a_call_in_raw_text_is_told_with_the_cure_that_helps(tmp_path: Path) -> None:
    cl = SHOP.replace("RAPID\nGOTO", "INSERT/M98 P77\nRAPID\nGOTO", 1)
    problem = refusal(tmp_path, "", cl, extends="matsuura_mx330")
    assert problem.what == "INSERT/M98 P77: nobody can say what it does: subprogram O0077 is not run with raw text"
    assert '"M98 P77" = "comes back' in problem.cure
    known = '[control.known]\n"M98 P77" = "comes back: probes"\n'
    assert "M98 P77" in program(tmp_path, "", cl, more=known, extends="matsuura_mx330")


@pytest.mark.third
@pytest.mark.parametrize("time", ["time", "operation.time", "total_time", "(time ~ ' long')", "(time | default('-'))"])
@pytest.mark.parametrize("use", [" | cut(5)", " | lower", " | replace('s', '')", " == '4 s'", " in ['4 s']"])
def test_a_machining_time_can_only_be_printed(tmp_path: Path, time: str, use: str) -> None:
    problem = refusal(tmp_path, f'''before_operation = ";A {{{{ {time} ~ '' }}}} {{{{ 1 if {time}{use} else 2 }}}}"''')
    assert (problem.code, "machining time" in problem.what) == ("DEF580", True)


@pytest.mark.parametrize(
    ("extends", "text", "word"),
    [
        ("yl569", "ORIMKS", "ORIMKS"), ("yl569", "CYCLE832()", "CYCLE832"), ("yl569", "M61 G642", "G642"),
        ("yl569", "COMPCAD", "COMPCAD"), ("matsuura_mx330", "G05.1 Q0", "G5.1"), ("matsuura_mx330", "G64", "G64"),
    ],
)  # fmt: skip
def test_a_mode_behind_the_approach_is_refused(tmp_path: Path, extends: str, text: str, word: str) -> None:
    problem = refusal(tmp_path, f'after_approach = """\n;LOOK\n{text} ;NOTE\n"""' if extends == "yl569" else
                      f'after_approach = "{text}"', more=KNOWN, extends=extends)  # fmt: skip
    assert (problem.code, problem.file) == ("CTL457", str(tmp_path / "ours.toml"))
    assert f"writes {word}," in problem.what


@pytest.mark.third
@pytest.mark.parametrize("place", ["same_tool", "preselect", "stop"])
@pytest.mark.parametrize(
    ("extends", "text", "word"),
    [
        ("yl569", "SOFT", "SOFT"), ("dmu65", "M120 LA10", "M120"), ("linuxcnc_5axis", "G61", "G61"),
        ("dmu65", "CYCL DEF 32.0 TOLERANCE\nCYCL DEF 32.1 T0.05", "CYCL DEF 32"), ("matsuura_mx330", "G61", "G61"),
    ],
)  # fmt: skip
def test_a_mode_at_places_behind_those_of_the_operation_is_refused(
    tmp_path: Path, place: str, extends: str, text: str, word: str
) -> None:
    stop = "\nM{number}" if place == "stop" else ""
    problem = refusal(tmp_path, f"{place} = '''\n{text}{stop}\n'''", LEVEL_ONLY, extends=extends)
    assert (problem.code, f"{place} writes {word}," in problem.what) == ("CTL457", True)


@pytest.mark.third
@pytest.mark.parametrize(
    ("extends", "text"),
    [
        ("yl569", "AROT Z5"), ("yl569", "TRANS X1"), ("yl569", "MIRROR X0"), ("yl569", "SCALE X2"),
        ("dmu65", "PLANE SPATIAL SPA+0 SPB+5 SPC+0 STAY"), ("dmu65", "CYCL DEF 7.0 DATUM SHIFT\nCYCL DEF 7.1 X+1"),
        ("dmu65", "CYCL DEF 10.0 ROTATION\nCYCL DEF 10.1 ROT+5"), ("dmu65", "CYCL DEF 8.0 MIRROR\nCYCL DEF 8.1 X"),
        ("dmu65", "CYCL DEF 11.0 SCALING\nCYCL DEF 11.1 SCL 0.99"), ("matsuura_mx330", "G68.2 X0 Y0 Z0 I0 J5. K0"),
        ("dmu65", "CYCL DEF 26.0 AXIS-SPEC. SCALING\nCYCL DEF 26.1 X0.9 Y0.9"),
        ("matsuura_mx330", "G52 X1."), ("matsuura_mx330", "G92 X1."), ("xyzbc_trt", "G52 X1."),
        ("xyzbc_trt", "G92 X1."), ("xyzbc_trt", "G10 L2 P1 R5"),
    ],
)  # fmt: skip
def test_what_is_left_to_the_next_program_is_refused(tmp_path: Path, extends: str, text: str) -> None:
    with pytest.raises(
        trunnion.RefusedError, match=r"ends (the program )?with|ends the program in|behind the last motion"
    ):
        program(tmp_path, f"after_operation = '''\n{text}\n'''", LEVEL_ONLY, extends=extends)


@pytest.mark.parametrize(
    ("extends", "text"),
    [
        ("yl569", "M17"), ("yl569", "RET"), ("yl569", "M30"), ("matsuura_mx330", "M99"), ("matsuura_mx330", "M30"),
        ("haas_umc750", "M99"), ("xyzbc_trt", "O1 return\nM9"), ("xyzbc_trt", "M2"), ("dmu65", "M30"),
        ("dmu65", "END PGM ROUGH_TOP MM"),
    ],
)  # fmt: skip
def test_a_subprogram_that_ends_too_early_is_refused(tmp_path: Path, extends: str, text: str) -> None:
    (tmp_path / "part.cls").write_text(LEVEL_ONLY, encoding="utf-8")
    ours = machine(tmp_path, f"after_operation = '''\n{text}\n'''", extends=extends)
    with pytest.raises(trunnion.RefusedError, match="never runs"):
        trunnion.post(tmp_path / "part.cls", machine=ours, output=tmp_path / "out", settings={"programs": "operations"})


@pytest.mark.parametrize("text", ["M2", "STOP M30"])
def test_blocks_behind_the_end_of_a_klartext_program_are_refused(tmp_path: Path, text: str) -> None:
    with pytest.raises(trunnion.RefusedError, match="never runs"):
        program(tmp_path, f"after_operation = '{text}'", LEVEL_ONLY, extends="dmu65")


def test_comments_and_declared_words_behind_the_approach_are_written(tmp_path: Path) -> None:
    lines = program(tmp_path, 'after_approach = ";G64 IS ON\\nM61"', more=KNOWN)
    assert lines.count("M61") == lines.count(";G64 IS ON") == 3


def test_a_limit_of_the_look_ahead_may_stand_before_the_first_cut(tmp_path: Path) -> None:
    assert "G103 P1" in program(tmp_path, "first_cut = 'G103 P1'", extends="haas_umc750")
    assert "unknown word G103" in refusal(tmp_path, "first_cut = 'G103 P1'", extends="matsuura_mx330").what


@pytest.mark.parametrize(
    ("base", "jump"), [("matsuura_mx330", "GOTO9000"), ("haas_umc750", "GOTO9000"), ("yl569", "GOTOF N9000")]
)
def test_a_text_may_bring_a_block_number_that_it_jumps_to(tmp_path: Path, base: str, jump: str) -> None:
    (tmp_path / "part.cls").write_text(LEVEL_ONLY, encoding="utf-8")
    ours = machine(tmp_path, f'before_operation = "{jump}\\nN9000 M9"', extends=base)
    posted = trunnion.post(tmp_path / "part.cls", machine=ours, settings={"numbers": "on"})
    assert posted.passed
    assert posted.text is not None
    lines = posted.text.splitlines()
    at = lines.index("N9000 M9")
    assert re.fullmatch(rf"N\d+ {jump}", lines[at - 1])
    assert re.match(r"N\d+ ", next(line for line in lines[at + 1 :] if line[0] != "("))
