"""What every reader must do with every file: give a sound and bounded result, or refuse it with file and line."""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np

from tests.support.fuzz.seeds import SUBPROGRAMS
from trunnion.cl import ClReading, read_cl
from trunnion.errors import InputError, RefusedError, TrunnionError
from trunnion.machines import Machine, load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import Kind, Toolpath
from trunnion.readers import run_program
from trunnion.readers.program.limits import MAX_DIAGNOSTICS, MOTIONS_PER_LINE
from trunnion.readers.program.options import RunOptions

#: Blocks that loops and calls may execute.
LIMIT: Final = 1500

MACHINES: Final = ("yl569", "mikron_600u", "generic_head_head_ca")

#: Columns that hold finite numbers; the feed may be missing (NaN) but never infinite.
_FINITE: Final = ("tip", "axis", "joints", "rpm", "start")


@cache
def machine(key: str) -> Machine:
    """A shipped machine."""
    return load_machine(key)


def prepare(folder: Path) -> None:
    """Put the subprograms into a folder."""
    for name, content in SUBPROGRAMS.items():
        (folder / name).write_bytes(content)


@contextmanager
def no_warnings() -> Iterator[None]:
    """Turn warnings of NumPy into errors: they mean a wrong number that was not checked."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


#: Names of the subprograms in the tests, by family of control.
_SUBPROGRAMS: Final = {"sinumerik": "*.[SM]PF", "heidenhain": "*.H", "linuxcnc": "*.ngc", "fanuc": "*.nc"}


def beside(program: Path, family: str) -> list[Path]:
    """The other programs of its folder, which it may call."""
    pattern = _SUBPROGRAMS.get(family.split("_")[0])
    return sorted(path for path in program.parent.glob(pattern) if path != program) if pattern else []


def judge_program(
    data: bytes, folder: Path, key: str | Machine = "yl569", limit: int = LIMIT, family: str = "sinumerik_840d"
) -> Run | None:
    """Run bytes as a program in a prepared folder; None if it is refused."""
    path = folder / ("MAIN.MPF" if family == "sinumerik_840d" else "MAIN.H")
    path.write_bytes(data)
    try:
        with no_warnings():
            on = machine(key) if isinstance(key, str) else key
            run = run_program(path, on, RunOptions(subprograms=beside(path, family), step_limit=limit), family=family)
    except InputError as error:
        _check_error(error, folder)
        return None
    _check_run(run, folder, limit)
    return run


def judge_cl(data: bytes, folder: Path, *, strict: bool = False) -> Toolpath | None:
    """Read bytes as a CL file; None if it is refused."""
    path = folder / "part.cls"
    path.write_bytes(data)
    try:
        with no_warnings():
            toolpath = read_cl(path, ClReading(strict=strict))
    except (InputError, RefusedError) as error:
        _check_error(error, folder)
        return None
    _check_toolpath(toolpath, data)
    return toolpath


def judge_definition(data: bytes, folder: Path) -> Machine | None:
    """Read bytes as the definition of a machine; None if it is refused."""
    path = folder / "machine.toml"
    path.write_bytes(data)
    try:
        with no_warnings():
            return load_machine(path)
    except InputError as error:
        _check_error(error, folder)
        return None


def _check_error(error: TrunnionError, folder: Path) -> None:
    assert error.problems
    for problem in error.problems:
        assert problem.what
        path = Path(problem.file)
        if path.parent == folder:
            assert 0 <= problem.line <= _lines(path)
        else:
            # A definition may extend a shipped one.
            assert path.suffix == ".toml"


@cache
def _fixed_lines(name: str) -> int:
    return SUBPROGRAMS[name].count(b"\n") + 1


def _lines(path: Path) -> int:
    if path.name in SUBPROGRAMS:
        return _fixed_lines(path.name)
    return path.read_bytes().count(b"\n") + 1


def _check_run(run: Run, folder: Path, limit: int) -> None:
    lines = {file: _lines(Path(file)) for file in run.files}
    total = sum(lines.values())
    size = sum(Path(file).stat().st_size for file in run.files)
    n = len(run)
    assert n <= limit + (1 + MOTIONS_PER_LINE) * total
    assert len(run.diagnostics) <= MAX_DIAGNOSTICS + 1
    assert len(run.events) + len(run.comments) <= limit + size
    assert len(run.tools) <= limit + size + 1
    for finding in run.diagnostics:
        assert 0 <= finding.line <= lines[finding.file]
        assert 0 < len(finding.text) < 10_000
    if n:
        assert run.line.min() >= 1
        assert all(run.line[run.file == k].max(initial=0) <= lines[file] for k, file in enumerate(run.files))
    rows = [event.before_row for event in run.events] + [comment.before_row for comment in run.comments]
    assert all(0 <= row <= n for row in rows)
    _check_columns(run)
    _check_arcs(run)


def _check_columns(run: Run) -> None:
    for name in _FINITE:
        column = getattr(run, name)
        bad = ~np.isfinite(column)
        if bad.any():
            rows = np.flatnonzero(bad.reshape(len(column), -1).any(axis=1))
            explained = {finding.line for finding in run.errors}
            assert set(run.line[rows].tolist()) <= explained, f"{name} is not finite in rows {rows[:5]}"
    assert not np.isinf(run.feed).any()
    np.testing.assert_allclose(np.linalg.norm(run.axis, axis=1), 1.0, rtol=0, atol=1e-9)


def _check_arcs(run: Run) -> None:
    assert np.array_equal(np.flatnonzero(run.kind == Kind.ARC), run.arcs.row)
    for values in (run.arcs.centre, run.arcs.normal, run.arcs.radius):
        assert np.isfinite(values).all()
    assert (run.arcs.radius > 0.0).all()
    assert (run.arcs.full_turns >= 0).all()


def _check_toolpath(toolpath: Toolpath, data: bytes) -> None:
    rows = sum(len(operation.moves) for operation in toolpath.operations)
    events = sum(len(operation.events) for operation in toolpath.operations)
    lines = data.count(b"\n") + 1
    assert 0 < rows <= lines
    assert events <= lines
    for remark in toolpath.remarks:
        assert 0 <= remark.line <= lines
    for operation in toolpath.operations:
        moves = operation.moves
        assert np.isfinite(moves.tip).all()
        assert not np.isinf(moves.feed).any()
        np.testing.assert_allclose(np.linalg.norm(moves.axis, axis=1), 1.0, rtol=0, atol=1e-9)
        assert ((moves.line >= 1) & (moves.line <= lines)).all()
        assert np.isfinite(operation.arcs.centre).all()
        assert (operation.arcs.radius > 0.0).all()
        assert all(0 <= event.row <= len(moves) for event in operation.events)
