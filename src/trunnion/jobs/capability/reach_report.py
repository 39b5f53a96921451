"""What a machine reaches as data and as a picture.

In:     ``Reach``.
Out:    plain data, or the file of the picture.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import Final

from trunnion.capability.reach import Reach
from trunnion.files import atomic_file
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.result_output import declared_output
from trunnion.machines.reach import ReachedVolume
from trunnion.messages import LIBRARY, Words
from trunnion.reporting.page_words import in_language, label
from trunnion.reporting.reach_picture import ReachPicture, TiltOfPicture, reach_picture
from trunnion.reporting.text import clean

#: Decimals of volumes, mm^3.
_DECIMALS: Final = 1


def write_reach_plot(found: Reach, file: FilePath, inputs: Iterable[FilePath] = (), words: Words = LIBRARY) -> None:
    """Draw the sphere of tool axes, and the volume of tips over the tilt.

    Raises ``InputError`` when the name does not end in ``.svg``, the file cannot be written, or it is one of
    ``inputs``.
    """
    with atomic_file(declared_output("reach", "plot", file), inputs=inputs) as sink, in_language(words):
        sink.write(reach_picture(_picture(found)).encode())


def _picture(found: Reach) -> ReachPicture:
    machine = found.machine
    share, length = 100.0 * found.sphere, machine.tool_length
    title = (
        label("reach_title", machine=machine.name, share=share)
        if length is None
        else label("reach_title_with_tool", machine=machine.name, length=length, share=share)
    )
    return ReachPicture(
        clean(title),
        [
            TiltOfPicture(
                each.tilt, each.branches, 0.0 if each.one_pose is None else each.one_pose[1],
                _triple(each.some), _triple(each.every),
            )
            for each in found.tilts
        ],
        found.step,
        [(clean(Path(each.file).name), *each.tilts) for each in found.paths],
    )  # fmt: skip


def _triple(volume: ReachedVolume | None) -> tuple[float, float, float] | None:
    return None if volume is None else (volume.low, volume.likely, volume.high)
