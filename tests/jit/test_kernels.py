"""Kernels: kept machine code does what it did when it was compiled, and belongs to one state of the sources."""

import hashlib
import os
import subprocess
import sys
from importlib.util import spec_from_file_location
from pathlib import Path
from shutil import which

import pytest

from tests.support.kept_kernels import INNER, RUN, WHAT_IS_IMPORTED, Compiled, machine_code, run
from tests.support.locations import ROOT
from trunnion.files.dead_jobs import remove_temporary_folders
from trunnion.jit import store


def test_what_is_loaded_is_what_was_compiled(compiled: Compiled, kept: Path) -> None:
    modules, first = compiled
    loaded = run(kept, modules=modules)

    assert first[0] == loaded[0] == "[1.0, -4.0, 600.0] [90.5, 88.0, 30.0]"
    assert first[1] == "False False"
    assert loaded[1:] == ["True True"]
    assert [line for line in first if line.startswith("compiling")] == [
        "compiling kernels for this computer, once; this takes some seconds (trunnion prepare compiles all at once)",
    ]


@pytest.mark.skipif(which("cc") is None, reason="needs a linker")
def test_what_a_linker_made_is_loaded_without_numba_and_llvm(compiled: Compiled, kept: Path) -> None:
    assert len(list(kept.glob("kept/*/*.so"))) == 2
    assert run(kept, RUN + WHAT_IS_IMPORTED, modules=compiled[0])[1:] == ["True True", ""]


@pytest.mark.nightly
def test_without_a_linker_llvm_loads_what_was_compiled(compiled: Compiled, folder: Path) -> None:
    first, again = (run(folder, RUN + WHAT_IS_IMPORTED, PATH="") for _ in range(2))

    assert len(list(folder.glob("kept/*/*.o"))) == 2
    assert first[0] == again[0] == compiled[1][0]
    assert again[1:] == ["True True", "llvmlite"]


@pytest.mark.nightly
@pytest.mark.parametrize("why", ["build.TRIED = ()", "build.library.is_as_expected = lambda: False"])
def test_where_no_library_is_known_to_be_right_numba_runs_the_kernels(
    compiled: Compiled, folder: Path, why: str
) -> None:
    script = f"from trunnion.jit import build\n{why}\n{RUN}"
    first, again = (run(folder, script) for _ in range(2))

    assert not [*folder.glob("kept/*/*.so"), *folder.glob("kept/*/*.o")]
    assert first[:2] == again[:2] == [compiled[1][0], "False False"]


@pytest.mark.parametrize(
    ("old", "new", "result"),
    [
        ("FACTOR = 2.0", "FACTOR = 3.0", "[1.5, -6.0, 900.0] [90.5, 88.0, 30.0]"),
        ("FACTOR * value", "-FACTOR * value", "[-1.0, 4.0, -600.0] [90.5, 88.0, 30.0]"),
    ],
)
def test_a_change_in_another_file_renews_the_kernels_that_it_reaches_and_no_others(
    compiled: Compiled, kept: Path, old: str, new: str, result: str
) -> None:
    assert old in INNER
    (kept / "some_inner.py").write_text(INNER.replace(old, new), encoding="utf-8")  # is imported before the other

    assert run(kept, modules=compiled[0])[:2] == [result, "False True"]
    assert len(list(kept.glob("kept/*/double-*.sum"))) == 1  # the old one is gone


