"""Programs in several files: they do what the program in one file does, and each can run alone."""

import io
import re
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from tests.support.locations import YL569
from tests.support.toolpath_strategies import SAYABLE, operations, skips_are_unsafe
from trunnion.arrays import Floats
from trunnion.cli import main
from trunnion.controls import load_control
from trunnion.controls.definition import SubprogramNaming
from trunnion.errors import InputError, RefusedError, Severity
from trunnion.files import atomic_output
from trunnion.jobs.post.post_job import parse_plan_options
from trunnion.machines import load_machine
from trunnion.model.run import Run
from trunnion.model.toolpath import (
    Arcs,
    Coolant,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    Frame,
    Kind,
    LoadTool,
    Moves,
    Operation,
    Phase,
    Sense,
    SpindleOn,
    Tool,
    Toolpath,
)
from trunnion.output.capabilities import control_capabilities
from trunnion.output.program import Program
from trunnion.output.program_writer import write_program
from trunnion.output.subprograms import END_RESERVE_BYTES, MIN_SUBPROGRAM_BYTES, SubprogramNames, SubprogramOutput
from trunnion.output.validation import check_program
from trunnion.planning import plan
from trunnion.readers import run_program
from trunnion.readers.program.options import RunOptions
from trunnion.verification.comparison import compare


def without_words(run: Run) -> Run:
    """A run without the builder's words, and without M words that repeat the last one.

    Each file says again what is in force where it begins: coolants with words of their own, and M29 before a thread.
    """
    last: object = None
    kept = []
    for event in run.events:
        repeats = event.kind == "m" and event.value == last
        last = event.value if event.kind == "m" else last
        if event.kind != "known" and not repeats:
            kept.append(event)
    return replace(run, events=kept)


class Language(NamedTuple):
    """How a control calls a subprogram, and how one ends.

    alone   a program that runs one alone, if its file is not enough
    before  what stands before its name in that of its file
    """

    call: str
    end: str
    alone: str = ""
    before: str = ""


#: A machine of each control that calls subprograms.
CONTROLS = {
    "yl569": Language(r"EXTCALL\(\"(?P<name>[A-Z_0-9]+)\"\)", "M17"),
    "dmu65": Language(r"CALL PGM (?P<name>[A-Z_0-9]+)\.H", "END PGM {name} MM"),
    "matsuura_mx330": Language(r"M98 P(?P<name>\d{4})", "M99\n%", "O9999\nM98 P{name}\nM30\n", "O"),
    "xyzac_trt": Language(r"o<(?P<name>[a-z_0-9]+)> call", "o<{name}> endsub", "o<{name}> call\nM2\n"),
}

MACHINES = {name: load_machine(name) for name in CONTROLS}

#: Tool axes that all these machines reach, upright ones among them, and none near a pole.
AXES = st.one_of(st.just((0.0, 0.0, 1.0)), st.tuples(st.floats(0.1, 0.5), st.floats(-0.5, 0.5), st.floats(0.8, 1)))

#: Events that all these controls can say.
KINDS = SAYABLE | {
    "coolant": st.sampled_from(["ON", "MIST", "OFF"]).map(lambda kind: Coolant(0, 0, kind)),
    "dwell": st.integers(1, 99999).map(lambda n: Dwell(0, 0, n / 1000, revolutions=False)),
}

TOOLPATHS = st.lists(operations(KINDS, AXES), min_size=1, max_size=3).map(
    lambda found: Toolpath("made.cls", tuple(found), "part.prt")
)


@dataclass(frozen=True)
class WrittenProgram:
    """A main program and its subprograms, as files of a folder."""

    main: Path
    others: list[Path]

    def run(self, machine: str) -> Run:
        return run_program(self.main, MACHINES[machine], RunOptions(subprograms=self.others))


