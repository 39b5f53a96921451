"""Hooks: what they change is checked, told and proven; what they do wrong is told at their line; none runs unasked."""

import re
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT, TESTS
from trunnion.cli import main

SHOP = (TESTS / "data" / "shop.cls").read_text(encoding="utf-8")
CL = SHOP.replace("BORHED/40.5,DEEP\n", "")

IMPORTS = "from dataclasses import replace\nfrom trunnion.hooks import *\n"


@pytest.fixture
def part(tmp_path: Path) -> Path:
    file = tmp_path / "part.cls"
    file.write_text(CL, encoding="utf-8")
    return file


def hook(part: Path, text: str, name: str = "shop.py") -> Path:
    """A file of hooks, whose functions begin in line 3."""
    file = part.parent / name
    file.write_text(IMPORTS + text, encoding="utf-8")
    return file


def posted(part: Path, *hooks: Path, output: Path | None = None, report: Path | None = None) -> trunnion.PostResult:
    result = trunnion.post(part, machine="yl569", hooks=hooks, output=output, report=report)
    assert result.passed
    return result


def refusal(part: Path, text: str) -> trunnion.Problem:
    with pytest.raises(trunnion.TrunnionError) as caught:
        trunnion.post(part, machine="yl569", hooks=[hook(part, text)])
    return next(problem for problem in caught.value.problems if problem.severity is trunnion.Severity.ERROR)


def told(result: trunnion.PostResult) -> list[trunnion.Problem]:
    return [problem for problem in result.problems if problem.file.endswith(".py")]


def test_a_hook_that_changes_nothing_leaves_the_program_as_it_is(part: Path) -> None:
    quiet = hook(
        part,
        "def on_operation(operation, context):\n    return operation\n"
        "def on_event(event, context):\n    return event if isinstance(event, Message) else None\n"
        "def on_block(block, context):\n    return []\n",
    )
    result = posted(part, quiet)
    assert result.text == posted(part).text
    assert not told(result)


def test_changed_events_are_in_the_program_and_told(part: Path) -> None:
    file = hook(
        part,
        "def on_event(event, context):\n"
        "    if isinstance(event, Message):\n"
        "        return [Message(0, 0, event.text.upper()), Insert(0, 0, 'M61')]\n"
        "    if isinstance(event, Coolant):\n"
        "        return []\n",
    )
    result = posted(part, file)
    lines = [line.split(" ", 1)[1] for line in (result.text or "").splitlines()]
    at = lines.index(";CHECK THE CLAMPS (3X)")
    assert lines[at + 1] == "M61"
    assert "M8" not in (result.text or "")
    (problem,) = told(result)
    assert (problem.file, problem.line, problem.severity) == (str(file), 3, trunnion.Severity.WARNING)
    assert problem.what.startswith("operation ROUGH TOP: hooks changed its events")
    assert "MOTION CHANGED" not in (result.text or "")


def test_changed_motion_is_what_the_program_is_proven_against_and_its_head_says_so(part: Path, tmp_path: Path) -> None:
    file = hook(
        part,
        "def on_operation(operation, context):\n"
        "    if context.number == 2:\n"
        "        moves = operation.moves\n"
        "        moves = replace(moves, feed=moves.feed / 2, tip=moves.tip + [0.0, 0.0, 1.0])\n"
        "        return replace(operation, moves=moves)\n",
    )
    result = posted(part, file, report=tmp_path / "report.json")
    assert "MOTION CHANGED BY HOOKS shop.py: DRILL SIDE" in (result.text or "").splitlines()[0]
    (problem,) = told(result)
    assert "hooks changed its motion at 4 of 4 points" in problem.what
    assert float(result.motions[1].operation.moves.feed[1]) == 150.0
    assert "hooks changed its motion" in (tmp_path / "report.json").read_text(encoding="utf-8")
    (tmp_path / "part.mpf").write_text(result.text or "", encoding="utf-8")
    assert not trunnion.verify(tmp_path / "part.mpf", cl=part, machine="yl569").passed
    trunnion.convert(tmp_path / "part.mpf", machine="yl569", to_cl=True, output=tmp_path / "back.cls")
    back = (tmp_path / "back.cls").read_text(encoding="utf-8")
    assert "MOTION CHANGED BY HOOKS shop.py: DRILL SIDE" in back
    assert "title=" not in back


