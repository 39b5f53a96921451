"""What `view` says of arguments that leave nothing to show, or contradict each other."""

from pathlib import Path

import pytest

from trunnion.cli import main


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ((), "ARG130"),
        (("--live", "opc.tcp://localhost:1", "--output", "page.html"), "ARG130"),
    ],
)
def test_arguments_without_a_page_are_refused(
    arguments: tuple[str, ...], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    assert main(["view", "--machine", "yl569", *arguments]) == 2
    assert said in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
