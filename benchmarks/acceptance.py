"""A pile of files through every step: ``python -m benchmarks.acceptance FOLDER [--only cl|nc] [--json]``.

CL files are described, posted on one shipped machine for each control, posted again with stand-ins for the settings
that errors ask for, verified against their CL file as programs of someone else, and converted back; NC programs are
verified, once more with the keys that ``trunnion check --program`` proposes where they are refused, and converted to
CL. What it prints is what ``trunnion survey`` prints, which stops behind the post, and the shares of posts that are
proven and of programs that are read.
"""

import argparse
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from tests.support.program_origins import OF_CAM, origin_of

from trunnion.cli import configure_process
from trunnion.cli.many_files.counting_terminal import CountingTerminal
from trunnion.cli.many_files.survey import survey_lines
from trunnion.results import as_json, to_data
from trunnion.survey.found_files import FileKind
from trunnion.survey.result import Became, Survey, SurveyedFile
from trunnion.survey.taking import TIMEOUT, take_survey
from trunnion.survey.trying import Step

#: All that is tried.
STEPS = {
    FileKind.CL: (Step.INFO, Step.POST, Step.SETTINGS, Step.VERIFY, Step.CONVERT),
    FileKind.PROGRAM: (Step.VERIFY, Step.KEYS, Step.CONVERT),
}
READ = (Became.READ, Became.READ_WARNED, Became.READ_KEYED, Became.CALLED, Became.BEYOND, Became.CHECK_FAILED)
ONLY = {"cl": FileKind.CL, "nc": FileKind.PROGRAM}


def shares(found: Survey) -> str:
    """Return the shares of posts that are proven as they are, and with settings, of those that the machine can do."""
    tries = [each for file in found.files if file.kind is FileKind.CL for each in file.tries]
    became = Counter(each.became for each in tries)
    beyond = became[Became.BEYOND]
    own = sum(each.became is Became.PROOF_FAILED and each.step == Step.POST for each in tries)
    posts = became.total() - beyond
    proven = became[Became.PROVEN] + became[Became.PROVEN_WARNED]
    filled = proven + became[Became.PROVEN_FILLED]
    return (
        f"{posts} posts, and {beyond} beyond the machine: {proven} proven as they are ({proven / max(posts, 1):.1%}), "
        f"{filled} after one round of settings ({filled / max(posts, 1):.1%}), {own} own proofs failed"
    )


def read_shares(programs: Sequence[SurveyedFile]) -> str:
    """Return the shares of programs that are read without an error as they are, and with one round of keys.

    That a check fails is another matter: many programs do not say their unit, which only their control knows. So is
    that a program that is read cannot be converted to CL.
    """
    read = [each for each in programs if each.became in READ or (each.tries and each.tries[0].step == Step.CONVERT)]
    plain, count = sum(not (each.tries and each.tries[0].keys) for each in read), max(len(programs), 1)
    return (
        f"{len(programs)} programs: {plain} read without an error as they are ({plain / count:.1%}), "
        f"{len(read)} after one round of keys ({len(read) / count:.1%})"
    )


def of_cam(found: Survey, programs: Sequence[SurveyedFile]) -> list[SurveyedFile]:
    """Return the programs that come from CAM posts by their content."""
    return [each for each in programs if origin_of(Path(found.folder, each.file)) in OF_CAM]


def main() -> None:
    """Run from the command line."""
    configure_process()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder")
    parser.add_argument("--only", choices=sorted(ONLY))
    parser.add_argument("--machine", action="append", default=[])
    parser.add_argument("--timeout", type=float, default=TIMEOUT)
    parser.add_argument("--workers", type=int)
    parser.add_argument("--json", action="store_true")
    said = parser.parse_args()
    steps = {kind: tried if said.only in (None, name) else () for name, kind in ONLY.items() for tried in [STEPS[kind]]}
    found = take_survey(
        said.folder, machine=said.machine, timeout=said.timeout, workers=said.workers, steps=steps,
        observer=CountingTerminal(),
    )  # fmt: skip
    # Also those of other controls, which the survey takes for none of ours: their refusal counts.
    programs = [file for file in found.files if file.kind is not FileKind.CL]
    print(
        as_json(to_data(found))
        if said.json
        else "\n".join(
            [
                *survey_lines(found),
                shares(found),
                read_shares(programs),
                f"of CAM posts: {read_shares(of_cam(found, programs))}",
            ]
        )
    )


if __name__ == "__main__":
    main()