SLOWER = (
    "def on_operation(operation, context):\n"
    "    return replace(operation, moves=replace(operation.moves, feed=operation.moves.feed / 2))\n"
)


@pytest.mark.parametrize(("source", "target"), [
    ("yl569", "dmu65"), ("dmu65", "matsuura_mx330"), ("matsuura_mx330", "hs664rt"), ("hs664rt", "xyzbc_trt"),
    ("xyzbc_trt", "yl569"), ("yl569", "yl569"),
])  # fmt: skip
@pytest.mark.parametrize("by_cl", [False, True])
def test_a_converted_program_keeps_the_notice_at_its_head(
    part: Path, tmp_path: Path, source: str, target: str, by_cl: bool
) -> None:
    names = [f"AN OPERATION WITH A RATHER LONG NAME {letter}" for letter in "ABC"]
    text = part.read_text()
    for old, new in zip(("ROUGH TOP", "DRILL SIDE", "FINISH SIDE"), names, strict=True):
        text = text.replace(old, new)
    part.write_text(text)
    file = hook(part, SLOWER)
    trunnion.post(part, machine=source, hooks=[file], output=tmp_path / "part.nc")
    if by_cl:
        back = tmp_path / "back.cls"
        trunnion.convert(tmp_path / "part.nc", machine=source, to_cl=True, output=back)
        assert trunnion.post(back, machine=target, output=tmp_path / "out.nc").passed
    else:
        found = trunnion.convert(tmp_path / "part.nc", machine=source, to_machine=target, output=tmp_path / "out.nc")
        assert found.posted is not None
        assert found.posted.passed
        assert "title" not in found.settings
    out = (tmp_path / "out.nc").read_text()
    assert out.upper().count("MOTION CHANGED BY HOOKS SHOP.PY") == 1
    head = "".join(re.sub(r"^N?\d+ |[ ;()]", "", line) for line in out.splitlines()[:6]).upper()
    assert "MOTIONCHANGEDBYHOOKSSHOP.PY" in head
    for name in names:
        assert name.replace(" ", "") in head, "also behind the end of a line"


def test_a_program_without_such_a_notice_gets_none(part: Path, tmp_path: Path) -> None:
    trunnion.post(part, machine="yl569", output=tmp_path / "part.nc")
    trunnion.convert(tmp_path / "part.nc", machine="yl569", to_machine="dmu65", output=tmp_path / "out.nc")
    assert "HOOKS" not in (tmp_path / "out.nc").read_text()


