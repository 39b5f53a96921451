"""No output of any command replaces a file that no output of its kind has written."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from tests.support.command_lines import code_of, ending_of, fill_folder, line_with
from tests.support.locations import TESTS, YL569
from trunnion.cli import main
from trunnion.jobs.job import Job
from trunnion.jobs.registry import JOBS
from trunnion.jobs.replaced_outputs import beginning, told, writers
from trunnion.options.kinds import FileOut
from trunnion.options.option import Option, outputs

#: A program, CL data, a definition and a tool library as people write them.
OTHERS = (
    "N10 G0 X0 ; edited\nN20 M30\n",
    "UNITS / MM\nFINI\n",
    'extends = "yl569"\n',
    '{"data": [{"type": "ball end mill"}]}',
    '{"schema": {"version": 2}, "tools": []}',
    "<html><body>our page</body></html>\n",
)


def own_outputs() -> list[tuple[Job, Option]]:
    """Outputs of all commands whose commands do not find out themselves what they may replace."""
    return [(job, option) for job in JOBS.values() for option in outputs(job.options) if not told(option)]


@pytest.mark.parametrize(("job", "option"), own_outputs(), ids=lambda each: each.name)
def test_an_output_replaces_no_file_of_others(
    job: Job, option: Option, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fill_folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert isinstance(option.kind, FileOut)
    for ending in option.kind.endings or (ending_of(option),):
        if option.name != "output" or ending != ".out":
            assert beginning(option, ending) is not None, "say how its files begin, or that its command tells them"
        target = Path(f"theirs{ending}")
        for other in OTHERS:
            target.write_text(other, encoding="utf-8")
            assert code_of(line_with(job, {option.name: str(target)})) == 2
            assert target.read_text(encoding="utf-8") == other
            assert "FIL250" in capsys.readouterr().err


def test_a_command_that_tells_itself_what_it_replaces_replaces_no_file_of_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Programs, CL data, recordings and summaries, and what a stopped --suggest would have written."""
    fill_folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    tried, replaced = 0, []
    for job, option in [(each, one) for each in JOBS.values() for one in outputs(each.options) if told(one)]:
        assert isinstance(option.kind, FileOut)
        for ending in option.kind.endings or (ending_of(option),):
            target = Path(f"theirs{ending}")
            target.write_text(OTHERS[0], encoding="utf-8")
            given = {option.name: str(target)} | ({"machine": "yl569"} if job.option("machine") else {})
            code = code_of(line_with(job, given))
            said, tried = capsys.readouterr().err, tried + 1
            if code != 2 or target.read_text(encoding="utf-8") != OTHERS[0] or "[ARG" in said:
                replaced.append((job.name, option.name, ending, code, said))
    assert replaced == []
    assert tried > 5


POST = "post part.cls --machine yl569 --output"

#: Commands whose outputs are written twice, the second time over the first.
TWICE = (
    f"{POST} a.mpf --report r.html --sheet s.html --listing l.txt --manifest m.json --json j.json",
    f"{POST} a.mpf --report r.json --sheet s.json",
    "verify part.mpf --machine yl569 --report v.html --json v.json",
    "info part.cls --json i.json --plot i.html",
    "sensitivity part.mpf --machine yl569 --report se.html --json se.json",
    "reach part.cls --machine yl569 --step 30 --plot re.svg --json re.json",
    "machines --json ma.json",
    "controls --json co.json",
    "kinematics yl569 --json k.json",
    "explain FIL250 --json e.json",
    "check yl569 --json ch.json",
    "diff part.mpf part.mpf --machine yl569 --json d.json",
    "convert part.mpf --machine yl569 --to-cl --output c.cls --json c.json",
    "view part.mpf --machine yl569 --output view.html",
    "twin part.mpf --machine yl569 --device-xml t.xml",
    "fit part.cls --machines yl569 --json f.json",
    "new n1.toml --like yl569 --json n.json",
    "place part.cls --machine yl569 --turns 90 --apply a.mpf --sheet s.html --plot p.svg --json p.json",
    "curve impeller/blade_points.csv --picture cu.svg --json cu.json",
)


