"""What the arguments of ``trunnion post`` mean together: CL files, or a project that states everything itself."""

import argparse
from collections.abc import Sequence
from typing import Final

#: Options that a project states itself, by the names of their arguments.
_STATED: Final = {
    "machine": "machine", "output": "output", "subprograms": "subprograms", "report": "report",
    "hooks": "hooks", "sheet": "sheet", "listing": "listing", "manifest": "manifest",
    "simulate": "[checks] simulate", "project": "its own keys", "stock": "stock", "part": "part",
    "fixtures": "fixtures", "tools": "tools", "libraries": "tool_libraries", "unit": "unit", "near": "near_mm",
    "cell": "cell_mm", "accuracy": "accuracy_mm", "turn": "turn_deg", "tilt": "tilt_deg",
}  # fmt: skip

#: Those of them that are not called after their arguments.
_OPTIONS: Final = {"subprograms": "with", "fixtures": "fixture", "tools": "tool", "libraries": "tools"}


def names_project(files: Sequence[str]) -> bool:
    """Whether files name a project: no CL file is called so."""
    return any(file.endswith(".toml") for file in files)


def post_mistake(arguments: argparse.Namespace) -> str:
    """What does not go together, and the cure; empty where everything does."""
    if names_project(arguments.files):
        return _mistake_of_project(arguments)
    if arguments.machine is None:
        return "the following arguments are required: --machine"
    if arguments.watch and "-" in (*arguments.files, arguments.output):
        return "--watch reads files again and again, and writes files: name them in place of -"
    return ""


def _mistake_of_project(arguments: argparse.Namespace) -> str:
    project = next(file for file in arguments.files if file.endswith(".toml"))
    if len(arguments.files) > 1:
        return f"{project} is a project, and stands beside other files; give it alone"
    if arguments.force:
        return f"{project} is a project, whose programs must all be fit to run; to force one, post its CL files alone"
    for name, key in _STATED.items():
        if getattr(arguments, name):
            option = f"--{_OPTIONS.get(name, name)}"
            return f"{option} does not go with a project; write it there, as {key}, or give CL files"
    return ""
