"""The JSON of every command stays as it is: keys, their order, texts and numbers."""

import json
from pathlib import Path

import pytest

from tests.support.frozen_results import FROZEN, JOBS, ROOT, data_of, differences, lay_out, portable, shortened


def test_the_json_of_all_commands_is_as_it_was(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lay_out(tmp_path)
    monkeypatch.chdir(tmp_path)
    found = list[str]()
    for name, arguments in JOBS.items():
        frozen = json.loads((FROZEN / f"{name}.json").read_text(encoding="utf-8"))
        now = json.loads(portable(data_of(arguments), tmp_path, ROOT))
        found += (f"{name}{place}" for place in differences(frozen, shortened(now)))
    assert not found, "\n".join(found)


def test_no_result_is_left_over() -> None:
    assert {file.stem for file in FROZEN.iterdir()} == set(JOBS)
