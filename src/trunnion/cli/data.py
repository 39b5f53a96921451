"""Results as data, of commands whose results nothing else makes data of."""

import io
import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from typing import Any

from trunnion.batch.running import BatchResult
from trunnion.definitions.source_lines import LocatedValue
from trunnion.jobs.convert.converting import ConvertResult
from trunnion.jobs.papers.manifests import ManifestCheck
from trunnion.jobs.papers.reports import add_report
from trunnion.jobs.post.result import PostResult
from trunnion.machines import Machine
from trunnion.verification import Verification
from trunnion.verification.comparison.result import Comparison


def report_data(verification: Verification) -> Any:
    """What a report of the verification has, as data (docs/report.md)."""
    sink = io.BytesIO()
    add_report(verification, sink, "report.json", ())
    return json.loads(sink.getvalue())


def difference_data(found: Comparison) -> dict[str, Any]:
    """How two programs compare."""
    return {"schema": 1, "same": found.same, **asdict(found)}


def posts_data(results: Iterable[PostResult]) -> dict[str, Any]:
    """Programs that were posted."""
    return {"schema": 1, "programs": [_program(result) for result in results]}


def conversion_data(found: ConvertResult) -> dict[str, Any]:
    """A program or a CL file that was converted."""
    operations = found.toolpath.operations
    return {
        "schema": 1,
        "passed": found.passed,
        "output": None if found.output is None else str(found.output),
        "operations": len(operations),
        "points": sum(len(each.moves) for each in operations),
        "settings": dict(found.settings),
        "posted": None if found.posted is None else _program(found.posted),
        "remarks": found.problems,
    }


def batch_data(result: BatchResult) -> dict[str, Any]:
    """What became of the files of a batch."""
    return {
        "schema": 1,
        "passed": result.passed,
        "results": result.store.label,
        "counts": {str(status): count for status, count in result.counts.items()},
        "done_before": result.done,
        "files": [
            {
                "job": each.job, "file": each.file, "status": str(each.status), "outputs": list(each.outputs),
                "error": each.error,
            }
            for each in result.records()
        ],
    }  # fmt: skip


def machines_data(machines: Sequence[Machine]) -> list[dict[str, Any]]:
    """The shipped machines; lengths in mm, angles in degrees."""
    return [
        {
            "key": each.key, "name": each.name, "description": each.description,
            "axes": [
                {
                    "name": axis.name, "is_rotary": axis.is_rotary, "carries": str(axis.mount), "endless": axis.endless,
                    "limits": [_finite(axis.low), _finite(axis.high)],
                }
                for axis in each.axes
            ],
        }
        for each in machines
    ]  # fmt: skip


def manifest_data(found: ManifestCheck) -> dict[str, Any]:
    """Whether the files of a post are still those of its manifest."""
    files = [{"name": each.name, "what": each.what, "fault": each.fault} for each in found.files]
    return {
        "schema": 1,
        "passed": found.passed,
        "proven": found.proven,
        "files": files,
        "not_compared": list(found.not_compared),
    }


def plain_data(located: LocatedValue) -> Any:
    """The values of a definition, without their places."""
    value = located.value
    if isinstance(value, dict):
        return {key: plain_data(each) for key, each in value.items()}
    if isinstance(value, list):
        return [plain_data(each) if isinstance(each, LocatedValue) else each for each in value]
    return value


def _finite(value: float) -> float | None:
    return value if abs(value) < float("inf") else None


def _program(result: PostResult) -> dict[str, Any]:
    return {
        "output": None if result.output is None else str(result.output),
        "subprograms": [str(file) for file in result.subprograms],
        "passed": result.passed,
        "operations": sum(motion.starts_operation for motion in result.motions),
        "points": sum(len(motion.operation.moves) for motion in result.motions),
        "checks": {check.key: check.passed for check in result.checks},
        "remarks": result.problems,
    }
