"""Files that appear together or not at all: links, devices, pipes, streams, full disks, and Ctrl-C at any moment."""

import errno
import io
import os
import signal
import sys
import threading
from contextlib import AbstractContextManager, nullcontext, suppress
from itertools import count
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

import trunnion.files.output
from trunnion.errors import InputError
from trunnion.files import OutputFiles, atomic_file, atomic_output, check_stream, output_group, resolve_output
from trunnion.files.interrupts import held_interrupts
from trunnion.files.streams import send

needs_pipes = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs pipes with names")


def fill(files: OutputFiles, text: bytes = b"new", *subprograms: str) -> None:
    files.main.write(text)
    for name in subprograms:
        files.add_file(name).write(text)


def write(target: Any, text: bytes, *subprograms: str, fail: BaseException | None = None, **given: Any) -> None:
    """Write a program, its subprograms and its report, or fail before the end."""
    with atomic_output(target, **given) as files:
        fill(files, text, *subprograms)
        for paper in given.get("papers", ()):
            files.add_paper(paper).write(text)
        if fail is not None:
            raise fail


def contents(folder: Path) -> dict[str, bytes]:
    """Everything in a folder, hidden or not."""
    return {path.name: path.read_bytes() if path.is_file() else b"" for path in folder.iterdir()}


