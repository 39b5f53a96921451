"""A pile of files through every step: ``python -m benchmarks.acceptance FOLDER [--machine NAME]… [--json]``.

CL files are described, posted on one shipped machine for each control, verified against their CL file as programs of
someone else, and converted back; NC programs are verified and converted to CL. What it prints is what
``trunnion survey`` prints, which stops behind the post.
"""

import argparse

from trunnion.cli import configure_process
from trunnion.cli.many_files.survey import survey_lines
from trunnion.results import as_json, to_data
from trunnion.survey.found_files import FileKind
from trunnion.survey.taking import TIMEOUT, take_survey
from trunnion.survey.trying import Step

#: All that is tried.
STEPS = {
    FileKind.CL: (Step.INFO, Step.POST, Step.SETTINGS, Step.VERIFY, Step.CONVERT),
    FileKind.PROGRAM: (Step.VERIFY, Step.CONVERT),
}


def main() -> None:
    """Run from the command line."""
    configure_process()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--machine", action="append", default=[])
    parser.add_argument("--timeout", type=float, default=TIMEOUT)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--json", action="store_true")
    said = parser.parse_args()
    found = take_survey(said.folder, machine=said.machine, timeout=said.timeout, workers=said.workers, steps=STEPS)
    print(as_json(to_data(found)) if said.json else "\n".join(survey_lines(found)))


if __name__ == "__main__":
    main()
