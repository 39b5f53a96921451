"""``trunnion.post`` and ``trunnion.plan`` as a script or a notebook uses them."""

import io
import json
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path

import numpy as np
import pytest

import trunnion
from tests.support.locations import GOLDEN, HEADS, YL569
from tests.support.machines import machine_without_tcp

CL = YL569 / "3_blade_finish.cls"
HUB = YL569 / "2_hub_rough.cls"


def beyond_travel(folder: Path) -> Path:
    """A CL file whose last tool axis is beyond the limit of B."""
    file = folder / "far.cls"
    text = HUB.read_text(encoding="utf-8")
    far = "GOTO/10.0,10.0,10.0,0.939692620786,0.0,-0.342020143326\n"
    file.write_text(text.replace("END-OF-PATH\n", f"{far}END-OF-PATH\n"), encoding="utf-8")
    return file


def test_five_lines_post_a_program_with_its_proof(tmp_path: Path) -> None:
    result = trunnion.post(CL, machine="yl569", output=tmp_path / "blade.mpf", settings=HEADS["3_blade_finish"])
    assert result.passed
    assert [check.key for check in result.checks if not check.passed] == []
    assert (tmp_path / "blade.mpf").read_bytes() == (YL569 / "3_blade_finish.expected.mpf").read_bytes()
    assert result.output == tmp_path / "blade.mpf"
    assert result.run is not None
    assert result.run.tip.shape == (154, 3)
    assert np.abs(np.linalg.norm(result.run.axis, axis=1) - 1.0).max() < 1e-9


def test_paths_machines_and_toolpaths_are_taken_in_any_form(tmp_path: Path) -> None:
    machine, toolpath = trunnion.load_machine("yl569"), trunnion.read_cl(str(CL))
    definition = tmp_path / "own.toml"
    definition.write_text('extends = "yl569"\n', encoding="utf-8")
    texts = {
        trunnion.post(cl, machine=each).text
        for cl in (CL, str(CL), toolpath, [CL])
        for each in ("yl569", machine, definition)
    }
    assert len(texts) == 1


def test_several_cl_files_become_one_program() -> None:
    result = trunnion.post([HUB, trunnion.read_cl(CL)], machine="yl569")
    assert result.text is not None
    assert result.text.count(";Start of Path") == 2
    assert [motion.operation.name for motion in result.motions] == ["MULTI_BLADE_ROUGH", "BLADE_FINISH"]
    assert [toolpath.file for toolpath in result.toolpaths] == [str(HUB), str(CL)]


def test_a_problem_names_the_file_of_its_operation(tmp_path: Path) -> None:
    second = tmp_path / "second.cls"
    lines = HUB.read_text(encoding="utf-8").splitlines()
    line = next(k for k, each in enumerate(lines) if each.startswith("SPINDL"))
    second.write_text("\n".join([*lines[: line + 1], "SPINDL/OFF", *lines[line + 1 :], ""]), encoding="utf-8")
    with pytest.raises(trunnion.InputError) as caught:
        trunnion.post([HUB, second], machine="yl569")
    assert {Path(problem.file).name for problem in caught.value.problems} == {"second.cls"}


def test_without_a_place_the_result_has_the_text_and_a_stream_takes_it(tmp_path: Path) -> None:
    stream = io.BytesIO()
    kept = trunnion.post(CL, machine="yl569")
    streamed = trunnion.post(CL, machine="yl569", output=stream)
    filed = trunnion.post(CL, machine="yl569", output=str(tmp_path / "p.mpf"))
    assert kept.text is not None
    assert stream.getvalue().decode() == kept.text == filed.text
    assert (kept.output, streamed.output, streamed.text) == (None, None, None)


def test_settings_are_those_of_the_command_as_text_or_numbers() -> None:
    given: dict[str, str | float | tuple[float, ...]] = {
        "tool": 7,
        "zero": (0, 0, 50.0),
        "tcp": "off",
        "tip_tolerance": 0.01,
        "numbers": "off",
    }
    text = trunnion.post(CL, machine="yl569", settings=given).text
    same = {"tool": "7", "zero": "0,0,50", "tcp": "off", "tip_tolerance": "0.01", "numbers": "off"}
    assert text == trunnion.post(CL, machine="yl569", settings=same).text
    assert text is not None
    assert "T=7\n" in text
    assert not text.startswith("N10")
    assert trunnion.post(CL, machine="yl569", settings={**given, "zero": np.array([0.0, 0.0, 50.0])}).text == text


