"""The registry of commands: everything that can be asked of Trunnion, as data.

Command line, completion, the guard of files, projects and the tables of the docs are made from it. Its entries name
modules by texts: nothing that computes is imported before a command is run.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from trunnion.jobs.declarations import automate, first, impellers, make, prove, see
from trunnion.jobs.job import Job

#: Commands by what they are for, in the order of ``trunnion --help``.
GROUPS: Final[Mapping[str, tuple[Job, ...]]] = MappingProxyType(
    {
        "First steps": first.JOBS,
        "Make programs": make.JOBS,
        "Prove them": prove.JOBS,
        "See": see.JOBS,
        "Impellers and curves": impellers.JOBS,
        "Automate": automate.JOBS,
    }
)

#: Commands that read CL files, or run a post, and take no hooks, and why.
WITHOUT_HOOKS: Final[Mapping[str, str]] = MappingProxyType(
    {
        "info": "hooks see a machine, and it has none",
        "convert": "what it writes does what the program does, and nothing else",
        "impeller": "it makes its toolpaths itself",
        "batch": "a file of jobs may come from anyone, and runs nothing",
        "survey": "a folder may hold files of anyone, and runs nothing",
    }
)

#: All of them by their names.
JOBS: Final[Mapping[str, Job]] = MappingProxyType({job.name: job for jobs in GROUPS.values() for job in jobs})
