"""What surrounds kernels: disks that are full, folders of any name, linkers that fail, processes and threads."""

import multiprocessing
import os
from pathlib import Path
from textwrap import indent

import pytest

from tests.support.kept_kernels import RUN, Compiled, run

#: Where programs are: with the linker of the system, if there is one, and without.
PATHS = (os.environ["PATH"], "")

FULL_DISK = """
import errno
from pathlib import Path
write = Path.write_bytes
def write_half(self, content):
    write(self, content[:len(content) // 2])
    raise OSError(errno.ENOSPC, "No space left on device")
Path.write_bytes = write_half
"""


@pytest.mark.nightly
def test_where_a_linked_library_cannot_be_loaded_object_code_is_kept(compiled: Compiled, folder: Path) -> None:
    script = f"from trunnion.jit import build\nbuild.shared_library = lambda code: b'no library'\n{RUN}"
    first, again = run(folder, script), run(folder)

    assert not [*folder.glob("kept/*/*.so")]
    assert first[:2] == [compiled[1][0], "False False"]
    assert again == [compiled[1][0], "True True"]


@pytest.mark.nightly
def test_on_a_full_disk_kernels_run_and_leave_nothing_half_written(compiled: Compiled, folder: Path) -> None:
    found = run(folder, FULL_DISK + RUN)

    assert found[:2] == [compiled[1][0], "False False"]
    assert [line for line in found if "kept" in line] == [
        "machine code cannot be kept: [Errno 28] No space left on device",
    ] * 2
    assert {file.suffix for file in folder.glob("kept/*/*")} <= {".lock"}


@pytest.mark.nightly
@pytest.mark.parametrize("path", PATHS)
def test_a_folder_may_have_any_name(compiled: Compiled, folder: Path, path: str) -> None:
    named = str(folder / "my kernels %d 'ä' 机床")
    first, again = (run(folder, NUMBA_CACHE_DIR=named, PATH=path) for _ in range(2))

    assert first[:2] == [compiled[1][0], "False False"]
    assert again == [compiled[1][0], "True True"]


@pytest.mark.nightly
@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.parametrize("path", PATHS)
def test_processes_of_a_process_have_its_kernels(compiled: Compiled, folder: Path, method: str, path: str) -> None:
    (folder / "some_worker.py").write_text("def work(lines):\n" + indent(RUN, "    ") + "    lines.put(out.tolist())\n")
    script = f"""
import multiprocessing
import os
from some_worker import work

context = multiprocessing.get_context({method!r})
lines = context.Queue()
for _ in range(2):
    child = context.Process(target=work, args=(lines,))
    child.start()
    print(lines.get(timeout=300))
    child.join()
    print(child.exitcode)
    work(context.Queue())
"""
    found = run(folder, script, PATH=path)
    assert found.count("[1.0, -4.0, 600.0]") == 2
    assert found.count("0") == 2
    assert found.count(compiled[1][0]) == 4


@pytest.mark.nightly
def test_threads_may_compile_and_run_kernels_at_once(compiled: Compiled, folder: Path) -> None:
    script = f"""
import sys
from threading import Thread
def work():
{indent(RUN, "    ")}
# A line is one write, so that lines of two threads do not mix.
def print(*values): sys.stdout.write(" ".join(map(str, values)) + "\\n")
threads = [Thread(target=work) for _ in range(4)]
for each in threads: each.start()
for each in threads: each.join()
"""
    assert run(folder, script).count(compiled[1][0]) == 4
