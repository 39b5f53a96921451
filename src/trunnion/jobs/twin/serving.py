"""The twin of a machine: a program that runs in time, for OPC UA and MTConnect clients."""

import ipaddress
import math
from collections.abc import Callable, Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Literal, Unpack

from trunnion.cl import is_cl_file
from trunnion.compensation.stretches import RegisterValue
from trunnion.encoding import decode
from trunnion.errors import InputError, Problem, RefusedError, Severity
from trunnion.extras import import_extra
from trunnion.files import atomic_file
from trunnion.jobs.arguments import SetUpArguments, taken
from trunnion.jobs.inputs.arguments import check_path, check_paths, wrong_argument
from trunnion.jobs.inputs.bodies import known_tools
from trunnion.jobs.inputs.control_settings import rapid_feed_of, register_value_of
from trunnion.jobs.inputs.driven_paths import driven_by_tools
from trunnion.jobs.inputs.input_files import machine_files
from trunnion.jobs.inputs.reading import FilePath, MachineLike, as_machine, as_run
from trunnion.jobs.inputs.stated_setup import LengthLike, ZeroLike, set_up_machine
from trunnion.jobs.observer import SILENT, Observer
from trunnion.jobs.result_output import check_output_name
from trunnion.messages import Wording, phrase
from trunnion.model.one_frame import frame_of_offset
from trunnion.model.run import Run
from trunnion.options.limits import FASTEST, LONGEST_RATE, SHORTEST_RATE, SLOWEST
from trunnion.timing import time_run
from trunnion.twin.mtconnect.device import device_xml
from trunnion.twin.playback import Playback
from trunnion.twin.ports import take_port
from trunnion.twin.snapshots import TwinProgram
from trunnion.user_cache import user_data
from trunnion.verification import restore_rapids

if TYPE_CHECKING:
    from trunnion.simulation.tools.profile import ToolShape
    from trunnion.twin.opcua.server import Security
    from trunnion.twin.serving import TwinAddresses


def _ignore(_addresses: object) -> None:
    """Nobody asked where it is served."""


class TwinProgramArguments(SetUpArguments, total=False):
    """Arguments of ``twin_program``."""

    subprograms: Sequence[FilePath]
    radius_register: Literal["unknown", "difference", "radius"] | None
    tools: "str | ToolShape | Iterable[str | ToolShape]"
    tool_libraries: Sequence[FilePath]
    unit: Literal["mm", "inch"] | None


class TwinArguments(TwinProgramArguments, total=False):
    """Arguments of ``serve_twin``."""

    speed: float | None
    loop: bool
    rate: float
    hold: bool
    host: str
    port: int
    adapter_port: int | None
    agent_port: int | None
    users: FilePath | None
    ready: "Callable[[TwinAddresses], None] | None"


def serve_twin(
    nc: FilePath | Run, *, machine: MachineLike, observer: Observer = SILENT, **given: Unpack[TwinArguments]
) -> None:
    """Serve an NC program as the machine that runs it, by OPC UA and MTConnect, until Ctrl-C.

    nc                  the program, or its run
    machine             the machine that runs it: a name, a path or a ``Machine``
    subprograms         files of the subprograms that it calls. No others are opened
    zero, tool_length   as for ``verify``. Without them slides count from the workpiece zero, and no travel of theirs is
                        watched
    radius_register     as for ``verify``: the tool's centre goes beside the path under radius compensation. Where
                        nobody has stated it, or the tool's radius is not known, the twin goes along the programmed path
    tools, tool_libraries, unit   as for ``simulate``: their radii
    speed               times real time, 0.1 to 1000; None: as fast as clients can follow
    loop                the program starts anew when it has ended
    rate                milliseconds between two samples, 5 to 60000; every end of a block is told besides
    hold                the program waits for a client to start it
    host                an address of this computer. On another than its own (127.0.0.1) clients need a user of
                        ``users``, and channels are encrypted; MTConnect stays on this computer
    port, adapter_port  ports of OPC UA and of the MTConnect adapter; 0: a free one. ``adapter_port`` None: no adapter
    agent_port          port of an MTConnect agent; 0: a free one. None: there is none
    users               file of users; None: that in the user's folder
    ready               is called with the addresses when clients can connect
    observer            receives warnings

    Raises ``InputError`` when a file or an argument cannot be used, a port is taken, or the extra ``twin`` is not
    installed.

    Raises ``RefusedError`` when the program has errors: a machine would not run it.
    """
    import_extra("asyncua", "twin")
    from trunnion.twin.running import Twin
    from trunnion.twin.serving import Ports, run_until_ended, serve_program

    found = taken(TwinArguments, "twin", given)
    speed, rate, host, adapter_port = found["speed"], found["rate"], found["host"], found["adapter_port"]
    if speed is not None and not SLOWEST <= _number("speed", speed) <= FASTEST:
        raise wrong_argument("speed", speed, phrase("give_speed"))
    if not SHORTEST_RATE <= _number("rate", rate) <= LONGEST_RATE:
        raise wrong_argument("rate", rate, phrase("give_rate"))
    security = None if is_loopback(host) else _security(found["users"])
    with ExitStack() as closing:
        served = closing.enter_context(take_port("OPC UA", host, found["port"], "port"))
        adapter = None
        if adapter_port is not None:
            adapter = closing.enter_context(take_port("MTConnect", "127.0.0.1", adapter_port, "adapter_port"))
        agent, agent_port = None, found["agent_port"]
        if agent_port is not None:
            agent = closing.enter_context(take_port("MTConnect", "127.0.0.1", agent_port, "agent_port"))
        own: TwinProgramArguments = {
            "subprograms": found["subprograms"], "zero": found["zero"], "tool_length": found["tool_length"],
            "radius_register": found["radius_register"], "tools": found["tools"],
            "tool_libraries": found["tool_libraries"], "unit": found["unit"],
        }  # fmt: skip
        program = twin_program(nc, machine=machine, observer=observer, **own)
        playback = Playback(program.timed, speed=speed, loop=found["loop"])
        ports = Ports(served, adapter, agent)
        ready = found["ready"] or _ignore
        run_until_ended(
            lambda: serve_program(
                Twin(program, playback, rate / 1000.0), ports, security=security, started=not found["hold"], ready=ready
            )
        )


