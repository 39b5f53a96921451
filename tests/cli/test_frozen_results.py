"""The JSON of every command stays as it is: keys, their order, texts and numbers."""

import json
from pathlib import Path

import pytest

from tests.support.frozen_results import FROZEN, JOBS, ROOT, data_of, differences, lay_out, portable, shortened

#: Long jobs of commands that have another one: left to nightly.
LONG = {"post_force", "post_simulated", "simulate_project", "place", "place_project", "place_nowhere", "reach_part"}
LONG |= {"sensitivity_home", "verify_failed"}


@pytest.mark.parametrize(
    "jobs", [JOBS.keys() - LONG, pytest.param(LONG, marks=pytest.mark.nightly)], ids=["each command", "long"]
)
def test_the_json_of_all_commands_is_as_it_was(jobs: set[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lay_out(tmp_path)
    monkeypatch.chdir(tmp_path)
    found = list[str]()
    for name in (name for name in JOBS if name in jobs):  # some read what those before them have written
        frozen = json.loads((FROZEN / f"{name}.json").read_text(encoding="utf-8"))
        now = json.loads(portable(data_of(JOBS[name]), tmp_path, ROOT))
        found += (f"{name}{place}" for place in differences(frozen, shortened(now)))
    assert not found, "\n".join(found)


def test_no_result_is_left_over() -> None:
    assert {file.stem for file in FROZEN.iterdir()} == set(JOBS)
