"""The path of CL files in space, as a page."""

from pathlib import Path

from trunnion.files import atomic_file, check_outputs, file_on_disk
from trunnion.jobs.describe.cl_files import ClDescription, OperationDescription
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import declared_output
from trunnion.messages import LIBRARY, Wording, Words, phrase, word_said
from trunnion.model.frames import into_frame
from trunnion.model.toolpath import Frame
from trunnion.reporting.path_page import render_path_page
from trunnion.reporting.path_series import collect_paths


def write_plot(description: ClDescription, plot: FilePath, words: Words = LIBRARY) -> None:
    """Draw the path of CL files in space, by operation, on a page that works offline.

    Parameters
    ----------
    description
        Of ``trunnion.describe_cl``.
    plot
        The page, ``.html``. An older file is replaced when the new one is complete.
    words
        The language of who reads it.

    Raises
    ------
    InputError
        When the name ends otherwise, the file cannot be written, or it is one of the CL files.

    Notes
    -----
    All operations are drawn in the coordinate system of the first one. Files whose coordinate systems cannot be put
    together are drawn as their numbers say.
    """
    if not isinstance(description, ClDescription):
        raise wrong_argument("description", description, phrase("give_description"))
    names = [file.file for file in description.files]
    inputs = list(map(file_on_disk, names))
    place = declared_output("info", "plot", plot)
    check_outputs([plot], inputs)
    operations = [operation for toolpath in description.toolpaths for operation in toolpath.operations]
    first = next((operation.frame for operation in operations if len(operation.moves)), Frame())
    paths, tolerance = collect_paths(
        (_details(about, words), into_frame(operation, first))
        for about, operation in zip(description.operations, operations, strict=True)
    )
    with atomic_file(place, inputs=inputs) as sink:
        sink.writelines(render_path_page(", ".join(Path(file).name for file in names), paths, tolerance, words))


def _details(about: OperationDescription, words: Words) -> str:
    """Return what is shown of an operation."""
    wording = Wording(
        "report", "path_of", kind=word_said(about.kind), points=about.points, arcs=about.arcs, holes=about.holes
    )
    return wording.text("what", words)
