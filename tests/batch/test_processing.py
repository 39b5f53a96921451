"""The work on one file: what the library gives, whatever folder it is done in, and nothing left behind."""

import errno
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

import trunnion
from tests.support.locations import YL569
from trunnion.batch.processing import work
from trunnion.batch.result_keys import program_version
from trunnion.batch.worker_task import Action, OtherVersionError, Outcome, Status, Task

CL, NC = (YL569 / "2_hub_rough.cls").read_bytes(), (YL569 / "2_hub_rough.expected.mpf").read_bytes()
SIMULATED = {
    "machine": "yl569", "stock": "box:80,40,40,-10,-20,-40", "tools": ["2=ball:8,length=80,flutes=40"], "cell": 5.0,
}  # fmt: skip


def done(
    action: Action, arguments: dict[str, Any], files: Mapping[str, bytes], result: str = "x.mpf", report: str = ""
) -> Outcome:
    named = {f"files/{name}": data for name, data in files.items()}
    return work(Task(program_version(), action, arguments, next(iter(named)), named, {}, result, report))


def test_a_post_is_that_of_the_library() -> None:
    found = done(Action.POST, {"machine": "yl569", "settings": {"title": "X"}}, {"a/x.cls": CL}, report="x.mpf.json")
    posted = trunnion.post(YL569 / "2_hub_rough.cls", machine="yl569", settings={"title": "X"})
    assert found.status is Status.PASSED
    assert found.files["x.mpf"].decode() == posted.text
    assert sorted(found.files) == ["x.mpf", "x.mpf.json"]
    figures = found.figures
    assert (figures["points"], figures["motions"], figures["tools"]) == (23, 30, ["2"])
    assert posted.text is not None
    assert figures["blocks"] == sum(1 for line in posted.text.splitlines() if line.strip())
    assert posted.verification is not None
    assert figures["seconds"] == pytest.approx(float(posted.verification.seconds.sum()), abs=1e-5)
    run = posted.verification.run
    rotary = [(k, axis) for k, axis in enumerate(run.machine.axes) if axis.is_rotary]
    for k, axis in rotary:
        extent = figures["axes"][axis.name]
        assert (extent["low"], extent["high"]) == pytest.approx(
            (run.joints[:, k].min(), run.joints[:, k].max()), abs=1e-5
        )
    assert figures["margin_deg"] == pytest.approx(11.0)  # B from 0 to 58.9 within -11 to 120


def test_results_do_not_depend_on_the_folder() -> None:
    for action, files, report in (
        (Action.POST, {"a/x.cls": CL}, "x.mpf.html"), (Action.VERIFY, {"a/x.mpf": NC}, "x.mpf.json"),
        (Action.VERIFY, {"a/x.mpf": NC, "a/x.cls": CL}, "x.mpf.json"),
        (Action.VERIFY, {"a/x.mpf": NC, "a/x.cls": CL}, "x.mpf.html"),
        (Action.SIMULATE, {"a/x.mpf": NC}, "x.mpf.json"), (Action.CONVERT, {"a/x.mpf": NC}, ""),
    ):  # fmt: skip
        arguments: dict[str, Any] = dict(SIMULATED) if action is Action.SIMULATE else {"machine": "yl569"}
        arguments |= {"to_machine": "generic_head_head_ca"} if action is Action.CONVERT else {}
        arguments |= {"cl": ["files/a/x.cls"]} if len(files) == 2 else {}
        one, other = (done(action, dict(arguments), files, report=report) for _ in range(2))
        assert len(one.files) == 1 + (action is Action.POST), action
        assert (one.status, one.problems, one.files, one.figures) == (
            other.status, other.problems, other.files, other.figures,
        )  # fmt: skip
        assert tempfile.gettempdir() not in repr((one.problems, one.files, one.figures)), action


