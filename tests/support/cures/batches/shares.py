"""Cures of messages about files whose work is divided, and about files of a batch that are not where they were."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path
from typing import Any, Final
from unittest.mock import patch

from tests.support.cures.cure import Cure, Outcome, Trial
from tests.support.cures.scripts import FILES, script
from tests.support.simulating import SLOT, STOCK, TOOL
from trunnion.batch.jobs_file import load_batch
from trunnion.batch.processing import work
from trunnion.batch.result_keys import digest
from trunnion.batch.running import run_jobs
from trunnion.batch.stores import open_store
from trunnion.batch.worker_task import Outcome as Became
from trunnion.batch.worker_task import Task
from trunnion.batch.workers import Assignment
from trunnion.errors import Problem
from trunnion.jobs.observer import Observer
from trunnion.messages import Wording

_SIMULATED: Final = (
    'results = "out"\n[[job]]\naction = "simulate"\nfiles = ["part.ngc"]\nmachine = "xyzac_trt"\n'
    f'stock = "{STOCK}"\ntools = ["{TOOL}"]\ncell_mm = 2\ntiles = 2\n'
)
_VERIFIED: Final = 'results = "out"\n[[job]]\naction = "verify"\nfiles = ["*.mpf"]\nmachine = "yl569"\n'


class _Here:
    """Works here, one task after another; before each join something happens, and the first shares may be all."""

    def __init__(self, happens: Callable[[], object], *, only_shares: bool) -> None:
        self._happens, self._only_shares = happens, only_shares

    def run(self, tasks: Iterable[tuple[Assignment, Task] | None]) -> Iterator[tuple[Assignment, Became]]:
        for assignment, task in filter(None, tasks):
            if task.shares:
                if self._only_shares:
                    raise KeyboardInterrupt
                self._happens()
            yield assignment, work(task)


class _Watching(Observer):
    """Keeps what is warned of; when files are about to be read, something happens."""

    def __init__(self, happens: Callable[[], object]) -> None:
        self.found: list[Problem] = []
        self._happens = happens

    def problems(self, problems: Sequence[Problem]) -> None:
        self.found += problems

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        self._happens()
        return nullcontext(lambda _: None)


def _nothing() -> None:
    pass


def _run(
    jobs: Path,
    *,
    at_join: Callable[[], object] = _nothing,
    at_start: Callable[[], object] = _nothing,
    only_shares: bool = False,
) -> Outcome:
    """Run a file of jobs; or only until its shares are made."""
    batch, heard = load_batch(jobs), _Watching(at_start)
    assert batch.results is not None
    workers: Any = _Here(at_join, only_shares=only_shares)
    text_of, said = Wording.text, dict[str, Wording]()

    def noted(self: Wording, part: Any, *others: Any) -> str:
        text = text_of(self, part, *others)
        said[text] = self
        return text

    with patch.object(Wording, "text", noted):  # records keep what is said as texts
        try:
            found = run_jobs(batch, open_store(batch.results), lambda _: nullcontext(workers), heard)
        except KeyboardInterrupt:
            return Outcome(tuple(heard.found), False)
    told = [problem for record in found.failures() for problem in record.problems]
    failed = [replace(problem, wording=said.get(problem.what, problem.wording)) for problem in told]
    return Outcome((*heard.found, *failed), found.passed)


def _jobs(text: str, folder: Path, name: str = "jobs.toml") -> Path:
    (folder / "part.ngc").write_text(SLOT, encoding="utf-8")
    (folder / "part.mpf").write_text(FILES["part.mpf"], encoding="utf-8")
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def _shares(folder: Path) -> list[Path]:
    return sorted(folder.rglob("*.share"))


def _interrupted(happens: Callable[[Path], object]) -> Trial:
    """Return what runs a batch again that was stopped when its shares were made; one of these is not as it was."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        jobs = _jobs(text, folder)
        _run(jobs, only_shares=True)
        share = _shares(folder)[0]
        happens(share)
        found = _run(jobs)
        if share.is_dir():
            share.rmdir()
        return found

    return tried


def _cut_short(share: Path) -> None:
    share.write_bytes(share.read_bytes()[:-9])


def _folder_instead(share: Path) -> None:
    share.unlink()
    share.mkdir()


def _damaged(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Run a batch, of which a share is damaged before it is joined with the others."""
    return _run(_jobs(text, folder), at_join=lambda: _cut_short(_shares(folder)[0]))


def _again(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    return _run(_jobs(text, folder))


def _beside_another(remedy: str = "") -> Trial:
    """Return what runs a batch where another one has left shares; these are removed, or it gets a folder of its own."""

    def tried(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
        own = folder / (remedy or "both")
        own.mkdir()
        _run(_jobs(text, own, "other.toml"), only_shares=True)
        if remedy == "removed":
            for share in _shares(own):
                share.unlink()
        return _run(_jobs(text.replace('"out"', '"new"') if remedy == "apart" else text, own))

    return tried


def _moved_out(text: str, settings: Mapping[str, str], folder: Path) -> Outcome:
    """Run a batch of which somebody puts a link that leads out in the place of a file, just before it is read."""
    inner = folder / "inner"
    inner.mkdir()
    jobs = _jobs(text, inner)

    def moved() -> None:
        (inner / "part.mpf").rename(folder / "part.mpf")
        (inner / "part.mpf").symlink_to(folder / "part.mpf")

    return _run(jobs, at_start=moved)


_CALLED: Final = _VERIFIED + 'subprograms = ["{folder}/{stem}.spf"]\n'
_BESIDE: Final = (
    "append part.mpf ''\nwrite ../sub/part.spf 'M17\\n'\nlink ../sub/part.spf part.spf\n"
    + "write jobs.toml '{}'\ntrunnion batch jobs.toml".replace("{}", _CALLED.replace("\n", "\\n"))
)
_ALIKE: Final = f"a.mpf-{digest(b'a/a.mpf')[:16]}"
_NAMED: Final = (
    f"cp part.mpf a.mpf\ncp part.mpf A.MPF\ncp part.mpf {_ALIKE}\n"
    + "write jobs.toml '{}'\ntrunnion batch jobs.toml".replace(
        "{}", _VERIFIED.replace("*.mpf", 'a*", "A*').replace("action", 'name = "a"\naction').replace("\n", "\\n")
    )
)

CURES: Final = (
    Cure("BAT395", "share_is_made_again", _interrupted(_cut_short), _SIMULATED, (), stays=True),
    Cure("BAT395", "damaged", _damaged, _SIMULATED, (), cured_by=_again),
    Cure("BAT320", "one_shares_would", _interrupted(_folder_instead), _SIMULATED, (), cured_by=_again),
    Cure("BAT370", "shares_simulation_another", _beside_another(), _SIMULATED, (), cured_by=_beside_another("apart")),
    Cure("BAT370", "shares_simulation_another", _beside_another(), _SIMULATED, (), cured_by=_beside_another("removed")),
    Cure("FIL120", "leads_out_folder", _moved_out, _VERIFIED, (), cured_by=_again),
    script("FIL120 goes_leads_out", _BESIDE, "link", "cp"),
    script("BAT120 no_place_own", _NAMED, f"cp part.mpf {_ALIKE}", "cp part.mpf a2.mpf"),
)