def test_every_wrong_setting_is_named_at_once() -> None:
    with pytest.raises(trunnion.InputError) as wrong:
        trunnion.post(CL, machine="yl569", settings={"titel": "x", "pole": "skip"})
    assert len(wrong.value.problems) == 2
    assert "titel is not a setting" in str(wrong.value)


def test_a_program_that_must_not_run_is_refused_and_nothing_is_written(tmp_path: Path) -> None:
    target, far = tmp_path / "p.mpf", beyond_travel(tmp_path)
    with pytest.raises(trunnion.RefusedError, match="axis B would go to 110") as refused:
        trunnion.post(far, machine="yl569", output=target)
    assert {problem.file for problem in refused.value.problems} == {str(far)}
    assert not target.exists()
    forced = trunnion.post(far, machine="yl569", output=target, force=True)
    assert not forced.passed
    assert [problem for problem in forced.problems if problem.severity is trunnion.Severity.ERROR]
    assert "MUST NOT RUN AS IT IS" in target.read_text(encoding="utf-8").splitlines()[0]


def test_a_program_that_fails_its_proof_is_refused_with_the_verification(tmp_path: Path) -> None:
    target, machine = tmp_path / "p.mpf", machine_without_tcp(tmp_path)
    with pytest.raises(trunnion.ProofFailedError, match="no program is written") as failed:
        trunnion.post(CL, machine=machine, output=target, report=tmp_path / "r.json")
    result = failed.value.result
    assert "tip" in [check.key for check in result.checks if not check.passed]
    assert (result.passed, result.output, result.text) == (False, None, None)
    assert not target.exists()
    assert json.loads((tmp_path / "r.json").read_text(encoding="utf-8"))["checks"]
    result.write_report(tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == (tmp_path / "r.json").read_bytes()
    forced = trunnion.post(CL, machine=machine, output=target, force=True)
    assert not forced.passed
    assert "MUST NOT RUN AS IT IS" in (forced.text or "")


def test_a_result_writes_its_report_afterwards(tmp_path: Path) -> None:
    result = trunnion.post(CL, machine="yl569", explain=True, report=tmp_path / "with.html")
    for name in ("page.html", "data.json"):
        result.write_report(tmp_path / name)
    assert (tmp_path / "page.html").read_bytes() == (tmp_path / "with.html").read_bytes()
    assert json.loads((tmp_path / "data.json").read_text(encoding="utf-8"))["motions"] == 154
    with pytest.raises(trunnion.InputError, match="a report is a page or data"):
        result.write_report(tmp_path / "page.pdf")


def test_a_report_needs_the_columns(tmp_path: Path) -> None:
    result = trunnion.post(CL, machine="yl569", columns=False)
    with pytest.raises(trunnion.InputError, match="no columns"):
        result.write_report(tmp_path / "r.html")


def test_no_cl_file_at_all_is_an_input_error() -> None:
    for call in (trunnion.post, trunnion.plan):
        with pytest.raises(trunnion.InputError, match="there is no CL file"):
            call([], machine="yl569")


def test_a_program_that_nothing_can_read_is_forced_without_a_proof(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("trunnion.readers.can_read", lambda machine: False)
    with pytest.raises(trunnion.RefusedError, match="nothing proves this one"):
        trunnion.post(CL, machine="yl569")
    forced = trunnion.post(CL, machine="yl569", force=True)
    assert (forced.passed, forced.checks, forced.run) == (False, (), None)
    assert repr(forced) == "PostResult(passed=False, not run)"
    assert "nothing has been checked" in forced.problems[-1].what
    with pytest.raises(trunnion.InputError, match="nothing was proven"):
        forced.write_report(tmp_path / "r.json")


def test_subprograms_are_named_and_need_a_folder(tmp_path: Path) -> None:
    settings = {"programs": "operations"}
    result = trunnion.post([HUB, CL], machine="yl569", output=tmp_path / "main.mpf", settings=settings)
    assert result.passed
    assert {file.name for file in result.subprograms} == {"MULTI_BLADE_ROUGH.SPF", "BLADE_FINISH.SPF"} or all(
        file.is_file() for file in result.subprograms
    )
    assert len(result.subprograms) == 2
    with pytest.raises(trunnion.InputError, match="several files needs a place"):
        trunnion.post([HUB, CL], machine="yl569", settings=settings)


def test_a_plan_has_its_columns_and_its_reasons() -> None:
    planned = trunnion.plan(HUB, machine="yl569")
    (motion,) = planned.motions
    assert motion.rotary.shape == (len(motion.operation.moves), 2)
    assert planned.problems == ()
    assert {decision.operation for decision in planned.decisions} == {"MULTI_BLADE_ROUGH"}
    far = trunnion.plan(HUB, machine="yl569", settings={"zero": (0, 0, 900)})
    assert trunnion.Severity.ERROR in {problem.severity for problem in far.problems}


class Log(trunnion.Observer):
    """Notes what it hears."""

    def __init__(self) -> None:
        self.heard: list[str] = []
        self.done: dict[str, int] = {}
        self.total: dict[str, int] = {}

    def problems(self, problems: Sequence[trunnion.Problem]) -> None:
        self.heard += [f"problem: {problem.what}" for problem in problems]

    def planned(self, plan: trunnion.Plan) -> None:
        self.heard.append("planned")

    def verified(self, verification: trunnion.Verification) -> None:
        self.heard.append("verified")

    def progress(self, stage: str, total: int, unit: str) -> AbstractContextManager[Callable[[int], None]]:
        self.total[stage] = total

        def advance(more: int) -> None:
            self.done[stage] = self.done.get(stage, 0) + more

        return nullcontext(advance)


def test_an_observer_hears_what_happens_in_its_order(tmp_path: Path) -> None:
    cl = tmp_path / "odd.cls"
    text = HUB.read_text(encoding="utf-8")
    cl.write_text(text.replace("FEDRAT/", "PAINT/COLOR,7\nFEDRAT/", 1), encoding="utf-8")
    log = Log()
    result = trunnion.post(cl, machine="yl569", observer=log)
    (warning,) = [problem for problem in result.problems if "colour 7" in problem.what]
    assert log.heard == [f"problem: {warning.what}", "planned", "verified"]
    assert log.total == {"odd.cls": cl.stat().st_size, "writing": 23}
    assert log.done == log.total
    cl.write_text(text.replace("FEDRAT/", "FROBNICATE/ON\nFEDRAT/", 1), encoding="utf-8")
    assert any("FROBNICATE" in problem.what for problem in trunnion.post(cl, machine="yl569").problems)
    with pytest.raises(trunnion.InputError, match="FROBNICATE"):
        trunnion.post(cl, machine="yl569", strict=True)


def test_a_result_shows_itself_in_one_line(tmp_path: Path) -> None:
    assert repr(trunnion.post(CL, machine="yl569")) == "PostResult(passed=True, 154 motions)"
    named = repr(trunnion.post(CL, machine="yl569", output=tmp_path / "p.mpf"))
    assert named == f"PostResult(passed=True, 154 motions, output={str(tmp_path / 'p.mpf')!r})"


def test_surface_normals_come_with_their_setting() -> None:
    cl = GOLDEN / "dmu65" / "corner.cls"
    assert trunnion.post(cl, machine="dmu65").passed


@pytest.mark.parametrize("suffix", [".json", ".html"])
def test_a_program_that_planning_refuses_has_its_report(tmp_path: Path, suffix: str) -> None:
    report = tmp_path / f"report{suffix}"
    cl = beyond_travel(tmp_path)
    with pytest.raises(trunnion.RefusedError):
        trunnion.post(cl, machine="yl569", report=report, output=tmp_path / "far.mpf")
    assert not (tmp_path / "far.mpf").exists()
    text = report.read_text(encoding="utf-8")
    assert "refused before it was run" in text
    line = 1 + next(k for k, each in enumerate(cl.read_text(encoding="utf-8").splitlines()) if "0.342020143326" in each)
    if suffix == ".html":
        assert f">{line}</span>" in text
        return
    data = json.loads(text)
    (check,) = data["checks"]
    assert (data["passed"], data["program"], check["state"], data["motions"]) == (
        False, str(tmp_path / "far.mpf"), "FAIL", 0
    )  # fmt: skip
    assert check["places"][0]["cl_line"] == line
    assert data["columns"]["nc_line"] == []
