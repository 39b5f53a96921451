"""Power failures at every operation of a job: what was not brought to the disk may be lost, in any order."""

import shutil
from collections import Counter
from pathlib import Path

import pytest

from tests.support.lost_power import lay_out, states_of
from tests.support.stopped_jobs import NEW, OLD, left, needs_fork, old_job, settle, write_job

#: The folder of the records of the jobs, which lose the power as well.
_RECORDS = "records"


def _files(folder: Path) -> dict[str, bytes]:
    return {name: text for name, text in left(folder).items() if not name.startswith(_RECORDS)}


@needs_fork
@pytest.mark.skipif(not Path("/proc/self/fd").is_dir(), reason="it says which file is brought to the disk")
@pytest.mark.parametrize("step", [pytest.param(1, marks=pytest.mark.nightly), 9])
def test_a_power_failure_leaves_a_whole_job(step: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder, kept = tmp_path / "shop", tmp_path / "kept"
    (folder / _RECORDS).mkdir(parents=True)
    monkeypatch.setenv("LOCALAPPDATA", str(folder / _RECORDS))
    old_job(folder)
    states = states_of(folder, lambda: write_job(folder, b"new", "MORE.SPF"))
    folder.rename(kept)
    found = Counter[str]()
    for number, state in enumerate(states):
        if number % step:
            continue
        lay_out(state, folder, folder)
        for name in ("nc", "two", "reports"):
            (folder / name).mkdir(exist_ok=True)
        said = settle(folder)
        there = _files(folder)
        assert there in (OLD, NEW), (number, said, sorted(state))
        assert not [path for path in folder.rglob(".*") if path.is_dir()], (number, "hidden folders")
        found["old" if there == OLD else "new"] += 1
        write_job(folder, b"next", "MORE.SPF")
        assert _files(folder) == dict.fromkeys(NEW, b"next"), (number, "it can be posted again")
        shutil.rmtree(folder)
    assert len(states) > 200
    assert min(found["old"], found["new"]) > 5
