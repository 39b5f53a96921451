"""A complete LinuxCNC with simulated joints and no screen: the motion of its joints while it runs programs.

LinuxCNC is started on a machine made for the test. Its display is a small client that homes the machine, sets the work
offset and runs the programs one after the other, while HAL's sampler records the joints, one line a millisecond.
"""

import fcntl
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from trunnion.arrays import Floats

needs_simulator = pytest.mark.skipif(
    any(shutil.which(tool) is None for tool in ("linuxcnc", "halsampler")) and not os.environ.get("CI"),
    reason="LinuxCNC is not installed (Debian package linuxcnc-uspace)",
)

#: The greatest speed of its joints, mm/s and deg/s, and their acceleration, mm/s^2 and deg/s^2.
VELOCITY = {"LINEAR": 500.0, "ANGULAR": 360.0}
ACCELERATION = 5000.0

#: A joint that moves by less than this in a millisecond rests, mm or degrees.
_RESTS = 1e-9

#: The step of a millisecond, mm or degrees, above which a joint has not slowed down to rest: ten times what its
#: acceleration takes away in that time. A tool length that comes into force under TCP moves joints at once, and how
#: long they stand there depends on when the next block is read.
_SLOWED_DOWN = 10.0 * ACCELERATION * 1e-6

#: How many samples the machine must rest; a dwell after each block provides them.
_SAMPLES = 8

_CLIENT = r"""#!/usr/bin/python3
import json, os, signal, subprocess, sys, time
sys.path.append("/usr/lib/python3/dist-packages")
import linuxcnc

with open(os.environ["JUDGE_JOB"]) as file:
    job = json.load(file)
command, status, channel = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
said = []
PATIENCE = 120  # seconds, for what takes an instant where the computer is idle

def until(holds, seconds, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        status.poll()
        while (message := channel.poll()) is not None:
            if message[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR):
                said.append(message[1])
        if said:
            raise RuntimeError("; ".join(said))
        if holds():
            return
        time.sleep(0.005)
    raise RuntimeError("waited in vain: " + what)

def idle():
    return status.interp_state == linuxcnc.INTERP_IDLE and status.inpos and status.queue == 0

def mode(wanted):
    command.mode(wanted)
    command.wait_complete(PATIENCE)

error = ""
try:
    until(lambda: status.task_state >= linuxcnc.STATE_ESTOP, PATIENCE, "the controller")
    for state in (linuxcnc.STATE_ESTOP_RESET, linuxcnc.STATE_ON):
        command.state(state)
        command.wait_complete(PATIENCE)
    until(lambda: status.task_state == linuxcnc.STATE_ON, PATIENCE, "power")
    mode(linuxcnc.MODE_MANUAL)
    command.home(-1)
    until(lambda: all(status.homed[: status.joints]), PATIENCE, "home")
    for program in job["programs"]:
        mode(linuxcnc.MODE_MDI)
        for text in job["first"]:
            command.mdi(text)
            command.wait_complete(PATIENCE)
            until(idle, PATIENCE, text)
        with open(program["samples"], "w") as out:
            sampler = subprocess.Popen(["halsampler", "-t"], stdout=out)
            time.sleep(0.1)
            mode(linuxcnc.MODE_AUTO)
            command.program_open(program["file"])
            command.wait_complete(PATIENCE)
            command.auto(linuxcnc.AUTO_RUN, 0)
            until(lambda: status.interp_state != linuxcnc.INTERP_IDLE, PATIENCE, "the program's start")
            until(idle, job["seconds"], "the program's end")
            time.sleep(0.1)
            sampler.send_signal(signal.SIGINT)
            sampler.wait(PATIENCE)
except Exception as problem:
    error = str(problem)
with open(job["outcome"], "w") as file:
    json.dump({"error": error}, file)
"""

_INI = """[EMC]
VERSION = 1.1
MACHINE = judge
[DISPLAY]
DISPLAY = {client}
[TASK]
TASK = milltask
CYCLE_TIME = 0.001
[RS274NGC]
PARAMETER_FILE = judge.var
SUBROUTINE_PATH = {folder}/remaps
HAL_PIN_VARS = 1
REMAP = M428 modalgroup=10 ngc=m428
REMAP = M429 modalgroup=10 ngc=m429
[EMCMOT]
EMCMOT = motmod
COMM_TIMEOUT = 4.0
SERVO_PERIOD = 1000000
[HAL]
HALFILE = judge.hal
[TRAJ]
COORDINATES = {letters}
LINEAR_UNITS = mm
ANGULAR_UNITS = deg
MAX_LINEAR_VELOCITY = 500
DEFAULT_LINEAR_VELOCITY = 500
MAX_LINEAR_ACCELERATION = 5000
MAX_ANGULAR_VELOCITY = 360
NO_FORCE_HOMING = 1
[EMCIO]
EMCIO = io
CYCLE_TIME = 0.01
TOOL_TABLE = judge.tbl
[KINS]
KINEMATICS = {kinematics}
JOINTS = {joints}
"""

