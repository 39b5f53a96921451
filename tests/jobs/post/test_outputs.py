"""Where results and reports go: never over a file that is read, and settled before any work."""

import io
import json
import os
import shutil
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.machines import machine_without_tcp
from trunnion.cli import main

CL = YL569 / "3_blade_finish.cls"
NC = YL569 / "3_blade_finish.expected.mpf"
READ = "would be written over, although"


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a CL file, a program and a definition; each has a link and a hard link."""
    monkeypatch.chdir(tmp_path)
    shutil.copy(CL, "part.cls")
    shutil.copy(NC, "part.mpf")
    shutil.copy(NC, "part.json")
    Path("mine.toml").write_text('extends = "yl569"\n', encoding="utf-8")
    for name in ("part.cls", "part.mpf", "part.json", "mine.toml"):
        Path(f"link-{name}").symlink_to(name)
        os.link(name, f"hard-{name}")
    Path("sub").mkdir()
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def spellings(name: str) -> list[str]:
    return [name, f"./{name}", f"sub/../{name}", f"link-{name}", f"hard-{name}", os.path.realpath(name)]


def test_no_result_is_written_over_what_it_is_made_from(folder: Path) -> None:
    before = contents(folder)
    for output in [*spellings("part.cls"), *spellings("mine.toml")]:
        forms: list[Any] = ["part.cls", ["part.cls"], iter([trunnion.read_cl("part.cls")])]
        for cl in forms:
            with pytest.raises(trunnion.InputError, match=READ):
                trunnion.post(cl, machine="mine.toml", output=output)
        assert main(["post", "part.cls", "--machine", "mine.toml", "--output", output]) == 2
        assert contents(folder) == before
    for output in [*spellings("part.mpf"), *spellings("mine.toml"), "part.json"]:
        subprograms = ["part.json"] if output == "part.json" else []
        for target in ({"to_cl": True}, {"to_machine": "mine.toml"}):
            arguments: dict[str, Any] = {"machine": "mine.toml", "subprograms": subprograms, **target}
            with pytest.raises(trunnion.InputError, match=READ):
                trunnion.convert("part.mpf", output=output, **arguments)
        assert contents(folder) == before


def test_nothing_is_written_over_what_a_definition_leads_to(folder: Path) -> None:
    """Definitions that give no value, controls, libraries and meshes of bodies count as much as what is named."""
    Path("base.toml").write_text('extends = "yl569"\nname = "overruled"\n', encoding="utf-8")
    Path("control.toml").write_text('extends = "sinumerik_840d"\n', encoding="utf-8")
    Path("iron.stl").write_bytes(b"solid")
    body = '[[body]]\nname = "door"\nlink = "bed"\nshape = "file"\nfile = "iron.stl"\n'
    text = f'extends = "./base.toml"\nname = "mine"\n[control]\nextends = "./control.toml"\n{body}'
    Path("mine.toml").write_text(text, encoding="utf-8")
    Path("tools.toml").write_text('extends = "./shared.toml"\n', encoding="utf-8")
    Path("shared.toml").write_text('[[tool]]\nnumber = 1\nkind = "ball"\ndiameter_mm = 10\n', encoding="utf-8")
    before = contents(folder)
    simulated = ["--stock", "box:9,9,9", "--tool-library", "tools.toml"]
    for name in ("base.toml", "control.toml", "iron.stl"):
        with pytest.raises(trunnion.InputError, match=READ):
            trunnion.post("part.cls", machine="mine.toml", output=name)
        with pytest.raises(trunnion.InputError, match=READ):
            trunnion.post("part.cls", machine="mine.toml", output="new.mpf", listing=name)
        with pytest.raises(trunnion.InputError, match=READ):
            trunnion.convert("part.mpf", machine="mine.toml", to_machine="yl569", output=name)
        assert main(["simulate", "part.mpf", "--machine", "mine.toml", *simulated, "--json", name]) == 2
    assert main(["simulate", "part.mpf", "--machine", "mine.toml", *simulated, "--json", "shared.toml"]) == 2
    posted = ["post", "part.cls", "--machine", "mine.toml", "--simulate", *simulated]
    assert main([*posted, "--output", "shared.toml"]) == 2
    assert contents(folder) == before
    for name in ("link.html", "link.xml"):
        Path(name).symlink_to("base.toml")
    assert main(["view", "part.mpf", "--machine", "mine.toml", "--output", "link.html"]) == 2
    assert main(["verify", "part.mpf", "--machine", "mine.toml", "--report", "link.html"]) == 2
    assert main(["twin", "part.mpf", "--machine", "mine.toml", "--device-xml", "link.xml"]) == 2
    for name in ("link.html", "link.xml"):
        Path(name).unlink()
    assert contents(folder) == before


def test_no_report_is_written_over_what_it_is_about(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    before = contents(folder)
    verified = trunnion.verify("part.json", machine="mine.toml", cl="part.cls")
    for report in spellings("part.json"):
        assert main(["verify", "part.json", "--machine", "mine.toml", "--report", report]) == 2
        assert main(["verify", "part.mpf", "--machine", "mine.toml", "--cl", "part.json", "--report", report]) == 2
        line = ["verify", "part.mpf", "--machine", "mine.toml", "--subprograms", "part.json"]
        assert main([*line, "--report", report]) == 2
        assert capfd.readouterr().err.count(READ) == 3
        with pytest.raises(trunnion.InputError, match=READ):
            trunnion.write_report(verified, report)
        with pytest.raises(trunnion.InputError, match=READ):
            trunnion.post("part.json", machine="mine.toml", report=report)
    for output, report in (("new.json", "new.json"), ("new.json", "sub/../new.json")):
        with pytest.raises(trunnion.InputError, match="would be written twice"):
            trunnion.post("part.cls", machine="mine.toml", output=output, report=report)
        command = ["post", "part.cls", "--machine", "mine.toml", "--output", output, "--report", report]
        assert main(command) == 2
    assert contents(folder) == before


def test_no_report_is_written_over_its_program_afterwards(folder: Path) -> None:
    result = trunnion.post("part.cls", machine="mine.toml", output="new.json")
    before = contents(folder)
    for report in ("new.json", "part.cls.json"):
        if report == "part.cls.json":
            os.link("part.cls", report)
            before = contents(folder)
        with pytest.raises(trunnion.InputError, match=READ):
            result.write_report(report)
    assert contents(folder) == before


def test_no_subprogram_is_written_over_a_cl_file_or_a_report(folder: Path) -> None:
    settings = {"programs": "operations"}
    shutil.copy("part.cls", "BLADE_FINISH.spf")
    before = contents(folder)
    with pytest.raises(trunnion.InputError, match=READ):
        trunnion.post("BLADE_FINISH.spf", machine="mine.toml", output="main.mpf", settings=settings)
    assert contents(folder) == before


def test_subprograms_of_another_program_stay(folder: Path) -> None:
    """Two jobs with operations of one name in one folder: each would run the operations of the other."""
    settings = {"programs": "operations"}
    trunnion.post("part.cls", machine="mine.toml", output="one.mpf", settings=settings)
    before = contents(folder)
    stays = r"BLADE_FINISH\.spf: error: would be replaced, although two\.mpf has"
    with pytest.raises(trunnion.InputError, match=stays) as not_its:
        trunnion.post("part.cls", machine="mine.toml", output="two.mpf", settings=settings)
    assert "choose a folder for this program alone, or move the file away" in str(not_its.value)
    assert contents(folder) == before
    trunnion.post("part.cls", machine="mine.toml", output="one.mpf", settings={**settings, "title": "AGAIN"})
    Path("BLADE_FINISH.spf").write_bytes(before["BLADE_FINISH.spf"] + b"; mended by hand\n")
    with pytest.raises(trunnion.InputError, match="was edited since it was written"):
        trunnion.post("part.cls", machine="mine.toml", output="one.mpf", settings=settings)


def test_numbered_subprograms_can_begin_with_another_number(folder: Path) -> None:
    settings = {"programs": "operations"}
    trunnion.post("part.cls", machine="matsuura_mx330", output="one.nc", settings=settings)
    with pytest.raises(
        trunnion.InputError, match=r"O1001\.nc: error: .* begin with another number by setting first_number=2001"
    ):
        trunnion.post("part.cls", machine="matsuura_mx330", output="two.nc", settings=settings)
    made = trunnion.post(
        "part.cls", machine="matsuura_mx330", output="two.nc", settings={**settings, "first_number": 2001}
    )
    assert [path.name for path in made.subprograms] == ["O2001.nc"]
    cases: list[dict[str, Any]] = [{"first_number": 2001}, *({**settings, "first_number": n} for n in (20.5, 0))]
    for wrong in cases:
        with pytest.raises(trunnion.InputError, match="first_number is"):
            trunnion.post("part.cls", machine="matsuura_mx330", settings=wrong)
    with pytest.raises(trunnion.InputError, match="names its subprograms"):
        trunnion.post("part.cls", machine="mine.toml", output="x.mpf", settings={**settings, "first_number": 2001})


def test_a_file_that_nobody_named_is_replaced_only_as_it_was_written(
    folder: Path, capfd: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A CL file of the CAM, a program of another post, and one that was edited since."""
    written = "exists, and is not as a command has written it"
    monkeypatch.chdir(folder / "sub")
    for name in ("part.cls", "tool.cls"):
        shutil.copy("../part.cls", name)
    assert main(["post", "part.cls", "--machine", "yl569"]) == 0
    assert main(["post", "part.cls", "--machine", "yl569"]) == 0
    before = contents(folder / "sub")
    convert = ["convert", "part.mpf", "--machine", "yl569", "--to-cl"]
    assert main(convert) == 2
    assert f"part.cls: error: {written}" in capfd.readouterr().err
    Path("tool.mpf").write_text("N10 M30\n")
    assert main(["post", "tool.cls", "--machine", "yl569"]) == 2
    assert f"tool.mpf: error: {written}" in (said := capfd.readouterr().err)
    assert "--output tool.mpf with --edited keep keeps it as NAME.edited-DATE, another name leaves it alone" in said
    Path("tool.mpf").unlink()
    assert contents(Path()) == before
    Path("cl").mkdir()
    assert main([*convert, "--output", "cl"]) == 0
    assert main([*convert, "--output", "cl"]) == 0
    with Path("part.mpf").open("ab") as program:
        program.write(b"; tried on the machine\n")
    for output in ([], ["--output", "part.mpf"]):
        assert main(["post", "part.cls", "--machine", "yl569", *output]) == 2
        assert "write --edited keep to keep it as NAME.edited-DATE" in capfd.readouterr().err
    assert main(["post", "part.cls", "--machine", "yl569", "--output", "part.mpf", "--edited", "replace"]) == 0


