"""One path, written in every dialect, becomes the same toolpath; and so it does in every dialect that we write."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.support.cl_dialects import EVERY, Step, write_in
from tests.support.cl_paths import changes, content, paths, told
from tests.support.examples import examples
from trunnion.cl import ClReading, read_cl
from trunnion.cl.read_back import read_back_problems
from trunnion.cl.writers import WRITERS as OURS
from trunnion.model.toolpath import SpindleOn, Toolpath


@settings(max_examples=examples(25), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=paths(), inch=st.booleans())
def test_a_path_is_the_same_in_every_dialect(tmp_path: Path, steps: list[Step], inch: bool) -> None:
    found = {}
    for dialect in EVERY:
        text = write_in(dialect, steps, inch)
        if text is None:
            continue
        path = tmp_path / f"{dialect}.txt"
        path.write_text(text, encoding="utf-8")
        toolpath = read_cl(path, ClReading(strict=True))
        assert toolpath.dialect == dialect
        found[dialect] = content(toolpath)
        offsets = [operation.work_offset for operation in toolpath.operations]
        assert all(offsets) == any(offsets) == (dialect == "trunnion")
        numbered = enumerate(toolpath.operations, 1)
        toolpath = replace(toolpath, operations=tuple(replace(one, work_offset=number) for number, one in numbered))
        for ours in OURS:
            again = rewritten(toolpath, ours, inch, tmp_path / "again")
            found[f"{dialect} as {ours}"] = content(again)
            stated = [operation.work_offset for operation in again.operations]
            assert any(stated) == (ours == "trunnion")
            assert ours != "trunnion" or stated == list(range(1, len(offsets) + 1))
    expected = found.pop("clsf")
    assert len(found) >= 3
    for dialect, other in found.items():
        for name in ("tip", "axis", "feed", "arcs"):
            np.testing.assert_allclose(other[name], expected[name], atol=3e-5, rtol=0, err_msg=f"{dialect} {name}")
        for name in ("kind", "arc rows", "turns"):
            np.testing.assert_array_equal(other[name], expected[name], err_msg=f"{dialect} {name}")
        assert other["events"] == expected["events"], dialect
        assert changes(other["tools"]) == changes(expected["tools"]), dialect


def rewritten(toolpath: Toolpath, dialect: str, inch: bool, path: Path) -> Toolpath:
    """A toolpath that we wrote in a dialect, and read back."""
    writer, sink = OURS[dialect](toolpath, inch=inch), io.BytesIO()
    writer.write(sink)
    path.write_bytes(sink.getvalue())
    assert not read_back_problems(writer.toolpath, path, dialect)
    return read_cl(path, ClReading(strict=True))


def test_the_writers_say_what_they_are_asked() -> None:
    """A test of the test: a spindle that turns the other way is seen."""
    assert told(SpindleOn(0, 1, 5.0), 0) != told(SpindleOn(0, 1, 6.0), 0)
