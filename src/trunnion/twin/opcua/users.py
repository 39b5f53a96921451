"""Users of a twin that other computers can reach: a file of names, roles and hashed passwords.

One user a line: ``name:role:scrypt:N:r:p:salt:hash``, salt and hash as base64. Lines that begin with # are comments.
"""

import base64
import binascii
import hashlib
import hmac
import os
import re
import secrets
import time
from collections import deque
from collections.abc import Callable
from enum import StrEnum
from pathlib import Path
from typing import Final

from trunnion.errors import InputError, Problem
from trunnion.messages import Wording
from trunnion.records import dataclass

#: Cost of a hash: some 50 ms and 16 MB.
_COST: Final = {"n": 2**14, "r": 8, "p": 1}
_MEMORY: Final = 64 * 1024 * 1024

#: Wrong passwords within so many seconds, after which all are refused for a while.
_MOST_WRONG: Final = 10
_WRONG_SECONDS: Final = 30.0

_NAME: Final = re.compile(r"[A-Za-z0-9_.@-]{1,64}")

#: The right of all others to write a POSIX file.
_WRITE_OF_OTHERS: Final = 0o002


class Role(StrEnum):
    """What a user may do: read, or operate the twin as well."""

    VIEWER = "viewer"
    OPERATOR = "operator"


@dataclass(frozen=True, slots=True)
class StoredUser:
    """A line of the file."""

    name: str
    role: Role
    cost: tuple[int, int, int]
    salt: bytes
    hash: bytes


class Users:
    """The users of a file, and what they may do."""

    def __init__(self, users: dict[str, StoredUser], clock: Callable[[], float] = time.monotonic) -> None:
        self._users, self._clock = users, clock
        self._wrong: deque[float] = deque(maxlen=_MOST_WRONG)
        self._nobody = _hashed("", Role.VIEWER, secrets.token_urlsafe())

    def __len__(self) -> int:
        return len(self._users)

    def role_of(self, name: str, password: str) -> Role | None:
        """Return the role of a user who knows the password; None: there is none, or too many tried wrong ones
        just now.
        """
        now = self._clock()
        if len(self._wrong) == _MOST_WRONG and now - self._wrong[0] < _WRONG_SECONDS:
            return None
        user = self._users.get(name)
        # An unknown name takes as long as a wrong password.
        checked = user or self._nobody
        is_right = hmac.compare_digest(_hash(password, checked.salt, checked.cost), checked.hash)
        if user is None or not is_right:
            self._wrong.append(now)
            return None
        return user.role


def read_users(path: Path) -> Users:
    """Read a file of users.

    Raises
    ------
    InputError
        If it cannot be read, or a line of it is none of a user; all mistakes at once.
    """
    return Users({user.name: user for user in _read(path)})


def write_user(path: Path, name: str, role: Role, password: str) -> None:
    """Add a user to a file, which is made if need be, or give one another password and role.

    Raises
    ------
    InputError
        If the name or the password cannot be taken, or the file cannot be written.
    """
    if not _NAME.fullmatch(name):
        raise InputError(Problem(str(path), 0, Wording("TWN130", "no_name_user", name=repr(name))))
    try:
        password.encode()
    except UnicodeEncodeError:
        raise InputError(Problem(str(path), 0, Wording("TWN130", "password_no_text"))) from None
    if len(password.strip()) < 8:
        raise InputError(Problem(str(path), 0, Wording("TWN130", "password_too_short")))
    others = [user for user in _read(path) if user.name != name] if path.exists() else []
    lines = [_line(user) for user in (*others, _hashed(name, role, password))]
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        # Only this user reads it, from the first byte on.
        beside = path.with_name(f".{path.name}.{os.getpid()}")
        descriptor = os.open(beside, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with os.fdopen(descriptor, "w", encoding="utf-8") as sink:
            sink.write("# Users of a Trunnion twin: name:role:scrypt:N:r:p:salt:hash\n" + "".join(lines))
        beside.replace(path)
    except OSError as error:
        raise InputError(Problem(str(path), 0, Wording("TWN131", "cannot_written", strerror=error.strerror))) from None


def _read(path: Path) -> list[StoredUser]:
    if path.exists() and not path.is_file():
        raise InputError(Problem(str(path), 0, Wording("TWN131", "no_file_users")))
    if os.name == "posix" and path.exists() and path.stat().st_mode & _WRITE_OF_OTHERS:
        what = "everybody can write it, and so make himself a user"
        raise InputError(Problem(str(path), 0, Wording("TWN131", "everybody_can_write")))
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        what = getattr(error, "strerror", None) or "it is no text in UTF-8"
        raise InputError(Problem(str(path), 0, Wording("TWN131", "file_users_cannot", subject=what))) from None
    users, problems = [], []
    for number, line in enumerate(text.splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        user = _parsed(line)
        if user is None:
            what = "is no user; a line is name:role:scrypt:N:r:p:salt:hash"
            problems.append(Problem(str(path), number, Wording("TWN131", "no_user_line")))
        else:
            users.append(user)
    if problems:
        raise InputError(problems)
    return users


def _parsed(line: str) -> StoredUser | None:
    parts = line.strip().split(":")
    if len(parts) != 8 or not _NAME.fullmatch(parts[0]) or parts[1] not in list(Role) or parts[2] != "scrypt":
        return None
    try:
        n, r, p = (int(part) for part in parts[3:6])
        salt, hashed = (base64.b64decode(part, validate=True) for part in parts[6:])
    except (ValueError, binascii.Error):
        return None
    is_sound = 2 <= n <= 2**17 and n & (n - 1) == 0 and 1 <= r <= 16 and 1 <= p <= 4 and 128 * n * r <= _MEMORY // 2
    return StoredUser(parts[0], Role(parts[1]), (n, r, p), salt, hashed) if is_sound and len(hashed) == 32 else None


def _line(user: StoredUser) -> str:
    salt, hashed = (base64.b64encode(part).decode() for part in (user.salt, user.hash))
    return ":".join((user.name, user.role, "scrypt", *map(str, user.cost), salt, hashed)) + "\n"


def _hashed(name: str, role: Role, password: str) -> StoredUser:
    salt, cost = secrets.token_bytes(16), (_COST["n"], _COST["r"], _COST["p"])
    return StoredUser(name, role, cost, salt, _hash(password, salt, cost))


def _hash(password: str, salt: bytes, cost: tuple[int, int, int]) -> bytes:
    n, r, p = cost
    return hashlib.scrypt(password.encode()[:1024], salt=salt, n=n, r=r, p=p, maxmem=_MEMORY, dklen=32)
