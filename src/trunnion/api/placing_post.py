"""A part at the place that was found: its CL files are posted turned, with the workpiece zero there."""

from trunnion.api.observer import SILENT, Observer
from trunnion.api.paper_files import paper_files
from trunnion.api.placing_inputs import nc_program_stays
from trunnion.api.post_result import PostResult
from trunnion.api.posting import post_beside
from trunnion.api.reading import FilePath, MachineLike
from trunnion.api.settings import Settings, as_texts
from trunnion.api.targets import OutputLike
from trunnion.errors import InputError, Problem
from trunnion.placing.placement import Placement


def post_placed(
    found: Placement,
    *,
    machine: MachineLike,
    output: OutputLike = None,
    settings: Settings | None = None,
    sheet: FilePath | None = None,
    observer: Observer = SILENT,
) -> PostResult:
    """Post the CL files of a placement with its best place.

    Parameters
    ----------
    found
        Of CL files. Where its best place is tilted or turned, so is the toolpath: first about X, then about Z of the
        program's coordinate system. Comments in the head of the program say so, and where the workpiece zero is.
    machine
        As ``trunnion.place`` had it.
    output, settings, sheet, observer
        As ``trunnion.post`` takes them; the setting ``zero`` is that of the place.

    Returns
    -------
    PostResult
        The proven program: its slides keep their limits with the workpiece zero there.

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
    if not found.toolpaths:
        raise InputError(nc_program_stays(found.files[0]))
    if found.best is None or not found.fits:
        raise InputError(Problem(found.files[0], 0, "the part fits nowhere", "see what limits it", code="PLC150"))
    texts = as_texts(settings)
    best = found.best
    return post_beside(
        found.toolpaths, (),
        machine=machine, output=output, settings={**texts, "zero": best.zero_mm}, strict=False, force=False,
        explain=False, papers=paper_files(None, sheet, None, None, output), columns=True, subprograms=(),
        turn=best.turn_deg, tilt=best.tilt_deg, is_placed=True, observer=observer,
    )  # fmt: skip