def written(
    machine: str, toolpath: Toolpath, folder: Path, largest: int | None = None
) -> tuple[Run, WrittenProgram] | None:
    """The program in one file as it runs, and in several; None where there can be none."""
    model = MACHINES[machine]
    control = load_control(model.control)
    options, capabilities = parse_plan_options({}, control), control_capabilities(control, {})
    try:
        planned = plan([toolpath], model, control.arcs.chord_tolerance, options, capabilities)
    except RefusedError as refused:
        if not skips_are_unsafe(refused):
            raise
        return None
    # Rotary axes that turn before any work offset, as in published programs, are elsewhere than behind one.
    given = {"tool": "7", "standing_spindle": "allowed", "safe_start": "all"}
    program = Program(model, control, planned.motions, given, toolpath.file)
    if any(problem.severity is Severity.ERROR for problem in check_program(program)):
        return None
    one = folder / f"one{control.extension}"
    with one.open("wb") as sink:
        write_program(program, sink)
    made: dict[Path, io.BytesIO] = {}

    def begin(name: str) -> io.BytesIO:
        assert folder / name not in made
        return made.setdefault(folder / name, io.BytesIO())

    head = io.BytesIO()
    write_program(program, head, subprograms=SubprogramOutput("part", begin, largest))
    made[folder / f"part{control.extension}"] = head
    for path, each in made.items():
        path.write_bytes(each.getvalue())
    *others, first = made
    return run_program(one, model), WrittenProgram(first, others)


@pytest.mark.parametrize("machine", CONTROLS)
@settings(max_examples=examples(8))
@given(toolpath=TOOLPATHS, largest=st.sampled_from([None, END_RESERVE_BYTES + 1800]))
def test_a_program_in_several_files_does_what_it_does_in_one(
    tmp_path_factory: pytest.TempPathFactory, machine: str, toolpath: Toolpath, largest: int | None
) -> None:
    made = written(machine, toolpath, tmp_path_factory.getbasetemp(), largest)
    assume(made is not None)
    assert made is not None
    one, several = made
    assume("NC343" not in {each.code for each in one.errors})  # a CUTCOM that changes sides without a way between
    run = several.run(machine)
    assert run.errors == one.errors == ()
    found = compare(without_words(one), without_words(run), 1e-9)
    assert found.same, "\n".join(found.lines())
    told = [
        [(e.kind, e.value) for e in each.events if e.kind in ("dwell", "stop", "optional_stop")] for each in (one, run)
    ]
    assert told[0] == told[1]
    language = CONTROLS[machine]
    lines = several.main.read_text(encoding="utf-8").splitlines()
    names = [match["name"] for line in lines if (match := re.search(language.call, line))]
    assert [language.before + name for name in names] == [path.stem for path in several.others]
    assert len(names) >= len(toolpath.operations)
    for path in several.others:
        assert path.read_text(encoding="utf-8").rstrip().endswith(language.end.format(name=path.stem))


#: Cycles that all these controls have, each with its number of holes.
CYCLES = st.lists(
    st.tuples(
        st.sampled_from([("DRILL",), ("DRILL", "DEEP"), ("TAP",), ("BORE",)]),
        st.lists(st.tuples(*[st.integers(-300, 300)] * 2, st.sampled_from([0, 0, 40])), min_size=1, max_size=12),
    ),
    min_size=1,
    max_size=3,
)


def drilling(cycles: list[tuple[tuple[str, ...], list[tuple[int, int, int]]]], axis: tuple[float, ...]) -> Toolpath:
    """Holes on a plane and on steps of it, a rapid before and behind those of each cycle; lengths are tenths."""
    across = np.linalg.svd(np.array([axis]))[2][1:]
    points, kinds, events = (
        list[Floats](),
        list[Kind](),
        list[Event]([LoadTool(0, 1, 1), SpindleOn(0, 1, 1000.0, Sense.CLW)]),
    )
    for mode, places in cycles:
        flat = [0.1 * (x * across[0] + y * across[1] + z * np.array(axis)) for x, y, z in places]
        feed = ("MMPR", (1.25,)) if mode == ("TAP",) else ("MMPM", (90.0,))
        values = (("RAPTO", (3.0,)), ("FEDTO", (-12.0,)), ("RTRCTO", (9.0,)), ("STEP", (2.5,)), feed)
        events += [CycleOn(len(points) + 1, 1, mode, values), CycleOff(len(points) + 1 + len(flat), 1)]
        points += [flat[0] + 50.0 * np.array(axis), *flat, flat[-1] + 50.0 * np.array(axis)]
        kinds += [Kind.RAPID, *[Kind.LINEAR] * len(flat), Kind.RAPID]
    n = len(points)
    kind = np.array(kinds, np.uint8)
    moves = Moves(
        np.array(points), np.tile(axis, (n, 1)), kind, np.where(kind, np.uint8(Phase.CUT), np.uint8(Phase.RAPID)),
        np.full(n, 300.0), np.zeros(n, bool), np.arange(1, n + 1, dtype=np.int32),
    )  # fmt: skip
    tool = Tool("DRILL", "D8", 8.0, 0.0, 75.0)
    operation = Operation("HOLES", tool, Frame(), moves, Arcs.empty(), tuple(events), 1, 0.01, 0.01)
    return Toolpath("holes.cls", (operation,))


