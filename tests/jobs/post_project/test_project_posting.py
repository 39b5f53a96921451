"""Projects are posted as a whole: every program proven and judged, all of them there, or none."""

import shutil
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.projects import OUT_OF_REACH, PROJECT, SETUPS, TWO, contents, operation, project
from trunnion.cli import main

Capture = pytest.CaptureFixture[str]


def texts(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in sorted(folder.glob("*.mpf"))}


def problems(path: Path, kind: type[trunnion.TrunnionError] = trunnion.InputError) -> list[str]:
    with pytest.raises(kind) as raised:
        trunnion.post_project(path)
    return [str(problem) for problem in raised.value.problems]


def test_a_project_posts_what_the_arguments_would(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, SETUPS)
    assert main(["post", str(path), "--set", "title=PART"]) == 0
    out, err = capsys.readouterr()
    assert out == ""
    assert f"{tmp_path / 'bottom.mpf'}: 2 points, 1 operation" in err
    assert err.index("set-up top") < err.index("set-up bottom")
    posted = texts(tmp_path)
    for name, offset in (("top", "G54"), ("bottom", "G55")):
        settings = {"title": "PART", "work_offset": offset}
        alone = trunnion.post(tmp_path / f"{name}.cls", machine="yl569", settings=settings)
        assert posted[f"{name}.mpf"] == alone.text


def test_the_library_gives_programs_and_their_proofs(tmp_path: Path) -> None:
    found = trunnion.post_project(project(tmp_path, PROJECT + 'report = "top.html"\nchecks = { longest_s = 3600 }\n'))
    assert found.files == (tmp_path / "top.mpf",)
    assert [each.passed for each in found.results] == [True]
    assert found.results[0].text == (tmp_path / "top.mpf").read_text()
    assert (found.simulation, found.problems) == (None, ())
    assert "<html" in (tmp_path / "top.html").read_text()


def test_one_program_that_must_not_run_leaves_all_as_they_were(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path, SETUPS)
    trunnion.post_project(path)
    path = project(tmp_path, SETUPS, top=OUT_OF_REACH, bottom=TWO)
    before = contents(tmp_path)
    assert main(["post", str(path)]) == 1
    assert contents(tmp_path) == before
    err = capsys.readouterr().err
    assert f"{tmp_path / 'bottom.mpf'}: warning: from before this change: do not run" in err
    assert "(set-up top)" in err
    assert "(set-up bottom)" not in err
    assert "bottom" in err, "the next set-up is judged as well"
    assert "force" not in err
    project(tmp_path, SETUPS, top=OUT_OF_REACH, bottom="nonsense\n")
    assert main(["post", str(path)]) == 2
    err = capsys.readouterr().err
    assert "top.cls:" in err
    assert "bottom.cls" in err


def test_a_project_of_subprograms_and_one_of_a_program_each(tmp_path: Path) -> None:
    found = trunnion.post_project(project(tmp_path / "sub", PROJECT + 'divide = "subprograms"\n'))
    assert [file.name for file in found.files] == ["top.mpf", "FACE.spf", "SLOT_2.spf"]
    path = project(tmp_path / "own", PROJECT + 'divide = "operations"\n')
    found = trunnion.post_project(path)
    assert [file.name for file in found.files] == ["top_1_FACE.mpf", "top_2_SLOT_2.mpf"]
    second = (tmp_path / "own" / "top_2_SLOT_2.mpf").read_text()
    assert "T=1" in second, "the tool that the operation before has loaded"
    assert "S4000" in second
    assert all(each.passed and each.toolpaths[0].operations for each in found.results)
    # Posted again they are replaced; one that was edited since is not.
    path.with_name("top_1_FACE.mpf").write_text("EDITED")
    assert "was edited since it was written, and would be replaced" in problems(path)[0]
    assert path.with_name("top_1_FACE.mpf").read_text() == "EDITED"
    path.with_name("top_1_FACE.mpf").unlink()
    path.with_name("top.cls").write_text(operation("FACE"))
    warned = trunnion.post_project(path).problems
    assert ["top_2_SLOT_2.mpf" in each.file and "no longer have" in each.what for each in warned] == [True]