def test_what_a_hook_prints_is_no_part_of_the_program(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    noisy = hook(part, "print('LOADED')\ndef on_operation(operation, context):\n    print('CALLED')\n")
    result = posted(part, noisy)
    assert result.text == posted(part).text
    out, err = capsys.readouterr()
    assert not out
    assert err.count("LOADED") == 1
    assert err.count("CALLED") == 3


def test_operations_can_be_left_out_and_multiplied(part: Path) -> None:
    file = hook(
        part,
        "def on_operation(operation, context):\n"
        "    if operation.name == 'DRILL SIDE':\n        return []\n"
        "    if operation.name == 'FINISH SIDE':\n        return [operation, replace(operation, name='AGAIN')]\n",
    )
    result = posted(part, file)
    assert [motion.operation.name for motion in result.motions] == ["ROUGH TOP", "FINISH SIDE", "AGAIN"]
    assert [problem.what.split(";")[0] for problem in told(result)] == [
        "operation DRILL SIDE: hooks left it out",
        "operation FINISH SIDE: hooks made 2 operations of it and changed its events (2 to 4)",
    ]
    assert "MOTION CHANGED BY HOOKS shop.py: DRILL SIDE, FINISH SIDE, AGAIN" in (result.text or "")


def test_a_hook_at_a_block_adds_events_before_and_behind_it(part: Path) -> None:
    file = hook(
        part,
        "def on_block(block, context):\n"
        "    if context.operation.name == 'ROUGH TOP' and block.kind is Kind.LINEAR and block.tip[0] == 10.0:\n"
        "        assert block.feed == 500.0 and block.axis == (0.0, 0.0, 1.0)\n"
        "        assert context.machine and context.settings == {}\n"
        "        return [Insert(block.row, 0, 'M61'), Insert(block.row + 1, 0, 'M62')]\n",
    )
    lines = [line.split(" ", 1)[1] for line in (posted(part, file).text or "").splitlines()]
    first, second = lines.index("M61"), lines.index("M62")
    assert [line for line in lines[first:second] if "X10." in line]


def test_a_hook_sees_statements_that_are_not_known(part: Path) -> None:
    part.write_text(SHOP.replace("BORHED/40.5,DEEP", "AUXFUN/61"), encoding="utf-8")
    with pytest.raises(trunnion.InputError, match="AUXFUN"):
        posted(part)
    file = hook(
        part,
        "def on_event(event, context):\n"
        "    if isinstance(event, UnknownStatement) and event.text.startswith('AUXFUN/'):\n"
        "        return Insert(0, 0, 'M' + event.text.partition('/')[2])\n",
    )
    result = posted(part, file)
    assert "M61" in (result.text or "").split()
    assert not [problem for problem in result.problems if "AUXFUN" in problem.what]


def test_files_of_hooks_are_called_one_after_the_other(part: Path) -> None:
    texts = ("event.text + '1'", "event.text + '2'")
    body = "def on_event(event, context):\n    if isinstance(event, Message):\n        return Message(0, 0, {})\n"
    files = [hook(part, body.format(text), f"{k}.py") for k, text in enumerate(texts)]
    assert ";check the clamps (3x)12" in (posted(part, *files).text or "")
    assert ";check the clamps (3x)21" in (posted(part, *files[::-1]).text or "")


@pytest.mark.third
@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("def on_event(event, context:\n    pass\n", 3, "SyntaxError"),
        ("x = 1\ny = x / 0\n", 4, "ZeroDivisionError: division by zero"),
        ("import no_such_module\n", 3, "ModuleNotFoundError"),
        ("x = 1\n", 0, "has no hooks"),
        ("def on_evnt(event, context):\n    pass\n", 3, "on_evnt is no hook"),
        ("def on_event(event):\n    pass\n", 3, "takes other arguments"),
        ("def on_event(event, context):\n\n    return event.no_such\n", 5, "AttributeError"),
        ("def on_event(e, c):\n    return told()\ndef told():\n    raise ValueError('no tool 7')\n", 6, "no tool 7"),
        ("def on_operation(operation, context):\n    raise SystemExit(0)\n", 4, "SystemExit"),
        ("def on_operation(operation, context):\n    return 'M30'\n", 3, "type str"),
        ("def on_event(event, context):\n    return ['M30']\n", 3, "type list"),
        ("def on_event(event, context):\n    return Event(0, 0)\n", 3, "no event"),
        ("def on_event(event, context):\n    return Insert(0, 0, 'M1\\nM30')\n", 3, "text"),
        ("def on_event(event, context):\n    return Insert(0, 0, 5)\n", 3, "text"),
        ("def on_event(event, context):\n    return Dwell(0, 0, float('nan'))\n", 3, "amount"),
        ("def on_event(event, context):\n    return SpindleOn(0, 0, 500.0, 'CLW')\n", 3, "sense"),
        ("def on_event(event, context):\n    return Stop(0, 0, 1)\n", 3, "optional"),
        ("def on_event(event, context):\n    return CycleOn(0, 0, ('DRILL',), (('RAPTO', 3.0),))\n", 3, "values"),
        ("def on_block(block, context):\n    return Message(True, 'x', 7)\n", 3, "row = True"),
        ("def on_block(block, context):\n    return Message(block.row, 'x', 7)\n", 3, "line = 'x'"),
        ("def on_operation(o, c):\n    return replace(o, events=(Message('1', 0, 'A'),))\n", 3, "row = '1'"),
        ("def on_operation(o, c):\n    return replace(o, tool=replace(o.tool, diameter=-1))\n", 3, "diameter = -1"),
        ("def on_operation(o, c):\n    return replace(o, tool=replace(o.tool, length=float('inf')))\n", 3, "length"),
        ("def on_operation(o, c):\n    return replace(o, tool=replace(o.tool, kind='SAW'))\n", 3, "SAW"),
        ("def on_operation(o, c):\n    return replace(o, tool=None)\n", 3, "tool"),
        ("def on_operation(o, c):\n    return replace(o, events=None)\n", 3, "events"),
        ("def on_operation(o, c):\n    return replace(o, intol=-1.0)\n", 3, "intol"),
        ("def on_operation(o, c):\n    return replace(o, frame=replace(o.frame, x=(2.0, 0.0, 0.0)))\n", 3, "unit"),
        ("def on_block(block, context):\n    return Insert(block.row + 2, 0, 'M61')\n", 3, "row"),
        ("def on_operation(o, c):\n    return replace(o, moves=replace(o.moves, feed=o.moves.feed[1:]))\n", 3, "feed"),
        ("def on_operation(o, c):\n    return replace(o, moves=replace(o.moves, axis=-2 * o.moves.axis))\n", 3, "unit"),
        ("def on_operation(o, c):\n    return replace(o, moves=replace(o.moves, tip=o.moves.tip / 0))\n", 3, "point"),
        ("def on_operation(o, c):\n    return replace(o, moves=o.moves.select(slice(0)))\n", 3, "no points"),
        ("def on_operation(o, c):\n    return replace(o, moves=replace(o.moves, kind=o.moves.kind + 1))\n", 3, "kind"),
        ("def on_operation(o, c):\n    return replace(o, name='A\\nM30')\n", 3, "control characters"),
        ("def on_operation(o, c):\n    return replace(o, events=(Stop(99, 0, False),))\n", 3, "row 99"),
    ],
)  # fmt: skip
def test_what_a_hook_does_wrong_is_told_at_its_line(part: Path, text: str, line: int, what: str) -> None:
    problem = refusal(part, text)
    assert (Path(problem.file).name, problem.line) == ("shop.py", line)
    assert what in problem.what
    assert not list(part.parent.glob("*.mpf"))


