"""The post for Fusion, HSMWorks and Inventor CAM: what it writes of streams of events, and what becomes of that."""

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import pytest

import trunnion
from tests.support.fusion.jobs import DRILL, HOLES, MILL, STREAMS, square, tilted
from tests.support.fusion.streams import Stream
from tests.support.locations import ROOT, TESTS
from trunnion.cli import main
from trunnion.cli.doors import posts_folder

NODE: Final = shutil.which("node")
POST: Final = ROOT / "src" / "trunnion" / "doors" / "trunnion.cps"

#: What a definition says of statements and kinds of coolant that the shipped ones do not know.
OWN: Final = '[control.coolant]\nAIR = 281\n[control.statements]\n"PROBE" = "M282"\n'
SETTINGS: Final = {
    "inches": {"units": "mm"},
    "probing": {"standing_spindle": "allowed"},
}
#: Machines, and what selects the second work offset there.
MACHINES: Final = {"dmu65": "Q339=+2", "yl569": "G55"}

needs_node = pytest.mark.skipif(NODE is None, reason="Node.js is not installed")


def posted(streams: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """What the post makes of streams: text, error and warnings of each."""
    engine = TESTS / "doors" / "node" / "engine.js"
    done = subprocess.run(
        [str(NODE), str(engine), str(POST)], input=json.dumps(streams), capture_output=True, text=True, check=True
    )
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


@needs_node
def test_each_stream_becomes_the_text_that_is_meant() -> None:
    jobs = [make() for make in STREAMS.values()]
    found = posted([job.event() for job in jobs])
    assert [each["error"] for each in found] == [None] * len(jobs)
    for job, each in zip(jobs, found, strict=True):
        assert each["text"].splitlines() == job.text.splitlines(), job.name
        assert each["text"] == job.text


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("name", STREAMS)
def test_each_text_is_posted_and_proven(name: str, machine: str, tmp_path: Path) -> None:
    file, definition = tmp_path / "part.apt", tmp_path / "own.toml"
    file.write_text(STREAMS[name]().text, encoding="utf-8")
    definition.write_text(f'schema = 1\nextends = "{machine}"\nname = "Own"\n{OWN}', encoding="utf-8")
    program = tmp_path / "part.nc"
    done = trunnion.post(file, machine=definition, output=program, settings=SETTINGS.get(name, {}))
    assert done.passed, [str(each) for each in done.problems]
    assert (MACHINES[machine] in program.read_text(encoding="utf-8")) == (name == "set_ups")


def test_the_language_of_the_post_is_that_of_the_engine() -> None:
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", POST.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert re.findall(r"\b(?:let|const|class|async)\b|=>|`|\.\.\.\w|\.(?:includes|startsWith|padStart)\(", text) == []


def test_probing_is_refused_unless_the_definition_says_what_it_is(tmp_path: Path) -> None:
    file = tmp_path / "part.apt"
    file.write_text(STREAMS["probing"]().text, encoding="utf-8")
    with pytest.raises(trunnion.InputError, match=r"part\.apt:18: error: PROBE is not known; write under"):
        trunnion.post(file, machine="yl569", output=tmp_path / "part.nc", settings=SETTINGS["probing"])


@needs_node
def test_a_form_that_cannot_be_said_is_a_warning() -> None:
    (found,) = posted([STREAMS["tools"]().event()])
    assert len(found["warnings"]) == 8
    assert found["warnings"][0].startswith("operation 'TOOL 8': the form of tool 38 cannot be said in CL data")


@needs_node
def test_a_set_up_that_states_no_work_offset_says_none() -> None:
    (found,) = posted([plain(offset=0)])
    assert found["error"] is None
    assert "WORK-OFFSET" not in found["text"]


Change = Callable[[dict[str, Any]], None]


def plain(**more: Any) -> dict[str, Any]:
    """A program with an operation FACE; ``more`` is its tool's or its section's."""
    job = Stream("PART")
    tool = replace(MILL, **more.pop("tool", {}))
    with job.section("FACE", tool, (30.0, 30.0, 50.0), **more):
        square(job, 25.0, 1.0)
    return job.event()


def behind(event: list[Any], **properties: str) -> dict[str, Any]:
    """The same with an event behind its operation."""
    found = plain()
    found["after"] = [event]
    found["properties"].update(properties)
    return found


def within(event: list[Any], **more: Any) -> dict[str, Any]:
    """The same with an event in its operation."""
    found = plain(**more)
    found["sections"][0]["events"].append(event)
    return found


def drilled(kind: str, tool: dict[str, Any] | None = None, **words: float) -> dict[str, Any]:
    """A cycle with three holes."""
    job = Stream("PART")
    with job.section("HOLES", replace(DRILL, **(tool or {})), (0.0, 0.0, 50.0), spindle=500.0):
        job.holes(kind, "", HOLES, 10.0, **words)  # type: ignore[arg-type]
    return job.event()


def two(**second: Any) -> dict[str, Any]:
    """Two operations, of which the second is of another set-up."""
    job = Stream("PART")
    for name, more in (("FIRST", {}), ("SECOND", second)):
        with job.section(name, MILL, (30.0, 30.0, 50.0), **more):
            square(job, 25.0, 1.0)
    return job.event()


UP: Final = (0.0, 0.0, 1.0)
TURNED: Final = {"origin": (0.0, 0.0, -50.0), "x": (1.0, 0.0, 0.0), "y": (0.0, -1.0, 0.0)}
REFUSED: Final[list[tuple[dict[str, Any], str]]] = [
    (plain(type=1), "operation 'FACE': turning and jet cutting are not read"),
    (plain(wrapped=True), "operation 'FACE': a wrapped path"),
    (plain(optimized=True), "operation 'FACE': its tool axes are angles of a machine"),
    (two(forced=True), "operation 'SECOND': the tool change is forced"),
    (plain(plane=tilted(0.0, 30.0), axis=UP), "operation 'FACE': a five-axis operation with a work plane"),
    (plain(plane=tilted(0.0, 30.0), engineShift=(0.0, 0.0, 1.0)), "operation 'FACE': the post engine maps its points"),
    (plain(tool={"coolant": "SUCTION"}), "operation 'FACE': coolant of the kind suction cannot be said"),
    (plain(tool={"others": (("breakControl", True),)}), "operation 'FACE': the break control of tool 1 cannot"),
    (within(["rapid5", (0, 0, 60), (0, 0, 1)]), "operation 'FACE': a tool axis is no unit vector"),
    (within(["line5", (0, 0, 60), (10, 0, 30), 500.0], axis=UP), "operation 'FACE': a tool axis is no unit"),
    (within(["line5", (0, 0, 60), (0, 0, 1), 5.0, 2], axis=UP), "operation 'FACE': a feed of a five-axis move"),
    (within(["arc", (0, 25, 50), (0, 0, 1), 90.0, 0.0, 100.0, 100.0]), "operation 'FACE': an arc whose ends"),
    (within(["compensation", 1]), "operation 'FACE': radius compensation of the type ''"),
    (within(["compensation", 1], parameters={"operation:compensationType": "inverseWear"}),
     "operation 'FACE': radius compensation of the type 'inverseWear'"),
    (within(["orient", 1.0]), "operation 'FACE': orienting the spindle cannot be said"),
    (behind(["command", "TOOL_MEASURE"]), "behind operation 'FACE': the command tool measure cannot be said"),
    (behind(["command", "CALIBRATE"]), "behind operation 'FACE': the command calibrate cannot be said"),
    (behind(["parameter", "action", "PALLET"]), "behind operation 'FACE': the action 'PALLET' cannot be said"),
    (behind(["parameter", "call-subprogram", "O9"]), "behind operation 'FACE': the call of program 'O9' cannot"),
    (behind(["dwell", 1.0], inserts="OPEN_DOOR"), "post property 'Lines of the program': 'OPEN_DOOR' has no '='"),
    *((drilled(kind), f"operation 'HOLES': the cycle '{kind}' cannot be said")
      for kind in ("fine-boring", "back-boring", "manual-boring")),
    (drilled("probing-x"), "operation 'HOLES': probing ('probing-x') cannot be said"),
    (drilled("tapping", {"type": "TAP_LEFT_HAND"}), "operation 'HOLES': a left-hand thread with the spindle"),
    (drilled("right-tapping", {"is_clockwise": False}), "operation 'HOLES': a right-hand thread with the"),
    (drilled("tapping"), "operation 'HOLES': the pitch of tap 5 is not known"),
    (drilled("drilling", rapid=-1.0), "operation 'HOLES': a hole whose top is above its feed height"),
    (two(wcs=TURNED), "operations 'FIRST' and 'SECOND' have one work offset (1) and different coordinate systems"),
]  # fmt: skip


@needs_node
def test_what_cannot_be_said_is_refused_with_the_name_of_the_operation() -> None:
    found = posted([stream for stream, _ in REFUSED])
    missed = [(wanted, each["error"]) for (_, wanted), each in zip(REFUSED, found, strict=True)
              if not (each["error"] or "").startswith(wanted)]  # fmt: skip
    assert missed == []


def test_install_and_remove(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "Posts"
    assert main(["fusion", "install", "--folder", str(folder)]) == 0
    assert (folder / "trunnion.cps").read_bytes() == POST.read_bytes()
    assert main(["fusion", "install", "--remove", "--folder", str(folder)]) == 0
    assert not list(folder.iterdir())
    monkeypatch.setattr("sys.platform", "linux")
    capsys.readouterr()
    assert main(["fusion", "install"]) == 2
    assert "give the folder of posts: --folder FOLDER" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("platform", "there", "folder"),
    [
        ("win32", "", "Roaming/Autodesk/Fusion 360 CAM/Posts"),
        ("darwin", "", "Autodesk/Fusion 360 CAM/Posts"),
        ("darwin", "Library/Application Support/Autodesk/Fusion 360 CAM/Posts",
         "Library/Application Support/Autodesk/Fusion 360 CAM/Posts"),
    ],
)  # fmt: skip
def test_where_fusion_looks(
    platform: str, there: str, folder: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.platform", platform)
    monkeypatch.setenv("APPDATA", str(tmp_path / "Roaming"))
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / there).mkdir(parents=True, exist_ok=True)
    assert posts_folder() == tmp_path / folder
