"""Papers of a project's programs tell what its checks found, and appear with the programs or not at all."""

import json
import re
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.projects import SETUPS, TWO, contents, project
from trunnion.errors import Problem, Severity

EXAMPLE = Path(__file__).parents[3] / "examples" / "project"

#: Set-up -> its papers.
PAPERS = {
    name: f'\nsheet = "{name}.html"\nmanifest = "{name}.json"\nreport = "{name}_report.html"'
    for name in ("top", "bottom")
}


class Told(trunnion.Observer):
    """Keeps what is told."""

    def __init__(self) -> None:
        self.all: list[Problem] = []

    def problems(self, problems: Sequence[Problem]) -> None:
        self.all += problems


def example(folder: Path, simulate: str = "warn") -> Path:
    """The example with papers, whose first set-up cuts too deep at its slot, through a shank."""
    for file in EXAMPLE.iterdir():
        if file.suffix != ".mpf":
            shutil.copy(file, folder)
    path = folder / "part.toml"
    text = path.read_text(encoding="utf-8").replace('simulate = "refuse"', f'simulate = "{simulate}"')
    for name, papers in PAPERS.items():
        text = text.replace(f'output = "plate_{name}.mpf"', f'output = "plate_{name}.mpf"{papers}')
    path.write_text(text.replace("cell_mm = 1.0", "cell_mm = 2.0"), encoding="utf-8")
    cl = folder / "plate_top.cls"
    text = cl.read_text(encoding="utf-8")
    assert "-6.0000,0.0" in text
    cl.write_text(text.replace("-6.0000,0.0", "-28.0000,0.0"), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def warned(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, trunnion.ProjectResult, Told]:
    """The example posted, with what was told."""
    folder, told = tmp_path_factory.mktemp("papers"), Told()
    return folder, trunnion.post_project(example(folder), observer=told), told


def data(file: Path) -> Any:
    return json.loads(file.read_text(encoding="utf-8"))


def test_sheet_manifest_and_report_tell_what_the_simulation_found(
    warned: tuple[Path, trunnion.ProjectResult, Told],
) -> None:
    folder, found, _ = warned
    sheet, manifest = (folder / "top.html").read_text(encoding="utf-8"), data(folder / "top.json")
    of_top = [each.what for each in found.problems if each.file.endswith("plate_top.mpf")]
    assert {"gouge", "collision"} <= {what.split(": ")[1] for what in of_top}
    assert "(no simulation)" not in sheet
    assert "THE SIMULATION WARNS" in sheet
    for what in of_top:
        assert f"Warning: {what}" in re.sub(r'</?span(?: class="nb")?>', "", sheet)
        assert what in manifest["warnings"]
    assert (manifest["may_run"], manifest["simulation_passed"]) == (True, False)
    report = (folder / "top_report.html").read_text(encoding="utf-8")
    assert "; the simulation warns, see below" in report
    assert "<td>part, shank of slot mill</td>" in report.replace("<bdi>", "").replace("</bdi>", "")
    names = {each["name"]: each for each in manifest["inputs"]["simulation"]}
    assert set(names) == {"part.toml", "vice.stl", "tools.toml", "plate.stl", "plate_top.cls"}
    assert all("sha256" in each for each in names.values())
    assert trunnion.verify_manifest(folder / "top.json").passed
    assert {each["name"] for each in manifest["files"]} == {"plate_top.mpf", "top.html", "top_report.html"}


def test_each_set_up_has_its_own_findings_and_what_came_before_it(
    warned: tuple[Path, trunnion.ProjectResult, Told],
) -> None:
    folder, _, _ = warned
    manifest = data(folder / "bottom.json")
    assert not any("the simulation finds: " in warning for warning in manifest["warnings"])
    assert "plate_top.cls" in {each["name"] for each in manifest["inputs"]["simulation"]}, "its stock comes from there"
    assert "The simulation (0 findings)" in (folder / "bottom.html").read_text(encoding="utf-8")


def test_what_is_judged_a_warning_is_told_once_and_as_one(
    warned: tuple[Path, trunnion.ProjectResult, Told],
) -> None:  # fmt: skip
    _, found, told = warned
    assert {each.severity for each in told.all} == {Severity.WARNING}
    assert [told.all.count(each) for each in found.problems] == [1] * len(found.problems)


def test_papers_appear_with_the_programs_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.jobs.post_project.checks._MOST_TOLD", 1)
    path = example(tmp_path, "refuse")
    before = contents(tmp_path)
    with pytest.raises(trunnion.RefusedError) as refused:
        trunnion.post_project(path)
    assert contents(tmp_path) == before
    (more,) = (each for each in refused.value.problems if "findings here; the first 1 are reported" in each.what)
    assert more.cure.startswith('mend these first; or post with simulate = "warn"'), "no program is there to simulate"


def test_a_program_that_breaks_off_is_told_once(tmp_path: Path) -> None:
    by_hand = SETUPS.replace('output = "bottom.mpf"', 'programs = ["hand.mpf"]')
    path = project(tmp_path, 'checks = { simulate = "warn" }\n' + by_hand)
    (tmp_path / "hand.mpf").write_text("T=1\nM6\nG54 G0 X0 Y0 Z50 S1000 M3\nG1 Z40 F100\nG1 X=NOBODY(1)\nM30\n")
    told = Told()
    trunnion.post_project(path, observer=told)
    broken = [each for each in told.all if "cut up to there" in each.what]
    assert [each.severity for each in broken] == [Severity.WARNING]


def test_a_set_up_behind_the_first_finding_is_told_as_not_simulated(tmp_path: Path) -> None:
    cl = TWO.replace("GOTO/0.0,0.0,50.0", "GOTO/0.0,0.0,-5.0")  # at rapid into the stock
    text = 'checks = { simulate = "warn" }\nstop_at = "first"\n' + SETUPS
    for name in ("top", "bottom"):
        text = text.replace(f'output = "{name}.mpf"', f'output = "{name}.mpf"{PAPERS[name]}')
    trunnion.post_project(project(tmp_path, text.replace("report.html", "report.json"), top=cl))
    assert (data(tmp_path / "top.json")["simulation_passed"], data(tmp_path / "bottom.json")["simulation_passed"]) == (
        False,
        None,
    )
    assert "(no simulation)" in (tmp_path / "bottom.html").read_text(encoding="utf-8")
    before = contents(tmp_path)
    trunnion.post_project(tmp_path / "part.toml")
    assert contents(tmp_path) == before, "nothing depends on the clock"


def test_papers_say_so_where_nothing_was_simulated(tmp_path: Path) -> None:
    trunnion.post_project(example(tmp_path, "off"))
    assert "(no simulation)" in (tmp_path / "top.html").read_text(encoding="utf-8")
    manifest = data(tmp_path / "top.json")
    assert (manifest["inputs"]["simulation"], manifest["simulation_passed"]) == ([], None)
