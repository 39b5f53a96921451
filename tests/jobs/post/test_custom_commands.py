"""The custom commands of published posts, as the page has them: each program is proven, and has the lines it shows."""

import re
import shlex
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import DOCS, GOLDEN, TESTS, YL569
from trunnion.cli import main

PAGE = (DOCS / "coming-from.md").read_text(encoding="utf-8").partition("## Custom commands of published posts")[2]
COMMANDS = dict(re.findall(r"^### (.+?)\n(.*?)(?=^### |\Z)", PAGE, re.MULTILINE | re.DOTALL))

#: Those whose program is that of the shipped definition, byte for byte, and its CL file.
AS_SHIPPED = {
    "G0 before TRAORI": ("hub.cls", "yl569"), "Cycle 32": ("hub.cls", "mikron_600u"),
    "M126 and M128": ("hub.cls", "mikron_600u"), "Start and retract of a Fidia": ("holes.cls", "hs664rt"),
}  # fmt: skip


@pytest.fixture
def posted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the CL files that the page names; it is the present one."""
    monkeypatch.chdir(tmp_path)
    shop = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8")
    Path("part.cls").write_text(shop.replace("BORHED/40.5,DEEP\n", ""), encoding="utf-8")
    Path("hub.cls").write_text((YL569 / "2_hub_rough.cls").read_text(encoding="utf-8"), encoding="utf-8")
    Path("holes.cls").write_text(
        (GOLDEN / "hs664rt" / "radial_holes.cls").read_text(encoding="utf-8"), encoding="utf-8"
    )
    return tmp_path


def samples(text: str) -> dict[str, list[str]]:
    """The samples of a part of the page by their languages, in their order."""
    found: dict[str, list[str]] = {}
    for language, sample in re.findall(r"^```(\w*)\n(.*?)^```", text, re.MULTILINE | re.DOTALL):
        found.setdefault(language, []).append(sample)
    return found


def test_the_page_has_the_eight_commands_of_its_table() -> None:
    rows = re.findall(r"^\| ([^|]+) \|", PAGE.partition("###")[0], re.MULTILINE)[2:]
    assert [row.replace("`", "").lower() for row in rows] == [name.lower() for name in COMMANDS]
    assert len(COMMANDS) == 8


@pytest.mark.parametrize("name", COMMANDS)
def test_a_custom_command_makes_a_proven_program_with_the_lines_that_it_shows(
    name: str, posted: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    found = samples(COMMANDS[name])
    assert found.keys() & {"tcl", "toml"}, "what it was"
    Path("shop.py").write_text(found["py"][0], encoding="utf-8")
    for definition in found.get("toml", []):
        Path("ours.toml").write_text(definition, encoding="utf-8")
    command, shown = found[""]
    program, *arguments = shlex.split(command)
    assert program == "trunnion"
    assert main([*arguments, "--output", "part.nc"]) == 0, capsys.readouterr().err
    text = Path("part.nc").read_text(encoding="utf-8")
    lines, at = [re.sub(r"^N?\d+ ", "", line) for line in text.splitlines()], 0
    for line in shown.splitlines():
        assert line in lines[at:], f"{line} is not behind the lines before it"
        at = lines.index(line, at) + 1
    if name in AS_SHIPPED:
        cl, machine = AS_SHIPPED[name]
        assert trunnion.post(cl, machine=machine).text == text


def test_what_the_stock_post_wrote_is_refused_without_its_function(posted: Path) -> None:
    Path("ours.toml").write_text(samples(COMMANDS["G0 before TRAORI"])["toml"][0], encoding="utf-8")
    with pytest.raises(trunnion.ProofFailedError):
        trunnion.post("hub.cls", machine="ours.toml")
