"""The machine as each operation finds it: the tool in its spindle, and the zero of its work offset.

In:     toolpaths and a job, whose machine has the stated lengths and zeros.
Out:    the job with the lengths of CL files and tool libraries where nobody states one, and with the machine of each
        operation.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Final

from trunnion import readers
from trunnion.jobs.inputs.stated_offsets import with_stated_offsets
from trunnion.jobs.inputs.tool_lengths import called_tools, with_lengths_of_tools
from trunnion.jobs.post.post_job import PostJob
from trunnion.machines import Machine
from trunnion.machines.machine import tool_key
from trunnion.model.clamping import number
from trunnion.model.clamping_notices import zero_notices
from trunnion.model.toolpath import Operation, Toolpath
from trunnion.output.program import OperationKey, operation_key

#: The setting that tool calls add to the length.
_DELTA: Final = "delta_length"


def with_operation_setups(toolpaths: Sequence[Toolpath], job: PostJob) -> PostJob:
    """Return the job with the work offset that each operation states, and its machine; none where all have the same."""
    _, own_settings = with_stated_offsets(toolpaths, (job.machine, job.control), job.settings, job.own_settings)
    job, tools = replace(job, own_settings=own_settings), None
    if job.simulation is not None:
        from trunnion.jobs.inputs.bodies import known_tools

        setup = job.simulation.setups[0]
        tools = known_tools(setup.tools, setup.tool_libraries, setup.unit, ())
    machine = with_lengths_of_tools(job.machine, toolpaths, tools)
    if not machine.has_single_values:
        return replace(job, machine=machine)
    setups, shared = dict[OperationKey, Machine](), dict[tuple[str, int], Machine]()
    for operation, names in called_tools(toolpaths):
        own = _settings(job, operation)
        offsets = readers.reader_of(machine).work_offsets if readers.can_read(machine) else None
        offset = (offsets.value_of(own["work_offset"]) if offsets and own.get("work_offset") else None) or 0
        known = [own["tool"]] if own.get("tool") else names
        name = next((each for each in known if tool_key(each) in machine.tool_lengths), known[0] if known else "")
        found = machine.set_up_for(name, offset)
        said = _in_force(found, name, machine.length_sources.get(tool_key(name), ""))
        if machine.zeros and own.get("work_offset"):
            said = [*said, f"the zero of {own['work_offset']}"]
        # Tools that share the length of all others share the machine: without TCP that is one tool too many.
        of_tool = tool_key(name) if tool_key(name) in machine.tool_lengths else ""
        own_machine = shared.setdefault((of_tool, offset), replace(found, in_force=" and ".join(said)))
        setups[operation_key(operation)] = own_machine
    return replace(job, machine=machine, setups=setups)


def _in_force(machine: Machine, name: str, source: str) -> list[str]:
    """Return the tool whose length is in force, in words; nothing where it is not known."""
    if machine.tool_length is None or not name:
        return []
    return [f"tool {name} of {machine.tool_length:g} mm{f' ({source})' if source else ''}"]


def planned_machines(job: PostJob, *, with_delta: bool) -> Callable[[Operation], Machine]:
    """Return the machine that an operation is planned for: with the margin to limits, and the tool as long as its call
    makes it. Operations that share a machine share that, too.
    """
    known: dict[tuple[int, float], Machine] = {}

    def planned(operation: Operation) -> Machine:
        machine = job.setups.get(operation_key(operation), job.machine)
        delta = _delta(job, operation) if with_delta and machine.tool_length is not None else 0.0
        key = id(machine), delta
        if key not in known:
            known[key] = _longer(job.with_margin(machine), delta) if delta else job.with_margin(machine)
        return known[key]

    return planned


def _longer(machine: Machine, delta: float) -> Machine:
    """Return a machine whose tool is longer by what its call adds, mm."""
    length = machine.tool_length or 0.0
    said = machine.in_force or f"a tool of {length:g} mm"
    return replace(machine, tool_length=length + delta, in_force=f"{said}, {delta:+g} mm by its call")


def setup_notices(job: PostJob, toolpaths: Sequence[Toolpath]) -> Iterator[str]:
    """Comments for the head of a program: the zeros that its linear axes are proven for, and the lengths."""
    cut = [(operation, names) for operation, names in called_tools(toolpaths) if len(operation.moves)]
    machines = [job.setups.get(operation_key(operation), job.machine) for operation, _ in cut]
    deltas = {_delta(job, operation) for operation, _ in cut}
    single = {(machine.workpiece_zero, machine.tool_length) for machine in machines}
    if len(single) == 1 and deltas == {0.0}:
        zero, length = single.pop()
        yield from zero_notices(zero, length) if zero is not None else ()
        return
    found = dict[str, None]()
    for (operation, names), machine in zip(cut, machines, strict=True):
        if machine.workpiece_zero is not None:
            x, y, z = machine.workpiece_zero
            offset = _settings(job, operation).get("work_offset", "")
            found[f"ZERO OF {offset} X{x:.3f} Y{y:.3f} Z{z:.3f} MM ON THE MACHINE, AXES AT 0"] = None
        if machine.tool_length is not None:
            tool, delta = _settings(job, operation).get("tool") or (names or ["0"])[0], _delta(job, operation)
            counts = f", COUNTS AS {number(machine.tool_length + delta)} MM BY ITS CALL" if delta else ""
            found[f"TOOL {tool.upper()} {number(machine.tool_length)} MM FROM GAUGE POINT TO TIP{counts}"] = None
    yield from found


def _settings(job: PostJob, operation: Operation) -> dict[str, str]:
    return {**job.control.settings, **job.settings, **job.own_settings.get(operation.name, {})}


def _delta(job: PostJob, operation: Operation) -> float:
    """Return what the tool call of an operation adds to the length, mm."""
    return float(_settings(job, operation).get(_DELTA) or 0.0)
