"""Papers of a post: report, setup sheet, listing and manifest, which appear together with the program.

In:     what was posted, and where its papers go.
Out:    their files.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from trunnion import __version__
from trunnion.api.job import PostJob
from trunnion.api.post_result import PostResult
from trunnion.api.reports import add_report
from trunnion.api.targets import Target
from trunnion.output.program import Program
from trunnion.verification import Verification

if TYPE_CHECKING:  # imported where they are written
    from trunnion.reporting.setup_sheet import SheetFile

#: What made a paper.
MADE_BY: Final = f"Trunnion {__version__}"


def write_papers(
    target: Target, program: Program, job: PostJob, result: PostResult, verification: Verification | None
) -> None:
    """Write the papers of a post beside its program, which is complete; without a proof there is a manifest alone."""
    files, places = target.files, target.papers
    if verification is not None and "report" in places:
        name = places["report"].name
        add_report(verification, files.add_paper(places["report"]), name, result.decisions, result.simulation)
    if verification is not None and "sheet" in places:
        place = places["sheet"]
        files.add_paper(place).write(_sheet(target, program, job, result, verification, place.path.suffix.lower()))
    if verification is not None and "listing" in places:
        from trunnion.reporting.listing import listing

        slides, name = job.settings.get("listing") == "slides", Path(target.name).name
        text = listing(verification.run, name, verification.operations, slides=slides, made_by=MADE_BY)
        files.add_paper(places["listing"]).writelines(text)
    if "manifest" in places:
        from trunnion.api.manifests import manifest_bytes

        files.flush()
        data = manifest_bytes(target, program, job, result, verification)
        files.add_paper(places["manifest"]).write(data)


def _sheet(
    target: Target, program: Program, job: PostJob, result: PostResult, verification: Verification, suffix: str
) -> bytes:
    """The setup sheet as a page or as data; stock, part and fixtures are drawn where the program is simulated."""
    from trunnion.api.setup_sheets import setup_sheet
    from trunnion.reporting.path_drawing import DrawnBody
    from trunnion.reporting.setup_sheet_page import sheet_json, sheet_page

    bodies = []
    if job.simulation is not None:
        from trunnion.api.posted_simulation import simulated_bodies

        bodies = [DrawnBody(kind, mesh.vertices, mesh.faces) for kind, mesh in simulated_bodies(job.simulation)]
    sheet = setup_sheet(program, job, result, verification, _written_files(target), bodies)
    return sheet_json(sheet) if suffix == ".json" else sheet_page(sheet)


def _written_files(target: Target) -> "list[SheetFile]":
    """The files of a program with their checksums, the main program first."""
    from trunnion.api.manifests import checksum
    from trunnion.reporting.setup_sheet import SheetFile

    target.files.flush()
    main = target.path.name if target.path is not None else target.name
    paths = [(main, target.files.path), *((path.name, path) for path in target.files.other_paths)]
    return [SheetFile(name, path.stat().st_size, checksum(path)) for name, path in paths]
