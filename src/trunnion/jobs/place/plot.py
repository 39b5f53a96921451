"""A picture of a placement."""

from collections.abc import Iterable

from trunnion.files import atomic_file
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import declared_output
from trunnion.messages import LIBRARY, Words, phrase
from trunnion.placing.placement import Placement
from trunnion.reporting.page_words import in_language
from trunnion.reporting.placing_picture import placing_picture


def write_placing_plot(
    found: Placement, plot: FilePath, *, inputs: Iterable[FilePath] = (), words: Words = LIBRARY
) -> None:
    """Draw the margin over the table at the best height and turn, and over the turns.

    Parameters
    ----------
    found
        Of ``trunnion.place``.
    plot
        The file, ``.svg``. An older one is replaced when the new one is complete.
    inputs
        Files that are not written over.
    words
        The language of who reads it.

    Raises
    ------
    InputError
        When the name ends otherwise, the file cannot be written, or no turn is within reach of the rotary axes.
    """
    if not isinstance(found, Placement) or found.best is None:
        raise wrong_argument("found", found, phrase("give_placement"))
    with atomic_file(declared_output("place", "plot", plot), inputs=inputs) as sink, in_language(words):
        sink.write(placing_picture(found).encode())