def write_device_xml(
    nc: FilePath | Run,
    *,
    machine: MachineLike,
    output: FilePath,
    subprograms: Sequence[FilePath] = (),
    zero: ZeroLike | None = None,
    tool_length: LengthLike | None = None,
) -> None:
    """Write the device model of a twin for an MTConnect agent.

    nc, machine, subprograms, zero, tool_length: as for ``serve_twin``: they say in which coordinates slides are told
    output: the file, ``.xml``. An older one is replaced when the new one is complete

    Raises ``InputError`` when a file or an argument cannot be used.

    Raises ``RefusedError`` when the program has errors.
    """
    place = check_output_name("output", output, (".xml",), phrase("device_model_is_xml"))
    program = twin_program(nc, machine=machine, subprograms=subprograms, zero=zero, tool_length=tool_length)
    read = [*program.run.files, *machine_files(machine, program.run.machine)]
    with atomic_file(place, inputs=read) as sink:
        sink.write(device_xml(program).encode())


def twin_program(
    nc: FilePath | Run, *, machine: MachineLike, observer: Observer = SILENT, **given: Unpack[TwinProgramArguments]
) -> TwinProgram:
    """Read a program, run it, and give it its times; arguments as for ``serve_twin``.

    Raises ``InputError`` when a file or an argument cannot be used.

    Raises ``RefusedError`` when the program has errors, or the control cannot compensate the radius of its tools.
    """
    subprograms = given.get("subprograms", ())
    placed = set_up_machine(as_machine(machine), given.get("zero"), given.get("tool_length"))
    if not isinstance(nc, Run) and is_cl_file(path := check_path("nc", nc)):
        raise InputError(Problem(str(path), 0, Wording("TWN110", "cl_file_served")))
    run = restore_rapids(as_run(nc, placed, check_paths("subprograms", subprograms)), rapid_feed_of(placed))
    if run.errors:
        raise RefusedError([Problem(each.file, each.line, each.wording.within("stops_twin")) for each in run.errors])
    if not len(run):
        raise InputError(Problem(run.files[0], 0, Wording("TWN111", "nothing_moves")))
    (run,) = frame_of_offset([run], None).runs([run])
    known = known_tools(given.get("tools", ()), given.get("tool_libraries", ()), given.get("unit"), ())
    holds = RegisterValue(given.get("radius_register") or register_value_of(placed))
    run, notices = driven_by_tools(run, known, holds)
    if alarms := [each for each in notices if each.severity is Severity.ERROR]:
        raise RefusedError(alarms)
    observer.problems(notices)
    return TwinProgram(time_run(run), [decode(Path(file).read_bytes(), run.encoding) for file in run.files])


def is_loopback(host: str) -> bool:
    """Whether only programs of this computer reach an address."""
    try:
        return host == "localhost" or ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def users_file(users: FilePath | None = None) -> Path:
    """Return the file of users: the given one, or that in the user's folder.

    Raises ``InputError`` if none is given, and the user has no folder.
    """
    if users is not None:
        return check_path("users", users)
    return _folder() / "users"


def add_twin_user(name: str, password: str, *, operator: bool = True, users: FilePath | None = None) -> Path:
    """Add a user to the file of users, who operates a twin or only looks; returns the file.

    Raises ``InputError`` if name or password cannot be taken, or the file cannot be written.
    """
    from trunnion.twin.opcua.users import Role, write_user

    path = users_file(users)
    write_user(path, name, Role.OPERATOR if operator else Role.VIEWER, password)
    return path


def _folder() -> Path:
    folder = user_data()
    if folder is None:
        raise InputError(Problem("trunnion", 0, Wording("TWN120", "no_folder_for_users")))
    return folder / "trunnion" / "twin"


def _security(users: FilePath | None) -> "Security":
    from trunnion.twin.opcua.server import Security
    from trunnion.twin.opcua.users import read_users

    path = users_file(users)
    found = read_users(path)
    if not len(found):
        raise InputError(Problem(str(path), 0, Wording("TWN132", "no_user")))
    return Security(found, _folder())


def _number(name: str, value: object) -> float:
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float(value)
    raise wrong_argument(name, value, phrase("give_number"))
