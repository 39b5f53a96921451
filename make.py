"""Set up Trunnion in a folder of its own and do one thing with it. Needs Python 3.11 or later and nothing else.

python3 make.py sample     set up, and post a real five-axis toolpath
python3 make.py simulate   set up, cut a part with its three programs, and draw what comes out
python3 make.py impeller   set up, and make an impeller from measured points: paths, programs, proof, and the part
python3 make.py freecad    set up, and make, post, prove and simulate a job in FreeCAD, which must be installed
python3 make.py test       set up, and run what judges a change: tests, style, types, the site
python3 make.py nightly    the rest: the whole matrix, long cases, all draws, fuzzing, archives; a number is the seed
python3 make.py quick      a minute and a half of it: style, types, contracts, the tests nearest to the change
python3 make.py docs       build the documentation site in build/site
python3 make.py package    build the wheel and the sdist in dist, and try both in environments of their own
python3 make.py run ...    run a program of the environment, such as pytest
"""

import sys

if sys.version_info < (3, 11):  # noqa: UP036 - people start this file with whatever Python they have
    sys.exit("Trunnion needs Python 3.11 or later; this is " + sys.version.split()[0])

# Nothing above is unknown to Python 3.6, which parses what is below and runs none of it.
import hashlib
import os
import random
import shutil
import subprocess
import tempfile
import venv
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

HERE = Path(__file__).resolve().parent
HOME = HERE / ".venv"
SUPPORTED = (11, 12, 13)  # minor versions of Python 3 that the wheel is tried on
TESTS = ("python", "-m", "pytest", "-n", "auto", "--dist", "worksteal")  # neighbours share what one process has kept
IMPELLER = Path("examples", "impeller", "impeller.toml")
FUZZING = "60"  # seconds
FREECAD = Path("examples", "freecad", "plate.py")
CELL = "0.25"  # mm, of the simulation of the impeller
KEEPING = {"PYTHONDONTWRITEBYTECODE": ""}  # a shell may forbid it: each of many processes would compile all it imports
SAMPLE = Path("tests", "golden", "yl569", "3_blade_finish.cls")
CUT = ("1_contour_rough", "2_hub_rough", "3_blade_finish")  # programs of one part, in their order


def program_of(environment: Path, name: str) -> Path:
    """Return a program in a virtual environment; on Windows ``.exe`` is found by itself."""
    return environment / ("Scripts" if os.name == "nt" else "bin") / name


def run(
    *command: str | Path,
    environment: Path = HOME,
    variables: Mapping[str, str] | None = None,
    good: Sequence[int] = (0,),
) -> None:
    """Run a program of an environment from the project's folder; end with its exit code when that is not good."""
    print("$", *command, flush=True)
    name, *arguments = command
    done = subprocess.run(
        [str(program_of(environment, str(name))), *map(str, arguments)],
        cwd=HERE, check=False, env={**os.environ, **KEEPING, **(variables or {})},
    )  # fmt: skip
    if done.returncode not in good:
        sys.exit(done.returncode)


def create(environment: Path) -> None:
    """Create a virtual environment, unless it is there."""
    if program_of(environment, "python.exe" if os.name == "nt" else "python").exists():
        return
    try:
        venv.create(environment, with_pip=True)
    except subprocess.CalledProcessError:
        sys.exit("this Python cannot create virtual environments; on Debian: apt install python3-venv")


def install(*what: str | Path, environment: Path = HOME) -> None:
    """Install packages into an environment; Python compiles of them what is imported, a fifth of it, when it is."""
    quiet = ("--quiet", "--disable-pip-version-check", "--no-compile")
    run("python", "-m", "pip", "install", *quiet, *what, environment=environment)


def set_up(what: str) -> None:
    """Create the environment once, and install this checkout into it, again if ``pyproject.toml`` has changed."""
    create(HOME)
    installed, asked = HOME / "installed.txt", hashlib.sha256((HERE / "pyproject.toml").read_bytes()).hexdigest()
    before = installed.read_text(encoding="utf-8").split() if installed.exists() else []
    if before[:1] == [asked] and what in before:
        return
    install("--editable", what)
    same = before if before[:1] == [asked] else [asked]
    installed.write_text(" ".join([*same, what]), encoding="utf-8")