@pytest.mark.parametrize("machine", CONTROLS)
@settings(max_examples=examples(6))
@given(cycles=CYCLES, tilted=st.booleans(), room=st.sampled_from([1800, 3000]))
def test_holes_are_divided_between_two_of_them(
    tmp_path_factory: pytest.TempPathFactory,
    machine: str,
    cycles: list[tuple[tuple[str, ...], list[tuple[int, int, int]]]],
    tilted: bool,
    room: int,
) -> None:
    axis = (0.48, 0.36, 0.8) if tilted else (0.0, 0.0, 1.0)
    made = written(machine, drilling(cycles, axis), tmp_path_factory.getbasetemp(), END_RESERVE_BYTES + room)
    assume(made is not None)  # LinuxCNC has no threads along a tilted axis
    assert made is not None
    one, several = made
    run = several.run(machine)
    assert run.errors == one.errors == ()
    found = compare(without_words(one), without_words(run), 1e-9)
    assert found.same, "\n".join(found.lines())
    drills = [np.count_nonzero(each.kind != Kind.RAPID) for each in (one, run)]
    assert drills[0] == drills[1] > 0
    waits = [[e.value for e in each.events if e.kind == "dwell"] for each in (one, run)]
    assert waits[0] == waits[1]
    if room == 1800 and sum(len(places) for _, places in cycles) > 8:
        assert len(several.others) > 1


@pytest.mark.parametrize("machine", CONTROLS)
@settings(max_examples=examples(8))
@given(toolpath=TOOLPATHS)
def test_each_operation_can_be_entered_alone(
    tmp_path_factory: pytest.TempPathFactory, machine: str, toolpath: Toolpath
) -> None:
    """What a subprogram does without its main program is what it does with it."""
    made = written(machine, toolpath, tmp_path_factory.getbasetemp())
    assume(made is not None)
    assert made is not None
    whole = made[1].run(machine)
    for k, path in enumerate(made[1].others):
        calling, language = path.with_name("alone"), CONTROLS[machine]
        calling.write_text(language.alone.format(name=path.stem.removeprefix(language.before)), encoding="utf-8")
        alone = (WrittenProgram(calling, [path]) if language.alone else WrittenProgram(path, [])).run(machine)
        assert alone.errors == ()
        rows = whole.file == whole.files.index(str(path)) if str(path) in whole.files else None
        assert rows is not None
        assert rows.sum() == len(alone), k
        for name in ("tip", "axis", "kind", "spindle", "tcp", "machine_frame"):
            # An endless axis may stand some turns away from where it stands after other operations.
            np.testing.assert_allclose(
                getattr(whole, name)[rows], getattr(alone, name), rtol=0, atol=1e-9, err_msg=name
            )
        at_work = ~alone.machine_frame & (alone.work_offset > 0)
        cuts = at_work & (alone.kind != 0)
        for name, count in {
            "work_offset": at_work,
            "edge": at_work,
            "feed": cuts,
            "feed_mode": cuts,
            "rpm": cuts,
        }.items():
            assert (getattr(whole, name)[rows][count] == getattr(alone, name)[count]).all(), name


