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
    """Write the papers of a post beside its program, which is complete; only a manifest needs no proof."""
    files = target.files
    files.flush()
    for name, place in target.papers.items():
        if name == "manifest":
            continue
        if verification is None:
            continue
        sink = files.add_paper(place)
        if name == "report":
            add_report(verification, sink, place.name, result.decisions, result.simulation)
        elif name == "sheet":
            from trunnion.api.setup_sheets import setup_sheet
            from trunnion.reporting.setup_sheet_page import sheet_json, sheet_page

            sheet = setup_sheet(program, job, result, verification, written_files(target))
            sink.write(sheet_json(sheet) if place.path.suffix.lower() == ".json" else sheet_page(sheet))
        else:
            from trunnion.reporting.listing import listing

            slides = job.settings.get("listing") == "slides"
            name = Path(target.name).name
            sink.writelines(listing(verification.run, name, verification.operations, slides=slides, made_by=MADE_BY))
    if "manifest" in target.papers:
        from trunnion.api.manifests import manifest_bytes

        files.flush()
        data = manifest_bytes(target, program, job, result, verification)
        files.add_paper(target.papers["manifest"]).write(data)


def written_files(target: Target) -> "list[SheetFile]":
    """The files of a program with their checksums, the main program first."""
    from trunnion.api.manifests import checksum
    from trunnion.reporting.setup_sheet import SheetFile

    target.files.flush()
    main = target.path.name if target.path is not None else target.name
    paths = [(main, target.files.path), *((path.name, path) for path in target.files.other_paths)]
    return [SheetFile(name, path.stat().st_size, checksum(path)) for name, path in paths]