def test_a_link_is_written_through(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    target, link = tmp_path / "real" / "p.mpf", tmp_path / "p.mpf"
    target.write_bytes(b"old")
    target.chmod(0o640)
    link.symlink_to(target)
    with atomic_output(str(link)) as files:
        fill(files, b"new", "A.SPF")
    assert link.is_symlink()
    assert contents(tmp_path / "real") == {"p.mpf": b"new"}
    assert sys.platform == "win32" or target.stat().st_mode & 0o777 == 0o640
    assert contents(tmp_path) == {"p.mpf": b"new", "A.SPF": b"new", "real": b""}, "subprograms are beside the link"


def test_a_subprogram_is_written_through_its_link_and_never_to_a_file_that_is_read(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    (tmp_path / "real" / "a").write_bytes(b"old")
    (tmp_path / "A.SPF").symlink_to(tmp_path / "real" / "a")
    with atomic_output(str(tmp_path / "p.mpf")) as files:
        fill(files, b"new", "A.SPF")
    assert (tmp_path / "A.SPF").is_symlink()
    assert contents(tmp_path / "real") == {"a": b"new"}
    with pytest.raises(InputError, match=r"A\.SPF: error: would be written over, although"):
        write(str(tmp_path / "p.mpf"), b"newer", "A.SPF", inputs=[tmp_path / "real" / "a"])
    with (
        atomic_output(str(tmp_path / "p.mpf")) as files,
        pytest.raises(InputError, match=r"p\.mpf: error: would be written over, although"),
    ):
        files.protect([tmp_path / "p.mpf"])
    (tmp_path / "p.mpf").write_bytes(b"new")
    assert contents(tmp_path / "real") == {"a": b"new"}
    assert (tmp_path / "p.mpf").read_bytes() == b"new"


def test_a_report_appears_with_its_program(tmp_path: Path) -> None:
    (tmp_path / "reports").mkdir()
    program, report = tmp_path / "p.mpf", resolve_output(tmp_path / "reports" / "r.html")
    for text in (b"one", b"two"):
        with atomic_output(str(program), papers=[report]) as files:
            fill(files, text)
            files.add_paper(report).write(text)
            assert not report.path.exists() or report.path.read_bytes() != text
        assert (program.read_bytes(), contents(tmp_path / "reports")) == (text, {"r.html": text})
    with pytest.raises(InputError, match="would be written twice"), atomic_output(str(report.path), papers=[report]):
        pass
    stream = io.BytesIO()
    with atomic_output(stream, papers=[report]) as files:
        fill(files, b"three")
        files.add_paper(report).write(b"three")
    assert (stream.getvalue(), contents(tmp_path / "reports")) == (b"three", {"r.html": b"three"})


@needs_pipes
def test_a_pipe_takes_the_program_as_a_stream_and_stays(tmp_path: Path) -> None:
    pipe = tmp_path / "p.mpf"
    os.mkfifo(pipe)
    taken: list[bytes] = []
    reader = threading.Thread(target=lambda: taken.append(pipe.read_bytes()))
    reader.start()
    with atomic_output(str(pipe)) as files:
        fill(files, b"x" * 300_000)
    reader.join()
    assert taken == [b"x" * 300_000]
    assert pipe.is_fifo()
    assert list(tmp_path.iterdir()) == [pipe]


@needs_pipes
def test_nothing_is_sent_into_a_pipe_if_the_work_fails(tmp_path: Path) -> None:
    pipe = tmp_path / "p.mpf"
    os.mkfifo(pipe)
    taken: list[bytes] = []
    reader = threading.Thread(target=lambda: taken.append(pipe.read_bytes()))
    reader.start()
    with pytest.raises(RuntimeError):
        write(str(pipe), b"new", fail=RuntimeError())
    reader.join()
    assert taken == [b""]


@needs_pipes
def test_no_subprogram_goes_into_a_pipe(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "A.SPF")
    with (
        pytest.raises(InputError, match="to a device"),
        atomic_output(str(tmp_path / "p.mpf")) as files,
    ):
        fill(files, b"", "A.SPF")
    assert [path.name for path in tmp_path.iterdir()] == ["A.SPF"]


@pytest.mark.parametrize("minor", [3, 7])
def test_a_device_is_written_into_and_stays(minor: int, tmp_path: Path) -> None:
    """A node like that of /dev/null (3), and one like that of /dev/full (7)."""
    node = tmp_path / "node"
    try:
        os.mknod(node, 0o600 | 0o020000, os.makedev(1, minor))
        node.open("r+b").close()
    except (OSError, AttributeError):
        pytest.skip("no device can be made here")
    full: AbstractContextManager[Any] = suppress(InputError) if minor == 7 else nullcontext()
    with full:
        write(str(node), b"new")
    assert node.is_char_device()
    assert list(tmp_path.iterdir()) == [node]


def test_a_stream_that_is_full_is_named() -> None:
    class Full(io.BytesIO):
        name = "disk"

        def write(self, data: Any, /) -> int:
            if data:
                raise OSError(errno.ENOSPC, "No space left on device")
            return 0

    with pytest.raises(InputError, match="disk: error: cannot be written: No space left"), atomic_output(Full()) as f:
        fill(f)


def test_a_reader_that_has_gone_away_stays_a_broken_pipe() -> None:
    class Gone(io.BytesIO):
        def write(self, data: Any, /) -> int:
            raise BrokenPipeError(errno.EPIPE, "Broken pipe")

    with pytest.raises(BrokenPipeError), atomic_output(Gone()) as files:
        fill(files)


def test_a_stream_may_take_a_little_at_a_time() -> None:
    class Slow(io.RawIOBase):
        taken = b""

        def writable(self) -> bool:
            return True

        def write(self, data: Any, /) -> int:
            self.taken += bytes(data[:1000])
            return min(len(data), 1000)

    class Deaf(Slow):
        def write(self, data: Any, /) -> None:  # type: ignore[override]
            return None

    slow = Slow()
    send(io.BytesIO(b"x" * 12_345), slow)  # type: ignore[arg-type]
    assert slow.taken == b"x" * 12_345
    with pytest.raises(BlockingIOError, match="takes no more"):
        send(io.BytesIO(b"x"), Deaf())  # type: ignore[arg-type]


class ReadOnly(io.BytesIO):
    """A stream that can be read, but not written."""

    def write(self, data: Any, /) -> int:
        raise io.UnsupportedOperation("write")


def closed() -> io.BytesIO:
    stream = io.BytesIO()
    stream.close()
    return stream


@pytest.mark.parametrize(
    ("stream", "what"),
    [
        (io.StringIO(), "takes text"),
        (io.TextIOWrapper(io.BytesIO()), "takes text"),
        (closed(), "closed file"),
        (7, "is no file and no stream"),
        (b"p.mpf", "is no file and no stream"),
        (ReadOnly(), "cannot be written"),
    ],
)
def test_what_takes_no_bytes_is_an_input_error(stream: object, what: str) -> None:
    with pytest.raises(InputError, match=what) as refused:
        check_stream(stream, "output")
    assert refused.value.problems[0].cure


# Errors of the output, and of other things


def test_an_error_of_something_else_is_not_blamed_on_the_output(tmp_path: Path) -> None:
    error = OSError(errno.EROFS, "Read-only file system: the cache")
    with pytest.raises(OSError, match="the cache"):
        write(str(tmp_path / "p.mpf"), b"new", fail=error)
    assert contents(tmp_path) == {}


@pytest.mark.skipif(sys.platform == "win32", reason="limits of a process are set otherwise there")
def test_a_full_disk_is_an_error_of_the_output_whoever_writes(tmp_path: Path) -> None:
    import resource

    target = tmp_path / "p.mpf"
    target.write_bytes(b"old")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, before[1]))
    try:
        for size in (1_000_000, 100_001):
            with pytest.raises(InputError, match=r"p\.mpf: error: cannot be written: File too large"):
                write(str(target), b"x" * size)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
        signal.signal(signal.SIGXFSZ, ignored)
    assert contents(tmp_path) == {"p.mpf": b"old"}


