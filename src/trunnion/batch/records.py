"""What is kept of each file beside its results: the key by which it is found done, problems, figures, checksums.

A record is two lines of JSON: the first is the same whenever the same is done, the second has what it cost.

A record is written before its files: if the work ends in between, the files are missing and are made again. Where
files of before are replaced, the record names them (``replaces``) until all are in place, so that what a batch has
written is told from what somebody else has put there, whenever it ends.
"""

import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, field, replace
from pathlib import PurePosixPath
from typing import Annotated, Any, Final

from trunnion.batch.result_keys import digest
from trunnion.batch.stores import Store, TakenError
from trunnion.batch.worker_task import NO_COSTS, Costs, Outcome, Status
from trunnion.errors import InputError, Problem, Severity, key_subject
from trunnion.messages import Wording, foreign
from trunnion.records import dataclass
from trunnion.results import Figure

#: The folder of records within the results; no output has a name that begins with a point.
FOLDER: Final = ".trunnion-batch"

#: The result of a file of which several come: a folder beside the results of others.
_SEVERAL: Final = ".programs"


@dataclass(frozen=True, slots=True)
class Written:
    """A file that was written."""

    bytes: int
    sha256: str


@dataclass(frozen=True, slots=True)
class Record:
    """What became of a file.

    place     by which it is known: that of its result, within the results
    file      its name, beside the jobs
    key       of all that it was made from; empty: not known
    outputs   files that were written, by name
    replaces  checksums of files of before that may still stand in their places
    home      what the files lie beside (``keys.home_of``): the same place of the same computer, so that it is no part
              of what is the same everywhere
    """

    place: str
    file: str
    job: str
    action: str
    key: str
    status: Status
    problems: tuple[Problem, ...] = ()
    warnings: int = 0
    outputs: Annotated[Mapping[str, Written], Figure(take=list)] = field(default_factory=dict)
    figures: Mapping[str, Any] = field(default_factory=dict)
    replaces: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    costs: Costs = NO_COSTS
    home: str = ""

    @property
    @Figure(is_extra=True)
    def error(self) -> Problem | None:
        """The first error."""
        return next((each for each in self.problems if each.severity is Severity.ERROR), None)

    def is_done(self, key: str, store: Store) -> bool:
        """Whether there is nothing to do: it was made from the same, and all files are as they were written."""
        if self.key != key or not self.status.is_final or self.replaces:
            return False
        return all(store.holds(name, each.bytes, each.sha256) for name, each in self.outputs.items())


def record_name(place: str) -> str:
    """Return the name of a record in the store."""
    name = digest(place.encode())[:32]
    return f"{FOLDER}/{name[:2]}/{name}.json"


def record_bytes(record: Record) -> bytes:
    """Return a record as it is kept."""
    values = asdict(record) | {"problems": [_values(each) for each in record.problems]}
    costs = {**values.pop("costs"), "home": values.pop("home")}
    lines = (json.dumps(each, ensure_ascii=False, allow_nan=False, sort_keys=True) for each in (values, costs))
    return ("\n".join(lines) + "\n").encode("utf-8", "backslashreplace")


def parse_record(content: bytes | None) -> Record | None:
    """Return a record that was kept; None: there is none, or it is damaged, or names files that are no results."""
    if content is None:
        return None
    try:
        values, costs = (json.loads(line) for line in content.decode().splitlines())
        values |= {
            "status": Status(values["status"]),
            "problems": tuple(_problem(each) for each in values["problems"]),
            "outputs": {name: Written(**each) for name, each in values["outputs"].items()},
            "replaces": {name: tuple(each) for name, each in values["replaces"].items()},
        }
        home = costs.pop("home")
        if not all(map(_is_result, (*values["outputs"], *values["replaces"]))):
            return None
        return Record(**values, costs=Costs(**costs), home=home)
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        return None


def _is_result(name: str) -> bool:
    """Whether a name is one within the results: what a record names may be removed."""
    parts = name.split("/")
    return not {"", ".", "..", FOLDER} & set(parts) and "\\" not in name and ":" not in name


def _values(problem: Problem) -> dict[str, Any]:
    return {
        "file": problem.file, "line": problem.line, "what": problem.what, "cure": problem.cure,
        "severity": str(problem.severity), "key": problem.key, "code": problem.code,
    }  # fmt: skip


