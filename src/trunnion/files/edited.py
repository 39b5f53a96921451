"""Files that are not as a job has written them, edited since or somebody else's: none is replaced unseen.

In:     the place of a file that is going to be replaced, what earlier jobs have written, and what the user wants.
Out:    where the file is kept; or an error.
"""

from datetime import datetime
from itertools import count

from trunnion.errors import InputError, Problem
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.places import OutputPlace
from trunnion.messages import Wording


def place_of_edited(place: OutputPlace, earlier: EarlierJob, edited: str) -> OutputPlace | None:
    """Return where a file is kept that jobs have not written as it is; None: they have, or it is replaced.

    Its own place: nobody knows whose it is. It is replaced only by what it holds already, as after a clone.

    place    of the file
    earlier  the jobs
    edited   ``keep``, ``replace``, or anything else to refuse

    Raises ``InputError`` if it is refused.
    """
    if edited == "replace" or place.is_stream or not earlier.is_foreign(place.path):
        return None
    if edited != "keep":
        if earlier.has_edited(place.path):
            raise InputError(Problem(place.name, 0, Wording("FIL250", "edited_since")))
        return place
    changed = _date_of(place)
    for number in count(1):
        again = f"-{number}" if number > 1 else ""
        path = place.path.with_name(f"{place.path.name}.edited-{changed:%Y-%m-%d}{again}")
        if not path.exists():
            return OutputPlace(str(path), path)
    raise AssertionError("there is a number that is free")


def _date_of(place: OutputPlace) -> datetime:
    """Return the date of the edit, not of today: the same files give the same names."""
    try:
        return datetime.fromtimestamp(place.path.stat().st_mtime)
    except (ValueError, OverflowError, OSError):  # some clocks are wrong by thousands of years
        return datetime(1970, 1, 1)
