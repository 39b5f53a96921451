"""What no argument can be, in each argument of each public function: an error of Trunnion with its code."""

import inspect
import shutil
from pathlib import Path
from typing import Any, Final

import pytest

import trunnion
from tests.support.locations import YL569
from tests.support.public_api import FUNCTIONS, arguments_of

#: Of no type that any argument has.
_WRONG: Final = (object(), [object()], {1: object()})

#: Any value is true or false.
_TRUTHS: Final = frozenset({"strict", "columns", "explain"})

_PROGRAM: Final[dict[str, Any]] = {"nc": "part.mpf", "machine": "yl569"}
_GOOD: Final[dict[str, dict[str, Any]]] = {
    "convert": _PROGRAM | {"to_cl": True},
    "cut_impeller": {"impeller": "impeller.toml", "machine": "yl569", "output": "out"},
    "describe_cl": {"cl": "part.cls"},
    "describe_control": {"control": "yl569"},
    "describe_machine": {"machine": "yl569"},
    "diff": {"first": "part.mpf", "second": "part.mpf", "machine": "yl569"},
    "explain": {"code": "CTL110"},
    "fit": {"files": ["part.cls"]},
    "fit_curve": {"points": "points.csv"},
    "kinematics": {"machine": "yl569"},
    "load_impeller": {"impeller": "impeller.toml"},
    "load_machine": {"machine": "yl569"},
    "model_impeller": {"impeller": "impeller.toml"},
    "place": {"files": ["part.cls"], "machine": "yl569"},
    "plan": {"cl": "part.cls", "machine": "yl569"},
    "post": {"cl": "part.cls", "machine": "yl569"},
    "post_placed": {"machine": "yl569"},
    "post_project": {"project": "none.toml"},
    "reach": {"machine": "yl569"},
    "read_cl": {"path": "part.cls"},
    "read_points": {"points": "points.csv"},
    "read_program": _PROGRAM,
    "sensitivity": _PROGRAM,
    "simulate": _PROGRAM | {"stock": "box:9,9,9"},
    "verify": _PROGRAM,
    "verify_manifest": {"manifest": "none.json"},
    "write_curve_picture": {"fits": [], "picture": "x.png"},
    "write_impeller_step": {"impeller": "impeller.toml", "output": "x.step"},
    "write_placing_plot": {"found": None, "plot": "x.svg"},
    "write_plot": {"description": None, "plot": "x.svg"},
    "write_report": {"result": None, "file": "x.html"},
    "write_view": _PROGRAM | {"output": "x.html"},
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the files that the functions are given."""
    shutil.copy(YL569 / "2_hub_rough.cls", tmp_path / "part.cls")
    shutil.copy(YL569 / "2_hub_rough.expected.mpf", tmp_path / "part.mpf")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def _said(name: str, argument: str, wrong: object) -> str:
    """What a function says of a wrong argument; empty: it is an error with a code."""
    function = getattr(trunnion, name)
    given = dict(_GOOD.get(name, {}))
    if name == "post_placed":
        given["found"] = None
    given[argument] = wrong
    positional = [p.name for p in inspect.signature(function).parameters.values() if p.kind is not p.KEYWORD_ONLY]
    positional = [each for each in positional if each in given]
    first = [given.pop(each) for each in positional]
    try:
        function(*first, **given)
    except trunnion.TrunnionError as error:
        return "" if all(problem.code for problem in error.problems) else f"no code: {error}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return "no error"


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_wrong_argument_is_an_error_with_a_code(name: str, folder: Path) -> None:
    arguments = list(arguments_of(inspect.signature(getattr(trunnion, name))))
    said = {
        f"{each.name} {type(wrong).__name__}": _said(name, each.name, wrong)
        for each in arguments
        for wrong in _WRONG
        if each.name not in _TRUTHS
    }
    assert "\n".join(f"{key}: {text}" for key, text in said.items() if text) == ""


@pytest.mark.parametrize("name", ["none", "none.toml"])
def test_a_project_that_is_missing_is_a_file_that_is_missing(name: str, folder: Path) -> None:
    with pytest.raises(trunnion.InputError) as error:
        trunnion.post_project(name)
    assert [problem.code for problem in error.value.problems] == ["FIL110"]
