"""``trunnion survey``: what becomes of each file of a folder, and what stands in the way."""

import json
import os
import re
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, Self

import pytest

from tests.support.locations import TESTS, YL569
from tests.support.open_cycles import OPEN
from tests.support.posting import FOOT, HEAD
from trunnion.batch.worker_task import Outcome, Status
from trunnion.batch.workers import timed_out
from trunnion.cli import main
from trunnion.errors import InputError, Problem
from trunnion.families import FAMILIES
from trunnion.jobs.inputs.reading import as_machine
from trunnion.messages import Wording, foreign, word_said
from trunnion.readers.program.settings import family_of
from trunnion.survey import taking
from trunnion.survey.found_files import FileKind, FoundFile, found_files
from trunnion.survey.result import Became, Survey, SurveyedMachine, surveyed, trying
from trunnion.survey.stand_ins import stand_ins
from trunnion.survey.taking import MACHINES, take_survey
from trunnion.survey.trying import SETTINGS, STEP, Step, Trial, try_steps

KLARTEXT = b"""0 BEGIN PGM 1 MM
1 TOOL CALL 1 Z S1000
2 L X+0 Y+0 Z+50 R0 FMAX M3
3 L Z+10 F100
4 M30
5 END PGM 1 MM
"""


class Here:
    """Workers that are no processes."""

    def __init__(self, count: int, function: Callable[[Trial], Outcome], timeout: float) -> None:
        self._timeout = timeout

    def __class_getitem__(cls, _: object) -> type[Self]:
        return cls

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def run(self, tasks: Iterable[tuple[Any, Trial]]) -> Iterator[tuple[Any, Outcome]]:
        """Do one after another; what is called slow takes too long."""
        for place, trial in tasks:
            if "slow" in trial.file:
                yield place, Outcome(Status.TIMED_OUT, (timed_out(trial.file, self._timeout),))
            else:
                yield place, try_steps(trial)


