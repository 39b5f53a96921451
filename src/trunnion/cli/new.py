"""``trunnion new`` and ``trunnion schema``."""

import argparse
from pathlib import Path

from trunnion.builder.likeness import definition_like
from trunnion.builder.saved_file import is_file_name
from trunnion.cli.results import print_result
from trunnion.definitions.value_marks import marked_values
from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file
from trunnion.machines import load_machine
from trunnion.machines.loading import check_is_shipped, shipped_machines
from trunnion.schemas import put_beside, schema_text
from trunnion.wording import counted


def new(arguments: argparse.Namespace) -> int:
    """Write a short definition that extends a shipped machine, and the schema that editors read beside it."""
    check_is_shipped(arguments.like)
    file = Path(arguments.name if arguments.name.endswith(".toml") else f"{arguments.name}.toml")
    if not is_file_name(file.name):
        what = "is no name for a file on every system"
        raise InputError(
            Problem(arguments.name, 0, what, "write letters, digits and _, such as our_mill", code="FIL340")
        )
    if file.stem in shipped_machines():
        what = "is the name of a shipped machine, which --machine would go on taking"
        raise InputError(Problem(arguments.name, 0, what, f"write another, such as our_{file.stem}", code="FIL340"))
    if file.exists() or file.is_symlink():
        raise InputError(
            Problem(str(file), 0, "is there already", "choose another name, or edit that file", code="FIL250")
        )
    text = definition_like(load_machine(arguments.like), file.stem)
    with atomic_file(file) as sink:
        sink.write(text.encode())
    schema = put_beside(file, "machine")
    marks = len(marked_values(text))
    print_result(
        f"{file}: extends {arguments.like}, {counted(marks, 'number')} to measure",
        *([f"{schema}: for editors that complete and check TOML"] if schema else []),
        f"next: trunnion check {file}",
    )
    return 0


def schema(arguments: argparse.Namespace) -> int:
    """Print the JSON Schema of a kind of file."""
    print_result(schema_text(arguments.kind), end="")
    return 0
