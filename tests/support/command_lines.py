"""A folder with a file of each kind, and command lines of any command with its files."""

import shutil
from pathlib import Path
from typing import Final

from tests.support.locations import ROOT, YL569
from tests.support.usage_table import values
from trunnion.cli import main
from trunnion.jobs.job import Job
from trunnion.options.kinds import FileIn, FileOut
from trunnion.options.option import Many, Option

#: Files that stand for what an option leads to; others are read as they are, or their names are enough.
SAMPLES: Final = {
    "machine": "mine.toml", "machines": "mine.toml", "definition": "mine.toml", "library": "tools.toml",
    "project": "part.mpf", "posted": "part.cls", "stock": "stock.stl", "fixture": "stock.stl",
    "impeller": "impeller/impeller.toml",
    "named": "nodes.toml", "jobs": "jobs.toml", "manifest": "part.mpf", "": "part.cls",
}  # fmt: skip


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