@pytest.mark.parametrize("words", TWICE)
def test_a_command_writes_its_own_file_again(
    words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    fill_folder(tmp_path)
    first = main(words.split())
    before = sorted(Path().iterdir())
    capsys.readouterr()
    assert main(words.replace("n1.toml", "n2.toml").split()) == first
    assert "FIL250" not in capsys.readouterr().err
    assert len(before) > 2


def test_a_manifest_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(YL569 / "2_hub_rough.cls", "part.cls")
    main([*POST.split(), "a.mpf", "--manifest", "m.json"])
    manifest = Path("m.json").read_bytes()
    assert main(["info", "part.cls", "--json", "m.json"]) == 2
    assert Path("m.json").read_bytes() == manifest


@pytest.mark.parametrize("ending", [".stl", ".ply", ".3mf", ".glb", ".png"])
def test_a_mesh_is_written_again(ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from trunnion.simulation.meshes.primitives import box_mesh
    from trunnion.simulation.meshes.writing import save_mesh

    save = JOBS["simulate"].option("save_stock")
    assert save is not None
    save_mesh(box_mesh(np.zeros(3), np.ones(3)), tmp_path / f"stock{ending}")
    begins = beginning(save, ending)
    assert begins is not None
    assert begins.match((tmp_path / f"stock{ending}").read_bytes()[:1000])


#: What writes data of each command, for which nothing is posted or simulated anew.
RESULT_OF = {
    "convert": "convert", "curve": "curve", "diff": "diff", "fit": "fit", "info": "info", "manifest_check": "verify",
    "place": "place", "place_nowhere": "place", "post": "post", "posted": "post", "reach": "reach", "sheet": "post",
    "reach_part": "reach", "sensitivity": "sensitivity", "simulate": "simulate", "survey": "survey",
    "verify": "verify", "verify_failed": "verify",
}  # fmt: skip


def test_the_data_of_each_command_are_known_as_its_own() -> None:
    found = {name: writers((TESTS / f"golden/results/{name}.json").read_bytes()[:1000]) for name in RESULT_OF}
    assert {name: commands for name, commands in found.items() if RESULT_OF[name] not in commands} == {}
    shared = {"post", "verify", "sheet", "posted", "verify_failed"}
    assert {name for name, commands in found.items() if len(commands) > 1} <= shared | {"place", "simulate"}


_OWNERS = {"simulate": "simulate or impeller"}


@pytest.mark.parametrize("other", ["simulate", "verify", "diff", "place", "survey"])
def test_a_result_replaces_no_result_of_another_command(
    other: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    shutil.copy(YL569 / "2_hub_rough.cls", "part.cls")
    theirs = (TESTS / f"golden/results/{other}.json").read_bytes()
    Path("a.json").write_bytes(theirs)
    assert main(["info", "part.cls", "--json", "a.json"]) == 2
    assert Path("a.json").read_bytes() == theirs
    assert f"holds a result of trunnion {_OWNERS.get(other, other)}, and would be replaced" in capsys.readouterr().err
    shutil.copy(TESTS / "golden/results/info.json", "a.json")
    assert main(["info", "part.cls", "--json", "a.json"]) == 0


#: Commands that make pages, and those that may replace them.
PAGES = (
    ("post part.cls --machine yl569 --output b.mpf --report p.html", ("post", "impeller", "place")),
    ("post part.cls --machine yl569 --output b.mpf --sheet p.html", ("post", "impeller", "place")),
    ("verify part.mpf --machine yl569 --report p.html", ("verify",)),
    ("info part.cls --plot p.html", ("info",)),
    ("sensitivity part.mpf --machine yl569 --report p.html", ("sensitivity",)),
    ("view part.mpf --machine yl569 --output p.html", ("view",)),
    ("survey . --machine yl569 --report p.html", ("survey",)),
    ("simulate part.mpf --machine yl569 --stock part.stl --tools t.json --report p.html", ("simulate", "impeller")),
)


def test_a_page_replaces_no_page_of_another_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fill_folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    shutil.copy(YL569 / "2_hub_rough.cls", "part.cls")
    shutil.copy(YL569 / "2_hub_rough.expected.mpf", "part.mpf")
    pages = {}
    for words, commands in PAGES[:-1]:
        main(words.split())
        pages[words] = Path("p.html").read_bytes()
        assert writers(pages[words][:1000]) == commands, words
        Path("p.html").unlink()
    capsys.readouterr()
    for words, (own, *_) in PAGES:
        for other, commands in PAGES[:-1]:
            if own not in commands:
                Path("p.html").write_bytes(pages[other])
                assert main(words.split()) == 2, (words, other)
                said = f"p.html: error: holds a result of trunnion {' or '.join(commands)}, and would be replaced"
                assert said in capsys.readouterr().err, (words, other)
                assert Path("p.html").read_bytes() == pages[other]
    report = PAGES[2][0].replace(".html", ".json")
    main(PAGES[0][0].replace(".html", ".json").split())
    before = Path("p.json").read_bytes()
    assert main(report.split()) == 2, "a report of post is none of verify"
    assert Path("p.json").read_bytes() == before