@pytest.mark.parametrize(
    ("cl", "words"),
    [
        (operation("A", end="CUTCOM/LEFT\n") + operation("B"), "A leaves on what line"),
        (operation("A") + operation("B", origin="0.0,0.0,10.0"), "B is in another coordinate system than A"),
        (
            operation("A") + operation("B").replace("MILL,10.0", "MILL,6.0"),
            "operations A and B both call tool 1, and their CL data differ",
        ),
    ],
    ids=["compensation", "zero", "tool"],
)
def test_an_operation_that_does_not_stand_alone_gets_no_program_of_its_own(
    tmp_path: Path, cl: str, words: str
) -> None:  # fmt: skip
    path = project(tmp_path, PROJECT + 'divide = "operations"\n', top=cl)
    assert words in problems(path, trunnion.RefusedError)[0]
    assert texts(tmp_path) == {}


def test_programs_of_operations_take_the_settings_of_their_operation(tmp_path: Path) -> None:
    text = PROJECT.replace("{ ", '{ method = "ROUGHING,SLOT 2:FINISHING", mode = "SLOT 2:tcp", frame = "absolute", ')
    cl = operation("FACE") + operation("SLOT 2", origin="0.0,0.0,10.0")
    path = project(tmp_path, text + 'divide = "operations"\n', top=cl)
    trunnion.post_project(path)
    first, second = texts(tmp_path).values()
    assert 'MSG("ROUGHING")' in first
    assert 'MSG("FINISHING")' in second
    assert "TRAORI" not in first
    assert "TRAORI" in second
    assert "Z60." in second, "counted from the absolute zero"
    path.write_text(path.read_text().replace("SLOT 2:tcp", "SLOT:tcp"))
    assert "settings.mode is set for operation SLOT, and the program has none of that name" in problems(path)[0]


def test_numbered_programs_of_operations_count_on(tmp_path: Path) -> None:
    text = PROJECT.replace("yl569", "matsuura_mx330").replace('title = "TOP"', 'program = "0010"')
    trunnion.post_project(project(tmp_path, text.replace("top.mpf", "top.nc") + 'divide = "operations"\n'))
    heads = [path.read_text().splitlines()[1] for path in sorted(tmp_path.glob("*.nc"))]
    assert [head[:5] for head in heads] == ["O0010", "O0011"]


def test_settings_are_told_where_the_project_states_them(tmp_path: Path) -> None:
    path = project(tmp_path, PROJECT + "zero_mm = [0, 0, 1e6]\n")
    (found,) = problems(path)
    assert found.startswith(f"{path}:5: error: zero_mm is '0.0,0.0,1000000.0'")
    path.write_text(PROJECT.replace("title", "titel"))
    assert problems(path)[0].startswith(f"{path}:4: error: settings.titel is not a setting")
    path.write_text(PROJECT.replace("title = ", "split = 20480, title = "))
    (found,) = problems(path)
    assert found.endswith(
        'settings.split divides subprograms, and there are none; write divide = "subprograms" too [ARG240]'
    )
    path.write_text(PROJECT.replace("yl569", "hs664rt").replace("top.mpf", "top.nc") + 'divide = "subprograms"\n')
    (found,) = problems(path)
    assert found.startswith(f'{path}:5: error: divide is "subprograms", and Fidia')
    with pytest.raises(trunnion.InputError, match=r"^settings: error: pole is 'no'"):
        trunnion.post_project(project(tmp_path), settings={"pole": "no"})


@pytest.mark.parametrize("value", ["[]", "[1, 2]", "nan", "inf", "07:32:00", "{ a = 1 }"])
def test_a_setting_is_a_text_or_a_number(tmp_path: Path, value: str) -> None:
    (found,) = problems(project(tmp_path, PROJECT.replace('"TOP"', value)))
    assert found.startswith(f"{tmp_path / 'part.toml'}:4: error: ")
    assert "write a text or a number" in found


def test_characters_that_nobody_sees_are_told_with_a_cure_that_helps(tmp_path: Path) -> None:
    path = project(tmp_path, PROJECT.replace('"TOP"', '"TO\\u202eP"'))
    (warned,) = [each for each in trunnion.post_project(path).results[0].problems if "nobody sees" in each.what]
    assert warned.cure == "rename it without them"
    assert ";TOP" in path.with_name("top.mpf").read_text()


def test_two_set_ups_do_not_write_one_file_nor_over_one_that_is_read(tmp_path: Path) -> None:
    path = project(tmp_path, SETUPS.replace("bottom.mpf", "top.mpf"))
    assert "would be written twice" in problems(path)[0]
    for name in ("part.toml", "bottom.cls"):
        path = project(tmp_path, SETUPS.replace("bottom.mpf", name))
        before = contents(tmp_path)
        assert "although it is read" in problems(path)[0]
        assert contents(tmp_path) == before


