"""The papers of a project's programs: they wait for its checks, and tell what these found.

In:     the papers of a program that is posted, and what the checks found of its set-up.
Out:    their files, which appear with those of the project.
"""

from dataclasses import replace
from pathlib import Path

from trunnion.errors import Severity
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.inputs.simulation_input import SimulationInput
from trunnion.jobs.post.papers.writing import PostPapers
from trunnion.jobs.post_project.checks import SetupFindings
from trunnion.jobs.project.named_files import simulated_files
from trunnion.jobs.project.project import Project
from trunnion.jobs.simulate.result import SimulationResult


def write_setup_papers(papers: PostPapers, project: Project, number: int, found: SetupFindings) -> None:
    """Write the papers of the program of a set-up, with the ``number`` that it has in the project from 0."""
    simulation, problems = found.simulation, list(found.problems)
    simulated, files = None, list[FilePath]()
    if simulation is not None:
        problems += [remark for remark in simulation.remarks if remark.severity is Severity.WARNING]
        simulated = _as_simulated(project.simulation, number, simulation)
        files = [project.path, *(file for file in simulated_files(project, number) if Path(file).is_file())]
    with papers.target.files.filled():
        papers.with_checks(dict.fromkeys(problems), simulation, simulated, files).write()


def _as_simulated(given: SimulationInput, number: int, found: SimulationResult) -> SimulationInput:
    """Return a set-up alone, in its own coordinates: its part, fixtures, and the bounds of what the one before has
    left.
    """
    from trunnion.simulation.meshes.primitives import box_mesh

    setup = found.simulation.model
    stock = given.stock if number == 0 else box_mesh(setup.stock.low, setup.stock.high, "stock")
    part = None if setup.part is None else setup.part.mesh
    return replace(given, stock=stock, setups=[replace(given.setups[number], part=part)])
