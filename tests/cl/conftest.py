"""Small CL files as texts."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.support.apt_heads import HEADS
from tests.support.cl_reading import Body, Fail, Read
from trunnion.cl import ClReading, read_cl
from trunnion.errors import InputError, Problem
from trunnion.model.toolpath import Operation, Toolpath

HEAD = "TOOL PATH/OP,TOOL,T1\nTLDATA/MILL,10.0,1.0,50.0,0.0,0.0\n"
FOOT = "\nEND-OF-PATH\n"


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Return a function that reads text or bytes as a CL file."""

    def reader(text: str | bytes, **options: object) -> Toolpath:
        path = tmp_path / "a.cls"
        path.write_bytes(text.encode() if isinstance(text, str) else text)
        return read_cl(path, ClReading(**options))  # type: ignore[arg-type]

    return reader


@pytest.fixture
def body(read: Read) -> Body:
    """Return a function that reads statements as the inside of one operation."""

    def reader(*lines: str, **options: object) -> Operation:
        return read(HEAD + "\n".join(lines) + FOOT, **options).operations[0]

    return reader


@pytest.fixture
def fails(read: Read) -> Fail:
    """Return a function that reads a bad file and gives back its problems."""

    def reader(text: str | bytes, **options: object) -> tuple[Problem, ...]:
        with pytest.raises(InputError) as caught:
            read(text, **options)
        return caught.value.problems

    return reader


@pytest.fixture
def body_fails(fails: Fail) -> Fail:
    """Return a function that reads bad statements inside one operation; the first of them is line 3."""

    def reader(*lines: str, **options: object) -> tuple[Problem, ...]:
        return fails(HEAD + "\n".join(lines) + FOOT, **options)

    return reader


@pytest.fixture
def apt(read: Read) -> Callable[..., Operation]:
    """Return a function that reads statements of a dialect as one operation."""

    def reader(dialect: str, *lines: str, **options: object) -> Operation:
        toolpath = read("\n".join([*HEADS[dialect], *lines, "FINI"]) + "\n", **options)
        assert toolpath.dialect == dialect
        return toolpath.operations[-1]

    return reader


@pytest.fixture
def refused(fails: Fail) -> Callable[..., str]:
    """Return a function that reads bad statements of a dialect and gives back what is wrong."""

    def reader(dialect: str, *lines: str) -> str:
        problems = fails("\n".join([*HEADS[dialect], "GOTO/0,0,0", *lines, "FINI"]) + "\n")
        return "\n".join(f"{problem.line}: {problem.what}; {problem.cure}" for problem in problems)

    return reader