def _problem(values: dict[str, Any]) -> Problem:
    file, line, what, cure = (values[name] for name in ("file", "line", "what", "cure"))
    subject = key_subject(values["key"]) if values["key"] else None
    wording = foreign(what, cure, values["code"])
    return Problem(file, line, wording, severity=Severity(values["severity"]), subject=subject)


def read_records(store: Store, places: Sequence[str]) -> Iterator[Record | None]:
    """Return the records of places, one after another."""
    return map(parse_record, store.read_many([record_name(place) for place in places]))


def settle(store: Store, record: Record, outcome: Outcome) -> Record:
    """Keep an outcome, with its files under their names within the results.

    If it is none of the file, and another run has meanwhile done the same, what that one has done counts.
    """
    if not outcome.status.is_final:
        there = parse_record(store.read(record_name(record.place)))
        if there is not None and there.is_done(record.key, store):
            return there
    return commit(store, record, replace(outcome, files=_named(record.place, outcome.files)))


def _named(place: str, files: Mapping[str, bytes]) -> dict[str, bytes]:
    """Files under their names within the results: a program alone in its place, several in a folder of their own."""
    path = PurePosixPath(place)
    report = f"{path.name}."
    programs = [name for name in files if not _is_report(name, report)]
    folder = path.parent / f"{path.stem}{_SEVERAL}" if len(programs) > 1 else path.parent
    return {
        (folder if name in programs else path.parent).joinpath(name).as_posix(): data for name, data in files.items()
    }


def _is_report(name: str, start: str) -> bool:
    return name in (f"{start}html", f"{start}json")


def commit(store: Store, record: Record, outcome: Outcome) -> Record:
    """Write the files of an outcome and its record; doing it again, even at the same time, changes nothing.

    record  with place, file, job, action and key; what became of it comes from the outcome

    Record  as it is kept. A file that somebody else has put into the place of a result stays, and makes the record one
            of a failure
    """
    files = dict(outcome.files)
    record = replace(
        record, status=outcome.status, problems=outcome.problems, warnings=outcome.warnings, figures=outcome.figures,
        outputs={name: Written(len(data), digest(data)) for name, data in files.items()}, costs=outcome.costs,
    )  # fmt: skip
    known = known_of(parse_record(store.read(record_name(record.place))))
    old: dict[str, str] = {}
    missing = []
    for name in sorted({*known, *files}):
        try:
            there = store.digest(name)
        except TakenError as error:
            if name in files:
                return _keep_away(store, record, error.problems[0].what, known)
            continue
        if name in files and there == record.outputs[name].sha256:
            continue
        if name in files:
            missing.append(name)
        if there is None:
            continue
        if there in known.get(name, ()):
            old[name] = there
        elif name in files:
            what = f"its result would replace {name}, which this batch has not written as it is"
            return _keep_away(store, record, what, known)
    record = replace(record, replaces={name: (checksum,) for name, checksum in old.items()})
    # A record that is lost is made again; only one that names files must be there before these are.
    store.write(record_name(record.place), record_bytes(record), lasting=bool(files or old))
    for name in old:
        if name not in files:
            store.remove(name)
    try:
        for name in missing:
            store.write(name, files[name])
    except TakenError as error:
        return _keep_away(store, record, error.problems[0].what, known_of(record))
    if old:
        record = replace(record, replaces={})
        store.write(record_name(record.place), record_bytes(record), lasting=bool(files))
    return record


def known_of(record: Record | None) -> dict[str, tuple[str, ...]]:
    """Checksums of files that a batch has written."""
    if record is None:
        return {}
    found = dict(record.replaces)
    for name, written in record.outputs.items():
        found[name] = (*found.get(name, ()), written.sha256)
    return found


def _keep_away(store: Store, record: Record, what: str, known: Mapping[str, tuple[str, ...]]) -> Record:
    """Keep a record of a file whose result cannot have its place."""
    problem = Problem(record.file, 0, Wording("BAT320", "place_taken", reason=what))
    record = replace(record, status=Status.UNUSABLE, key="", problems=(problem,), outputs={}, replaces=known)
    store.write(record_name(record.place), record_bytes(record))
    return record


def check_store(store: Store) -> None:
    """Find out before any work whether results can be written.

    Raises ``InputError`` if not.
    """
    name = f"{FOLDER}/README.txt"
    text = (
        b"Trunnion keeps here what it needs to go on with this batch. Without this folder everything is done again.\n"
    )
    if store.read(name) != text:
        store.write(name, text)
    if store.read(name) != text:
        raise InputError(Problem(store.label, 0, Wording("BAT130", "does_not_give")))