_AXIS = """[{section}]
MIN_LIMIT = -100000
MAX_LIMIT = 100000
MAX_VELOCITY = {velocity}
MAX_ACCELERATION = {acceleration}
"""

_JOINT = """TYPE = {kind}
HOME = 0
HOME_SEARCH_VEL = 0
HOME_LATCH_VEL = 0
HOME_SEQUENCE = 0
FERROR = 1000
MIN_FERROR = 1000
"""


@dataclass(frozen=True)
class Bench:
    """A machine of LinuxCNC: a table-table machine, or one with plain axes.

    module   its kinematics; ``trivkins``: each axis is a joint
    pins     numbers of the module
    letters  of the joints, in their order
    zero     G54, mm
    length   of tool 1, mm
    """

    module: str
    pins: dict[str, float]
    letters: str
    zero: tuple[float, float, float]
    length: float

    @property
    def is_plain(self) -> bool:
        """Whether each axis is a joint."""
        return self.module == "trivkins"

    @property
    def kinematics(self) -> str:
        """The module with its parameters."""
        return f"trivkins coordinates={self.letters}" if self.is_plain else f"{self.module} sparm=identityfirst"


class SimulatorError(Exception):
    """LinuxCNC does not run a program to its end; the message is its own."""


def with_rests(program: str) -> str:
    """The program with a short dwell after each block that moves, so that the machine rests at every block's end.

    A dwell is measured by the clock, a rest in cycles of the servo thread, which are fewer where the computer is busy.
    """
    lines = []
    for line in program.splitlines():
        lines.append(line)
        if re.match(r"(N\d+ )?(G[0-39]\S* )*[XYZABC]-?[.\d]", line) or "G53" in line:
            lines.append("G4 P0.1")
    return "\n".join(lines) + "\n"


def motions(bench: Bench, programs: Sequence[str], seconds: float = 60.0) -> list[Floats]:
    """The positions of the joints in each program, one row a millisecond, (k, n) mm and degrees.

    Raises
    ------
    SimulatorError
        When LinuxCNC does not run a program to its end.
    """
    with _alone(), tempfile.TemporaryDirectory(prefix="linuxcnc") as name:
        folder = Path(name)
        folder.chmod(0o777)
        samples = _write(bench, programs, folder, seconds)
        environment = {**os.environ, "JUDGE_JOB": str(folder / "job.json")}
        environment.pop("DISPLAY", None)
        if os.getuid() == 0:  # which the realtime part does not run as
            environment |= {"RTAPI_UID": "65534", "RTAPI_FIFO_PATH": str(folder / "fifo")}
        with (folder / "log.txt").open("w") as log:
            running = subprocess.Popen(
                ["linuxcnc", str(folder / "judge.ini")],
                cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=log, stderr=log, start_new_session=True,
            )  # fmt: skip
            try:
                running.wait(seconds * (len(programs) + 1))
            except subprocess.TimeoutExpired:
                os.killpg(running.pid, signal.SIGTERM)
                running.wait(20)
        outcome = folder / "outcome.json"
        if not outcome.is_file():
            raise SimulatorError((folder / "log.txt").read_text(errors="replace")[-3000:])
        error = json.loads(outcome.read_text())["error"]
        if error:
            raise SimulatorError(error)
        return [_read(file) for file in samples]