def test_a_damaged_file_is_noticed_and_compiled_anew(compiled: Compiled, kept: Path) -> None:
    modules, first = compiled
    double, fold = (machine_code(kept, name) for name in ("double", "fold"))
    code = bytearray(double.read_bytes())
    code[len(code) // 2] ^= 1
    double.write_bytes(code)
    fold.write_bytes(fold.read_bytes()[:50])
    damaged = run(kept, modules=modules)

    assert damaged[:2] == [first[0], "False False"]
    assert [line for line in damaged if "damaged" in line] == [
        "some machine code was damaged on disk and is compiled anew"
    ] * 2
    assert run(kept, modules=modules)[1:] == ["True True"]


def test_what_cannot_be_loaded_is_compiled_anew(compiled: Compiled, kept: Path) -> None:
    file = machine_code(kept, "double")
    file.write_bytes(b"no machine code")
    checksum = hashlib.sha256(b"no machine code").hexdigest()
    file.with_suffix(".sum").write_text(f"{file.name} {checksum}", encoding="ascii")
    found = run(kept, modules=compiled[0])

    assert found[1] == "False True"
    assert "some machine code cannot be loaded and is compiled anew" in found[2]


def test_what_a_process_left_unfinished_is_compiled_again_without_a_word_about_damage(
    compiled: Compiled, kept: Path
) -> None:
    machine_code(kept, "double").with_suffix(".sum").unlink()
    found = run(kept, modules=compiled[0])

    assert found[1] == "False True"
    assert not [line for line in found if "damaged" in line]


@pytest.mark.nightly
def test_a_second_process_compiles_from_the_back(folder: Path) -> None:
    modules = (folder / "some_kernels.py").read_text(encoding="utf-8")
    third = modules[modules.index('@kernel(writes="out")\ndef fold') :].replace("def fold", "def fold_again")
    (folder / "some_kernels.py").write_text(modules + "\n\n" + third, encoding="utf-8")
    script = """
import sys, warnings
warnings.simplefilter("error", ResourceWarning)
sys.unraisablehook = lambda told: print("a process is forgotten:", told.exc_value)
import some_kernels as k
from trunnion.jit import compile_ahead
compile_ahead([k.double, k.fold, k.fold_again])
import time
until = time.monotonic() + 600
while not (k.fold_again.is_kept and k.fold.is_kept and k.double.is_kept) and time.monotonic() < until:
    time.sleep(0.02)
compile_ahead([k.double, k.fold, k.fold_again])
"""
    done = run(folder, script + RUN.replace("print(double.", "print(k.fold_again.is_kept, double."))

    assert done == [
        "[1.0, -4.0, 600.0] [90.5, 88.0, 30.0]",
        "True True True",
        "compiling 3 kernels for this computer, once; this takes some seconds (trunnion prepare compiles all at once)",
    ]


@pytest.mark.nightly
def test_processes_that_need_the_same_kernel_wait_for_the_one_that_compiles_it(folder: Path) -> None:
    path = os.pathsep.join((str(folder), str(ROOT / "src")))
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kept"), "PYTHONPATH": path}
    started = [
        subprocess.Popen([sys.executable, "-c", RUN], env=environment, stdout=subprocess.PIPE, text=True)
        for _ in range(3)
    ]
    printed = [process.communicate()[0].splitlines() for process in started]

    assert {lines[0] for lines in printed} == {"[1.0, -4.0, 600.0] [90.5, 88.0, 30.0]"}
    for k in range(2):
        assert sum(lines[1].split()[k] == "False" for lines in printed) == 1


@pytest.mark.parametrize("text", ["", "5", "../lock 1", "\0 \0", "double-6b3a55-0123456789abcdef.so 5", "ä"])
def test_a_checksum_that_is_none_makes_a_kernel_incomplete(tmp_path: Path, text: str) -> None:
    kept = store.Store(tmp_path, "some_kernels.double", "0123456789abcdef")
    file = kept.keep(b"code", is_linked=True)
    assert kept.whole() == file
    file.with_suffix(".sum").write_text(text, encoding="utf-8")

    assert store.Store(tmp_path, "some_kernels.double", "0123456789abcdef").whole() is None


def test_another_version_of_numba_and_another_processor_have_folders_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "numba").mkdir()
    (tmp_path / "numba" / "__init__.py").touch()
    monkeypatch.setattr(store, "find_spec", lambda name: spec_from_file_location(name, tmp_path / name / "__init__.py"))
    found = [store._made_for()]
    for make in (
        (tmp_path / "numba-0.68.1.dist-info").mkdir,
        (tmp_path / "llvmlite-0.50.0.dist-info").mkdir,
        lambda: (tmp_path / "numba-0.68.1.dist-info").rename(tmp_path / "numba-0.68.2.dist-info"),
        lambda: monkeypatch.setattr(store, "_processor", lambda: "flags: another"),
    ):
        make()
        found.append(store._made_for())

    assert len(set(found)) == 5
    assert found[-1] == store._made_for()