@pytest.mark.parametrize(
    "text",
    [
        "def on_operation(o, c):\n    o.moves.tip.setflags(write=True)\n    o.moves.tip[2, 0] += 5.0\n",
        "def on_operation(o, c):\n    o.moves.tip.setflags(write=True)\n    o.moves.tip[2, 0] += 5.0\n    return o\n",
        "def on_event(e, c):\n    m = c.operation.moves\n    m.feed.setflags(write=True)\n    m.feed[-1] = 9000.0\n",
        "def on_block(b, c):\n    m = c.operation.moves\n    m.kind.setflags(write=True)\n    m.kind[2] = 0\n",
        "def on_operation(o, c):\n    object.__setattr__(o, 'name', 'OTHER')\n",
        "def on_event(e, c):\n    object.__setattr__(e, 'row', 1)\n",
        "def on_operation(o, c):\n    object.__setattr__(o.tool, 'diameter', 3.0)\n    return replace(o)\n",
    ],
)
def test_what_a_hook_changes_in_place_is_refused(part: Path, text: str) -> None:
    problem = refusal(part, text)
    assert (problem.line, problem.code) == (3, "HOK135")
    assert "in place" in problem.what


HALF = "    feed = o.moves.feed * 0.5\n    return replace(o, moves=replace(o.moves, feed=feed[:]))\n"


