"""No command writes over a file that it reads, and no two of its outputs are one file."""

import os
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.support.locations import ROOT, YL569
from tests.support.usage_table import good_line, values
from trunnion.cli import main
from trunnion.jobs.job import Job
from trunnion.jobs.registry import JOBS
from trunnion.options.kinds import FileIn, FileOut
from trunnion.options.option import Many, Option, outputs

#: Files that stand for what an option leads to; others are read as they are, or their names are enough.
SAMPLES = {
    "machine": "mine.toml", "machines": "mine.toml", "definition": "mine.toml", "library": "tools.toml",
    "project": "part.mpf", "posted": "part.cls", "stock": "stock.stl", "fixture": "stock.stl",
    "impeller": "impeller/impeller.toml",
    "named": "nodes.toml", "jobs": "jobs.toml", "manifest": "part.mpf", "": "part.cls",
}  # fmt: skip

#: Commands that say themselves what they write, or write nothing but what is named; the tests of these try them.
OWN = {"test"}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with a file of each kind, from which commands are run."""
    fill_folder(tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def fill_folder(tmp_path: Path) -> None:
    """Put a file of each kind into a folder."""
    shutil.copy(YL569 / "2_hub_rough.cls", tmp_path / "part.cls")
    shutil.copy(YL569 / "2_hub_rough.expected.mpf", tmp_path / "part.mpf")
    shutil.copytree(ROOT / "examples" / "impeller", tmp_path / "impeller")
    (tmp_path / "base.toml").write_text('extends = "yl569"\n', encoding="utf-8")
    (tmp_path / "mine.toml").write_text('extends = "./base.toml"\n', encoding="utf-8")
    (tmp_path / "tools.toml").write_text('[[tool]]\nnumber = 1\nkind = "ball"\ndiameter_mm = 10\n', encoding="utf-8")
    shutil.copy(ROOT / "examples" / "simulation" / "plate.stl", tmp_path / "stock.stl")
    for name in ("nodes.toml", "jobs.toml"):
        (tmp_path / name).touch()


def pairs() -> Iterator[tuple[Job, Option, Option]]:
    """Every output of every command with each of its inputs."""
    for job in JOBS.values():
        if job.name not in OWN:
            for out in outputs(job.options):
                yield from ((job, out, each) for each in job.options if isinstance(each.kind, FileIn))


def line_with(job: Job, given: dict[str, str]) -> list[str]:
    """A command line that the parser takes, with files of the folder for its arguments, and some values by option."""
    words = [job.name]
    for each in job.options:
        if each.name in given:
            words += [given[each.name]] if not each.flag else [f"{each.flag}={given[each.name]}"]
        elif not each.flag and each.many not in (Many.MAYBE, Many.ANY):
            sample = SAMPLES[each.kind.leads] if isinstance(each.kind, FileIn) else values(each)[0]
            words += [sample] * (2 if each.many is Many.TWO else 1)
        elif each.flag and each.required:
            words += [each.flag, "yl569"]
    if job.name == "diff" and "files" in given:
        words.insert(2, "part.mpf")
    if job.name == "post" and "machine" not in given:
        words += ["--machine", "yl569"]
    if job.name == "import" and "machine" not in given:
        words += ["--output", "ours"]
    if job.name == "convert" and not {"to_cl", "to_machine"} & given.keys():
        words += ["--to-cl"]
    return words


def code_of(words: list[str]) -> int:
    """The exit code of a command."""
    try:
        return main(words)
    except SystemExit as stop:
        return int(str(stop.code))


def ending_of(option: Option) -> str:
    """An ending that an output may have."""
    assert isinstance(option.kind, FileOut)
    return ".stl" if option.kind.form else option.kind.endings[0] if option.kind.endings else ".out"


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
