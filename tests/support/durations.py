"""What processor time files of tests take: ``python -m tests.support.durations REPORT.xml ...`` keeps it as data.

A report is what ``pytest --junitxml REPORT.xml`` writes. Files that no report has keep what they had, unless they are
gone. ``make.py quick`` chooses by it what it has time for.
"""

import sys
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path
from xml.etree import ElementTree

from tests.support.locations import TESTS

#: The property of a test in a report.
PROCESSOR_SECONDS = "processor_seconds"

#: What a file takes that is not listed, s: files that round to no second are not, nor is one that nobody has measured.
UNLISTED = 0.3

#: A file that takes longer is slow, s.
SLOW = 5.0

_KEPT = Path(__file__).with_name("durations.toml")

_HEAD = "# Processor time of files of tests, s. Written by python -m tests.support.durations; by hand for a new file.\n"


def kept() -> dict[str, float]:
    """Files of tests, from the folder of all tests -> processor time, s."""
    return {file: float(seconds) for file, seconds in tomllib.loads(_KEPT.read_text(encoding="utf-8")).items()}


def measured(reports: Iterable[Path]) -> dict[str, float]:
    """Files of tests in reports of pytest -> processor time, s."""
    sums = defaultdict[str, float](float)
    for report in reports:
        for case in ElementTree.parse(report).iter("testcase"):
            file = f"{case.get('classname', '').removeprefix('tests.').replace('.', '/')}.py"
            values = (each.get("value", "") for each in case.iter("property") if each.get("name") == PROCESSOR_SECONDS)
            sums[file] += sum(map(float, values))
    return dict(sums)


def listing(seconds: Mapping[str, float]) -> str:
    """The text that is kept: whole seconds, of files that take one."""
    lines = [f'"{file}" = {round(seconds[file])}\n' for file in sorted(seconds) if round(seconds[file])]
    return _HEAD + "".join(lines)


def main() -> None:
    """Measure and keep."""
    seconds = {**kept(), **measured(map(Path, sys.argv[1:]))}
    _KEPT.write_text(listing({file: each for file, each in seconds.items() if (TESTS / file).exists()}), "utf-8")


if __name__ == "__main__":
    main()