@pytest.fixture(scope="module")
def pile(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of all kinds of files."""
    folder = tmp_path_factory.mktemp("pile")
    sound = (YL569 / "2_hub_rough.cls").read_bytes()
    contents = {
        "cl/sound.cls": sound,
        "cl/broken.cls": sound.replace(b"GOTO/", b"GOTO/1,", 1),
        "cl/slow.cls": sound,
        "empty.nc": b"",
        "klartext.h": KLARTEXT,
        "picture.nc": b"G1 X\0\1\2\0",
        "sinumerik.mpf": (YL569 / "2_hub_rough.expected.mpf").read_bytes(),
        "<b>&.mpf": b"N1 TRAORI\nN2 CYCLE832(0.01)\nN3 G1 X10 F100\nN4 FOO(3\n",
    }
    for name, content in contents.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    shutil.copy(TESTS / "data" / "kinds" / "lathe.nc", folder)
    (folder / "link.cls").symlink_to(folder / "cl" / "sound.cls")
    return folder


@pytest.fixture(scope="module")
def found(pile: Path) -> Survey:
    """What is found there on two machines."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(taking, "LocalWorkers", Here)
        return take_survey(pile, machine=["yl569", "dmu65"], timeout=5)


def test_each_file_becomes_what_it_is(found: Survey) -> None:
    became = {each.file: (str(each.kind), each.looks, str(each.became), len(each.tries)) for each in found.files}
    assert became == {
        "<b>&.mpf": ("program", "a Sinumerik program", "refused", 1),
        "empty.nc": ("other", "an empty file", "not ours", 0),
        "klartext.h": ("program", "a Heidenhain Klartext program", "read", 1),
        "lathe.nc": ("other", "a program for a lathe", "not ours", 0),
        "link.cls": ("other", "a link", "not tried", 0),
        "picture.nc": ("other", "a binary file", "not ours", 0),
        "sinumerik.mpf": ("program", "a Sinumerik program", "read", 1),
        "cl/broken.cls": ("CL file", "NX CLSF", "refused", 2),
        "cl/slow.cls": ("CL file", "NX CLSF", "timed out", 2),
        "cl/sound.cls": ("CL file", "NX CLSF", "proven", 2),
    }


def test_rates_are_by_dialect_and_control(found: Survey) -> None:
    rates = {(str(each.kind), each.looks, each.control): (each.passed, each.files) for each in found.rates}
    assert rates == {
        ("CL file", "NX CLSF", "Heidenhain TNC 640"): (1, 3),
        ("CL file", "NX CLSF", "Sinumerik 840D sl"): (1, 3),
        ("program", "a Heidenhain Klartext program", "Heidenhain TNC 640"): (1, 1),
        ("program", "a Sinumerik program", "Sinumerik 840D sl"): (1, 2),
    }


def test_codes_that_block_have_their_first_place_and_what_they_open(found: Survey) -> None:
    blockers = {each.code: (each.files, each.opens, each.first.file, each.first.line) for each in found.blockers}
    broken = next(each for each in found.files if each.file == "cl/broken.cls")
    (code,) = broken.tries[0].codes
    assert blockers[code] == (1, 1, "cl/broken.cls", 13)
    assert blockers["NC210"] == (1, 1, "<b>&.mpf", 4)
    assert found.blockers[0].first.cure


def test_a_file_that_failed_tells_the_step(found: Survey) -> None:
    steps = {each.file: {one.step for one in each.tries} for each in found.files if each.tries}
    assert steps["cl/broken.cls"] == {"info"}
    assert steps["cl/sound.cls"] == {"post"}
    assert steps["sinumerik.mpf"] == {"verify"}


def test_nothing_is_written_into_the_folder(pile: Path, found: Survey) -> None:
    assert len([*found_files(pile)]) == len(found.files)


def test_the_command_prints_and_writes_page_and_data(
    pile: Path, found: Survey, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("trunnion.cli.many_files.survey.take_survey", lambda folder, **_: found)
    data, page = tmp_path / "survey.json", tmp_path / "survey.html"
    assert main(["survey", str(pile), "--json", str(data), "--report", str(page)]) == 0
    out = capsys.readouterr().out
    assert "cl/sound.cls                                        CL file, NX CLSF: proven on 2 of 2 machines" in out
    assert "lathe.nc                                            a program for a lathe: not ours" in out
    assert out.endswith("10 files: 1 proven, 2 read, 2 refused, 1 timed out, 1 not tried, 3 not ours\n")
    written = json.loads(data.read_text("utf-8"))
    assert written["schema"] == 1
    assert written["counts"] == {str(became): count for became, count in found.counts.items()}
    assert [each["file"] for each in written["files"]] == [each.file for each in found.files]
    html = page.read_text("utf-8")
    assert "&lt;b&gt;&amp;.mpf" in html
    assert "<b>&.mpf" not in html
    read, *_ = [each.file for each in found.files if str(each.became).startswith("read")]
    assert f'<tr class="open"><th scope=row><bdi>{read}<' in html  # it is not proven
    assert "<script" not in html


def test_a_file_of_the_folder_is_not_written_over(pile: Path) -> None:
    with pytest.raises(InputError, match=r"sinumerik\.mpf"):
        take_survey(pile, written=[pile / "sinumerik.mpf"])


def test_results_of_an_earlier_survey_in_its_folder_are_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("notes.txt").write_text("ours", encoding="utf-8")
    line = ["survey", ".", "--machine", "yl569", "--json", "s.json", "--report", "s.html"]
    for _ in range(2):
        assert main(line) == 0
        assert [each["file"] for each in json.loads(Path("s.json").read_text("utf-8"))["files"]] == ["notes.txt"]
    Path("s.json").write_text(Path("s.json").read_text("utf-8").replace("folder", "dialect", 1), encoding="utf-8")
    assert main(line) == 2
    assert "FIL250" in capsys.readouterr().err


def test_a_folder_that_is_not_there_is_an_error(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["survey", "nowhere"]) == 2
    assert "there is no such folder" in capsys.readouterr().err


def test_later_steps_are_of_the_program_that_was_posted(pile: Path) -> None:
    steps = (Step.INFO, Step.POST, Step.VERIFY, Step.CONVERT)
    outcome = try_steps(Trial("cl/sound.cls", pile / "cl/sound.cls", "yl569", steps))
    assert (outcome.status, outcome.figures["step"], outcome.files) == (Status.PASSED, "convert", {})


def test_the_program_that_was_posted_is_named_by_its_cl_file(tmp_path: Path) -> None:
    shutil.copy(TESTS / "golden" / "hs664rt" / "radial_holes.cls", tmp_path / "a.cls")
    outcome = try_steps(Trial("a.cls", tmp_path / "a.cls", "hs664rt", (Step.POST, Step.CONVERT)))
    assert (outcome.figures["step"], outcome.problems[0].file) == ("convert", "a.cls (its program)")


def test_a_program_of_no_certain_control_counts_where_it_reads_best(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    (tmp_path / "plain.nc").write_text("O1\nG21 G90 G17 G40\nT1 M6\nS1000 M3\nG0 X0 Y0\nG43 H1 Z50\nG1 Z1 F100\nM30\n")
    (file,) = take_survey(tmp_path, machine=["dmu65", "matsuura_mx330"]).files
    assert (file.looks, [each.machine for each in file.tries]) == ("", ["matsuura_mx330"])
    assert file.became in (Became.READ, Became.READ_WARNED)


def test_programs_are_read_for_all_shipped_machines(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    (tmp_path / "turned.h").write_bytes(KLARTEXT.replace(b"Z+50", b"Z+50 B+0"))
    found = take_survey(tmp_path)
    assert {each.machine for each in found.machines if each.posts} == set(MACHINES)
    assert [each.machine for each in found.files[0].tries] == ["mikron_600u"]  # which has a B, unlike dmu65


def test_a_program_that_goes_through_is_tried_on_no_other_machine(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    tried = []

    class Listing(Here):
        def run(self, tasks: Iterable[tuple[Any, Trial]]) -> Iterator[tuple[Any, Outcome]]:
            for place, trial in tasks:
                tried.append((trial.machine, trial.steps))
                yield place, try_steps(trial)

    monkeypatch.setattr(taking, "LocalWorkers", Listing)
    (tmp_path / "sound.h").write_bytes(KLARTEXT)
    (tmp_path / "turned.h").write_bytes(KLARTEXT.replace(b"Z+50", b"Z+50 UNHEARD"))
    (tmp_path / "unheard.ngc").write_text(
        "G21 G90\n#<feed> = 100\no1 if [#<feed> GT 1]\nG1 X5 F#<feed> UNHEARD\no1 endif\nM2\n"
    )
    take_survey(tmp_path)
    # What a control does not understand is not tried on the other machines of that control.
    of_linuxcnc = [machine for machine, _ in tried if machine in ("xyzac_trt", "xyzbc_trt", "linuxcnc_5axis")]
    assert set(of_linuxcnc) == {"xyzac_trt"}
    tried = [each for each in tried if each[0] in ("dmu65", "mikron_600u", "ucp800")]
    plain = (Step.VERIFY,)
    others = [("mikron_600u", plain), ("ucp800", plain)]
    assert tried == [("dmu65", plain), ("dmu65", plain), *others, ("dmu65", (Step.VERIFY, Step.KEYS))]


def test_a_refused_program_is_read_once_more_with_keys(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    start = "O1\nG21 G90 G17 G40\nT1 M6\nS1000 M3\nG0 X0 Y0\nG43 H1 Z50\n"
    (tmp_path / "nested.nc").write_text(f"{start}G1 Z1 F100 (A (B))\nM30\n")
    (tmp_path / "worse.nc").write_text(f"{start}G1 Z1 F100 (A (B))\nG1 UNHEARD\nM30\n")
    (tmp_path / "unit.nc").write_text("%\nG90 G17 G40 G94\nG1 X5 F9 ; A\n%\n")
    nested, unit, worse = take_survey(tmp_path, machine=["matsuura_mx330", "xyzac_trt"]).files
    assert (unit.became, unit.tries[0].codes, unit.tries[0].keys) == (Became.CHECK_FAILED, ("modal",), ())
    assert (nested.became, nested.tries[0].codes) == (Became.READ_KEYED, ("NC210",))
    assert nested.tries[0].keys == worse.tries[0].keys == ("nested_comments",)
    assert (worse.became, worse.tries[0].count) == (Became.REFUSED, 1)


def test_programs_find_the_subprograms_beside_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    call = KLARTEXT.replace(b"3 L Z+10 F100", b"3 CALL PGM tnc:\\\\parts\\\\plunge.h")
    (tmp_path / "parts").mkdir()
    (tmp_path / "lost").mkdir()
    for place in ("parts", "lost"):
        (tmp_path / place / "main.h").write_bytes(call)
    (tmp_path / "parts" / "PLUNGE.H").write_bytes(
        b"0 BEGIN PGM PLUNGE MM\n1 L Z+10 F100\n2 L Z+2\n3 END PGM PLUNGE MM\n"
    )
    (tmp_path / "parts" / "notes.txt").write_text("no program calls this")
    found = take_survey(tmp_path, machine=["dmu65"]).files
    became = {each.file: (str(each.became), *each.tries[0].codes) for each in found if each.tries}
    assert became["parts/main.h"] == ("read",)
    assert became["lost/main.h"] == ("refused", "NC132")


def test_subprograms_of_cl_data_are_refused_and_no_turning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    cl = "PARTNO/A\nUNITS/MM\nLOADTL/1\nSPINDL/1000,CLW\nFEDRAT/200,MMPM\nGOTO/1,2,3\n{}\nFINI\n"
    (tmp_path / "called.apt").write_text(cl.format("CALSUB/5"))
    (tmp_path / "turned.apt").write_text(cl.format("MODE/TURN"))
    called, turned = take_survey(tmp_path, machine=["dmu65"]).files
    assert (called.became, called.tries[0].codes) == (Became.REFUSED, ("CL260",))
    assert (turned.became, turned.looks) == (Became.NOT_OURS, "CL data of turning")


def test_what_only_the_machine_cannot_do_is_no_fault_of_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    cl = (YL569 / "2_hub_rough.cls").read_bytes()
    (tmp_path / "far.cls").write_bytes(re.sub(rb"GOTO/[-0-9.]+", b"GOTO/9000.0", cl, count=1))
    (tmp_path / "fast.cls").write_bytes(re.sub(rb"SPINDL/RPM,[0-9.]+", b"SPINDL/RPM,20000", cl))
    (tmp_path / "far.h").write_bytes(KLARTEXT.replace(b"L Z+10 F100", b"L X+9000 F100"))
    (tmp_path / "far_and_wrong.h").write_bytes(KLARTEXT.replace(b"L Z+10 F100", b"L X+9000 F100\n4 L Z+1 UNHEARD"))
    found = take_survey(tmp_path, machine=["yl569", "dmu65"])
    became = {each.file: str(each.tries[0].became) for each in found.files}
    beyond = "beyond the machine"
    assert became == {"far.cls": beyond, "fast.cls": beyond, "far.h": beyond, "far_and_wrong.h": "refused"}
    assert {each.code for each in found.blockers} >= {"PLN430", "travel"}


def test_a_program_of_ones_own_that_leaves_the_travel_is_a_failed_proof() -> None:
    figures = {"failed_checks": ["travel"], "step": "post"}
    outcome = Outcome(Status.FAILED, (Problem("a.cls", 0, foreign("x", "y", "travel")),), figures=figures)
    tried = trying(SurveyedMachine("m", "c"), FileKind.CL, outcome)
    assert tried.became is Became.PROOF_FAILED


def test_what_only_follows_from_other_errors_blocks_nothing() -> None:
    problems = [Problem("a.cls", line, foreign("x", "y", code)) for line, code in ((3, "PLN120"), (4, "PLN160"))]
    outcome = Outcome(Status.FAILED, (*problems, Problem("a.cls", 0, foreign("z", "", "CTL940"))))
    tried = trying(SurveyedMachine("m", "c"), FileKind.CL, outcome)
    file = surveyed(FoundFile("a.cls", Path("a.cls"), FileKind.CL, word_said("NX CLSF")), [tried])
    (blocker,) = Survey("f", (), 1.0, {}, (file,)).blockers
    assert (blocker.code, blocker.opens, blocker.first.line) == ("PLN120", 1, 3)


def test_what_no_reader_understands_is_not_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    (tmp_path / "table.csv").write_text("X1,Y1,Z1,,\nX 2,Y2,Z3,,\n" * 5)
    (file,) = take_survey(tmp_path, machine=["yl569", "matsuura_mx330"]).files
    assert (str(file.became), file.looks) == ("not ours", "understood by no reader")


def test_what_cannot_be_opened_is_not_tried(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.nc")
    (tmp_path / "huge.cls").touch()
    os.truncate(tmp_path / "huge.cls", 1 << 40)
    (tmp_path / "bomb.zip").write_bytes(b"PK\x03\x04" + b"x" * 100)
    found = {each.name: (each.kind, each.looks, each.is_tried) for each in found_files(tmp_path)}
    assert found == {
        "bomb.zip": (FileKind.OTHER, "an archive: cannot be unpacked: File is not a zip file", True),
        "huge.cls": (FileKind.OTHER, "larger than 200 MB", False),
        "pipe.nc": (FileKind.OTHER, "a device or a pipe", False),
    }


def test_a_folder_that_cannot_be_read_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "locked").mkdir()
    scandir = os.scandir

    def refuse(path: str) -> Any:
        if str(path).endswith("locked"):
            raise PermissionError(13, "Permission denied", str(path))
        return scandir(path)

    monkeypatch.setattr(os, "scandir", refuse)
    (found,) = found_files(tmp_path)
    assert (found.name, found.looks, found.is_tried) == ("locked", "cannot be read: Permission denied", False)


@pytest.mark.skipif(sys.platform != "linux", reason="names are texts there")
def test_a_name_that_is_no_text_has_question_marks(tmp_path: Path) -> None:
    Path(os.fsdecode(os.fsencode(tmp_path) + b"/bad\xff.nc")).write_bytes(b"")
    assert [each.name for each in found_files(tmp_path)] == ["bad?.nc"]


def test_there_is_a_machine_for_each_reader() -> None:
    read = {entry.reader for entry in FAMILIES.values()}
    assert {FAMILIES[family_of(as_machine(name))].reader for name in MACHINES} == read


def test_a_post_that_lacks_settings_is_proven_with_stand_ins(tmp_path: Path) -> None:
    sound = (YL569 / "2_hub_rough.cls").read_text()
    bare = re.sub("(?m)^(SPINDL/RPM|FEDRAT|LOAD/TOOL).*\n", "", sound)
    assert bare != sound
    (tmp_path / "bare.cls").write_text(bare)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(taking, "LocalWorkers", Here)
        (file,) = take_survey(tmp_path, machine=["yl569"]).files
    assert file.became is Became.PROVEN_FILLED
    assert {"CTL310", "CTL510"} <= {*file.tries[0].codes}
    assert not file.passes


def test_nothing_is_decided_that_lets_through_what_is_refused() -> None:
    asks = Problem("part.cls", 3, Wording("CTL510", "operation_cuts_while_spindle", operation="OP1"))
    speed = Problem("part.cls", 3, Wording("CTL510", "operation_cuts_while", operation="OP1"))
    assert stand_ins([asks]) == {}
    assert stand_ins([asks, speed]) == {"spindle": "OP1:1000"}


def _after(path: Path, text: str, machine: str) -> Outcome:
    path.write_text(text)
    return try_steps(Trial(path.name, path, machine, (Step.INFO, Step.POST, Step.SETTINGS, Step.VERIFY)))


def test_a_file_that_cannot_be_described_without_settings_is_posted_with_stand_ins(tmp_path: Path) -> None:
    outcome = _after(tmp_path / "part.apt", OPEN, "dmu65")
    assert (outcome.status, outcome.figures[STEP]) == (Status.PASSED, Step.VERIFY)
    assert list(outcome.figures[SETTINGS]) == ["open_cycle"]


def test_a_program_is_verified_with_what_it_was_posted_with(tmp_path: Path) -> None:
    turned = HEAD.replace("1.0000000,0.0000000\nINTOL", "-1.0000000,0.0000000\nINTOL").replace(
        "0.0,0.0,1.0", "0.0,0.0,-1.0"
    )
    assert turned.count("-1.0") == 2
    outcome = _after(tmp_path / "part.cls", turned + FOOT, "hs664rt")
    assert (outcome.status, outcome.figures[STEP]) == (Status.PASSED, Step.VERIFY)
    assert outcome.figures[SETTINGS] == {"frame": "absolute"}


def test_subprograms_are_read_through_the_programs_beside_them_that_call_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = "G21 G90 G94 G17 G54\nT1 M6\nS500 M3\nG43 H1 Z50.\nG0 X0. Y0.\n"
    back = "G91 G1 X1. F100.\nG90\nM99\n"
    contents = {
        "O0001.nc": f"O0001\n{head}M98 P77\nG49\nM30\n",
        "O0077.nc": f"O0077\nM98 P88\n{back}",
        "O0088.nc": f"O0088\n{back}",
        "O0099.nc": f"O0099\n{back}",
        "O0101.nc": f"O0101\nM98 P102\n{back}",
        "O0102.nc": f"O0102\nM98 P101\n{back}",
        "other/O0077.nc": f"O0077\n{back}",
        "MAIN.MPF": "G90 G54 G17 G71\nT1 D1\nM6\nS500 M3\nPOCKET\nM30\n",
        "POCKET.SPF": "G91 G1 X1 F100\nG90\nM17\n",
    }
    for name, content in contents.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(content, encoding="utf-8")
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    found = take_survey(tmp_path, machine=["haas_umc750", "yl569"], timeout=5)
    assert {each.file: (each.looks, len(each.tries)) for each in found.files if each.became is Became.CALLED} == {
        "O0077.nc": ("a subprogram of O0001.nc", 0),
        "O0088.nc": ("a subprogram of O0077.nc", 0),
        "POCKET.SPF": ("a subprogram of MAIN.MPF", 0),
    }
    assert {each.file for each in found.files if each.tries} == contents.keys() - {"O0077.nc", "O0088.nc", "POCKET.SPF"}
    assert [each.became for each in found.files if each.file in ("O0001.nc", "MAIN.MPF")] == [Became.READ] * 2


def test_units_dialect_and_strictness_of_cl_files_are_stated_for_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(taking, "LocalWorkers", Here)
    folder = tmp_path / "cl"
    folder.mkdir()
    ways = "GOTO/0,0,40,0,0,1\nGOTO/300,0,40,0,0,1\n"
    (folder / "far.cls").write_text(f"{HEAD}{ways}{FOOT}", encoding="utf-8")
    (folder / "odd.cls").write_text(f"{HEAD}ODDITY/1\n{ways}{FOOT}", encoding="utf-8")

    def codes(**stated: Any) -> dict[str, set[str]]:
        found = take_survey(folder, machine=["yl569"], **stated)
        return {file.file: {code for each in file.tries for code in each.codes} for file in found.files}

    assert codes() == codes(strict=True) | {"odd.cls": set()} == {"far.cls": set(), "odd.cls": set()}
    assert codes(strict=True)["odd.cls"] == {"CL210"}
    assert codes(units="inch")["far.cls"] == {"PLN125"}
    assert codes(dialect="nci") == {"far.cls": {"CL110", "CL165"}, "odd.cls": {"CL110", "CL165"}}
    with pytest.raises(InputError, match="furlong"):
        codes(units="furlong")
