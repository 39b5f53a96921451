"""Set up Trunnion in a folder of its own and do one thing with it. Needs Python 3.11 or later and nothing else.

python3 make.py sample     set up, and post a real five-axis toolpath
python3 make.py test       set up, and pass the tests
"""

import os
import subprocess
import sys
import venv
from pathlib import Path

HERE = Path(__file__).resolve().parent
HOME = HERE / ".venv"
BIN = HOME / ("Scripts" if os.name == "nt" else "bin")
SAMPLE = Path("tests", "golden", "yl569", "3_blade_finish.cls")


def run(*command: str | Path) -> None:
    """Run a program of the environment from the project's folder; end with its exit code when it fails."""
    print("$", *command, flush=True)
    program, *arguments = command
    done = subprocess.run([str(BIN / program), *map(str, arguments)], cwd=HERE, check=False)
    if done.returncode:
        sys.exit(done.returncode)


def set_up(what: str) -> None:
    """Make the environment once, and install this checkout into it."""
    if sys.version_info < (3, 11):  # noqa: UP036 - whoever starts this may have an older one
        sys.exit("Trunnion needs Python 3.11 or later; this is " + sys.version.split()[0])
    if not (BIN / ("python.exe" if os.name == "nt" else "python")).exists():
        try:
            venv.create(HOME, with_pip=True)
        except subprocess.CalledProcessError:
            sys.exit("this Python cannot make virtual environments; on Debian: apt install python3-venv")
    run("python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--editable", what)
    run("python", "-m", "compileall", "-q", "src")  # an editable package is not compiled by being installed


def sample() -> None:
    """Post the sample and show the head of the program."""
    set_up(".")
    run("trunnion", "post", SAMPLE, "--machine", "yl569", "--set", "title=BLADE FINISH", "--output", "blade.mpf")
    program = HERE / "blade.mpf"
    lines = program.read_text(encoding="utf-8").splitlines()
    print("\n".join(lines[36:60]))
    print(f"… {len(lines)} blocks in {program}")


def test() -> None:
    """Style, types, the rules of the house, and the tests."""
    set_up(".[test]")
    run("ruff", "check")
    run("ruff", "format", "--check")
    run("mypy")
    run("lint-imports")
    run("python", "-m", "pytest", "-n", "auto")


if __name__ == "__main__":
    commands = {"sample": sample, "test": test}
    if len(sys.argv) != 2 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]]()
