"""A part at the place that was found: its CL files are posted turned, with the workpiece zero there."""

from typing import Any, Unpack

from trunnion.errors import InputError, Problem
from trunnion.jobs.arguments import PlacedArguments
from trunnion.jobs.inputs.arguments import wrong_argument
from trunnion.jobs.inputs.reading import MachineLike
from trunnion.jobs.inputs.settings import as_texts
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.place.inputs import nc_program_stays
from trunnion.jobs.post.posting import Work, post_beside
from trunnion.jobs.post.result import PostResult
from trunnion.messages import Wording, phrase
from trunnion.placing.placement import Placement


def post_placed(
    found: Placement,
    *,
    machine: MachineLike,
    observer: Observer = SILENT,
    **given: Unpack[PlacedArguments],
) -> PostResult:
    """Post the CL files of a placement with its best place.

    Parameters
    ----------
    found
        Of CL files. Where its best place is tilted or turned, so is the toolpath: first about X, then about Z of the
        program's coordinate system. Comments in the head of the program say so, and where the workpiece zero is.
    machine
        As ``trunnion.place`` had it.
    output, settings, sheet, hooks, observer
        As ``trunnion.post`` takes them; the setting ``zero`` is that of the place, and ``tool_length`` by default that
        of the placement.

    Returns
    -------
    PostResult
        The proven program: its linear axes keep their limits with the workpiece zero there.

    Raises
    ------
    InputError
        When it is a placement of NC programs, or something cannot be used.
    RefusedError
        When the program must not run.

    Examples
    --------
    >>> import trunnion
    >>> found = trunnion.place("tests/golden/yl569/2_hub_rough.cls", machine="yl569")
    >>> trunnion.post_placed(found, machine="yl569").passed
    True
    """
    if not isinstance(found, Placement):
        raise wrong_argument("found", found, phrase("give_placement"))
    if not found.toolpaths:
        raise InputError(nc_program_stays(found.files[0]))
    if found.best is None or not found.fits:
        raise InputError(Problem(found.files[0], 0, Wording("PLC150", "fits_nowhere")))
    texts = as_texts(given.get("settings"))
    every = [] if found.tool_length_mm is None else [str(found.tool_length_mm)]
    if lengths := [*every, *(f"{name}={length}" for name, length in found.tool_lengths_mm.items())]:
        texts.setdefault("tool_length", ",".join(lengths))
    best = found.best
    stated: Any = {
        **given, "settings": {**texts, "zero": best.zero_mm}, "turn": best.turn_deg, "tilt": best.tilt_deg
    }  # fmt: skip
    return post_beside(found.toolpaths, machine, stated, Work(is_placed=True), observer)
