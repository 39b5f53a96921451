"""Names of hidden folders: each carries a seal, by which it is known as one of Trunnion's whatever is left in it.

A power failure may leave any part of what was in a folder: the name alone tells then that nobody else has made it.
"""

import hashlib
import os
import re
from typing import Final

#: How the names of temporary folders begin.
TEMPORARY: Final = "trunnion-"

_NAME: Final = re.compile(rf"(?P<all>(\..+\.|{TEMPORARY})[0-9a-f]{{6}})(?P<seal>[0-9a-f]{{6}})", re.DOTALL)


def hidden_name(prefix: str) -> str:
    """Return a name that no other folder has: the prefix, six random digits, and the seal of both.

    prefix  what it begins with: a point, the beginning of a file's name, and a point; or ``TEMPORARY``
    """
    name = f"{prefix}{os.urandom(3).hex()}"
    return f"{name}{_seal(name)}"


def is_hidden_name(name: str) -> bool:
    """Whether a folder of this name may be one of a job; those of earlier versions have no seal."""
    return _NAME.fullmatch(name) is not None


def is_sealed(name: str) -> bool:
    """Whether a name was made by ``hidden_name``."""
    found = _NAME.fullmatch(name)
    return found is not None and found["seal"] == _seal(found["all"])


def _seal(text: str) -> str:
    return hashlib.sha256(os.fsencode(text)).hexdigest()[:6]
