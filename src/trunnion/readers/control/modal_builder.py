"""The values of a run that change seldom, while its program runs."""

import math

import numpy as np

from trunnion.model.feed_path import FeedPath
from trunnion.model.run import ORIENTATION_FROM_WORDS
from trunnion.model.run_columns import ModalState
from trunnion.readers.control.row_buffer import StepColumnBuilder


class ModalBuilder:
    """Builders of the columns of a ``ModalState``; their names and values are those of ``trunnion.model.run.Run``."""

    def __init__(self) -> None:
        self.file = StepColumnBuilder(0)
        self.feed = StepColumnBuilder(math.nan)
        self.feed_mode = StepColumnBuilder(94)
        self.rpm = StepColumnBuilder(0.0)
        self.spindle = StepColumnBuilder(0)
        self.tool = StepColumnBuilder(0)
        self.edge = StepColumnBuilder(-1)
        self.compensation = StepColumnBuilder(0)
        self.radius = StepColumnBuilder(-1)
        self.compensation_plane = StepColumnBuilder(-1)
        self.compensation_style = StepColumnBuilder(0)
        self.stated_radius = StepColumnBuilder(math.nan)
        self.work_offset = StepColumnBuilder(0)
        self.tcp = StepColumnBuilder(False)
        self.at_ends = StepColumnBuilder(False)
        self.machine_frame = StepColumnBuilder(False)
        self.machine_steps = StepColumnBuilder(0)
        self.inches = StepColumnBuilder(False)
        self.orientation = StepColumnBuilder(ORIENTATION_FROM_WORDS)
        self.xyz_is_tip = StepColumnBuilder(False)
        self.plane = StepColumnBuilder(-1)
        self.feed_path = StepColumnBuilder(int(FeedPath.SLIDES))
        self.length_axis = StepColumnBuilder(-1)
        self.working_plane = StepColumnBuilder(2)

    def state(self, n: int) -> ModalState:
        """Return the columns with n rows; nothing may be added afterwards."""
        return ModalState(
            file=self.file.steps(n, np.uint16),
            feed=self.feed.steps(n, np.float64),
            feed_mode=self.feed_mode.steps(n, np.uint8),
            rpm=self.rpm.steps(n, np.float64),
            spindle=self.spindle.steps(n, np.int8),
            tool=self.tool.steps(n, np.int32),
            edge=self.edge.steps(n, np.int32),
            compensation=self.compensation.steps(n, np.int8),
            radius=self.radius.steps(n, np.int32),
            compensation_plane=self.compensation_plane.steps(n, np.int32),
            compensation_style=self.compensation_style.steps(n, np.uint8),
            stated_radius=self.stated_radius.steps(n, np.float64),
            work_offset=self.work_offset.steps(n, np.uint16),
            tcp=self.tcp.steps(n, np.bool_),
            at_ends=self.at_ends.steps(n, np.bool_),
            machine_frame=self.machine_frame.steps(n, np.bool_),
            machine_steps=self.machine_steps.steps(n, np.uint8),
            inches=self.inches.steps(n, np.bool_),
            orientation=self.orientation.steps(n, np.uint8),
            xyz_is_tip=self.xyz_is_tip.steps(n, np.bool_),
            plane=self.plane.steps(n, np.int32),
            feed_path=self.feed_path.steps(n, np.uint8),
            length_axis=self.length_axis.steps(n, np.int8),
            working_plane=self.working_plane.steps(n, np.uint8),
        )