def test_a_project_is_not_written_over_what_it_extends(tmp_path: Path) -> None:
    (tmp_path / "base.toml").write_text('extends = "yl569"\nname = "overruled"\n')
    (tmp_path / "own.toml").write_text('extends = "./base.toml"\nname = "own"\n')
    (tmp_path / "shared.toml").write_text('output = "overruled.mpf"\n')
    for name in ("base.toml", "shared.toml"):
        text = 'extends = "./shared.toml"\n' + PROJECT.replace("yl569", "own.toml").replace("top.mpf", name)
        path = project(tmp_path, text)
        before = contents(tmp_path)
        assert "although it is read" in problems(path)[0]
        assert contents(tmp_path) == before
    text = PROJECT.replace('["top.cls"]', '["top.cls", ""]')
    assert f'{tmp_path / "part.toml"}:2: error: cl names ""' in problems(project(tmp_path, text))[0]


@pytest.mark.third
@pytest.mark.parametrize(
    ("name", "words"),
    [
        (".bashrc", '".bashrc" begins with a point'),
        ("sub/.hooks/x", "in a folder that is not there"),
        (".git/pre-commit", '".git" begins with a point'),
        ("link.mpf", '".profile" begins with a point'),
        ("links/x.mpf", '".git" begins with a point'),
        ("nul", "is a device of Windows"),
        ("COM1.mpf", "is a device of Windows"),
        ("CONIN$", "is a device of Windows"),
        ("x.mpf.", "ends in one or in a point"),
        ("x.mpf ", "ends in one or in a point"),
        ("x?.mpf", "is no part of a name"),
        ("x\u202empf", "nobody sees"),
        ("x\u200b.mpf", "nobody sees"),
        ("x\ufe0f.mpf", "nobody sees"),
        ("ä" * 90 + ".mpf", "is too long"),
        ("TOP.CLS", "although it is read"),
    ],
)
def test_a_project_names_what_it_writes_so_that_every_system_takes_it(tmp_path: Path, name: str, words: str) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / "link.mpf").symlink_to(".profile")
    (tmp_path / "links").symlink_to(".git")
    for text in (PROJECT.replace("top.mpf", name), PROJECT + f'listing = "{name}"\n'):
        path = project(tmp_path, text)
        before = contents(tmp_path)
        (found,) = problems(path)
        assert words in found
        assert "part.toml:" in found or name == "TOP.CLS"
        assert contents(tmp_path) == before


def test_a_project_replaces_only_what_posts_have_written(tmp_path: Path) -> None:
    """The author of a project names files of the user."""
    (tmp_path / "doc").mkdir()
    papers = 'report = "doc/top.json"\nlisting = "top.txt"\n'
    path = project(tmp_path, PROJECT + papers)
    written = [tmp_path / name for name in ("top.mpf", "doc/top.json", "top.txt")]
    (tmp_path / "top.mpf").touch()  # an empty file is nobody's work
    trunnion.post_project(path)
    trunnion.post_project(path)
    path.with_name("top.cls").write_text(OUT_OF_REACH)
    for _ in range(2):  # the report of a refusal is ours as well
        problems(path, trunnion.RefusedError)
    path.with_name("top.cls").write_text(TWO)
    trunnion.post_project(path)
    for file in written[1:]:
        before = file.read_bytes()
        file.write_text("MINE")
        (found,) = problems(path)
        assert found.startswith(f"{path}:")
        assert f": {file} would be replaced, although no post has written it as it is" in found
        assert file.read_text() == "MINE"
        file.write_bytes(before)
    written[0].write_text("EDITED")
    assert "was edited since it was written, and would be replaced" in problems(path)[0]
    assert written[0].read_text() == "EDITED"
    clone = tmp_path / "clone"  # whose a program is nobody knows
    clone.mkdir()
    for file in (path, tmp_path / "top.cls", written[0]):
        shutil.copy(file, clone)
    (clone / path.name).write_text(PROJECT)
    assert "although no post or conversion has written it as it is" in problems(clone / path.name)[0]
    posted = trunnion.post_project(clone / path.name, settings={"edited": "replace"})
    assert "EDITED" not in posted.files[0].read_text()
    path.write_text((PROJECT + papers).replace("top.mpf", "notes.txt"))
    (tmp_path / "notes.txt").write_text("MINE")
    assert "notes.txt would be replaced" in problems(path)[0]


def test_links_in_a_project_lead_nowhere_else(tmp_path: Path) -> None:
    folder = tmp_path / "part"
    path = project(folder, PROJECT + 'divide = "subprograms"\n')
    (folder / "FACE.spf").symlink_to(tmp_path / "outside.spf")
    assert "FACE.spf: error: leads out of the folder of the project" in problems(path)[0]
    assert [path.name for path in tmp_path.iterdir()] == ["part"]
    assert texts(folder) == {}