@pytest.mark.parametrize(
    ("honest", "keeping"),
    [
        (
            "def on_operation(o, c):\n" + HALF,
            "KEPT = []\ndef on_operation(o, c):\n    for each in KEPT: each[:] = 9000.0\n"
            + HALF.replace("    return", "    KEPT.append(feed)\n    return"),
        ),
        (
            "def on_event(e, c): return None\n",
            "KEPT = []\ndef on_event(e, c):\n    for m in KEPT:\n        if m is not c.operation.moves:\n"
            "            m.tip.setflags(write=True)\n            m.tip[:, 2] += 1.0\n"
            "    KEPT.append(c.operation.moves)\n",
        ),
        (
            "def on_event(e, c): return [e, Stop(0, 0, False, 'LOOK')]\n",
            "KEPT = []\ndef on_event(e, c):\n    for each in KEPT: object.__setattr__(each, 'text', 'OTHER')\n"
            "    KEPT.append(Stop(0, 0, False, 'LOOK'))\n    return [e, KEPT[-1]]\n",
        ),
        (
            "def on_block(b, c): return Stop(b.row, 1, False, 'LOOK') if b.row == 2 else None\n",
            "KEPT = []\ndef on_block(b, c):\n    for each in KEPT: object.__setattr__(each, 'text', 'OTHER')\n"
            "    if b.row == 2:\n        KEPT.append(Stop(b.row, 1, False, 'LOOK'))\n        return KEPT[-1]\n",
        ),
    ],
)
def test_what_a_hook_keeps_and_changes_later_is_in_no_program(part: Path, honest: str, keeping: str) -> None:
    wanted = posted(part, hook(part, honest)).text
    assert posted(part, hook(part, keeping)).text == wanted
    assert wanted != ""
    assert "OTHER" not in (wanted or "")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("def on_operation(o, c):\n    return 7\n", "HOK130"),
        ("def on_operation(o, c):\n    return replace(o, name='A\\nM30')\n", "HOK132"),
        ("def on_event(e, c):\n    return Stop(0, 0, False, 'A\\nB')\n", "HOK132"),
        ("def on_block(b, c):\n    return Stop(b.row + 2, 0, False)\n", "HOK132"),
        ("def on_operation(o, c):\n    return []\n", "HOK160"),
    ],
)
def test_each_fault_of_a_hook_has_the_explanation_with_its_cure(part: Path, text: str, code: str) -> None:
    problem = refusal(part, text)
    assert (problem.line, problem.code) == (3, code)


def test_raw_text_of_a_hook_is_tried_as_that_of_a_cl_file(part: Path) -> None:
    problem = refusal(part, "def on_block(block, context):\n    return Insert(block.row, 0, 'G91')\n")
    assert problem.what.startswith("INSERT/G91: ")
    text = "    return Insert(0, 0, 'G91', 'program_start') if isinstance(event, Message) else None\n"
    problem = refusal(part, "def on_event(event, context):\n" + text)
    assert problem.what.startswith("INSERT/G91: ")


@pytest.mark.parametrize(
    ("name", "what"), [("none.py", "file not found"), ("part.cls", "no Python file"), (".", "is a folder")]
)
def test_what_is_no_file_of_hooks_is_refused(part: Path, name: str, what: str) -> None:
    with pytest.raises(trunnion.InputError, match=what):
        posted(part, part.parent / name)


def test_no_file_of_hooks_is_written_over(part: Path) -> None:
    file = hook(part, "def on_block(block, context):\n    return None\n")
    before = file.read_bytes()
    with pytest.raises(trunnion.InputError, match=r"shop\.py"):
        posted(part, file, output=file)
    assert main(["post", str(part), "--machine", "yl569", "--hooks", str(file), "--output", str(file)]) == 2
    assert file.read_bytes() == before


