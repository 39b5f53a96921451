"""No command writes over a file that it reads, and no two of its outputs are one file."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.command_lines import SAMPLES, code_of, ending_of, fill_folder, line_with
from tests.support.usage_table import good_line
from trunnion.cli import main
from trunnion.jobs.job import Job
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import FileIn
from trunnion.options.option import Option, outputs

#: Commands that say themselves what they write, or write nothing but what is named; the tests of these try them.
OWN = {"test"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a file of each kind, from which commands are run."""
    fill_folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def pairs() -> Iterator[tuple[Job, Option, Option]]:
    """Every output of every command with each of its inputs."""
    for job in JOBS.values():
        if job.name not in OWN:
            for out in outputs(job.options):
                yield from ((job, out, each) for each in job.options if isinstance(each.kind, FileIn))


@pytest.mark.parametrize("name", sorted({job.name for job, _, _ in pairs()}))
def test_no_command_writes_over_what_it_reads(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    written: list[str] = []
    for job, out, source in pairs():
        assert isinstance(source.kind, FileIn)
        if job.name != name:
            continue
        sample = SAMPLES[source.kind.leads]
        is_definition = sample.endswith(".toml")
        for kind in ("itself", "link"):
            copy = str(Path(sample).with_suffix(".toml" if is_definition else ending_of(out)))
            if not Path(copy).exists():
                shutil.copy(sample, copy)
            target = copy
            if kind == "link":
                target = str(Path(copy).with_name(f"link_{Path(copy).name}"))
                if not os.path.lexists(target):
                    os.link(copy, target)
            before = Path(copy).read_bytes()
            capsys.readouterr()
            code = code_of(line_with(job, {source.name: copy, out.name: target}))
            error = capsys.readouterr().err
            is_told = any(each in error for each in ("FIL240", "FIL260", "SIM218", "is a project already"))
            if code != 2 or Path(copy).read_bytes() != before or not is_told:
                written.append(f"{out.flag} over {source.flag or source.value_name} ({kind}): exit {code}: {error}")
    assert not written, "\n".join(written)


@pytest.mark.parametrize("name", sorted(name for name, job in JOBS.items() if len(outputs(job.options)) > 1))
def test_no_two_outputs_are_one_file(name: str, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    job = JOBS[name]
    options = outputs(job.options)
    for k, first in enumerate(options):
        for second in options[k + 1 :]:
            target = "both" + (ending_of(second) if ending_of(first) == ".out" else ending_of(first))
            more = {"apply": "placed.mpf"} if name == "place" and "apply" not in (first.name, second.name) else {}
            code = code_of(line_with(job, {**more, first.name: target, second.name: f"./{target}"}))
            assert code == 2, (first.flag, second.flag)
            assert not Path(target).exists(), (first.flag, second.flag)
            error = capsys.readouterr().err
            assert "would be written twice" in error or "FIL260" in error or "SIM218" in error, error


def test_a_definition_that_machines_name_is_not_written_over(folder: Path) -> None:
    for name in ("mine.toml", "base.toml"):
        before = Path(name).read_bytes()
        assert main(["fit", "part.cls", "--machines", "yl569,mine.toml", "--json", name]) == 2
        assert Path(name).read_bytes() == before


def test_what_a_manifest_lists_is_not_written_over(folder: Path) -> None:
    post = ["post", "part.cls", "--machine", "yl569", "--output", "own.mpf", "--manifest", "own.json"]
    assert main([*post, "--listing", "own.lst", "--sheet", "own.html"]) == 0
    for name in ("own.mpf", "own.lst", "own.html", "own.json", "part.cls"):
        before = Path(name).read_bytes()
        assert main(["verify", "own.json", "--json", name]) == 2
        assert Path(name).read_bytes() == before
    assert main(["verify", "own.json", "--json", "other.json"]) == 0


def test_what_a_batch_reads_and_a_new_definition_are_not_written_over(folder: Path) -> None:
    Path("many").mkdir()
    shutil.copy("part.cls", "many/part.cls")
    before = Path("part.cls").read_bytes()
    batch = ["batch", "many", "--action", "post", "--machine", "yl569", "--results", "made", "--workers", "1"]
    assert main([*batch, "--json", "many/part.cls"]) == 2
    assert Path("many/part.cls").read_bytes() == before
    for name in ("fresh.toml", "trunnion-machine.schema.json"):
        assert main(["new", "fresh", "--like", "yl569", "--json", name]) == 2
        assert not Path(name).exists()


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--machine", "yl569", "--machine", "dmu65"], "has two values, yl569 and dmu65"),
        (["--machine", "yl569", "--output", "x" * 500], "longer than the name of a file can be"),
        (["--machine", ""], "names no file"),
    ],
)
def test_a_line_that_cannot_be_meant_is_refused(
    words: list[str], says: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert code_of(["post", "part.cls", *words]) == 2
    assert says in capsys.readouterr().err


def test_a_line_of_every_command_is_understood() -> None:
    assert all(good_line(job) for job in JOBS.values())
