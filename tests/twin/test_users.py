"""The file of users: hashed passwords, told line by line where it is broken."""

import os
import socket
from pathlib import Path

import pytest

from trunnion.errors import InputError
from trunnion.twin.opcua.users import Role, read_users, write_user
from trunnion.twin.ports import take_port


def test_a_user_is_known_by_the_password_alone(tmp_path: Path) -> None:
    path = tmp_path / "folder" / "users"
    write_user(path, "ada", Role.OPERATOR, "first password")
    write_user(path, "eve", Role.VIEWER, "other password")
    write_user(path, "ada", Role.OPERATOR, "second password")
    users = read_users(path)
    assert len(users) == 2
    assert users.role_of("ada", "second password") is Role.OPERATOR
    assert users.role_of("eve", "other password") is Role.VIEWER
    assert users.role_of("ada", "first password") is None
    assert users.role_of("bob", "second password") is None
    assert "password" not in path.read_text(encoding="utf-8").partition("\n")[2]


def test_many_wrong_passwords_shut_everybody_out_for_a_while(tmp_path: Path) -> None:
    path, now = tmp_path / "users", [0.0]
    write_user(path, "ada", Role.OPERATOR, "good password")
    users = type(read_users(path))(read_users(path)._users, lambda: now[0])
    for _ in range(10):
        assert users.role_of("ada", "bad password") is None
    assert users.role_of("ada", "good password") is None
    now[0] = 31.0
    assert users.role_of("ada", "good password") is Role.OPERATOR


def test_all_broken_lines_are_told(tmp_path: Path) -> None:
    path = tmp_path / "users"
    write_user(path, "ada", Role.OPERATOR, "good password")
    good = path.read_text(encoding="utf-8").splitlines()[1]
    costly = good.replace(":16384:", ":1073741824:").replace("ada", "cost")
    path.write_text(f"{good}\nnonsense\n{costly}\n{good.replace('operator', 'king')}\n", encoding="utf-8")
    with pytest.raises(InputError) as raised:
        read_users(path)
    assert [problem.line for problem in raised.value.problems] == [2, 3, 4]


@pytest.mark.parametrize(("name", "password"), [("a:b", "good password"), ("", "good password"), ("ada", "short")])
def test_names_and_passwords_that_cannot_be_taken(tmp_path: Path, name: str, password: str) -> None:
    with pytest.raises(InputError):
        write_user(tmp_path / "users", name, Role.VIEWER, password)
    assert not (tmp_path / "users").exists()


@pytest.mark.parametrize("password", ["p\udce4ss-word-\udcff", " " * 8])
def test_a_password_that_is_no_text_is_refused(tmp_path: Path, password: str) -> None:
    with pytest.raises(InputError, match="password"):
        write_user(tmp_path / "users", "bob", Role.OPERATOR, password)
    assert not (tmp_path / "users").exists()


@pytest.mark.skipif(os.name != "posix", reason="rights of others are those of POSIX")
def test_a_file_that_everybody_can_write_names_no_users(tmp_path: Path) -> None:
    path = tmp_path / "users"
    write_user(path, "ada", Role.OPERATOR, "good password")
    path.chmod(0o666)
    with pytest.raises(InputError, match="everybody can write it"):
        read_users(path)
    os.mkfifo(tmp_path / "fifo")
    with pytest.raises(InputError, match="is no file of users"):
        read_users(tmp_path / "fifo")


def test_a_port_that_does_not_exist_is_told() -> None:
    for port in (70000, -1):
        with pytest.raises(InputError, match="there is no port"):
            take_port("OPC UA", "127.0.0.1", port, "port").socket.close()
    with take_port("OPC UA", "127.0.0.1", 0, "port") as served:
        place = served.socket.getsockname()
        with pytest.raises(ConnectionRefusedError):  # nobody answers yet
            socket.create_connection(place, timeout=120)
        served.open()
        socket.create_connection(place, timeout=120).close()
