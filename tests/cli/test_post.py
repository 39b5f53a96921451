"""``trunnion post`` as a user meets it: exit codes, messages, and output that appears whole or not at all."""

import os
import signal
import subprocess
import sys
import time
from importlib.resources import files
from pathlib import Path

import pytest

from tests.support.locations import YL569
from tests.support.proof import unproven
from trunnion.cli import main

GOOD = (YL569 / "2_hub_rough.cls").read_text(encoding="utf-8")
POINT = "GOTO/49.032380,11.151730,-21.134940\n"


class Outcome:
    """Posts one file into a folder and keeps what happened."""

    def __init__(self, source: Path, capfd: pytest.CaptureFixture[str], *arguments: str) -> None:
        self.target = source.parent / "out" / "program.mpf"
        self.target.parent.mkdir(exist_ok=True)
        self.code = main(["post", str(source), "--machine", "yl569", "--output", str(self.target), *arguments])
        self.out, self.err = capfd.readouterr()
        self.err = self.err.replace(str(source), "part.cls")
        self.left = sorted(path.name for path in self.target.parent.iterdir())


def post_text(folder: Path, capfd: pytest.CaptureFixture[str], text: str | bytes, *arguments: str) -> Outcome:
    """Post a file that holds ``text``."""
    source = folder / "part.cls"
    source.write_bytes(text.encode() if isinstance(text, str) else text)
    return Outcome(source, capfd, *arguments)


BAD: dict[str, tuple[str | bytes, str, str]] = {
    "not a CL file": ("Dear colleague,\nplease find the drawing attached.\n", "part.cls", "CL file"),
    "empty": ("", "part.cls", "empty"),
    "truncated in mid-line": (GOOD[: GOOD.index("GOTO/47.735880") + 9], "part.cls:19", ""),
    "NaN": (GOOD.replace(POINT, "GOTO/nan,11.151730,-21.134940\n"), "part.cls:17", ""),
    "zero vector": (GOOD.replace(POINT, "GOTO/1,2,3,0.0,0.0,0.0\n"), "part.cls:17", "zero"),
    "vector off unit length": (GOOD.replace(POINT, "GOTO/1,2,3,0.0,0.0,0.98\n"), "part.cls:17", "0.98"),
    "seven numbers": (GOOD.replace(POINT, "GOTO/1,2,3,0,0,1,7\n"), "part.cls:17", "7"),
    "two circles": (GOOD.replace(POINT, 2 * "CIRCLE/0,0,0,0,0,1,5\n" + POINT), "part.cls:18", "CIRCLE"),
    "missing END-OF-PATH": (GOOD.replace("END-OF-PATH\n", ""), "part.cls", "END-OF-PATH"),
    "unknown encoding": (GOOD.encode("utf-16"), "part.cls", "encoding"),
    "a line of 10 MB": (GOOD.replace(POINT, "PPRINT/" + "x" * 10_000_000 + "\n"), "part.cls:17", "long"),
    "splines": (GOOD.replace(POINT, "NURBS/3\n"), "part.cls:17", "NURBS"),
}  # fmt: skip


