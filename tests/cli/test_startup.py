"""A command imports what it needs, and ``post`` while its first CL file is being read."""

import re
import subprocess
import sys
import weakref
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from shutil import which

import pytest

from tests.support.locations import GOLDEN, YL569
from trunnion.cl.read import AS_IT_SAYS
from trunnion.cli import main
from trunnion.cli.cl_files import begin_reading
from trunnion.errors import InputError

FILES = [str(YL569 / "2_hub_rough.cls"), str(YL569 / "3_blade_finish.cls"), str(GOLDEN / "dmu65" / "corner.cls")]

#: What neither posts nor proves a program: pages and papers, simulation, projects, impellers, hooks, ...
NOT_ASKED_FOR = (
    r"jinja2|ssl|http|trimesh|asyncio|multiprocessing$|tqdm"
    r"|trunnion\.(simulation|impeller|geometry|viewer|twin|batch|builder|conversion|capability|schemas|explanations)"
    r"|trunnion\.reporting\.(?!text$)"
    r"|trunnion\.jobs\.(project|post_project|simulate|convert|view|place|describe|capability|impeller)"
    r"|trunnion\.(hooks\.calling|controls\.texts|jobs\.post\.papers\.manifests)"
)


def test_arguments_are_understood_without_the_rooms_that_carry_them_out() -> None:
    script = (
        "import sys\nfrom trunnion.cli.command_line.parser import parse\n"
        "parse(['post', 'a.cls', '--machine', 'yl569'])\n"
        "print(*(name for name in sys.modules if name in ('numpy', 'numba') or name.startswith('trunnion.')))"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == {
        "trunnion.cli",
        "trunnion.cli.columns",
        "trunnion.cli.command_line",
        "trunnion.cli.command_line.help_texts",
        "trunnion.cli.command_line.language",
        "trunnion.cli.command_line.parser",
        "trunnion.cli.command_line.post_mistakes",
        "trunnion.cli.printing",
        "trunnion.cli.process",
        "trunnion.cli.terminal_text",
        "trunnion.dialect_names",
        "trunnion.errors",
        "trunnion.jobs",
        "trunnion.jobs.declarations",
        "trunnion.jobs.declarations.automate",
        "trunnion.jobs.declarations.first",
        "trunnion.jobs.declarations.impellers",
        "trunnion.jobs.declarations.make",
        "trunnion.jobs.declarations.prove",
        "trunnion.jobs.declarations.see",
        "trunnion.jobs.job",
        "trunnion.jobs.registry",
        "trunnion.messages",
        "trunnion.options",
        "trunnion.options.groups",
        "trunnion.options.kinds",
        "trunnion.options.limits",
        "trunnion.options.option",
        "trunnion.options.words",
        "trunnion.records",
        "trunnion.version",
        "trunnion.wording",
    }


@pytest.mark.parametrize(
    "words",
    [
        ["post", FILES[1], "--machine", "yl569", "--output", "part.mpf"],
        ["verify", str(YL569 / "3_blade_finish.expected.mpf"), "--machine", "yl569", "--cl", FILES[1]],
    ],
    ids=["post", "verify"],
)
def test_a_command_imports_nothing_of_what_it_is_not_asked_for(words: list[str], tmp_path: Path) -> None:
    imported = imported_by(words, tmp_path)
    assert {f"trunnion.cli.{words[0]}", "trunnion.verification.verifier"} <= imported
    assert not {name for name in imported if name == "xml" or re.match(NOT_ASKED_FOR, name)}


def test_the_version_is_said_without_the_commands(tmp_path: Path) -> None:
    imported = imported_by(["--version"], tmp_path)
    assert not imported & {"argparse", "hashlib", "json", "shutil", "tempfile", "numpy"}
    assert {name for name in imported if name.startswith("trunnion.")} == {
        "trunnion.cli",
        "trunnion.cli.columns",
        "trunnion.cli.command_line",
        "trunnion.cli.command_line.language",
        "trunnion.cli.printing",
        "trunnion.cli.process",
        "trunnion.cli.terminal_text",
        "trunnion.errors",
        "trunnion.messages",
        "trunnion.records",
        "trunnion.version",
        "trunnion.wording",
    }


def test_help_needs_the_declarations_of_commands_alone(tmp_path: Path) -> None:
    for words in (["--help"], ["post", "--help"]):
        imported = imported_by(words, tmp_path)
        assert not imported & {"hashlib", "json", "tempfile", "numpy"}
        assert not {
            name for name in imported if re.match(r"trunnion\.(files|results|jobs\.(guard|inputs|post))\b", name)
        }


def imported_by(words: list[str], folder: Path) -> set[str]:
    """Return the modules that a command imports in a process of its own."""
    script = (
        "import sys\nfrom trunnion.cli import main\n"
        "try:\n    code = main(sys.argv[1:])\nexcept SystemExit as end:\n    code = end.code\n"
        "assert code == 0\nprint('imported', *sys.modules)"
    )
    command = [sys.executable, "-c", script, *words]
    done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)
    return set(done.stdout.splitlines()[-1].split()[1:])


@pytest.mark.skipif(which("cc") is None, reason="without a linker, LLVM loads the kernels")
def test_numba_and_llvm_are_not_imported_once_the_kernels_are_made(tmp_path: Path) -> None:
    words = ["post", FILES[1], "--machine", "yl569", "--output", "part.mpf"]
    imported_by(words, tmp_path)

    assert not {"numba", "llvmlite"} & imported_by(words, tmp_path)


def test_toolpaths_come_in_order_and_are_not_kept() -> None:
    with ThreadPoolExecutor(1) as executor:
        coming = begin_reading(FILES, AS_IT_SAYS, executor)
        (first,) = next(coming)
        assert first.file == FILES[0]
        gone = weakref.ref(first.operations[0].moves.tip)
        del first
        assert [path.file for path in next(coming)] == FILES[1:2]
        assert gone() is None
        assert [path.file for (path,) in coming] == [FILES[2]]


def test_a_file_that_cannot_be_read_is_said_where_its_toolpath_is_wanted(tmp_path: Path) -> None:
    with ThreadPoolExecutor(1) as executor:
        coming = begin_reading([str(tmp_path / "none.cls"), *FILES], AS_IT_SAYS, executor)
        with pytest.raises(InputError, match="file not found"):
            next(coming)


def test_an_unknown_machine_is_said_before_a_file_that_cannot_be_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["post", str(tmp_path / "none.cls"), "--machine", "no_such_machine"]) == 2
    error = capsys.readouterr().err
    assert "no_such_machine" in error
    assert "none.cls" not in error