def test_parts_of_an_operation_are_no_larger_than_asked_and_say_what_is_in_force(tmp_path: Path) -> None:
    target, size = tmp_path / "hub.mpf", MIN_SUBPROGRAM_BYTES
    cl = tmp_path / "hub.cls"
    text = (YL569 / "2_hub_rough.cls").read_text()
    begin, end = text.index("GOTO/"), text.rindex("GOTO/")
    moves = text[begin:end]
    cl.write_text(text[:begin] + moves * 100 + text[end:])
    common = ["post", str(cl), "--machine", "yl569", "--output", str(target)]
    assert main([*common, "--set", "programs=operations", "--set", f"split={size}"]) == 0
    parts = sorted(tmp_path.glob("*.spf"))
    assert len(parts) > 3
    assert all(path.stat().st_size <= size for path in parts)
    for path in parts[1:]:
        moving = next(line for line in path.read_text().splitlines() if " X" in line and "_X_HOME" not in line)
        assert re.fullmatch(r"N\d+ (G40 )?G94 G17 G[01] X\S+ Y\S+ Z\S+ B\S+ C\S+ S\d+ D1 M3( M8)?( F\S+)?", moving), (
            moving
        )
    again = tmp_path / "one.mpf"
    assert main([*common[:-1], str(again)]) == 0
    files = ["--to-subprograms", *map(str, parts)]
    assert main(["diff", str(again), str(target), "--machine", "yl569", *files, "--tolerance", "1e-9"]) == 0


def test_parts_with_holes_are_no_larger_than_asked(tmp_path: Path) -> None:
    cl, target = tmp_path / "holes.cls", tmp_path / "holes.mpf"
    head, end = (YL569 / "2_hub_rough.cls").read_text().split("GOTO/", 1)[0], "END-OF-PATH\n"
    points = "".join(f"GOTO/{k % 40},{k // 40},{k % 3}\n" for k in range(900))
    cycle = "CYCLE/DRILL,DEEP,RAPTO,3,FEDTO,-12,STEP,2.5,RTRCTO,9,MMPM,90\n"
    cl.write_text(f"{head}GOTO/0,0,50,0,0,1\n{cycle}{points}CYCLE/OFF\nRAPID\nGOTO/0,0,50\n{end}")
    common = ["post", str(cl), "--machine", "yl569", "--output", str(target)]
    assert main([*common, "--set", "programs=operations", "--set", f"split={MIN_SUBPROGRAM_BYTES}"]) == 0
    parts = sorted(tmp_path.glob("*.spf"))
    assert len(parts) > 3
    assert all(path.stat().st_size <= MIN_SUBPROGRAM_BYTES for path in parts)
    assert parts[1].read_text().splitlines()[5].endswith("S2000 D1 M3"), parts[1].read_text()[:600]


NAMINGS = st.sampled_from([SubprogramNaming(".spf", True, 24, ("CYCLE",)), SubprogramNaming(".ngc", False, 12)])


@given(naming=NAMINGS, main_program=st.sampled_from(["PART", "OP"]), texts=st.lists(st.text(max_size=40), max_size=30))
def test_names_are_such_as_controls_take_and_each_is_given_once(
    naming: SubprogramNaming, main_program: str, texts: list[str]
) -> None:
    names = SubprogramNames(naming, main_program)
    found = [names.unique(text) for text in [*texts, *texts, "CON", "cycle81", "", "刀具", "1st"]]
    letters = "[A-Z]{2}[A-Z0-9_]*" if naming.capitals else "[a-z]{2}[a-z0-9_]*"
    assert all(re.fullmatch(letters, name) and len(name) <= naming.max_length for name in found)
    assert len({name.upper() for name in [*found, main_program]}) == len(found) + 1
    assert not {"CON", "NUL", "COM1"} & {name.upper() for name in found}
    assert not any(name.upper().startswith(naming.reserved_prefixes) for name in found)


@given(first=st.integers(1, 9990), program=st.integers(1, 9999), texts=st.lists(st.text(), max_size=8))
def test_numbers_are_given_once_and_never_that_of_the_main_program(first: int, program: int, texts: list[str]) -> None:
    names = SubprogramNames(SubprogramNaming(".nc", True, 4, first_number=first), "part", f"{program:04d}")
    found = [int(names.unique(text)) for text in texts]
    assert found == [n for n in range(first, first + 9) if n != program][: len(texts)]


