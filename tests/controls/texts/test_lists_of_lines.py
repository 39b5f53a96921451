"""A template may be stated as the list of its lines, which is the text of these lines."""

from pathlib import Path

import pytest

from trunnion.cli import main
from trunnion.controls.loading import load_control
from trunnion.errors import InputError
from trunnion.machines import load_machine

SHOP = """extends = "yl569"
name = "YL569 实训室"
[control.templates]
program_end = ["M5", ";程序结束", "M30"]
program_start = [{start}]
[control.settings]
encoding = "gbk"
"""


def written(tmp_path: Path, start: str) -> Path:
    path = tmp_path / "shop.toml"
    path.write_bytes(SHOP.format(start=start).encode("gbk"))
    return path


def test_a_list_of_lines_is_their_text(tmp_path: Path) -> None:
    start = '";{title}",\n  "{% for one in tools %}", ";T{{ one }}", "{% endfor %}"'
    templates = load_control(load_machine(written(tmp_path, start)).control.unread_copy()).templates
    assert templates["program_end"].lines == ("M5", ";程序结束", "M30")
    assert templates["program_start"].lines == (";{title}", "{% for one in tools %}", ";T{{ one }}", "{% endfor %}")


@pytest.mark.parametrize(
    ("start", "line"),
    [
        ('";{title}", ";{titel}"', 5),
        ('\n  ";{title}",\n  ";{titel}",\n', 7),
        ('\n  "{% if date %}",\n  ";{{ titel }}",\n  "{% endif %}"\n', 7),
        ('"{% if date %}", ";{{ titel }}", "{% endif %}"', 5),
        ('"M5", 5', 5),
    ],
    ids=["one line", "a line each", "a line each, with a branch", "one line, with a branch", "no text"],
)
def test_a_mistake_has_its_line(start: str, line: int, tmp_path: Path) -> None:
    path = written(tmp_path, start)
    with pytest.raises(InputError) as caught:
        load_control(load_machine(path).control.unread_copy())
    assert {(problem.file, problem.line) for problem in caught.value.problems} == {(str(path), line)}


def test_a_shop_that_writes_gbk_posts_with_it(tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_text(
        "TOOL PATH/ROUGH,TOOL,D10\nTLDATA/MILL,10,0,40,0,0\nMSYS/0,0,0,1,0,0,0,1,0\nLOAD/TOOL,1\nSPINDL/RPM,2000,CLW\n"
        "RAPID\nGOTO/0,0,20,0,0,1\nFEDRAT/MMPM,200\nGOTO/0,0,0\nGOTO/30,0,0\nRAPID\nGOTO/30,0,20\nEND-OF-PATH\n"
    )
    program = tmp_path / "part.mpf"
    names = "DEF REAL _X_HOME, _Y_HOME, _Z_HOME, _{primary}_HOME, _{secondary}_HOME"
    start = f'";{{title}}", "DEF REAL _camtolerance", "{names}", "G40 G17 {{unit_word}} G94 G90 G60 G601 FNORM"'
    machine = str(written(tmp_path, start))
    assert main(["post", str(tmp_path / "part.cls"), "--machine", machine, "--output", str(program)]) == 0
    assert program.read_bytes().decode("gbk").splitlines()[-2:] == ["N490 ;程序结束", "N500 M30"]