def test_a_folder_of_programs_writes_over_none_of_them(folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Two programs with an operation of the same name would call the same subprogram."""
    shutil.copy("part.cls", "other.cls")
    shutil.copy("part.cls", "other.mpf")
    command = ["post", "part.cls", "other.cls", "--machine", "mine.toml", "--output", "sub", "--set"]
    assert main([*command, "programs=operations"]) == 2
    assert "BLADE_FINISH.spf: error: would be written over, although" in capfd.readouterr().err
    assert sorted(contents(folder / "sub")) == ["BLADE_FINISH.spf", "part.mpf"]
    before = contents(folder)
    assert main(["post", "other.cls", "other.mpf", "--machine", "mine.toml", "--output", "."]) == 2
    assert contents(folder) == before


@pytest.mark.parametrize(
    "wrong",
    [b"p.mpf", 7, "p\0.mpf", "", "missing/", ".", io.StringIO()],
    ids=lambda wrong: type(wrong).__name__ + (repr(wrong) if isinstance(wrong, str) else ""),
)
def test_an_output_that_cannot_be_is_an_input_error_before_any_work(wrong: Any, folder: Path) -> None:
    calls: list[Callable[[], object]] = [
        lambda: trunnion.post("missing.cls", machine="yl569", output=wrong),
        lambda: trunnion.convert("missing.mpf", machine="yl569", to_cl=True, output=wrong),
        lambda: trunnion.post("missing.cls", machine="yl569", report=wrong),
    ]
    for call in calls:
        with pytest.raises(trunnion.InputError) as error:
            call()
        assert "missing.cls" not in str(error.value)
        assert "missing.mpf" not in str(error.value)
        assert error.value.problems[0].cure


@pytest.mark.parametrize("wrong", [b"r.json", 7, "r\0.json", "", "missing/r.json", ".", "r.txt"])
def test_a_report_that_cannot_be_is_an_input_error(wrong: Any, folder: Path) -> None:
    verification = trunnion.post("part.cls", machine="yl569").verification
    assert verification is not None
    before = contents(folder)
    with pytest.raises(trunnion.InputError) as error:
        trunnion.write_report(verification, wrong)
    assert error.value.problems[0].cure
    assert contents(folder) == before
    trunnion.write_report(verification, "r.json")
    assert (folder / "r.json").stat().st_size > 0


class Stopping(trunnion.Observer):
    """Stops when the program is proven."""

    def verified(self, verification: trunnion.Verification) -> None:
        raise KeyboardInterrupt


def test_a_stopped_post_leaves_program_and_report_as_they_were(folder: Path) -> None:
    Path("p.mpf").write_text("old")
    Path("r.json").write_text("old")
    before, threads = contents(folder), threading.active_count()
    with pytest.raises(KeyboardInterrupt):
        trunnion.post("part.cls", machine="yl569", output="p.mpf", report="r.json", observer=Stopping())
    assert contents(folder) == before
    assert [path for path in folder.iterdir() if path.name.startswith(".")] == []
    assert threading.active_count() == threads


def test_a_report_that_cannot_be_written_keeps_its_program_back(folder: Path) -> None:
    Path("p.mpf").write_text("old")
    with pytest.raises(trunnion.InputError, match="there is no folder"):
        trunnion.post("missing.cls", machine="yl569", output="p.mpf", report="nowhere/r.json")
    assert Path("p.mpf").read_text() == "old"


def test_a_program_that_fails_its_proof_leaves_its_report_alone(folder: Path) -> None:
    machine = machine_without_tcp(folder)
    with pytest.raises(trunnion.ProofFailedError):
        trunnion.post("part.cls", machine=machine, output="p.mpf", report="r.json")
    assert (Path("p.mpf").exists(), Path("r.json").exists()) == (False, True)
    trunnion.post("part.cls", machine=machine, output="p.mpf", report="forced.json", force=True)
    refused, forced = (json.loads(Path(name).read_text())["checks"] for name in ("r.json", "forced.json"))
    assert [(each["key"], each["state"]) for each in refused] == [(each["key"], each["state"]) for each in forced]


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")
def test_a_pipe_takes_the_program_and_is_no_file_of_the_result(folder: Path) -> None:
    os.mkfifo("pipe.mpf")
    taken: list[bytes] = []
    reader = threading.Thread(target=lambda: taken.append(Path("pipe.mpf").read_bytes()))
    reader.start()
    result = trunnion.post("part.cls", machine="yl569", output="pipe.mpf")
    reader.join()
    kept = trunnion.post("part.cls", machine="yl569").text
    assert (result.output, result.text, [data.decode() for data in taken]) == (None, None, [kept])
    assert Path("pipe.mpf").is_fifo()


def test_a_cl_file_that_is_named_twice_is_warned_of(tmp_path: Path) -> None:
    """By whatever name; two parts of one file, and a copy of it, are two."""
    part, link, copy = tmp_path / "part.cls", tmp_path / "link.cls", tmp_path / "copy.cls"
    part.write_bytes((YL569 / "2_hub_rough.cls").read_bytes())
    copy.write_bytes(part.read_bytes())
    link.symlink_to(part)
    given: list[list[Any]] = [[part, part], [part, link], [trunnion.read_cl(part), part]]
    for twice in given:
        found = trunnion.post(twice, machine="yl569")
        assert [problem.code for problem in found.problems if "named twice" in problem.what] == ["CL190"]
        assert found.passed
    assert not [each for each in trunnion.post([part, copy], machine="yl569").problems if each.code == "CL190"]
