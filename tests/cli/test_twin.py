"""``trunnion twin``: what cannot be served is told before anything is, and passwords stay off the command line."""

import io
import socket
from pathlib import Path

import pytest

from tests.support.locations import YL569
from tests.support.twins import HUB_ROUGH
from trunnion.cli import main
from trunnion.jobs.twin.serving import users_file
from trunnion.twin.opcua.users import Role, read_users


@pytest.fixture(autouse=True)
def _folder_of_data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("LOCALAPPDATA", str(tmp_path))


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ([], "NC: error: is missing"),
        ([str(HUB_ROUGH)], "--machine"),
        ([str(YL569 / "2_hub_rough.cls"), "--machine", "yl569"], "post it first"),
        ([str(HUB_ROUGH), "--machine", "yl569", "--host", "0.0.0.0"], "--add-user"),
        ([str(HUB_ROUGH), "--machine", "yl569", "--host", "192.0.2.1"], "users"),
        ([str(HUB_ROUGH), "--machine", "yl569", "--zero", "1,2"], "--zero"),
        ([str(HUB_ROUGH), "--machine", "no such machine"], "no such machine"),
        (["no.mpf", "--machine", "yl569"], "no.mpf"),
    ],
)
def test_what_cannot_be_served(arguments: list[str], told: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["twin", *arguments, "--port", "0", "--adapter-port", "0"]) == 2
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("wrong", [("--speed", "0.01"), ("--speed", "fast"), ("--rate", "1"), ("--rate", "nan")])
def test_bounds_of_speed_and_rate(wrong: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["twin", str(HUB_ROUGH), "--machine", "yl569", *wrong])
    assert wrong[1] in capsys.readouterr().err


def test_a_taken_port_is_told_with_the_option(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = str(taken.getsockname()[1])
        assert main(["twin", str(HUB_ROUGH), "--machine", "yl569", "--port", port]) == 2
        assert "--port" in capsys.readouterr().err
        assert main(["twin", str(HUB_ROUGH), "--machine", "yl569", "--port", "0", "--adapter-port", port]) == 2
        assert "--adapter-port" in capsys.readouterr().err


def test_a_program_with_errors_is_not_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program = tmp_path / "wrong.mpf"
    program.write_text("N10 G0 X1\nN20 G777 X2\nN30 M30\n", encoding="utf-8")
    assert main(["twin", str(program), "--machine", "yl569", "--port", "0", "--adapter-port", "0"]) == 1
    assert "wrong.mpf:2: error" in capsys.readouterr().err


def test_a_user_is_added_with_a_password_from_stdin(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.stdin", io.StringIO("a good password\n"))
    assert main(["twin", "--add-user", "eve", "--role", "viewer"]) == 0
    assert read_users(users_file()).role_of("eve", "a good password") is Role.VIEWER


def test_the_devices_of_an_agent_are_written_and_nothing_is_served(tmp_path: Path) -> None:
    file = tmp_path / "devices.xml"
    assert main(["twin", str(HUB_ROUGH), "--machine", "yl569", "--device-xml", str(file)]) == 0
    assert 'name="B_actual"' in file.read_text(encoding="utf-8")
    assert main(["twin", str(HUB_ROUGH), "--machine", "yl569", "--device-xml", str(tmp_path / "devices.txt")]) == 2
