"""Machine code that a wheel brings: made for all systems here, loaded where its sources are the same."""

import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.locations import ROOT
from trunnion.jit.wheel_libraries import SYSTEMS, System, make_libraries

#: A room with a single small kernel.
KERNELS = "trunnion.output.blocks"
HERE = {
    ("linux", "x86_64"): "manylinux_2_17_x86_64",
    ("linux", "aarch64"): "manylinux_2_17_aarch64",
    ("win32", "AMD64"): "win_amd64",
    ("darwin", "x86_64"): "macosx_13_0_x86_64",
    ("darwin", "arm64"): "macosx_13_0_arm64",
}[sys.platform, platform.machine()]

#: How a library of a system begins, and what of its processor stands there: ELF, PE and Mach-O.
FORMATS = {
    "manylinux_2_17_x86_64": (b"\x7fELF", b"\x3e\x00"),
    "manylinux_2_17_aarch64": (b"\x7fELF", b"\xb7\x00"),
    "win_amd64": (b"MZ", b"PE\x00\x00\x64\x86"),
    "macosx_13_0_x86_64": (b"\xcf\xfa\xed\xfe", b"\x07\x00\x00\x01"),
    "macosx_13_0_arm64": (b"\xcf\xfa\xed\xfe", b"\x0c\x00\x00\x01"),
}

ASK = """
import sys
from trunnion.jit.ahead import all_kernels, is_first_run
from trunnion.jit.shipped import shipped_library
found = [each.shipped is not None for each in all_kernels("output/blocks")]
print(shipped_library() is not None, is_first_run(), found)
print(*sorted({"numba", "llvmlite"} & sys.modules.keys()))
"""


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the package with machine code for this system; tests that change it change it back."""
    folder = tmp_path_factory.mktemp("made")
    command = [sys.executable, "-m", "trunnion.jit.wheel_libraries", str(folder / "libraries"), KERNELS, HERE]
    subprocess.run(command, check=True)
    shutil.copytree(ROOT / "src" / "trunnion", folder / "trunnion", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copytree(folder / "libraries" / HERE, folder / "trunnion" / "jit" / "shipped")
    return folder


def _ask(folder: Path) -> list[str]:
    environment = {**os.environ, "PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", ASK], check=True, cwd=folder, env=environment, encoding="utf-8", stdout=subprocess.PIPE
    )
    return done.stdout.splitlines()


def test_machine_code_of_the_same_sources_is_loaded(made: Path) -> None:
    assert _ask(made) == ["True False [True]", ""]


def test_machine_code_of_other_sources_is_not_loaded(made: Path) -> None:
    changed = made / "trunnion" / "output" / "blocks" / "block_kernel.py"
    before = changed.read_bytes()
    changed.write_bytes(before + b"\n")
    try:
        assert _ask(made) == ["True False [False]", ""]
    finally:
        changed.write_bytes(before)


def test_without_a_base_library_nothing_is_loaded(made: Path) -> None:
    shipped = made / "trunnion" / "jit" / "shipped"
    (base,) = shipped.glob("kernels-base.*")
    away = base.rename(made / base.name)
    try:
        assert _ask(made) == ["False True [False]", ""]
    finally:
        away.rename(base)


@pytest.mark.nightly
@pytest.mark.parametrize("tag", sorted(SYSTEMS))
def test_libraries_for_every_system_are_made_on_any(tag: str, tmp_path: Path) -> None:
    make_libraries(tmp_path, [tag], KERNELS)
    system: System = SYSTEMS[tag]
    names = {f"kernels-{level}{system.suffix}" for level in ("base", *system.levels)}
    assert {each.name for each in (tmp_path / tag).iterdir()} == names
    begin, processor = FORMATS[tag]
    for name in names:
        content = (tmp_path / tag / name).read_bytes()
        assert content.startswith(begin)
        assert processor in content[:512]
        assert (b"trunnion_level" if "base" in name else b"trunnion_") in content, "its function is found by this name"