@pytest.mark.parametrize("main_program", ["O1001", "o1001", "1001"])
def test_no_number_is_that_of_the_main_programs_file(main_program: str) -> None:
    names = SubprogramNames(SubprogramNaming(".nc", True, 4, first_number=1001, prefix="O"), main_program, "0001")
    assert [names.unique("a"), names.unique("b")] == ["1002", "1003"]


def test_numbers_come_to_an_end() -> None:
    names = SubprogramNames(SubprogramNaming(".nc", True, 4, first_number=9998), "9999")
    assert names.unique("a") == "9998"
    with pytest.raises(InputError, match="no program numbers are left from 9998 on"):
        names.unique("b")


def test_files_appear_together_or_as_they_were(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("part.mpf", "A.spf", "C.spf"):
        (tmp_path / name).write_text(f"old {name}")
    before = {path.name: path.read_text() for path in tmp_path.iterdir()}
    target = str(tmp_path / "part.mpf")

    def write(fails: str = "") -> None:
        with atomic_output(target) as made:
            made.main.write(b"main")
            for name in ("A.spf", "B.spf", "C.spf"):
                made.add_file(name).write(name.encode())
            if fails == "inside":
                raise ValueError("inside")

    with pytest.raises(ValueError, match="inside"):
        write("inside")
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before
    real = Path.replace
    for broken in ("A.spf", "B.spf", "C.spf", "part.mpf"):

        def replaced(self: Path, there: Path, name: str = broken) -> Path:
            if there.name == name and self.suffix != ".before":
                raise PermissionError(13, "Permission denied")
            return real(self, there)

        monkeypatch.setattr(Path, "replace", replaced)
        with pytest.raises(InputError, match="cannot be written: Permission denied"):
            write()
        assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before
    monkeypatch.setattr(Path, "replace", real)
    write()
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {
        "part.mpf": "main", "A.spf": "A.spf", "B.spf": "B.spf", "C.spf": "C.spf"
    }  # fmt: skip


def test_a_folder_in_the_way_stays(tmp_path: Path) -> None:
    (tmp_path / "A.spf").mkdir()
    with (
        pytest.raises(InputError, match=r"A\.spf: error: .* it is a folder"),
        atomic_output(str(tmp_path / "part.mpf")) as made,
    ):
        made.add_file("A.spf")
    assert [path.name for path in tmp_path.iterdir()] == ["A.spf"]


REFUSED = {
    "no control for it": (["--machine", "hs664rt", "--set", "programs=operations"], "no words for subprograms"),
    "stdout": (
        ["--machine", "yl569", "--set", "programs=operations", "--output", "-"],
        "a program of several files needs a place",
    ),
    "split alone": (["--machine", "yl569", "--set", "split=1000000"], "write programs=operations too"),
    "too small": (["--machine", "yl569", "--set", "programs=operations", "--set", "split=99"], "at least 20480"),
    "another word": (["--machine", "yl569", "--set", "programs=many"], "write programs=one or programs=operations"),
}


@pytest.mark.parametrize(("arguments", "what"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_is_refused_with_its_cure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], arguments: list[str], what: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["post", str(YL569 / "3_blade_finish.cls"), *arguments]) == 2
    assert what in capfd.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_program_that_must_not_run_is_not_written_and_forced_says_so_in_every_file(tmp_path: Path) -> None:
    files = [str(YL569 / f"{name}.cls") for name in ("2_hub_rough", "3_blade_finish")]
    machine = tmp_path / "short.toml"
    own = 'schema = 1\nextends = "yl569"\nname = "short"\n[[axis]]\nname = "B"\nlimits_deg = [-11, 30]\n'
    machine.write_text(own, encoding="utf-8")
    target = tmp_path / "out"
    target.mkdir()
    common = ["post", *files, "--machine", str(machine), "--output", str(target / "part.mpf")]
    assert main([*common, "--set", "programs=operations"]) == 1
    assert list(target.iterdir()) == []
    assert main([*common, "--set", "programs=operations", "--force"]) == 1
    made = sorted(target.iterdir())
    assert [path.name for path in made] == ["BLADE_FINISH.spf", "MULTI_BLADE_ROUGH.spf", "part.mpf"]
    assert all("MUST NOT RUN AS IT IS" in path.read_text(encoding="utf-8") for path in made)
