"""``import trunnion``: quick, complete, and without a trace in the process."""

import doctest
import inspect
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import trunnion
from tests.support.locations import ROOT, YL569
from tests.support.public_api import FUNCTIONS, arguments_of


def python(script: str, *arguments: str, folder: Path | None = None) -> str:
    """What a script prints in a process of its own."""
    command = [sys.executable, "-c", script, *arguments]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def test_every_public_name_is_there_and_documented() -> None:
    assert dir(trunnion) == sorted(trunnion.__all__)
    for name in trunnion.__all__:
        assert inspect.getdoc(getattr(trunnion, name)) or name == "__version__", name
    assert FUNCTIONS == [
        "convert", "cut_impeller", "describe_cl", "describe_control", "describe_controls", "describe_machine",
        "diff", "explain", "fit", "fit_curve", "kinematics", "load_impeller", "load_machine", "model_impeller",
        "place", "plan", "post", "post_placed", "post_project", "reach", "read_cl", "read_points", "read_program",
        "sensitivity", "simulate", "verify", "verify_manifest",
        "write_curve_picture", "write_impeller_step", "write_placing_plot", "write_plot", "write_report", "write_view",
    ]  # fmt: skip


def undocumented(name: str) -> list[str]:
    """What of a function has no type or is not in its docstring."""
    function = getattr(trunnion, name)
    doc, signature = inspect.getdoc(function) or "", inspect.signature(function)
    arguments, returned = list(arguments_of(signature)), signature.return_annotation
    sections = doc.partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    described = {
        word.strip()
        for line in sections.splitlines()
        if not line.startswith(" ")
        for word in line.partition(" : ")[0].split(",")
    }
    found = {
        "type of what is returned": returned is not inspect.Signature.empty,
        "the errors": "Raises\n------\nInputError" in doc,
        "what is returned": ("Returns\n-------\n" in doc) is (returned is not None),
        **{f"type of {each.name}": each.annotation is not inspect.Parameter.empty for each in arguments},
        **{each.name: each.name in described for each in arguments},
    }
    return [f"{name}: {what}" for what, is_there in found.items() if not is_there]


def test_every_argument_is_typed_and_documented() -> None:
    assert [what for name in FUNCTIONS for what in undocumented(name)] == []


@pytest.mark.parametrize("name", ["trunnion", *FUNCTIONS])
def test_the_examples_of_the_documentation_give_what_they_show(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    if name == "cut_impeller":  # it writes files, whose names an earlier run of the tests may have taken
        shutil.copytree(ROOT / "examples" / "impeller", tmp_path / "examples" / "impeller")
        (tmp_path / "build").mkdir()
        monkeypatch.chdir(tmp_path)
    documented = trunnion if name == "trunnion" else getattr(trunnion, name)
    examples = [found for found in doctest.DocTestFinder(recurse=False).find(documented, name) if found.examples]
    assert examples or name.startswith("write_") or name == "post_project", "these leave files"
    for example in examples:
        result = doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(example)
        assert result.failed == 0


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="module 'trunnion' has no attribute 'psot'"):
        getattr(trunnion, "psot")  # noqa: B009 - the type checker knows that there is none


def test_the_import_loads_nothing_heavy() -> None:
    script = "import sys, trunnion; print(*({'numpy', 'numba', 'argparse', 'tqdm'} & sys.modules.keys()))"
    assert python(script).strip() == ""


@pytest.mark.parametrize("option", ["--help", "--version"])
def test_the_help_of_the_command_loads_nothing_heavy(option: str) -> None:
    script = (
        "import sys\nfrom trunnion.cli import main\n"
        "try:\n    main(sys.argv[1:])\nexcept SystemExit:\n    pass\n"
        "print(*({'numpy', 'numba', 'tqdm'} & sys.modules.keys()), 'end')"
    )
    assert python(script, option).splitlines()[-1].strip() == "end"


#: Posts, verifies, converts and compares, and prints what has changed in the process.
_TRACELESS = """
import gc, os, signal, sys, threading
import numpy
def state():
    return {
        "environ": dict(os.environ), "gc": (gc.isenabled(), gc.get_threshold()), "switch": sys.getswitchinterval(),
        "folder": os.getcwd(), "signal": signal.getsignal(signal.SIGINT), "threads": threading.active_count(),
        "numpy": numpy.geterr(), "path": list(sys.path), "hook": sys.excepthook, "recursion": sys.getrecursionlimit(),
        "locale": numpy.get_printoptions()["precision"], "files": sorted(os.listdir(".")),
    }
before = state()
import trunnion
cl, machine = sys.argv[1], "yl569"
posted = trunnion.post(cl, machine=machine, output="p.mpf", settings={"title": "x"})
trunnion.verify("p.mpf", machine=machine, cl=cl)
trunnion.convert("p.mpf", machine=machine, to_cl=True)
trunnion.diff("p.mpf", "p.mpf", machine=machine)
try:
    trunnion.post(cl, machine=machine, settings={"titel": "x"})
except trunnion.InputError:
    pass
os.remove("p.mpf")
after = state()
changed = [key for key in before if before[key] != after[key]]
sys.stdout.write(" ".join(changed))
"""


def test_a_call_prints_nothing_and_leaves_the_process_as_it_was(tmp_path: Path) -> None:
    assert python(_TRACELESS, str(YL569 / "3_blade_finish.cls"), folder=tmp_path) == ""
