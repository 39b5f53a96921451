"""Setup sheet, listing and manifest of a post: what they say, and that they appear with the program or not at all."""

import hashlib
import json
import os
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.browser import browser as browser
from tests.support.browser import needs_browser, open_file
from tests.support.locations import TESTS
from tests.support.posting import FOOT, HEAD
from trunnion.cli import main
from trunnion.errors import InputError

EVIL = "<script>alert(1)</script>\"'&\u202e"

CL = (
    HEAD.replace("TOOL,D10", "TOOL,D10</td><b>").replace("SPINDL", "COOLNT/FLOOD\nSPINDL")
    + "GOTO/20.0,-3.5,5.0\n" + FOOT
    + HEAD.replace("OP1", EVIL).replace("TOOL,1", "TOOL,2").replace("0.0,0.0,1.0", "0.0,0.6,0.8")
    + FOOT
)  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A post with all of its papers."""
    found = tmp_path_factory.mktemp("papers")
    (found / "part.cls").write_text(CL, encoding="utf-8")
    post(found)
    return found


def post(folder: Path, **given: Any) -> trunnion.PostResult:
    papers: dict[str, Any] = {
        "sheet": folder / "job.html",
        "listing": folder / "job.lpt",
        "manifest": folder / "job.json",
        "report": folder / "report.html",
    }
    settings = {"programs": "operations", "zero": "0,0,-100"}
    return trunnion.post(
        folder / "part.cls", machine="yl569", output=folder / "job.mpf", settings=settings, **{**papers, **given}
    )


class _Tags(HTMLParser):
    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)

    def handle_data(self, data: str) -> None:
        self.text += data + " "


def test_the_sheet_tells_what_a_setter_needs(folder: Path) -> None:
    page = _Tags((folder / "job.html").read_text(encoding="utf-8"))
    text = " ".join(page.text.split())
    for wanted in (
        "job.mpf", "Yalong YL569", "G54", "X0.000 Y0.000 Z−100.000", "Passed in part", "OP1", "three-axis",
        "TCP", "flood", "X 0.000 … 20.000", "Y −3.500 … 0.000", "500", "4000", "Tools", "Travel",
        "To be checked at the machine", "Programmed by", "Set up by", "First part released by", "no simulation",
        hashlib.sha256((folder / "job.mpf").read_bytes()).hexdigest(),
    ):  # fmt: skip
        assert wanted in text, wanted
    assert "svg" in page.tags
    assert str(folder) not in text


def test_hostile_names_are_text(folder: Path) -> None:
    source = (folder / "job.html").read_text(encoding="utf-8")
    page = _Tags(source)
    assert "script" not in page.tags
    assert "b" not in page.tags
    assert "<script>alert(1)</script>" in page.text
    assert "\u202e" not in source
    assert "default-src 'none'" in source


def test_the_data_of_a_sheet(folder: Path) -> None:
    post(folder, sheet=folder / "sheet.json", manifest=None, report=None)
    data = json.loads((folder / "sheet.json").read_text(encoding="utf-8"))
    assert data["may_run"] is True
    assert data["zero"] == [0.0, 0.0, -100.0]
    assert [(tool["call"], tool["diameter"], tool["operations"]) for tool in data["tools"]] == [
        ("1", 10.0, [1]), ("2", 10.0, [2]),
    ]  # fmt: skip
    first, second = data["operations"]
    assert first["box"] == [[0.0, -3.5, 5.0], [20.0, 0.0, 50.0]]
    assert (first["feed"], first["rpm"], first["coolant"]) == ([500.0, 500.0], [4000.0, 4000.0], "flood")
    assert first["seconds"] > first["cutting_seconds"] > 0
    assert second["mode"] in ("TCP", "tilted plane")
    assert second["rotary"].keys() == {"B", "C"}
    assert second["start"]["nc_file"] == data["files"][2]["name"]
    assert sum(each["seconds"] for each in data["operations"]) == pytest.approx(data["seconds"])
    assert {axis["name"] for axis in data["axes"]} == {"X", "Y", "Z", "B", "C"}
    assert all(check["state"] != "FAIL" for check in data["checks"])
    assert data["files"][0]["name"] == "job.mpf"
    assert len(data["files"]) == 3


@pytest.mark.parametrize(
    "settings", [{"restart": "on"}, {"numbers": "operations"}, {"programs": "operations", "split": "20480"}]
)
def test_an_operation_begins_where_its_blocks_do(settings: dict[str, str], tmp_path: Path) -> None:
    plate = Path(trunnion.__file__).parents[2] / "examples" / "project" / "plate_top.cls"
    sheet, listing = tmp_path / "a.json", tmp_path / "a.lpt"
    output = tmp_path / "a.mpf"
    trunnion.post(plate, machine="yl569", output=output, settings=settings, sheet=sheet, listing=listing)
    start = json.loads(sheet.read_text(encoding="utf-8"))["operations"][1]["start"]
    name = start["nc_file"] or "a.mpf"
    assert (name == "a.mpf") == ("programs" not in settings)
    lines = (tmp_path / name).read_text(encoding="utf-8").splitlines()
    first, *more = lines[start["nc_line"] - 1 :]
    assert re.match(rf"N{start['number']} ", first)
    assert "Operation : SLOT" in "".join(more[:20])  # its head, and not the end of the operation before
    rows = listing.read_text(encoding="utf-8").split("operation 2: SLOT\n")[1].splitlines()
    assert int(next(row for row in rows if row[0] != ";").split()[0]) > start["nc_line"]
    # Where the operation before goes home, its own listing tells so.
    before = listing.read_text(encoding="utf-8").split("operation 2: SLOT\n")[0]
    assert before.count("machine\n") > 2 + 1


def test_rotary_positions_are_those_that_the_display_shows(tmp_path: Path) -> None:
    flange = Path(__file__).parents[3] / "golden" / "fanuc" / "flange.cls"
    sheet, listing, output = tmp_path / "a.json", tmp_path / "a.lpt", tmp_path / "a.nc"
    trunnion.post(flange, machine="matsuura_mx330", output=output, sheet=sheet, listing=listing)
    programmed = set(re.findall(r" C(\d+)\.", output.read_text(encoding="ascii")))
    rows = [line.split() for line in listing.read_text(encoding="utf-8").splitlines() if line[:1] == " "]
    shown = {row[6] for row in rows if len(row) > 8} & {"240.0000", "120.0000", "-120.0000", "-240.0000", "-720.0000"}
    assert programmed == {"0", "120", "240"}
    assert shown == {"120.0000", "240.0000"}
    (turned,) = (axis for axis in json.loads(sheet.read_text(encoding="utf-8"))["axes"] if axis["name"] == "C")
    assert turned["used"] == [0.0, 360.0]


def test_a_sheet_tells_what_its_numbers_lack(tmp_path: Path) -> None:
    flange = Path(__file__).parents[3] / "golden" / "fanuc" / "flange.cls"
    trunnion.post(flange, machine="matsuura_mx330", output=tmp_path / "a.nc", sheet=tmp_path / "a.html")
    text = " ".join(_Tags((tmp_path / "a.html").read_text(encoding="utf-8")).text.split())
    assert "Not in these times rapids, speeding up and slowing down, tool changes: the machine" in text
    assert "the workpiece zero" in text
    assert "the workpiece zero: only" not in text
    assert not re.search(r"TAP_SIDES[^.]*(ROUGH|FINISH)", text)


def test_a_sheet_tells_of_compensation_pitches_angles_and_stops(tmp_path: Path) -> None:
    cl = tmp_path / "part.cls"
    drill = HEAD.replace("OP1", "TAPPING").replace("TOOL,1,ADJUST,1", "TOOL,2,ADJUST,2")
    drill = re.sub("TLDATA.*", "TLDATA/DRILL,MILL,10.0000,0.0000,60.0000,118.0000,8.0000", drill)
    holes = "CYCLE/TAP,RAPTO,3,FEDTO,-10,MMPR,1.25\nGOTO/0.0,0.0,0.0\nCYCLE/OFF\nGOTO/0.0,0.0,50.0\n"
    stop = "OPSTOP\n" + holes
    cl.write_text(HEAD + FOOT + drill + stop + FOOT, encoding="utf-8")
    sheet = tmp_path / "a.json"
    settings = {"drills_sideways": "allowed"}
    trunnion.post(cl, machine="matsuura_mx330", output=tmp_path / "a.nc", sheet=sheet, settings=settings)
    data = json.loads(sheet.read_text(encoding="utf-8"))
    first, second = data["operations"]
    assert first["notes"] == []
    assert second["notes"] == ["optional stop (M1)", "pitch 1.25 mm"]
    assert second["method"] == ""
    assert [tool["kind"] for tool in data["tools"]] == ["mill", ""]  # the tap is no drill, whatever the CL file says


def test_a_sheet_tells_of_blocks_to_skip_left_hands_and_where_axes_stand(tmp_path: Path) -> None:
    """C goes from 270 to 330 and 30: it cuts at these, and nowhere between."""
    cl, sheet = tmp_path / "part.cls", tmp_path / "a.json"
    tap = HEAD.replace("OP1", "TAPPING").replace(",CLW", ",CCLW")
    around = "".join(
        f"GOTO/{30.0 * x:.4f},{30.0 * y:.4f},0.0,{x:.7f},{y:.7f},0.0\n"
        for x, y in ((1.0, 0.0), (0.5, 0.8660254), (-0.5, 0.8660254))
    )
    holes = "RAPID\nGOTO/60.0,0.0,0.0,1.0,0.0,0.0\nCYCLE/TAP,RAPTO,3,FEDTO,-10,RTRCTO,20,MMPR,1.25\n"
    cl.write_text(HEAD + "OPSKIP/ON\nGOTO/20,0,5\nOPSKIP/OFF\n" + FOOT + tap + holes + around + "CYCLE/OFF\n" + FOOT)
    paper, settings = tmp_path / "a.html", {"drills_sideways": "allowed"}
    result = trunnion.post(cl, machine="matsuura_mx330", output=tmp_path / "a.nc", sheet=sheet, settings=settings)
    assert result.passed
    first, second = json.loads(sheet.read_text(encoding="utf-8"))["operations"]
    assert first["notes"] == ["blocks that the operator may skip (/)"]
    assert second["notes"] == ["pitch 1.25 mm, left hand"]
    assert second["rotary"]["C"] != [0.0, 360.0]
    trunnion.post(cl, machine="matsuura_mx330", output=tmp_path / "b.nc", sheet=paper, settings=settings)
    text = " ".join(_Tags(paper.read_text(encoding="utf-8")).text.split())
    assert re.search(r"C \d+\.000°, \d+\.000°, \d+\.000°", text)


def test_the_travel_of_a_sheet_is_that_of_its_check(tmp_path: Path) -> None:
    cl, sheet = TESTS / "data" / "cases" / "tilted.cls", tmp_path / "a.json"
    placed: dict[str, Any] = {"zero": (700.0, 0.0, -500.0), "tool_length": 150.0}
    result = trunnion.post(cl, machine="generic_head_head_ca", output=tmp_path / "a.mpf", settings=placed, sheet=sheet)
    told = next(check.told for check in result.checks if check.key == "travel")
    axes = json.loads(sheet.read_text(encoding="utf-8"))["axes"]
    for axis in axes:
        assert f"{axis['name']} {axis['margin']:.3f} {axis['unit']} left" in told


def test_what_is_left_to_a_person_is_told_as_a_task(tmp_path: Path) -> None:
    cl, sheet = TESTS / "data" / "cases" / "contour.cls", tmp_path / "a.json"
    trunnion.post(cl, machine="yl569", output=tmp_path / "a.mpf", sheet=sheet)
    tasks = json.loads(sheet.read_text(encoding="utf-8"))["to_check"]
    assert all(re.match(r"Check |Look |Run |Measure |Warning: ", task) for task in tasks), tasks


def test_a_refused_post_tells_of_the_files_that_are_there(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cl = tmp_path / "part.cls"
    cl.write_text(HEAD + FOOT, encoding="utf-8")
    old, sheet = tmp_path / "a.mpf", tmp_path / "a.html"
    arguments = ["post", str(cl), "--machine", "yl569", "--output", str(old), "--sheet", str(sheet)]
    assert main(arguments) == 0
    assert "from before this change" not in capsys.readouterr().err
    cl.write_text((HEAD + FOOT).replace("0.0,0.0,1.0", "0.0,0.7071068,-0.7071068"), encoding="utf-8")
    assert main(arguments) == 1
    assert f"{old}, {sheet}: warning: from before this change: do not run" in capsys.readouterr().err
    sheet.unlink()
    old.unlink()
    assert main(arguments) == 1
    assert "from before this change" not in capsys.readouterr().err


@needs_browser
def test_the_sheet_prints_on_a4(folder: Path, browser: Any) -> None:
    page = browser.new_page()
    errors: list[str] = []
    page.on("console", lambda message: errors.append(message.text))
    page.goto(open_file(folder / "job.html"))
    page.emulate_media(media="print")
    data = page.pdf(prefer_css_page_size=True)
    sizes = set(re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", data))
    assert [tuple(round(float(each)) for each in size) for size in sizes] == [(595, 842)]
    assert 1 <= len(re.findall(rb"/Type /Page\b", data)) <= 5
    widths = page.evaluate("() => [document.body.scrollWidth, document.body.clientWidth]")
    assert widths[0] <= widths[1], "nothing is wider than the paper"
    assert page.evaluate("() => getComputedStyle(document.querySelector('thead')).display") == "table-header-group"
    assert not errors
    page.close()


def test_what_is_simulated_is_drawn(folder: Path) -> None:
    post(folder, sheet=folder / "drawn.html", listing=None, manifest=None, report=None, force=True,
         simulation={"stock": "box:60,60,30,-20,-30,-26", "cell": 4.0})  # fmt: skip
    source = (folder / "drawn.html").read_text(encoding="utf-8")
    (stock,) = re.findall(r'<path class="stock" d="([^"]*)"', source)
    assert stock.count("L") == 12
    assert "The simulation (" in source
    assert "no simulation" not in source


# The manifest


def test_a_manifest_tells_of_all_files_and_inputs(folder: Path) -> None:
    post(folder)  # other posts into this folder replace its subprograms
    data = json.loads((folder / "job.json").read_text(encoding="utf-8"))
    whats = {file["name"]: file["what"] for file in data["files"]}
    assert whats["job.mpf"] == "program"
    assert sorted(whats.values()) == ["listing", "program", "report", "sheet", "subprogram", "subprogram"]
    for file in data["files"]:
        content = (folder / file["name"]).read_bytes()
        assert (file["bytes"], file["sha256"]) == (len(content), hashlib.sha256(content).hexdigest())
    (cl,) = data["inputs"]["cl"]
    assert cl["sha256"] == hashlib.sha256((folder / "part.cls").read_bytes()).hexdigest()
    assert [each["name"] for each in data["inputs"]["definitions"]] == ["yl569.toml", "sinumerik_840d.toml"]
    assert data["settings"] == {"programs": "operations", "zero": "0,0,-100"}
    assert data["settings_in_force"]["work_offset"] == "G54"
    assert data["may_run"] is True
    assert {check["key"] for check in data["checks"]} >= {"tip", "travel"}
    assert data["seconds"] == pytest.approx(sum(each["seconds"] for each in data["operations"]))
    assert str(folder) not in json.dumps(data)


def test_the_same_input_gives_the_same_bytes(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "part.cls").write_bytes((folder / "part.cls").read_bytes())
    post(folder)
    post(tmp_path)
    for name in ("job.mpf", "job.html", "job.lpt"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes(), name
    one, other = (
        {file["name"]: file["sha256"] for file in json.loads((each / "job.json").read_text("utf-8"))["files"]}
        for each in (folder, tmp_path)
    )
    one.pop("report.html"), other.pop("report.html")  # it names the folder
    assert one == other


def test_a_changed_file_is_found(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    post(folder)
    manifest = folder / "job.json"
    found = trunnion.verify_manifest(manifest, cl=[folder / "part.cls"])
    assert found.passed
    assert [file.what for file in found.files].count("cl") == 1
    assert main(["verify", str(manifest), "--cl", str(folder / "part.cls")]) == 0
    assert "job.mpf: the same (program)" in capsys.readouterr().out
    program = folder / "job.mpf"
    data = program.read_bytes()
    program.write_bytes(data.replace(b"M30", b"M02"))
    other = folder / "other.cls"
    other.write_text(CL.replace("500.0", "501.0"), encoding="utf-8")
    (folder / "job.lpt").unlink()
    assert main(["verify", str(manifest), "--cl", str(other)]) == 1
    out = capsys.readouterr().out
    assert "job.mpf: differs (program)" in out
    assert "job.lpt: is missing (listing)" in out
    assert "other.cls: is not what the program was made from (cl)" in out
    assert "job.html: the same (sheet)" in out


def test_a_forced_program_is_told_on_every_paper(tmp_path: Path) -> None:
    cl = HEAD.replace("GOTO/10.0,", "GOTO/9000.0,") + FOOT
    (tmp_path / "part.cls").write_text(cl, encoding="utf-8")
    with pytest.raises(trunnion.RefusedError):
        post(tmp_path)
    assert {path.name for path in tmp_path.iterdir()} <= {"part.cls", "report.html"}
    result = post(tmp_path, force=True)
    assert not result.passed
    sheet = (tmp_path / "job.html").read_text(encoding="utf-8")
    assert "MUST NOT RUN AS IT IS" in sheet
    assert "OVERRULED" in sheet
    data = json.loads((tmp_path / "job.json").read_text(encoding="utf-8"))
    assert data["may_run"] is False
    assert data["overruled"]
    found = trunnion.verify_manifest(tmp_path / "job.json")
    assert not found.passed
    assert not any(file.fault for file in found.files)


@pytest.mark.third
@pytest.mark.parametrize(
    "change",
    [
        {"files": [{"name": "../secret", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "/etc/passwd", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "a\\b", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "C:x", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "..", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "a\0", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": 3, "what": "program"}]},
        {"files": ["job.mpf"]},
        {"files": [{"name": "a" * 5000, "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": [{"name": "\ud800", "what": "program", "bytes": 1, "sha256": ""}]},
        {"files": []},
        {"files": {}},
        {"schema": 2},
    ],
)
def test_a_manifest_leads_to_no_other_file(change: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "job.json"
    path.write_text(json.dumps({"schema": 1, "made_by": "x", "files": [], "may_run": True, **change}), encoding="utf-8")
    with pytest.raises(InputError, match="is no manifest of a post"):
        trunnion.verify_manifest(path)


def _without(what: str) -> Callable[[dict[str, Any]], object]:
    return lambda data: data.update(files=[each for each in data["files"] if each["what"] != what])


@pytest.mark.third
@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (_without("program"), "its program is not the one among its files"),
        (lambda data: data.update(program="other.mpf"), "its program is not the one among its files"),
        (lambda data: data["files"].append(data["files"][-1]), "twice"),
        (lambda data: data["files"].append(data["files"][0] | {"what": "listing"}), "job.mpf twice"),
        (lambda data: data.update(checks=[]), "its checks do not"),
        (lambda data: data.pop("checks"), "its checks do not"),
        (lambda data: data["checks"][0].update(passed=False), "its checks do not"),
        (lambda data: data["overruled"].append("an axis leaves its travel"), "its checks do not"),
        (lambda data: data["files"][0].update(what="program\nall the same"), "is nothing that a post writes"),
        (lambda data: data["inputs"].update(cl=[]), "it names no CL file"),
    ],
)
def test_a_manifest_from_which_something_was_taken_is_told(
    folder: Path, tmp_path: Path, edit: Callable[[dict[str, Any]], object], words: str
) -> None:
    data = json.loads((folder / "job.json").read_text(encoding="utf-8"))
    path = tmp_path / "job.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    trunnion.verify_manifest(path)
    edit(data)
    path.write_text(json.dumps(data), encoding="utf-8")
    with pytest.raises(InputError, match=words):
        trunnion.verify_manifest(path)


def test_cl_files_that_are_not_compared_are_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cl = [tmp_path / "part.cls", tmp_path / "second.cls"]
    cl[0].write_text(CL, encoding="utf-8")
    cl[1].write_text(CL.replace("500.0", "501.0"), encoding="utf-8")
    manifest = tmp_path / "job.json"
    trunnion.post(cl, machine="yl569", output=tmp_path / "job.mpf", manifest=manifest)
    assert trunnion.verify_manifest(manifest).not_compared == ("part.cls", "second.cls")
    assert trunnion.verify_manifest(manifest, cl=cl).not_compared == ()
    assert main(["verify", str(manifest), "--cl", str(cl[0])]) == 0
    assert "second.cls: not compared" in capsys.readouterr().err


@pytest.mark.parametrize("data", [b"", b"\xff\xfe", b"[]", b"{}", b"[" * 100_000, b'{"files": 1'])
def test_what_is_no_manifest_is_told(data: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "job.json"
    path.write_bytes(data)
    assert main(["verify", str(path)]) == 2
    assert "is no manifest of a post" in capsys.readouterr().err


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
def test_nobody_waits_for_a_pipe(folder: Path, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "job.json")
    with pytest.raises(InputError, match="is not a regular file"):
        trunnion.verify_manifest(tmp_path / "job.json")
    (folder / "job.mpf").unlink()  # a test before has edited it
    post(folder)
    with pytest.raises(InputError, match="is not a regular file"):
        trunnion.verify_manifest(folder / "job.json", cl=[tmp_path / "job.json"])
    (folder / "job.lpt").unlink()
    os.mkfifo(folder / "job.lpt")
    found = trunnion.verify_manifest(folder / "job.json")
    assert [file.fault for file in found.files if file.what == "listing"] == ["is missing"]
    (folder / "job.lpt").unlink()


def test_papers_that_cannot_be(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for given, message in (
        ({"sheet": folder / "a.pdf"}, "a setup sheet is a page or data"),
        ({"manifest": folder / "a.txt"}, "a manifest is data"),
        ({"manifest": tmp_path / "a.json"}, "lists the files beside it"),
        ({"sheet": folder / "same.html", "report": folder / "same.html"}, "would be written twice"),
        ({"listing": folder / "part.cls"}, "would be written over"),
    ):
        with pytest.raises(InputError, match=message):
            post(folder, **given)
    with pytest.raises(InputError, match="lists the files beside it"):
        trunnion.post(folder / "part.cls", machine="yl569", manifest=tmp_path / "a.json")
    assert main(["verify", str(folder / "job.mpf")]) == 2
    assert "name the machine" in capsys.readouterr().err
    assert main(["verify", str(folder / "job.json"), "--zero", "0,0,0"]) == 2
    assert "says nothing about a manifest" in capsys.readouterr().err


def test_the_sheet_has_title_library_coolant_and_what_compensation_means(tmp_path: Path) -> None:
    first = HEAD.replace("SPINDL", "COOLNT/THRU\nSPINDL") + "GOTO/20.0,-3.5,5.0\n" + FOOT
    second = HEAD.replace("OP1", "OP2").replace("SPINDL", "CUTCOM/LEFT,1\nSPINDL")
    (tmp_path / "part.cls").write_text(first.replace("END-OF-PATH", "CUTCOM/OFF\nEND-OF-PATH") + second + FOOT)
    sheet, page = tmp_path / "sheet.json", tmp_path / "sheet.html"
    for paper in (sheet, page):
        trunnion.post(
            tmp_path / "part.cls", machine="yl569", output=tmp_path / "job.mpf", sheet=paper, force=True,
            settings={"title": "Our <hub>"},
            simulation={"stock": "box:60,60,20,-30,-30,-20", "cell": 4.0,
                        "tools": ["1=flat:10,length=60,flutes=20,shank=10,holder=40x50"]},
        )  # fmt: skip
    data = json.loads(sheet.read_text("utf-8"))
    assert data["title"] == "Our <hub>"
    (tool,) = data["tools"]
    assert (tool["holder"], tool["stick_out"]) == ("Ø40 × 50 mm", 60.0)
    coolants = [each["coolant"] for each in data["operations"]]
    assert coolants[0].startswith("through the tool (THRU, M26)")
    (note,) = [note for each in data["operations"] for note in each["notes"] if "radius compensation" in note]
    assert note.startswith("radius compensation: the path is that of the tool's centre, so enter the radius minus 5 mm")
    assert "Our &lt;hub&gt;" in page.read_text("utf-8")


def test_a_sheet_has_the_way_of_a_rotary_axis_and_no_kind_that_is_not_known(tmp_path: Path) -> None:
    """The finishing turns C from 319.355 through 0 to 11.045; a tap and a reamer are drills in the CL file."""

    def sheet(cl: Path) -> str:
        output = tmp_path / f"{cl.stem}.mpf"
        settings = {"zero": "-30,0,-80", "tool_length": "120"}
        trunnion.post(cl, machine="yl569", settings=settings, output=output, sheet=tmp_path / "x.html")
        return (tmp_path / "x.html").read_text("utf-8")

    assert "C 319.355 … 11.045° through 0°" in sheet(TESTS / "golden/yl569/3_blade_finish.cls")
    holes = sheet(TESTS / "data/cases/holes.cls")
    assert "<bdi>DR5</bdi><br><small>drill, tip 118°</small>" in holes
    assert "<bdi>TAP6</bdi></td>" in holes
    assert "<bdi>REAM8</bdi></td>" in holes


def test_a_sheet_has_the_lengths_and_numbers_of_its_tools_and_the_zeros_that_are_known(tmp_path: Path) -> None:
    cl, sheet = tmp_path / "part.cls", tmp_path / "a.json"
    second = HEAD.replace("OP1", "OP2").replace("TOOL,1,ADJUST,1", "TOOL,2")
    cl.write_text(HEAD + FOOT + second + FOOT, encoding="utf-8")
    settings = {"zero": "G54=-200,-200,100", "work_offset": "OP2:G55", "tool_length": "1=110,2=85"}
    trunnion.post(cl, machine="matsuura_mx330", output=tmp_path / "a.nc", settings=settings, sheet=sheet)
    data = json.loads(sheet.read_text(encoding="utf-8"))
    assert [(tool["set_length"], tool["register"]) for tool in data["tools"]] == [(110.0, 1), (85.0, 2)]
    assert data["zeros"] == [{"name": "G54", "zero_mm": [-200.0, -200.0, 100.0]}, {"name": "G55", "zero_mm": None}]
    assert [(each["tool"], each["length_mm"]) for each in data["tool_lengths"]] == [("1", 110.0), ("2", 85.0)]
    trunnion.post(cl, machine="matsuura_mx330", output=tmp_path / "a.nc", settings=settings, sheet=tmp_path / "a.html")
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "<bdi>G54 X−200.000 Y−200.000 Z100.000; G55 not stated</bdi>" in page
    assert "<bdi>1: 110; 2: 85</bdi>" in page
    assert any("proven for it, and not for G55" in task for task in data["to_check"])
    assert any(task.startswith("Check that work offsets G54 and G55 are set to") for task in data["to_check"])
