"""Output files: settled before any work, complete or not there at all, alone or several together."""

from trunnion.files.command_output import command_output, once_in_place, output_at_once
from trunnion.files.dead_jobs import settle_and_log, settle_dead_jobs
from trunnion.files.earlier_job import EarlierJob
from trunnion.files.names import name_fault
from trunnion.files.output import OutputFiles, atomic_file, atomic_output
from trunnion.files.output_group import OutputGroup, output_group
from trunnion.files.places import OutputPlace, check_outputs, file_on_disk, resolve_output
from trunnion.files.streams import check_stream
from trunnion.files.write_progress import WriteProgress, WritingStoppedError

__all__ = [
    "EarlierJob",
    "OutputFiles",
    "OutputGroup",
    "OutputPlace",
    "WriteProgress",
    "WritingStoppedError",
    "atomic_file",
    "atomic_output",
    "check_outputs",
    "check_stream",
    "command_output",
    "file_on_disk",
    "name_fault",
    "once_in_place",
    "output_at_once",
    "output_group",
    "resolve_output",
    "settle_and_log",
    "settle_dead_jobs",
]