@pytest.mark.skipif(sys.platform == "win32" or os.getuid() != 0, reason="makes the folder of another user")
def test_the_folder_of_another_user_is_passed_over_in_silence(folder: Path) -> None:
    anothers, own = folder / "anothers", folder / "own"
    anothers.mkdir(mode=0o755)
    os.chown(anothers, 12345, 12345)
    script = f"""
from pathlib import Path
from trunnion.jit import store
store._candidates = lambda: iter([Path({str(anothers)!r}), Path({str(own)!r})])
print(store.cache_folder())
"""
    assert run(folder, script) == [str(own)]


@pytest.mark.nightly
def test_without_a_folder_that_can_be_written_to_kernels_are_compiled_and_it_is_said_once(folder: Path) -> None:
    nowhere = folder / "some_inner.py" / "below"
    script = f"""
from pathlib import Path
from trunnion.jit import store
store._candidates = lambda: iter([Path({str(nowhere)!r})])
"""
    found = run(folder, script + RUN)

    assert found[:2] == ["[1.0, -4.0, 600.0] [90.5, 88.0, 30.0]", "False False"]
    assert len([line for line in found if "no folder can be written to" in line]) == 1


def test_the_user_chooses_the_folder_and_the_next_best_is_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "file"
    file.write_text("", encoding="utf-8")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "mine"))
    candidates = list(store._candidates())

    assert candidates[0].parent == tmp_path / "mine"
    monkeypatch.setattr(store, "_candidates", lambda: iter([file / "below", tmp_path / "next"]))
    assert store.cache_folder.__wrapped__() == tmp_path / "next"


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="temporary folders are the user's own there")
def test_machine_code_is_not_taken_from_a_folder_that_others_can_write_to(tmp_path: Path) -> None:
    open_to_all = tmp_path / "open"
    open_to_all.mkdir()
    open_to_all.chmod(0o777)
    (tmp_path / "link").symlink_to(tmp_path)
    (tmp_path / "common").mkdir(mode=0o700)
    (tmp_path / "common").chmod(0o770)

    assert store._is_private(tmp_path / "own")
    assert not store._is_private(tmp_path / "common")
    assert not store._is_private(open_to_all)
    assert not store._is_private(tmp_path / "link")


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="temporary folders are the user's own there")
def test_nor_from_such_a_folder_that_the_user_chose(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    chosen = tmp_path / "chosen"
    chosen.mkdir()
    chosen.chmod(0o777)
    monkeypatch.setattr(store, "_candidates", lambda: iter([chosen, tmp_path / "next"]))

    assert store.cache_folder.__wrapped__() == tmp_path / "next"


def test_without_a_temporary_folder_there_is_one_candidate_less(monkeypatch: pytest.MonkeyPatch) -> None:
    """A disk that takes no file has none, and a program can be verified there nevertheless."""
    before = list(store._candidates())

    def nowhere() -> str:
        raise FileNotFoundError(2, "No usable temporary directory found")

    monkeypatch.setattr("tempfile.gettempdir", nowhere)
    assert list(store._candidates()) == before[:-1]
    remove_temporary_folders()


def test_a_home_that_does_not_exist_is_not_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("HOME", "USERPROFILE", "LOCALAPPDATA"):
        monkeypatch.setenv(name, str(tmp_path / "nowhere"))

    assert not [folder for folder in store._candidates() if tmp_path in folder.parents]


def test_an_argument_of_another_type_is_refused(folder: Path) -> None:
    script = """
import numpy as np
from some_kernels import double
try:
    double(np.zeros(2, np.int64), np.zeros(2))
except TypeError as error:
    print("refused")
"""
    assert run(folder, script)[0] == "refused"


def test_without_compiling_a_kernel_is_the_function_itself(folder: Path) -> None:
    script = "import some_kernels\nprint(type(some_kernels.double))"

    assert run(folder, script, NUMBA_DISABLE_JIT="1") == ["<class 'function'>"]


def test_importing_the_package_leaves_the_environment_alone() -> None:
    script = "import os; before = dict(os.environ); import trunnion; print(before == dict(os.environ))"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)

    assert done.stdout == "True\n"