HOOK = """from trunnion.hooks import Message

def on_operation(operation, context):
    from dataclasses import replace
    return replace(operation, events=(Message(0, 0, "HOOKED"), *operation.events))
"""


def test_a_project_runs_the_hooks_that_it_names_and_says_so(tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / "hook.py").write_text(HOOK)
    assert main(["post", str(project(tmp_path, PROJECT))]) == 0
    assert "hook.py" not in capsys.readouterr().err
    assert "HOOKED" not in texts(tmp_path)["top.mpf"]
    path = project(tmp_path, PROJECT + 'hooks = ["hook.py"]\n')
    assert main(["post", str(path)]) == 0
    assert "hook.py: warning: runs as Python, because part.toml names it" in capsys.readouterr().err
    assert "HOOKED" in texts(tmp_path)["top.mpf"]


def test_a_hook_that_fails_is_told_with_its_line_and_nothing_is_written(tmp_path: Path) -> None:
    path = project(tmp_path, PROJECT + 'hooks = ["hook.py"]\n')
    (tmp_path / "hook.py").write_text("def on_operation(operation, context):\n    return 1 / 0\n")
    assert "hook.py:2: error: " in problems(path)[0]
    assert texts(tmp_path) == {}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--force"], "post its CL files alone"),
        (["--machine", "yl569"], "--machine does not go with a project; write it there, as machine"),
        (["--subprograms", "a.spf"], "--subprograms does not go with a project; write it there, as subprograms"),
        (["--simulate"], 'write it there, as [checks] simulate = "refuse"'),
        (["more.cls"], "stands beside other files"),
    ],
)
def test_what_a_project_states_is_not_said_beside_it(options: list[str], words: str, capsys: Capture) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["post", "part.toml", *options])
    assert ended.value.code == 2
    assert words in capsys.readouterr().err


# What is judged after the posts


def test_a_simulation_runs_through_all_set_ups_and_refuses(tmp_path: Path, capsys: Capture) -> None:
    cl = TWO.replace("GOTO/0.0,0.0,50.0", "GOTO/0.0,0.0,-5.0")  # at rapid into the stock
    path = project(tmp_path, 'checks = { simulate = "refuse" }\n' + SETUPS, bottom=cl)
    (first, *_, nothing) = problems(path, trunnion.RefusedError)
    assert first.startswith(f"{tmp_path / 'bottom.mpf'}:")
    assert "the simulation finds: rapid through stock: tool 1, stock: " in first
    assert "no program of the project is written" in nothing
    assert texts(tmp_path) == {}
    path.write_text('checks = { simulate = "warn" }\n' + SETUPS)
    found = trunnion.post_project(path)
    assert found.simulation is not None
    assert [each.setup for each in found.simulation.setups] == ["top", "bottom"]
    assert not found.simulation.passed
    assert {"the simulation finds" in each.what for each in found.problems} == {True}
    assert list(texts(tmp_path)) == ["bottom.mpf", "top.mpf"]
    main(["post", str(path)])
    assert capsys.readouterr().err.splitlines()[-1] == f"simulation: {found.simulation.told}"
    # The same project, simulated as it lies there.
    alone = trunnion.simulate(path)
    assert [each.removed for each in alone.setups] == [each.removed for each in found.simulation.setups]


def test_what_a_simulation_lacks_is_told_by_its_key(tmp_path: Path) -> None:
    by_hand = SETUPS.replace('cl = ["bottom.cls"]\noutput = "bottom.mpf"', 'programs = ["hand.mpf"]')
    path = project(tmp_path, 'checks = { simulate = "warn" }\n' + by_hand)
    alone = trunnion.post(tmp_path / "top.cls", machine="yl569")
    assert alone.text is not None
    (tmp_path / "hand.mpf").write_text(alone.text)
    (found,) = problems(path)
    assert found.startswith(f"{path}: error: tools: nothing says the form of tool 1")