@contextmanager
def _alone() -> Iterator[None]:
    """There can be one LinuxCNC at a time: its shared memory has fixed keys."""
    with (Path(tempfile.gettempdir()) / "one-linuxcnc.lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _write(bench: Bench, programs: Sequence[str], folder: Path, seconds: float) -> list[Path]:
    """Write all files of the machine, and the client's job; returns where the samples of each program will be."""
    client = folder / "client.py"
    client.write_text(_CLIENT)
    client.chmod(0o755)
    (folder / "remaps").mkdir()
    for code, kinematics in ((428, 1), (429, 0)):
        text = f"o<m{code}> sub\nM68 E3 Q{kinematics}\nM66 E0 L0\no<m{code}> endsub\n"
        (folder / "remaps" / f"m{code}.ngc").write_text(text)
    ini = _INI.format(
        client=client, folder=folder, letters=bench.letters, joints=len(bench.letters), kinematics=bench.kinematics
    )
    for joint, letter in enumerate(bench.letters):
        kind = "ANGULAR" if letter in "ABC" else "LINEAR"
        velocity = VELOCITY[kind]
        ini += _AXIS.format(section=f"AXIS_{letter}", velocity=velocity, acceleration=ACCELERATION)
        ini += _AXIS.format(section=f"JOINT_{joint}", velocity=velocity, acceleration=ACCELERATION)
        ini += _JOINT.format(kind=kind)
    (folder / "judge.ini").write_text(ini)
    (folder / "judge.tbl").write_text(f"T1 P1 Z{bench.length} D6\n")
    hal = [
        "loadrt [KINS]KINEMATICS",
        "loadrt [EMCMOT]EMCMOT servo_period_nsec=[EMCMOT]SERVO_PERIOD num_joints=[KINS]JOINTS",
        f"loadrt sampler depth=50000 cfg={'f' * len(bench.letters)}",
        "addf motion-command-handler servo-thread",
        "addf motion-controller servo-thread",
        "addf sampler.0 servo-thread",
        *(
            f"net joint{k} joint.{k}.motor-pos-cmd => joint.{k}.motor-pos-fb sampler.0.pin.{k}"
            for k in range(len(bench.letters))
        ),
        *(
            []
            if bench.is_plain
            else [
                "net kinematics motion.analog-out-03 => motion.switchkins-type",
                f"net length motion.tooloffset.z => {bench.module}.tool-offset",
            ]
        ),
        *(f"setp {bench.module}.{pin} {value}" for pin, value in bench.pins.items()),
        "net estop iocontrol.0.user-enable-out => iocontrol.0.emc-enable-in",
        "net prepare iocontrol.0.tool-prepare => iocontrol.0.tool-prepared",
        "net change iocontrol.0.tool-change => iocontrol.0.tool-changed",
    ]
    (folder / "judge.hal").write_text("\n".join(hal) + "\n")
    x, y, z = bench.zero
    turned = " ".join(f"{letter}0" for letter in bench.letters if letter in "ABC")
    listed = []
    for k, text in enumerate(programs):
        file = folder / f"part{k}.ngc"
        file.write_text(text)
        listed.append({"file": str(file), "samples": str(folder / f"samples{k}.txt")})
    job = {
        "programs": listed,
        "first": ["G21 G90 G49 M429", f"G10 L2 P1 X{x} Y{y} Z{z} {turned}", "G53 G0 X0 Y0 Z0"],
        "seconds": seconds,
        "outcome": str(folder / "outcome.json"),
    }
    (folder / "job.json").write_text(json.dumps(job))
    return [Path(each["samples"]) for each in listed]


def _read(samples: Path) -> Floats:
    """All samples of a program.

    Raises
    ------
    SimulatorError
        When samples were lost: the machine has gone on without them.
    """
    lines = [line.split() for line in samples.read_text().splitlines()]
    width = max(map(len, lines), default=0)  # the last line may be cut off
    table = np.array([[float(value) for value in line] for line in lines if len(line) == width])
    if not len(table):
        raise SimulatorError("the sampler has seen nothing")
    lost = np.flatnonzero(np.diff(table[:, 0]) != 1.0)
    if (np.abs(np.diff(table[:, 1:], axis=0))[lost] > _RESTS).any():
        raise SimulatorError("samples were lost while the machine moved: the sampler was not read in time")
    return np.asarray(table[:, 1:])


def rests_of(joints: Floats) -> Floats:
    """The places at which motions have ended and all joints rest for a while, without repeats."""
    steps = np.abs(np.diff(joints, axis=0)).max(axis=1)
    edges = np.flatnonzero(np.diff(np.concatenate(([False], steps < _RESTS, [False])).astype(np.int8)))
    long = [
        int(first)
        for first, last in zip(edges[::2], edges[1::2], strict=True)
        if last - first >= _SAMPLES and (first == 0 or steps[first - 1] < _SLOWED_DOWN)
    ]
    found = joints[long]
    apart = np.abs(np.diff(found, axis=0)).max(axis=1) > 1e-6
    return np.asarray(found[np.concatenate(([True], apart))])
