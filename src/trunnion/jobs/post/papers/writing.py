"""Papers of a post: report, setup sheet, listing and manifest, which appear together with the program.

In:     what was posted, and where its papers go.
Out:    their files.

The papers of a project's programs are written when its checks are done: they tell what these found.
"""

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from trunnion.errors import Problem
from trunnion.jobs.inputs.reading import FilePath
from trunnion.jobs.post.papers import MADE_BY
from trunnion.jobs.post.post_job import PostJob
from trunnion.jobs.post.result import PostResult
from trunnion.jobs.result_output import Target
from trunnion.jobs.verify.reports import OfPost, add_report
from trunnion.messages import LIBRARY, Words
from trunnion.output.program import Program
from trunnion.records import dataclass
from trunnion.verification import Verification

if TYPE_CHECKING:  # imported where they are written
    from trunnion.jobs.inputs.simulation_input import SimulationInput
    from trunnion.jobs.post.papers.manifests import PostInputs
    from trunnion.jobs.simulate.result import SimulationResult
    from trunnion.reporting.setup_sheet import SheetFile


@dataclass(frozen=True, slots=True, eq=False)
class PostPapers:
    """All that the papers of a post tell.

    inputs  the manifest's entries of what was read, as it was then
    words   the language of who asks, for pages
    """

    target: Target
    program: Program
    job: PostJob
    result: PostResult
    inputs: "PostInputs"
    words: Words = LIBRARY

    def with_checks(
        self,
        problems: Iterable[Problem],
        simulation: "SimulationResult | None",
        simulated: "SimulationInput | None",
        files: Iterable[FilePath],
    ) -> "PostPapers":
        """Return the papers with what was found after the post: problems, and a simulation with what it was of and
        read.
        """
        from trunnion.jobs.post.papers.manifests import inputs_of

        # A sheet has room for some warnings: these are the first.
        result = replace(self.result, problems=(*problems, *self.result.problems), simulation=simulation)
        read = self.inputs | {"simulation": inputs_of(files)} if self.inputs else self.inputs
        return replace(self, job=replace(self.job, simulation=simulated), result=result, inputs=read)

    def write(self) -> None:
        """Write them beside the program, which is complete; without a proof there is a manifest alone."""
        target, job, result, verification = self.target, self.job, self.result, self.result.proof
        files, places = target.files, target.papers
        if verification is not None and "report" in places:
            name = places["report"].name
            of_post = OfPost(result.decisions, result.simulation)
            add_report(verification, files.add_paper(places["report"]), name, of_post, self.words)
        if verification is not None and "sheet" in places:
            place = places["sheet"]
            data = self._sheet(verification, place.path.suffix.lower())
            files.add_paper(place).write(data)
        if verification is not None and "listing" in places:
            from trunnion.reporting.listing import listing

            slides, name = job.settings.get("listing") == "slides", Path(target.name).name
            text = listing(verification.run, name, verification.operations, slides=slides, made_by=MADE_BY)
            files.add_paper(places["listing"]).writelines(text)
        if "manifest" in places:
            from trunnion.jobs.post.papers.manifests import manifest_bytes

            files.flush()
            data = manifest_bytes(target, self.program, job, result, self.inputs)
            files.add_paper(places["manifest"]).write(data)

    def _sheet(self, verification: Verification, suffix: str) -> bytes:
        """Return the setup sheet as a page or as data; stock, part and fixtures are drawn where the program is
        simulated.
        """
        from trunnion.jobs.post.papers.setup_sheets import setup_sheet
        from trunnion.reporting.page_words import in_language
        from trunnion.reporting.path_drawing import DrawnBody
        from trunnion.reporting.setup_sheet_page import sheet_json, sheet_page

        bodies = []
        if self.job.simulation is not None:
            from trunnion.jobs.simulate.posted import simulated_bodies

            found = simulated_bodies(self.job.simulation)
            bodies = [DrawnBody(kind, mesh.vertices, mesh.faces) for kind, mesh in found]
        files = _written_files(self.target)
        is_data = suffix == ".json"
        with in_language(LIBRARY if is_data else self.words):
            sheet = setup_sheet(self.program, self.job, self.result, verification, files, bodies)
            return sheet_json(sheet) if is_data else sheet_page(sheet)


def post_papers(
    target: Target, program: Program, job: PostJob, result: PostResult, words: Words = LIBRARY
) -> PostPapers:
    """Return the papers of a post that is proven."""
    inputs: PostInputs = {}
    if "manifest" in target.papers:
        from trunnion.jobs.post.papers.manifests import post_inputs

        inputs = post_inputs(job, result)
    return PostPapers(target, program, job, result, inputs, words)


def _written_files(target: Target) -> "list[SheetFile]":
    """Return the files of a program with their checksums, the main program first."""
    from trunnion.jobs.post.papers.manifests import checksum
    from trunnion.reporting.setup_sheet import SheetFile

    target.files.flush()
    main = target.path.name if target.path is not None else target.name
    paths = [(main, target.files.path), *((path.name, path) for path in target.files.other_paths)]
    return [SheetFile(name, path.stat().st_size, checksum(path)) for name, path in paths]