def test_where_folders_are_on_other_disks_files_are_copied_beside_their_places(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever is moved is moved within one folder, or from a hidden folder right below it."""
    moved: list[tuple[Path, Path]] = []
    replace = Path.replace

    def spy(self: Path, target: Path) -> Path:
        if ".trunnion" not in Path(target).name:
            moved.append((self, Path(target)))
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", spy)
    (tmp_path / "other").mkdir()
    report = resolve_output(tmp_path / "other" / "r.json")
    for _ in range(2):
        with atomic_output(str(tmp_path / "p.mpf"), papers=[report]) as files:
            fill(files, b"new", "A.SPF")
            files.add_paper(report).write(b"new")
    assert len(moved) == 6
    for source, target in moved:
        assert source.parent in target.parents or target.parent in source.parents


# Ctrl-C


class Interrupting:
    """Traces, and sends Ctrl-C at the n-th line that is executed in some modules."""

    def __init__(self, line: int, modules: tuple[str, ...]) -> None:
        self._left, self._modules = line, modules

    @property
    def came(self) -> bool:
        return self._left <= 0

    def __call__(self, frame: FrameType, event: str, _: Any) -> Any:
        if frame.f_code.co_filename not in self._modules:
            return None
        if event == "line":
            self._left -= 1
            if self._left == 0:
                signal.raise_signal(signal.SIGINT)
        return self


NAMES = ("A.SPF", "B.SPF", "p.mpf", "reports/r.html")


def write_interrupted(line: int, folder: Path) -> bool:
    """Write a program over an older one, with Ctrl-C at some line; whether that line was reached."""
    (folder / "reports").mkdir(parents=True)
    for name in NAMES[1:]:
        (folder / name).write_bytes(b"old")
    report = resolve_output(folder / "reports" / "r.html")
    modules = ("output", "hidden_folders", "interrupts", "journal", "locks", "moves", "streams")
    here = Path(trunnion.files.output.__file__)
    interrupting = Interrupting(line, tuple(str(here.with_name(f"{name}.py")) for name in modules))
    tracer = sys.gettrace()
    sys.settrace(interrupting)
    try:
        with atomic_output(str(folder / "p.mpf"), papers=[report]) as files:
            fill(files, b"new", "A.SPF", "B.SPF")
            files.start_sync()
            files.add_paper(report).write(b"new")
    except KeyboardInterrupt:
        assert interrupting.came
    finally:
        sys.settrace(tracer)
    return interrupting.came


@pytest.mark.nightly  # test_stopped_jobs stops a job at any operation in each run
def test_ctrl_c_at_any_line_leaves_everything_old_or_everything_new(tmp_path: Path) -> None:
    handler, threads = signal.getsignal(signal.SIGINT), threading.active_count()
    old, new = dict.fromkeys(NAMES[1:], b"old"), dict.fromkeys(NAMES, b"new")
    outcomes = []
    for line in count(1):
        folder = tmp_path / str(line)
        came = write_interrupted(line, folder)
        assert signal.getsignal(signal.SIGINT) is handler
        assert threading.active_count() == threads
        left = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        assert left in (old, new), line
        assert sum(1 for path in folder.rglob("*") if path.is_dir()) == 1, f"hidden folders at {line}"
        outcomes.append(left == new)
        if not came:
            break
    assert outcomes[-1]
    assert outcomes == sorted(outcomes), "from some line on the new files are there"
    assert 0 < outcomes.count(True) < outcomes.count(False)


def test_interruptions_wait_for_the_end_of_the_block_and_come_then() -> None:
    handler = signal.getsignal(signal.SIGINT)
    done: list[bool] = []

    def work() -> None:
        for _ in range(2):
            signal.raise_signal(signal.SIGINT)
        done.append(True)

    with pytest.raises(KeyboardInterrupt), held_interrupts():
        work()
    assert done
    assert signal.getsignal(signal.SIGINT) is handler


def test_a_failing_move_is_undone_whatever_it_fails_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "A.SPF").write_bytes(b"old")
    (tmp_path / "p.mpf").write_bytes(b"old")
    report = resolve_output(tmp_path / "r.html")
    replace = Path.replace
    for error in (KeyboardInterrupt(), MemoryError(), OSError(errno.EIO, "Input/output error")):
        for stopping in ("A.SPF", "B.SPF", "p.mpf", "r.html"):
            report.path.write_bytes(b"old")

            def fail(self: Path, target: Path, error: BaseException = error, stopping: str = stopping) -> Path:
                if Path(target).name == stopping and self.parent.name != ".earlier":
                    raise error
                return replace(self, target)

            with monkeypatch.context() as patch:
                patch.setattr(Path, "replace", fail)
                expected = InputError if isinstance(error, OSError) else type(error)
                with pytest.raises(expected):
                    write(str(tmp_path / "p.mpf"), b"new", "A.SPF", "B.SPF", papers=[report])
            assert contents(tmp_path) == dict.fromkeys(("A.SPF", "p.mpf", "r.html"), b"old")


def test_a_single_file_is_whole_or_not_there(tmp_path: Path) -> None:
    with atomic_file(str(tmp_path / "r.json")) as sink:
        sink.write(b"whole")
        sink.flush()
        assert Path(sink.name).read_bytes() == b"whole"
    assert contents(tmp_path) == {"r.json": b"whole"}


# Several jobs together


def group_of_two(folder: Path, *, second: str = "b/two.mpf", fail: BaseException | None = None) -> None:
    """Write two jobs, the first with a subprogram and a report, or fail after the second."""
    with output_group(remembers=False) as group:
        report = resolve_output(folder / "one.html")
        with group.open(resolve_output(folder / "a" / "one.mpf"), papers=[report]) as files:
            fill(files, b"one", "SUB.SPF")
            files.add_paper(report).write(b"report")
        assert contents(folder / "a").get("one.mpf") in (None, b"old"), "nothing appears before all of it does"
        with group.open(resolve_output(folder / second)) as files:
            fill(files, b"two")
            if fail is not None:
                raise fail


@pytest.fixture
def two_folders(tmp_path: Path) -> Path:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / ("one.mpf" if name == "a" else "two.mpf")).write_bytes(b"old")
    return tmp_path


def test_jobs_of_a_group_appear_together(two_folders: Path) -> None:
    group_of_two(two_folders)
    assert contents(two_folders / "a") == {"one.mpf": b"one", "SUB.SPF": b"one"}
    assert contents(two_folders / "b") == {"two.mpf": b"two"}
    assert contents(two_folders) == {"a": b"", "b": b"", "one.html": b"report"}


@pytest.mark.parametrize("fail", [InputError(()), KeyboardInterrupt(), OSError(5, "disk")])
def test_of_a_group_that_fails_nothing_appears(two_folders: Path, fail: BaseException) -> None:
    with pytest.raises(type(fail)):
        group_of_two(two_folders, fail=fail)
    assert contents(two_folders / "a") == {"one.mpf": b"old"}
    assert contents(two_folders / "b") == {"two.mpf": b"old"}
    assert not (two_folders / "one.html").exists()


def test_a_group_that_cannot_take_one_of_its_places_takes_none(
    two_folders: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    replace = Path.replace

    def failing(self: Path, target: str | os.PathLike[str]) -> Path:
        if Path(target).name == "two.mpf" and self.name == "two.mpf":
            raise OSError(errno.ENOSPC, "No space left on device")
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", failing)
    with pytest.raises(InputError, match=r"two\.mpf: error: cannot be written: No space left"):
        group_of_two(two_folders)
    assert contents(two_folders / "a") == {"one.mpf": b"old"}
    assert contents(two_folders / "b") == {"two.mpf": b"old"}
    assert not (two_folders / "one.html").exists()


@pytest.mark.parametrize("second", ["a/one.mpf", "a/SUB.SPF", "one.html"])
def test_jobs_of_a_group_do_not_write_the_same_file(two_folders: Path, second: str) -> None:
    with pytest.raises(InputError, match="would be written twice"):
        group_of_two(two_folders, second=second)


@needs_pipes
def test_a_device_takes_no_part_in_a_group(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with (
        output_group() as group,
        pytest.raises(InputError, match="is a device"),
        group.open(resolve_output(tmp_path / "pipe")),
    ):
        raise AssertionError