@pytest.mark.parametrize("code", [errno.ENOSPC, errno.EACCES, errno.EMFILE, errno.EIO])
@pytest.mark.parametrize("where", ["atomic", "layout", "folder"])
def test_what_the_computer_hinders_is_no_verdict_on_the_file(
    monkeypatch: pytest.MonkeyPatch, code: int, where: str
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise OSError(code, "not now")

    names = {
        "atomic": "trunnion.files.hidden_folders.HiddenFolders._make", "layout": "trunnion.batch.processing._lay_out",
        "folder": "trunnion.batch.processing.TemporaryDirectory",
    }  # fmt: skip
    monkeypatch.setattr(names[where], refuse)
    found = done(Action.POST, {"machine": "yl569", "settings": {"title": "X"}}, {"a/x.cls": CL})
    assert (found.status, [each.code for each in found.problems]) == (Status.HINDERED, ["BAT390"])
    assert "not now" in found.problems[0].what
    assert not found.status.is_final


def test_full_memory_is_no_verdict_on_the_file(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise MemoryError

    monkeypatch.setattr("trunnion.batch.processing.post_beside", refuse)
    found = done(Action.POST, {"machine": "yl569"}, {"a/x.cls": CL})
    assert (found.status, found.status.is_final) == (Status.HINDERED, False)


def test_a_file_that_cannot_be_read_stays_a_verdict() -> None:
    assert done(Action.POST, {"machine": "yl569"}, {"a/x.cls.gz": b"\x1f\x8bno"}).status is Status.UNUSABLE
    files, machine = {"x.mpf": NC}, {"machine": "yl569"}
    found = done(Action.VERIFY, machine | {"cl": ["files/in/no.cls"]}, files)
    assert (found.status, found.problems[0].file) == (Status.UNUSABLE, "in/no.cls")


def test_a_conversion_is_that_of_the_library() -> None:
    found = done(Action.CONVERT, {"machine": "yl569", "to_machine": "dmu65"}, {"x.mpf": NC}, "x.h")
    converted = trunnion.convert(YL569 / "2_hub_rough.expected.mpf", machine="yl569", to_machine="dmu65")
    assert found.files == {"x.h": (converted.text or "").encode()}
    to_cl = done(Action.CONVERT, {"machine": "yl569", "to_cl": True}, {"x.mpf": NC}, "x.cls")
    text = trunnion.convert(YL569 / "2_hub_rough.expected.mpf", machine="yl569", to_cl=True).text
    assert to_cl.files == {"x.cls": (text or "").encode()}


def test_a_conversion_may_give_several_programs() -> None:
    arguments = {"machine": "yl569", "to_machine": "dmu65", "settings": {"programs": "operations"}}
    found = done(Action.CONVERT, arguments, {"x.mpf": NC}, "x.h")
    assert found.status is Status.PASSED
    assert len(found.files) == 2
    assert b"CALL PGM" in found.files["x.h"]


def test_a_program_is_compared_with_the_cl_file_beside_it() -> None:
    arguments = {"machine": "yl569", "cl": ["files/x.cls"]}
    assert done(Action.VERIFY, dict(arguments), {"x.mpf": NC, "x.cls": CL}).status is Status.PASSED
    wrong = done(Action.VERIFY, dict(arguments), {"x.mpf": NC.replace(b"X41.", b"X42.", 1), "x.cls": CL})
    assert wrong.status is Status.FAILED
    assert "tip" in [problem.code for problem in wrong.problems]
    assert "tip" in wrong.figures["failed_checks"]
    missing = done(Action.VERIFY, dict(arguments), {"x.mpf": NC})
    assert missing.status is Status.UNUSABLE
    assert (missing.problems[0].file, missing.problems[0].code) == ("x.cls", "FIL110")


def test_what_is_not_understood_is_told_by_its_own_codes_with_the_first_of_each() -> None:
    program = b"N1 G90 G94 F100 M3 S100\n" + b"FOO(3\n" * 30 + b"R1=R2\nN9 M30\n"
    found = done(Action.VERIFY, {"machine": "yl569"}, {"x.mpf": program})
    told = [(each.code, each.line) for each in found.problems]
    assert found.status is Status.FAILED
    assert [each for each in told if each[0] == "NC210"][:2] == [("NC210", 2), ("NC210", 3)]
    assert len({code for code, _ in told}) == len(found.figures["error_codes"]) > 1
    assert "words" not in found.figures["error_codes"]


def test_what_the_simulation_finds_fails() -> None:
    found = done(Action.SIMULATE, {**SIMULATED, "tools": ["2=flat:30,length=9,flutes=5"]}, {"x.mpf": NC})
    assert found.status is Status.FAILED
    assert found.problems[0].code == "BAT340"
    assert found.figures["findings"] > 0


@pytest.mark.parametrize(
    ("content", "status", "line", "code"),
    [
        (b"GOTO/1,2\n", Status.UNUSABLE, 1, "CL310"),
        (CL.replace(b"RPM,2000", b"RPM,99000"), Status.FAILED, 10, "PLN430"),
        (b"", Status.UNUSABLE, 0, "CL140"),
        (b"\0\xff" * 1000, Status.UNUSABLE, 1, "CL150"),
    ],
)
def test_errors_are_those_of_the_library_with_the_names_of_the_jobs(
    tmp_path: Path, content: bytes, status: Status, line: int, code: str
) -> None:
    found = done(Action.POST, {"machine": "yl569"}, {"a/x.cls": content})
    (tmp_path / "x.cls").write_bytes(content)
    with pytest.raises(trunnion.TrunnionError) as caught:
        trunnion.post(tmp_path / "x.cls", machine="yl569")
    assert (found.status, found.files) == (status, {})
    first = found.problems[0]
    assert (first.file, first.line, first.code) == ("a/x.cls", line, code)
    told = [(each.line, each.what, each.code) for each in caught.value.problems]
    assert [(each.line, each.what, each.code) for each in found.problems][: len(told)] == told


def test_an_error_of_trunnion_is_told_as_such(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trunnion.batch.processing.post_beside", lambda *_, **__: 1 / 0)
    found = done(Action.POST, {"machine": "yl569"}, {"x.cls": CL})
    assert (found.status, found.problems[0].code) == (Status.BROKEN, "BAT330")
    assert "ZeroDivisionError" in found.problems[0].what


def test_nothing_is_left_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    monkeypatch.setattr("trunnion.files.earlier_job.user_cache", lambda: tmp_path / "cache")
    assert done(Action.POST, {"machine": "yl569"}, {"x.cls": CL}).status is Status.PASSED
    assert list(tmp_path.iterdir()) == []


def test_another_version_is_refused() -> None:
    with pytest.raises(OtherVersionError):
        work(Task("0", Action.POST, {"machine": "yl569"}, "files/x.cls", {"files/x.cls": CL}, {}, "x.mpf", ""))
