"""Where compiled kernels are kept.

Numba keeps machine code by the file of each kernel, and does not notice when another file, whose functions the kernel
calls, has changed: after an update that touched only ``machine/inverse.py`` the planner would go on with the old
kinematics. So the code is kept in a folder named for what all files with kernels hold.
"""

import hashlib
import os
import shutil
from pathlib import Path

_PREFIX = "kernels-"


def keep_kernels(package: Path) -> None:
    """Tell Numba, before it is imported, where to keep the package's machine code; throw away what is out of date.

    Does nothing when the user has chosen a place (``NUMBA_CACHE_DIR``). A package that cannot be written to has its
    kernels in the user's own folder.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    folder = package / "__pycache__" if os.access(package, os.W_OK) else _users_folder()
    here = folder / f"{_PREFIX}{_state(package)}"
    if not here.exists():
        for old in folder.glob(f"{_PREFIX}*"):
            shutil.rmtree(old, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = str(here)


def _state(package: Path) -> str:
    """A short name for what the files with kernels hold now."""
    digest = hashlib.sha256(str(package).encode())
    for file in sorted(package.rglob("*.py")):
        source = file.read_bytes()
        if b"njit" in source:
            digest.update(source)
    return digest.hexdigest()[:16]


def _users_folder() -> Path:
    local = os.environ.get("LOCALAPPDATA")
    return (Path(local) if local else Path.home() / ".cache") / "trunnion"
