"""``trunnion new`` and ``trunnion schema``."""

import shlex
from pathlib import Path

from trunnion.builder.likeness import definition_like
from trunnion.builder.saved_file import is_file_name
from trunnion.cli.printing import print_result
from trunnion.cli.results import show
from trunnion.cli.wording import line
from trunnion.definitions.value_marks import marked_values
from trunnion.errors import InputError, Problem
from trunnion.files import atomic_file, check_outputs
from trunnion.jobs.job import Given
from trunnion.machines import load_machine
from trunnion.machines.loading import check_is_shipped, shipped_machines
from trunnion.messages import Wording
from trunnion.schemas import file_name, put_beside, schema_text


def new(given: Given) -> int:
    """Write a short definition that extends a shipped machine, and the schema that editors read beside it."""
    check_is_shipped(given.like)
    file = Path(given.name if given.name.endswith(".toml") else f"{given.name}.toml")
    if not is_file_name(file.name):
        raise InputError(Problem(given.name, 0, Wording("FIL340", "not_on_every_system")))
    if file.stem in shipped_machines():
        raise InputError(Problem(given.name, 0, Wording("FIL340", "name_of_shipped_machine", stem=file.stem)))
    if file.exists() or file.is_symlink():
        raise InputError(Problem(str(file), 0, Wording("FIL250", "definition_exists")))
    streams = [] if given.json in (None, "-") else [given.json]
    check_outputs([file, file.with_name(file_name("machine")), *streams], [])
    text = definition_like(load_machine(given.like), file.stem)
    with atomic_file(file) as sink:
        sink.write(text.encode())
    schema = put_beside(file, "machine")
    marks = len(marked_values(text))
    lines = (
        line("extends_to_measure", file=str(file), base=given.like, marks=marks),
        *([line("schema_for_editors", file=str(schema))] if schema else []),
        line("next_check", file=shlex.quote(str(file))),
    )
    data = {"schema": 1, "file": str(file), "extends": given.like, "numbers_to_measure": marks}
    show(given, lambda: data, lines)
    return 0


def schema(given: Given) -> int:
    """Print the JSON Schema of a kind of file."""
    print_result(schema_text(given.kind), end="")
    return 0