@pytest.mark.third
@pytest.mark.parametrize("name", BAD)
def test_bad_input_ends_with_2_names_its_place_and_leaves_no_file(
    name: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    text, place, word = BAD[name]
    outcome = post_text(tmp_path, capfd, text)
    assert outcome.code == 2
    assert outcome.err.startswith(f"{place}:")
    assert ": error: " in outcome.err
    assert word.lower() in outcome.err.lower()
    assert (outcome.out, outcome.left) == ("", [])


def test_a_directory_is_no_cl_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "folder.cls"
    folder.mkdir()
    outcome = Outcome(folder, capfd)
    assert outcome.code == 2
    assert "error" in outcome.err
    assert "folder" in outcome.err or "directory" in outcome.err
    assert outcome.left == []


def test_a_file_that_is_not_there_is_named(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    outcome = Outcome(tmp_path / "nothing.cls", capfd)
    assert outcome.code == 2
    assert "error" in outcome.err
    assert outcome.left == []


def test_an_output_in_a_folder_that_is_not_there_is_said_before_any_work(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    code = main(
        ["post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl569", "--output", str(tmp_path / "no" / "p.mpf")]
    )
    assert code == 2
    assert "p.mpf: error: cannot be written" in capfd.readouterr().err


def test_a_folder_that_cannot_be_written_into_is_an_error(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    code = main(["post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl569", "--output", str(blocked / "p.mpf")])
    assert code == 2
    assert "cannot be written" in capfd.readouterr().err
    assert blocked.read_text() == "in the way"


def long_file(limit_line: int, lines: int = 60_000) -> str:
    """A CL file with a tool axis beyond the B limit in one line."""
    head = GOOD[: GOOD.index("GOTO/49.032380")]
    body = ["GOTO/10.0,10.0,10.0,0.5,0.0,0.866025403784\n"] * (lines - head.count("\n"))
    body[limit_line - 1 - head.count("\n")] = "GOTO/10.0,10.0,10.0,0.939692620786,0.0,-0.342020143326\n"
    return head + "".join(body) + "END-OF-PATH\n"


def test_a_limit_exceeded_in_line_50000_is_refused_with_its_place_and_no_file(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    outcome = post_text(tmp_path, capfd, long_file(50_000))
    assert outcome.code == 1
    assert "part.cls:50000: error: axis B would go to 110.00000, above its limit 100 degrees" in outcome.err
    assert (outcome.out, outcome.left) == ("", [])


def test_force_writes_it_and_its_head_says_so(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    outcome = post_text(tmp_path, capfd, long_file(50_000), "--force")
    assert outcome.code == 1
    head = outcome.target.read_text(encoding="utf-8").splitlines()[0]
    assert (
        head
        == "N10 ;MUST NOT RUN AS IT IS, written by --force: axis B would go to 110.00000, above its limit 100 degrees"
    )


@pytest.mark.parametrize(
    ("machine", "first"),
    [
        ("yl569", []),
        ("xyzac_trt", []),
        ("dmu65", ["BEGIN PGM"]),
        ("matsuura_mx330", ["%", "O"]),
    ],
)
def test_the_head_says_so_where_the_control_reads_it(tmp_path: Path, machine: str, first: list[str]) -> None:
    source, target = tmp_path / "part.cls", tmp_path / "part.nc"
    far = "GOTO/9000.0,0.0,10.0\n"
    source.write_text(
        "TOOL PATH/FAR,TOOL,T1\nTLDATA/MILL,10.,0.,75.,0.,0.\nLOAD/TOOL,1\nSPINDL/RPM,1000,CLW\nRAPID\n"
        f"GOTO/0.0,0.0,10.0,0.,0.,1.\nFEDRAT/MMPM,500\n{far}END-OF-PATH\n"
    )
    assert main(["post", str(source), "--machine", machine, "--output", str(target), "--force"]) == 1
    lines = target.read_text(encoding="utf-8").splitlines()
    assert len(lines) > len(first)
    for line, word in zip(lines, first, strict=False):
        assert word in line
        assert "MUST NOT RUN" not in line
    assert "MUST NOT RUN AS IT IS" in lines[len(first)]


@pytest.mark.parametrize(
    ("word", "options"), [("FROBNICATE/ON", ("--strict",)), ("AUXFUN/31", ()), ("AUXFUN/31", ("--force",))]
)
def test_an_unknown_statement_is_an_error_where_it_may_act_and_when_strict(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], word: str, options: tuple[str, ...]
) -> None:
    outcome = post_text(tmp_path, capfd, GOOD.replace(POINT, f"{word}\n" * 3 + POINT), *options)
    assert (outcome.code, outcome.left) == (2, [])
    assert f"part.cls:17: error: {word.partition('/')[0]} is not known" in outcome.err


def test_any_other_unknown_statement_is_a_warning_with_its_count(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    outcome = post_text(tmp_path, capfd, GOOD.replace(POINT, "FROBNICATE/ON\n" * 3 + POINT))
    assert outcome.code == 0
    assert "part.cls:17: warning: FROBNICATE is not known (3 times, first here); nothing becomes of it" in outcome.err


def test_an_old_program_stays_when_the_new_one_fails(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    first = post_text(tmp_path, capfd, GOOD)
    before = first.target.read_bytes()
    second = post_text(tmp_path, capfd, GOOD.replace("END-OF-PATH\n", ""))
    assert second.code == 2
    assert second.target.read_bytes() == before
    assert second.left == ["program.mpf"]


def test_a_folder_takes_one_program_for_each_cl_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    files = [str(YL569 / f"{name}.cls") for name in ("2_hub_rough", "3_blade_finish")]
    assert main(["post", *files, "--machine", "yl569", "--output", str(tmp_path)]) == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["2_hub_rough.mpf", "3_blade_finish.mpf"]


def test_several_cl_files_become_one_program_in_one_file(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    files = [str(YL569 / f"{name}.cls") for name in ("1_contour_rough", "2_hub_rough")]
    target = tmp_path / "both.mpf"
    assert main(["post", *files, "--machine", "yl569", "--output", str(target)]) == 0
    program = target.read_text(encoding="utf-8")
    assert program.count(";Start of Path") == 2
    assert program.count("M30") == 1
    assert [line for line in program.splitlines() if "T=" in line] == ["N190 T=1", "N1550 T=2"] or "T=2" in program


def test_a_folder_must_be_there(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """With a slash at its end a name is a folder's, and so it looks without an extension where there are several."""
    files = [str(YL569 / f"{name}.cls") for name in ("1_contour_rough", "2_hub_rough")]
    program = str(YL569 / "2_hub_rough.expected.mpf")
    for command in (
        ["post", *files, "--output", str(tmp_path / "out")],
        ["post", *files, "--output", f"{tmp_path / 'out'}/"],
        ["post", files[0], "--output", f"{tmp_path / 'out'}/"],
        ["convert", program, "--to-cl", "--output", f"{tmp_path / 'out'}/"],
        ["convert", program, "--to-machine", "yl569", "--output", f"{tmp_path / 'out'}/"],
    ):
        assert main([*command, "--machine", "yl569"]) == 2
        err = capfd.readouterr().err
        assert "error: there is no such folder; make it first" in err
        assert list(tmp_path.iterdir()) == []
    (tmp_path / "out").mkdir()
    assert main(["post", *files, "--output", f"{tmp_path / 'out'}/", "--machine", "yl569"]) == 0
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["1_contour_rough.mpf", "2_hub_rough.mpf"]


@pytest.mark.skipif(sys.platform == "win32", reason="has no signals that a process can handle")
@pytest.mark.parametrize("name", ["SIGTERM", pytest.param("SIGHUP", marks=pytest.mark.nightly)])
def test_a_command_that_is_ended_leaves_nothing_half_written(name: str, tmp_path: Path) -> None:
    """It is stopped where the hidden folder of its program is there: this one plans for ever."""
    arguments = ["post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl569", "--output", str(tmp_path / "p.mpf")]
    script = f"""
import signal, sys, time
if signal.getsignal(signal.{name}) is signal.SIG_IGN:  # as nohup leaves it
    signal.signal(signal.{name}, signal.SIG_DFL)
import trunnion.jobs.post.posting, trunnion.cli
trunnion.jobs.post.posting.plan_program = lambda *_: time.sleep(600)
sys.argv[1:] = {arguments!r}
trunnion.cli.run_and_exit()
"""
    with subprocess.Popen([sys.executable, "-c", script]) as post:
        while post.poll() is None and not list(tmp_path.iterdir()):
            time.sleep(0.02)
        post.send_signal(signal.Signals[name])
        assert post.wait() == 128 + signal.Signals[name]
    assert list(tmp_path.iterdir()) == []


def test_messages_that_nobody_reads_cost_no_program(tmp_path: Path) -> None:
    """As with ``2>&1 | head -1``."""
    reader, writer = os.pipe()
    os.close(reader)
    target = tmp_path / "p.mpf"
    command = ["post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl569", "--output", str(target)]
    done = subprocess.run([sys.executable, "-m", "trunnion", *command], stdout=writer, stderr=writer, check=False)
    os.close(writer)
    assert done.returncode == 0
    assert target.exists()


def test_an_nc_program_is_told_once(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    program = YL569 / "2_hub_rough.expected.mpf"
    assert main(["post", str(program), "--machine", "yl569", "--output", str(tmp_path / "p.mpf")]) == 2
    (said,) = capfd.readouterr().err.splitlines()
    assert "this is a Sinumerik program and no CL file, by TRAFOOF in line 29" in said


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs a device that is full")
@pytest.mark.parametrize("command", ["post", "verify"])
def test_a_stdout_that_is_full_is_said(command: str) -> None:
    file = YL569 / ("2_hub_rough.cls" if command == "post" else "2_hub_rough.expected.mpf")
    arguments = [command, str(file), "--machine", "yl569", *(["--output", "-"] if command == "post" else [])]
    with Path("/dev/full").open("wb") as full:
        done = subprocess.run([sys.executable, "-m", "trunnion", *arguments], stdout=full, stderr=-1, check=False)
    assert done.returncode == 2
    cure = b"make space there, or write to another disk [FIL230]"
    assert b"stdout: error: cannot be written: No space left on device; " + cure in done.stderr
    assert b"Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--set", "titel=x"], "titel is not a setting"),
        (["--set", "units=feet"], "units is 'feet'"),
        (["--set", "zero=1,2"], "zero is '1,2'"),
        (["--set", "title=a\nM30"], "write a text of one line"),
        (["--set", "edge=x"], "edge is 'x'"),
        (["--set", "stock=thick"], "stock is 'thick'"),
    ],
)
def test_a_setting_that_makes_no_sense_is_named(
    arguments: list[str], word: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    outcome = post_text(tmp_path, capfd, GOOD, *arguments)
    assert outcome.code == 2
    assert word in outcome.err
    assert outcome.left == []


def test_a_machine_that_is_not_there_is_named_with_those_that_are(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert main(["post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl596", "--output", "-"]) == 2
    assert "yl569" in capfd.readouterr().err


def test_a_machine_whose_control_cannot_be_written_yet_says_so(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    text = files("trunnion.machines").joinpath("library", "ucp800.toml").read_text(encoding="utf-8")
    machine = tmp_path / "other.toml"
    machine.write_text(text.replace('extends = "heidenhain_itnc530"', 'family = "unheard_of"'), encoding="utf-8")
    assert main(["post", str(YL569 / "2_hub_rough.cls"), "--machine", str(machine), "--output", "-"]) == 2
    assert 'control.family is "unheard_of"' in capfd.readouterr().err


def test_the_installed_command_speaks_utf8_through_a_pipe(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONIOENCODING": "ascii", "LC_ALL": "C"}
    command = [sys.executable, "-m", "trunnion", "post", str(YL569 / "2_hub_rough.cls"), "--machine", "yl569"]
    done = subprocess.run(
        [*command, "--output", "-", "--set", "title=轮毂"], capture_output=True, check=False, env=environment
    )
    assert done.returncode == 0
    assert unproven(done.stderr.decode()) == "", "no progress bar in a pipe"
    assert done.stdout.startswith("N10 ;轮毂\n".encode())


def test_a_usage_error_is_2() -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["post"])
    assert stopped.value.code == 2