def test_a_program_is_compared_with_the_released_one(tmp_path: Path, capsys: Capture) -> None:
    path = project(tmp_path)
    trunnion.post_project(path)
    (tmp_path / "top.mpf").rename(tmp_path / "released.mpf")
    path.write_text(PROJECT.replace("TOP", "OTHER TITLE") + 'released = ["released.mpf"]\n')
    assert trunnion.post_project(path).problems == ()
    slower = (tmp_path / "released.mpf").read_text().replace("F500.", "F400.")
    (tmp_path / "released.mpf").write_text(slower)
    (warning,) = trunnion.post_project(path).problems
    assert "does not move as released.mpf does: different: 1 place" in warning.what
    before = contents(tmp_path)
    path.write_text(path.read_text() + 'checks = { released = "refuse" }\n')
    assert main(["post", str(path)]) == 1
    assert "feed 400 against 500 mm/min" in capsys.readouterr().err
    assert {**contents(tmp_path), "part.toml": b""} == {**before, "part.toml": b""}


def test_a_program_that_takes_too_long_is_refused(tmp_path: Path) -> None:
    path = project(tmp_path, PROJECT + "checks = { longest_s = 2 }\n")
    (first, _) = problems(path, trunnion.RefusedError)
    assert "takes " in first
    assert "and may take 2.0 s" in first


def test_a_set_up_may_have_programs_that_exist(tmp_path: Path) -> None:
    path = project(tmp_path, SETUPS)
    trunnion.post_project(path)
    (tmp_path / "bottom.mpf").rename(tmp_path / "by_hand.mpf")
    by_hand = SETUPS.replace(
        'cl = ["bottom.cls"]\noutput = "bottom.mpf"', 'cl = ["bottom.cls"]\nprograms = ["by_hand.mpf"]'
    )
    found = trunnion.post_project(project(tmp_path, 'checks = { simulate = "refuse" }\n' + by_hand, top=operation("A")))
    assert [file.name for file in found.files] == ["top.mpf"]


def test_files_that_cannot_be_written_are_reported_where_the_project_names_them(tmp_path: Path) -> None:
    """``FILE.toml:LINE``, the key and the file, and a cure that destroys nothing."""
    (tmp_path / "top.cls").write_bytes((YL569 / "2_hub_rough.cls").read_bytes())
    path = tmp_path / "part.toml"

    def found(*lines: str) -> str:
        path.write_text("\n".join(['machine = "yl569"', 'cl = ["top.cls"]', *lines, ""]), encoding="utf-8")
        said = "\n".join(problems(path))
        assert "remove" not in said
        return said

    path.write_text('machine = "yl569"\ncl = ["top.cls"]\noutput = "top.mpf"\n', encoding="utf-8")
    trunnion.post_project(path)
    program = tmp_path / "top.mpf"
    program.write_bytes(program.read_bytes() + b"; mine\n")
    (tmp_path / "other.json").write_text("{}", encoding="utf-8")
    assert f"{path}:3: error: output: {program} was edited since" in found('output = "top.mpf"')
    said = found('output = "top.mpf"', 'manifest = "other.json"')
    assert f"{path}:4: error: manifest: {tmp_path / 'other.json'} would be replaced" in said
    said = found('output = "top.cls"')
    assert f"{path}:3: error: output: {tmp_path / 'top.cls'} would be written over" in said
    twice = [line for name in "ab" for line in ("[[setup]]", f'name = "{name}"', 'output = "one.mpf"')]
    assert f"{path}:8: error: setup[1].output: {tmp_path / 'one.mpf'} would be written twice" in found(*twice)


CONTOUR = (
    "TOOL PATH/ONE,TOOL,D10\nTLDATA/MILL,10,0,75,0,0\nINTOL/0.01\nOUTTOL/0.01\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\n"
    "RAPID\nGOTO/0,0,30,0,0,1\nRAPID\nGOTO/0,0,-2\nCUTCOM/LEFT\nFEDRAT/MMPM,500\nGOTO/0,20,-2\nGOTO/30,20,-2\n"
    "CUTCOM/OFF\nGOTO/40,20,-2\nRAPID\nGOTO/40,20,30\nEND-OF-PATH\n"
)


def test_what_the_registers_hold_is_the_same_for_posts_and_simulation_of_a_project(tmp_path: Path) -> None:
    text = PROJECT + 'stock = "box:60,40,10,-10,-10,-10"\nchecks = { simulate = "warn" }\n'
    stated = text.replace('title = "TOP"', 'radius_register = "difference"')
    for own, settings in ((text, None), (stated, None), (text, {"radius_register": "difference"})):
        path = project(tmp_path, own, top=CONTOUR)
        found = trunnion.post_project(path, settings=settings)
        assert found.simulation is not None
        unstated = own is text and settings is None
        assert bool(found.simulation.cuts_not_checked) == unstated
    path = project(tmp_path, stated, top=CONTOUR)
    assert not trunnion.simulate(path).cuts_not_checked
