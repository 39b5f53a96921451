"""``trunnion prepare``: all kernels are found, and compiled before they are needed."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest

from tests.support.locations import GOLDEN, ROOT
from trunnion.cl.scan import scan
from trunnion.cli import main
from trunnion.cli import prepare as command
from trunnion.jit.ahead import all_kernels, compile_all
from trunnion.jit.kernels import Kernel
from trunnion.jobs.kernels import needed
from trunnion.machines.links import link_rows
from trunnion.options.words import PREPARED


def kernel(value: Any) -> Kernel:
    """Return a kernel as what it is."""
    assert isinstance(value, Kernel)
    return value


def test_every_kernel_of_the_sources_is_found() -> None:
    pytest.importorskip("scipy")
    texts = [file.read_text(encoding="utf-8") for file in (ROOT / "src").rglob("*.py")]
    found = all_kernels()

    assert len({each.name for each in found}) == len(found) == sum(text.count("\n@kernel(") for text in texts)
    assert kernel(scan) in found


def test_what_is_missing_is_compiled_and_nothing_else(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    kernel(link_rows).prepare()
    monkeypatch.setattr(command, "all_kernels", lambda: [kernel(link_rows)])

    assert main(["prepare"]) == 0
    assert capsys.readouterr().out == "1 kernel is ready for this computer; 0 compiled now\n"


@pytest.mark.parametrize("machine", ["yl569", "dmu65", "matsuura_mx330", "haas_umc750", "hs664rt", "xyzac_trt"])
def test_what_the_sample_needs_is_prepared_for_post(
    machine: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    asked: set[str] = set()
    prepare = Kernel.__call__

    def recorded(self: Kernel, *arguments: Any) -> Any:
        asked.add(self.name)
        return prepare(self, *arguments)

    monkeypatch.setattr(Kernel, "__call__", recorded)
    sample = GOLDEN / "yl569" / "3_blade_finish.cls"
    main(["post", str(sample), "--machine", machine, "--set", "spindle=5000", "--output", str(tmp_path / "a.nc")])

    assert len(asked) > 10
    assert asked <= {each.name for each in needed("post")}


@pytest.mark.parametrize("work", PREPARED)
def test_one_command_is_prepared_alone(
    work: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Kernel, "is_kept", True)
    monkeypatch.setattr(command, "all_kernels", lambda: pytest.fail("asks for all kernels"))

    assert main(["prepare", work]) == 0
    assert capsys.readouterr().out == f"{len(needed(work))} kernels are ready for this computer; 0 compiled now\n"


def test_it_is_said_how_many_are_made(monkeypatch: pytest.MonkeyPatch) -> None:
    class Missing:
        """A kernel that is made when it is prepared, the second time."""

        name, announced, asked = "none.such", False, 0

        @property
        def is_kept(self) -> bool:
            return self.asked > 1

        def prepare(self, *, wait: bool) -> None:
            assert wait == (self.asked > 0)
            self.asked += 1

    told: list[int] = []
    kernels: Sequence[Any] = [Missing(), Missing()]
    monkeypatch.setattr("trunnion.jit.ahead._can_start", lambda: False)
    advance: Callable[[int], None] = told.append

    assert compile_all(kernels, advance) == 2
    assert told == [0, 0, 1, 1]