def sample() -> None:
    """Post the sample and show the head of the program."""
    set_up(".")
    run("trunnion", "prepare", "post")
    run("trunnion", "post", SAMPLE, "--machine", "yl569", "--set", "title=BLADE FINISH", "--output", "blade.mpf")
    program = HERE / "blade.mpf"
    lines = program.read_text(encoding="utf-8").splitlines()
    print("\n".join(lines[36:60]))
    print(f"… {len(lines)} blocks in {program}")


def simulate() -> None:
    """Cut the stock of a part with the published programs of one machine, one after another, and draw what is left."""
    set_up(".")
    programs = [SAMPLE.with_name(f"{name}.expected.mpf") for name in CUT]
    tools = ("--tool", "1=flat:16,length=75,flutes=40", "--tool", "2=ball:10,length=75,flutes=40")
    stock = ("--stock", "cylinder:108,30,-30", "--cell", "0.5", "--save-stock", "stock.png")
    run("trunnion", "prepare", "simulate")
    print("One finding is to be expected: a rapid goes through this stock, which is a plain cylinder.", flush=True)
    run("trunnion", "simulate", *programs, "--machine", "yl569", *stock, *tools, good=(0, 1))
    print(f"the finished stock is drawn in {HERE / 'stock.png'}; --save-stock stock.stl saves it as a solid")


def impeller() -> None:
    """Model the published impeller, make its programs, prove them, simulate the finished part, and draw it."""
    set_up(".[impeller,simulate]")
    run("trunnion", "prepare")
    folder = HERE / "build" / "impeller"
    folder.mkdir(parents=True, exist_ok=True)
    run("trunnion", "impeller", "model", IMPELLER, "--output", folder / "model.stl")
    how = ("--machine", "yl569", "--set", "zero=0,0,0", "--cell", CELL)
    run("trunnion", "impeller", "cut", IMPELLER, *how, "--output", folder / "nc", good=(0, 1))
    print(f"CL files, programs, the report of their proof, that of the simulation, and pictures are in {folder / 'nc'}")


def freecad() -> None:
    """Make a part and its job in FreeCAD, post it by the post for FreeCAD, prove it, simulate it, and draw it."""
    free = shutil.which("freecadcmd") or shutil.which("FreeCADCmd")
    if free is None:
        sys.exit("FreeCAD is not installed: on Debian, apt install freecad")
    set_up(".")
    run("trunnion", "prepare", "simulate")
    folder = HERE / "build" / "freecad"
    folder.mkdir(parents=True, exist_ok=True)
    run("trunnion", "freecad", "install", "--folder", folder)
    how = {"TRUNNION_OUT": str(folder), "TRUNNION_ARGS": "--machine haas_umc750", "QT_QPA_PLATFORM": "offscreen"}
    print("$", free, FREECAD, flush=True)
    done = subprocess.run(
        [free, str(FREECAD)], cwd=HERE, check=False, stdin=subprocess.DEVNULL, env={**os.environ, **how}
    )
    if done.returncode:
        sys.exit(done.returncode)
    cl, part, picture = (folder / f"plate{ending}" for ending in (".apt", ".stl", ".png"))
    look = ("--cell", "0.5", "--save-stock", picture, "--report", folder / "plate_simulated.html")
    run("trunnion", "simulate", folder / "plate.nc", "--machine", "haas_umc750", "--cl", cl, "--part", part, *look)
    print(f"program, report of the proof, that of the simulation, and picture are in {folder}")


def check() -> None:
    """Style, types and import contracts."""
    run("ruff", "check")
    run("ruff", "format", "--check")
    run("mypy")
    run("lint-imports")


def quick() -> None:
    """Run what a commit needs: the tests nearest to the change, as many as a minute and a half has room for."""
    set_up(".[test,docs]")
    command = [str(program_of(HOME, "python")), "-m", "tests.support.reached"]
    environment = {**os.environ, **KEEPING}
    done = subprocess.run(command, cwd=HERE, check=True, stdout=subprocess.PIPE, encoding="utf-8", env=environment)
    reached = done.stdout.split()
    tests = [each for each in reached if each != "docs"]
    with ThreadPoolExecutor(1) as beside:
        others = beside.submit(in_turn, check, *([site] if "docs" in reached else []))
        run(*TESTS, *tests)
        others.result()


