"""Jobs of parts that are clamped turned: posted, verified and simulated with one pair of angles; and their warnings."""

import json
import sqlite3
from collections.abc import Iterable, Iterator
from contextlib import closing
from pathlib import Path

import pytest

import trunnion
from tests.support.batches import InOrder
from tests.support.locations import YL569
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.processing import work
from trunnion.batch.records import Record
from trunnion.batch.running import BatchResult, run_jobs
from trunnion.batch.stores import FolderStore
from trunnion.batch.summary import write_summary
from trunnion.batch.worker_task import Outcome, Status, Task
from trunnion.batch.workers import Assignment
from trunnion.cli.many_files.batch import result_lines

HUB = YL569 / "2_hub_rough.cls"


class Here(InOrder):
    """Does the real work in this process: another one would take seconds to start."""

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Outcome | Record]]:
        for assignment, task in filter(None, tasks):
            yield assignment, work(task)


def run(file: Path, results: Path) -> BatchResult:
    return run_jobs(load_batch(file), FolderStore(results), lambda _: Here())


def jobs(folder: Path, text: str) -> Path:
    file = folder / "jobs.toml"
    file.write_text('[defaults]\nmachine = "yl569"\n' + text, "utf-8")
    return file


@pytest.fixture(scope="module")
def posted(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with two CL files, and their programs of a part that is turned by 45 and tilted by -10 degrees."""
    folder = tmp_path_factory.mktemp("turned")
    for name in ("a.cls", "b.cls"):
        (folder / name).write_bytes(HUB.read_bytes())
    post = jobs(folder, '[[job]]\nfiles = ["*.cls"]\nturn_deg = 45\ntilt_deg = -10\n')
    assert run(post, folder / "results").passed
    for name in ("a.mpf", "b.mpf"):
        (folder / name).write_bytes((folder / "results" / name).read_bytes())
    return folder


def test_a_job_posts_what_the_single_post_does(posted: Path) -> None:
    single = trunnion.post(posted / "a.cls", machine="yl569", turn=45.0, tilt=-10.0).text
    assert single is not None
    assert "PART TURNED 45 DEG" in single
    assert (posted / "a.mpf").read_text("utf-8") == single


def test_verify_and_simulate_take_the_angles_and_warn_without(posted: Path) -> None:
    body = 'stock = "box:80,40,40,-10,-20,-40"\ntools = ["2=ball:8,length=80,flutes=40"]\ncell_mm = 4\n'
    angles = "turn_deg = 45\ntilt_deg = -10\n"
    verify = '[[job]]\nname = "v"\naction = "verify"\nfiles = ["*.mpf"]\noutput = "v"\ncl = ["{stem}.cls"]\n'
    simulate = '[[job]]\nname = "s"\naction = "simulate"\nfiles = ["*.mpf"]\noutput = "s"\n' + body
    sound = run(jobs(posted, verify + angles + simulate + angles), posted / "sound")
    assert not {each.code for each in sound.warned} & {"PLC220", "PLC230"}
    assert [each.status for each in sound.records() if each.job == "v"] == [Status.PASSED] * 2
    plain = run(jobs(posted, verify + simulate), posted / "plain")
    write_summary(plain, posted / "plain.sqlite")
    of_code = {each.code: each for each in plain.warned}
    assert (of_code["PLC220"].files, of_code["PLC220"].file) == (2, "a.mpf")
    assert of_code["PLC230"].files == 2
    lines = list(result_lines(plain))
    (line,) = [line for line in lines if line.startswith("PLC220")]
    assert line.split()[:3] == ["PLC220", "2", "a.mpf:"]
    assert "the part is tilted by -10 degrees about X and turned by 45 degrees" in line
    with closing(sqlite3.connect(posted / "plain.sqlite")) as database:
        found = database.execute("SELECT action, warnings, warning_codes FROM files ORDER BY job, file").fetchall()
    for action, count, codes in found:
        assert count >= 1
        assert ("PLC230" if action == "simulate" else "PLC220") in json.loads(codes)
    again = run(jobs(posted, verify + simulate), posted / "plain")
    assert again.done == 4
    assert [(each.code, each.files) for each in again.warned] == [(each.code, each.files) for each in plain.warned]


def test_angles_without_cl_files_and_beyond_a_turn_are_told_with_their_lines(tmp_path: Path) -> None:
    (tmp_path / "a.mpf").write_text("M30\n")
    text = '[[job]]\naction = "verify"\nfiles = ["*.mpf"]\nturn_deg = 45\n'
    with pytest.raises(trunnion.InputError, match=r"jobs.toml:6: .*turn_deg.*the job has none"):
        load_batch(jobs(tmp_path, text))
    text = '[[job]]\naction = "verify"\nfiles = ["*.mpf"]\ncl = ["a.cls"]\ntilt_deg = 91\n'
    with pytest.raises(trunnion.InputError, match=r"jobs.toml:7: .*tilt_deg"):
        load_batch(jobs(tmp_path, text))
    text = '[[job]]\naction = "convert"\nfiles = ["*.mpf"]\nto_cl = true\nturn_deg = 45\n'
    with pytest.raises(trunnion.InputError, match="BAT110"):
        load_batch(jobs(tmp_path, text))


def test_zero_and_tool_length_of_a_post_are_settings(posted: Path, tmp_path: Path) -> None:
    """Those of the defaults and of the job, in which order they may stand; the head of the program has them."""
    head = "zero_mm = [1, 2, -60]\ntool_length_mm = 120\n"
    (tmp_path / "a.cls").write_bytes((posted / "a.cls").read_bytes())
    job = '[[job]]\nfiles = ["a.cls"]\nturn_deg = 45\n'
    for name, text in (
        ("defaults", head + job),
        ("job", job + head),
        ("over", head.replace("1, 2", "3, 4") + job + head),
        ("setting", head.replace("1, 2", "3, 4") + job + "[job.settings]\nzero = [1, 2, -60]\n"),
    ):
        assert run(jobs(tmp_path, text), tmp_path / name).passed
        program = (tmp_path / name / "a.mpf").read_text("utf-8")
        assert "WORKPIECE ZERO X1.000 Y2.000 Z-60.000 MM" in program
        assert "ZERO FOR TOOL LENGTH 120 MM" in program
    twice = job + head + "[job.settings]\nzero = [1, 2, -60]\n"
    with pytest.raises(trunnion.InputError, match=r"zero_mm.*is stated besides settings.zero"):
        load_batch(jobs(tmp_path, twice))