def test_hooks_run_only_when_they_are_named(part: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name in ("hooks.py", "part.py", "yl569.py", "ours.py", "conftest.py", "trunnion_hooks.py"):
        (tmp_path / name).write_text(f"open({str(tmp_path / 'ran')!r}, 'w').close()\n", encoding="utf-8")
    ours = tmp_path / "ours.toml"
    ours.write_text('schema = 1\nextends = "yl569"\nname = "Ours"\n', encoding="utf-8")
    assert main(["post", str(part), "--machine", str(ours), "--output", "-"]) == 0
    for place in ("", "[control]\n", "[control.settings]\n"):
        ours.write_text(
            f'schema = 1\nextends = "yl569"\nname = "Ours"\n{place}hooks = ["hooks.py"]\n', encoding="utf-8"
        )
        main(["post", str(part), "--machine", str(ours), "--output", "-"])
    assert not (tmp_path / "ran").exists()
    capsys.readouterr()


def test_the_command_takes_several_files(part: Path, capsys: pytest.CaptureFixture[str]) -> None:
    body = "def on_event(event, context):\n    if isinstance(event, Message):\n        return Message(0, 0, '{}')\n"
    files = [hook(part, body.format(k), f"{k}.py") for k in (1, 2)]
    arguments = [argument for file in files for argument in ("--hooks", str(file))]
    assert main(["post", str(part), "--machine", "yl569", "--output", "-", *arguments]) == 0
    out, err = capsys.readouterr()
    assert ";2\n" in out
    assert "1.py:3: warning: operation ROUGH TOP: hooks changed its events" in err


def test_the_hooks_of_the_page_do_what_it_says(part: Path) -> None:
    page = (ROOT / "docs" / "hooks.md").read_text(encoding="utf-8")
    sample = page.partition("```py\n")[2].partition("```")[0]
    file = part.parent / "shop.py"
    file.write_text(sample, encoding="utf-8")
    result = posted(part, file)
    lines = [line.split(" ", 1)[1] for line in (result.text or "").splitlines()]
    shown = page.partition("```\n;")[2].partition("\n")[0]
    assert lines[0] == f";{shown}"
    assert lines.count(";cut begins at Z0") == 1
    assert float(result.motions[0].operation.moves.feed[-2]) == 400.0


SHIFTED = (
    "def on_operation(operation, context):\n"
    "    if context.machine and context.control.startswith('Sinumerik'):\n"
    "        moves = operation.moves\n"
    "        return replace(operation, moves=replace(moves, tip=moves.tip + [0.5, 0.0, 0.0]))\n"
)


def test_a_program_is_verified_with_the_hooks_that_it_was_posted_with(
    part: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file, program = hook(part, SHIFTED), part.parent / "part.mpf"
    posted(part, file, output=program)
    assert not trunnion.verify(program, machine="yl569", cl=part).passed
    found = trunnion.verify(program, machine="yl569", cl=part, hooks=[file])
    assert found.passed
    command = ["verify", str(program), "--machine", "yl569", "--cl", str(part)]
    assert main(command) == 1
    assert main([*command, "--hooks", str(file)]) == 0
    assert "changed" in capfd.readouterr().err
    report = ["--report", str(file)]
    assert main([*command, "--hooks", str(file), *report]) == 2
    assert file.read_text(encoding="utf-8") == IMPORTS + SHIFTED


def test_hooks_of_a_verification_need_cl_files(part: Path) -> None:
    file, program = hook(part, "raise SystemExit\n"), part.parent / "part.mpf"
    posted(part, output=program)
    with pytest.raises(trunnion.InputError, match="change CL files, and there are none"):
        trunnion.verify(program, machine="yl569", hooks=[file])