def nightly(seed: str = "") -> None:
    """Run what ``test`` leaves out, from a fresh seed: long cases, all draws of properties, fuzzing, the archives."""
    set_up(".[test]")
    seed = seed or str(random.SystemRandom().randrange(10**9))
    print(f"seed {seed}; python3 make.py nightly {seed} draws the same again", flush=True)
    campaign = ("python", "-m", "tests.fuzz.campaign", "every", "--seconds", FUZZING, "--patience", "300")
    with ThreadPoolExecutor(1) as beside:  # both keep one processor busy at most
        others = beside.submit(in_turn, build, partial(run, *campaign, "--seed", seed))
        run(*TESTS, "--nightly", f"--hypothesis-seed={seed}")
        others.result()


def test() -> None:
    """Everything that judges a change; CI runs ``nightly`` besides."""
    set_up(".[test,docs]")
    with ThreadPoolExecutor(1) as beside:  # each of its programs keeps one processor busy at most
        others = beside.submit(in_turn, check, site)
        run(*TESTS)
        others.result()


def in_turn(*steps: Callable[[], object]) -> None:
    """Do steps one after the other."""
    for step in steps:
        step()


def docs() -> None:
    """Build the documentation site."""
    set_up(".[docs]")
    site()


def site() -> None:
    """Build the documentation site; a warning, such as a broken link, is an error."""
    run("python", "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "docs", "build/site")


def package() -> None:
    """Build the wheel and the sdist, and try both."""
    set_up(".[test]")
    build()


def build() -> None:
    """Build the wheel and the sdist; post the sample with both, with the wheel on every supported Python found."""
    dist = HERE / "dist"
    shutil.rmtree(dist, ignore_errors=True)
    run("python", "-m", "build", "--outdir", dist)
    (wheel,), (sdist,) = dist.glob("*.whl"), dist.glob("*.tar.gz")
    try_out(sdist, sys.executable, {"NUMBA_DISABLE_JIT": "1"})  # its wheel was built from it: that one compiles kernels
    for python in (sys.executable, *other_pythons()):
        try_out(wheel, python)


def other_pythons() -> list[str]:
    """Return the other supported versions of Python on the path."""
    names = [f"python3.{minor}" for minor in SUPPORTED if minor != sys.version_info.minor]
    return [name for name in names if shutil.which(name) and works(name)]


def works(python: str) -> bool:
    """Whether a Python runs: version managers put names on the path that stand for nothing."""
    return not subprocess.run([python, "--version"], capture_output=True, check=False).returncode


def try_out(archive: Path, python: str, variables: Mapping[str, str] | None = None) -> None:
    """Install an archive into a new environment, with the newest packages that it allows, and post the sample."""
    with tempfile.TemporaryDirectory() as folder:
        environment, output = Path(folder, "environment"), Path(folder, "blade.mpf")
        subprocess.run([python, "-m", "venv", str(environment)], check=True)
        install(archive, environment=environment)
        post = ("trunnion", "post", SAMPLE, "--machine", "yl569", "--output", output)
        run(*post, environment=environment, variables=variables)
        print(f"{archive.name}, {python}: {len(output.read_bytes())} bytes of NC")


COMMANDS: dict[str, Callable[..., None]] = {
    "sample": sample, "simulate": simulate, "impeller": impeller, "freecad": freecad, "test": test, "nightly": nightly,
    "quick": quick, "docs": docs, "package": package,
}  # fmt: skip


if __name__ == "__main__":
    if sys.argv[1:2] == ["run"] and len(sys.argv) > 2:
        run(*sys.argv[2:])
    elif len(sys.argv) == 2 and sys.argv[1] in COMMANDS:
        COMMANDS[sys.argv[1]]()
    elif len(sys.argv) == 3 and sys.argv[1] == "nightly" and sys.argv[2].isdigit():
        nightly(sys.argv[2])
    else:
        sys.exit(__doc__)
