"""A part at the place that was found: its CL files turned, and posted with the workpiece zero there."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from trunnion.api.observer import SILENT, Observer
from trunnion.api.post_result import PostResult
from trunnion.api.posting import post
from trunnion.api.reading import MachineLike
from trunnion.api.settings import Settings, as_texts
from trunnion.api.targets import OutputLike
from trunnion.errors import InputError, Problem
from trunnion.model.frames import frame_from_vectors, into_frame, into_plane
from trunnion.model.toolpath import Frame, Operation, Toolpath
from trunnion.placing.path_rows import about_z
from trunnion.placing.placement import Placement


def post_placed(
    found: Placement,
    *,
    machine: MachineLike,
    output: OutputLike = None,
    settings: Settings | None = None,
    observer: Observer = SILENT,
) -> PostResult:
    """Post the CL files of a placement with its best place.

    Parameters
    ----------
    found
        Of CL files. Where its best place is turned, so is the toolpath, about Z of the program's coordinate system.
    machine
        As ``trunnion.place`` had it.
    output, settings, observer
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
        what, cure = "an NC program stays as it is", "set its work offset to the place, or give the CL files"
        raise InputError(Problem(found.files[0], 0, what, cure, code="PLC140"))
    if found.best is None or not found.fits:
        raise InputError(Problem(found.files[0], 0, "the part fits nowhere", "see what limits it", code="PLC150"))
    texts = as_texts(settings)
    absolute = texts.get("frame") == "absolute"
    toolpaths = turned_toolpaths(found.toolpaths, found.best.turn_deg, absolute=absolute)
    return post(
        toolpaths, machine=machine, output=output, settings={**texts, "zero": found.best.zero_mm}, observer=observer
    )


def turned_toolpaths(toolpaths: Sequence[Toolpath], degrees: float, *, absolute: bool = False) -> list[Toolpath]:
    """Toolpaths of a part that is turned about Z of the program's coordinate system, right-handed.

    That is the coordinate system of the first operation with motion, or the ``absolute`` one of the CAM system.
    """
    if degrees % 360.0 == 0.0:
        return list(toolpaths)
    moving = (operation for path in toolpaths for operation in path.operations if len(operation.moves))
    frame = Frame() if absolute else next(moving).frame
    back = about_z(-degrees)
    plane = frame_from_vectors(np.zeros(3), back[:, 0], back[:, 1])

    def turned(operation: Operation) -> Operation:
        return replace(into_plane(into_frame(operation, frame), plane), frame=frame)

    return [replace(path, operations=tuple(map(turned, path.operations))) for path in toolpaths]
