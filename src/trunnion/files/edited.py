"""Programs that somebody has edited since a job has written them: none is replaced unseen.

In:     the place of a file that is going to be replaced, what earlier jobs have written, and what the user wants.
Out:    where the edited file is kept; or an error.
"""

from datetime import datetime
from itertools import count

from trunnion.errors import InputError, Problem
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.places import OutputPlace
from trunnion.messages import Wording


def place_of_edited(place: OutputPlace, earlier: EarlierJob, edited: str) -> OutputPlace | None:
    """Return where an edited file is kept; None: it is as jobs have written it, or of somebody else, or replaced.

    place    of the file
    earlier  the jobs
    edited   ``keep``, ``replace``, or anything else to refuse

    Raises ``InputError`` if it is refused.
    """
    if edited == "replace" or place.is_stream or not earlier.has_edited(place.path):
        return None
    if edited != "keep":
        raise InputError(edited_problem(place.name))
    # The date of the edit, not of today: the same files give the same names.
    changed = datetime.fromtimestamp(place.path.stat().st_mtime)
    for number in count(1):
        again = f"-{number}" if number > 1 else ""
        path = place.path.with_name(f"{place.path.name}.edited-{changed:%Y-%m-%d}{again}")
        if not path.exists():
            return OutputPlace(str(path), path)
    raise AssertionError("there is a number that is free")


def edited_problem(name: str) -> Problem:
    """Return what is said where an edited program is not replaced."""
    return Problem(name, 0, Wording("FIL250", "edited_since"))
