"""The optimum against the nearest neighbour: ``python benchmarks/planning.py``.

Four paths on five machines: how often each of the two must rewind in the cut, how far it turns the rotary axes, how
many points are added so that the tool axis keeps to its way, how far it is off it, and how long it takes; how many
points a second are planned, with TCP and without; and what becomes of rotary axes that are too fast near the pole.
Prints the tables of docs/planning.md.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from make_cls import path
from trunnion.arrays import Codes
from trunnion.machines import Machine, forward, load_machine
from trunnion.model.motion import MachiningMode, Motion, PoleStrategy
from trunnion.model.toolpath import Arcs, Frame, Kind, Moves, Operation, Phase, Tool, Toolpath
from trunnion.planning import ControlCapabilities, PlanOptions, operation_seconds, plan
from trunnion.planning.linearization.point_insertion import linearize
from trunnion.planning.poses.decision_log import ChosenPoses, rewind_rows, rotary_travel
from trunnion.planning.poses.selection import choose_nearest_states, choose_states, poses_of_states
from trunnion.planning.poses.states import states_of
from trunnion.planning.request import PlanRequest
from trunnion.planning.rotary_positions import continuous_positions
from trunnion.planning.speed.rotary_speed import speed_shares

Floats = NDArray[np.float64]
Choose = Callable[[Machine, Moves, bool], Codes]

LIMITED = {"name": "Generic B head, C table ±360", "axis": [{"name": "C", "endless": False, "limits_deg": [-360, 360]}]}


def machines() -> dict[str, Machine]:
    """Endless and limited, tables and heads, one pose for most tool axes and two."""
    names = ("yl569", "hs664rt", "generic_head_head_ca", "generic_nutated_b45_c")
    found = {name: load_machine(name) for name in names}
    return found | {"generic_head_table_bc, C ±360": load_machine("generic_head_table_bc", LIMITED)}


def directions(tilt: Floats, azimuth: Floats) -> Floats:
    """(n, 3) tool axes by their angle from Z and about it, degrees."""
    t, a = np.radians(tilt), np.radians(azimuth)
    return np.column_stack((np.sin(t) * np.cos(a), np.sin(t) * np.sin(a), np.cos(t)))


def moves_of(axis: Floats, rapid: NDArray[np.bool_]) -> Moves:
    """Return a ball of 30 mm radius, touched where the tool axis points."""
    n = len(axis)
    return Moves(
        30.0 * axis,
        axis,
        np.where(rapid, Kind.RAPID, Kind.LINEAR).astype(np.uint8),
        np.where(rapid, Phase.RAPID, Phase.CUT).astype(np.uint8),
        np.full(n, 500.0),
        np.zeros(n, bool),
        np.arange(1, n + 1, dtype=np.int32),
    )


def passes(parts: list[Floats]) -> Moves:
    """Cuts, each after a rapid to its start."""
    rapid = np.concatenate([np.arange(len(part)) == 0 for part in parts])
    return moves_of(np.concatenate(parts), rapid)


def near_pole_spiral() -> Moves:
    """Twenty turns about a direction 1.5 degrees off the pole, inwards from 25 degrees."""
    axis = directions(np.linspace(25.0, 0.2, 6000), np.linspace(0.0, 7200.0, 6000))
    c, s = np.cos(np.radians(1.5)), np.sin(np.radians(1.5))
    return passes([axis @ np.array([[c, 0.0, -s], [0.0, 1.0, 0.0], [s, 0.0, c]])])


def impeller() -> Moves:
    """Return a hub that winds 700 degrees, then nine blades to and fro, 140 degrees each."""
    parts = [directions(np.linspace(30.0, 55.0, 3000), np.linspace(10.0, 710.0, 3000))]
    for blade in range(9):
        start = 40.0 * blade + 80.0
        for k in range(6):
            swing = np.linspace(start, start + 140.0, 250)
            tilt = np.linspace(35.0 + k, 65.0 + k, 250)
            parts.append(directions(tilt, swing) if k % 2 == 0 else directions(tilt, swing)[::-1])
    return passes(parts)


def sphere() -> Moves:
    """Parallel passes over the top of a ball, one way, 60 degrees to either side."""
    parts = []
    for across in np.radians(np.linspace(-40.0, 40.0, 41)):
        along = np.radians(np.linspace(-60.0, 60.0, 240))
        parts.append(
            np.column_stack(
                (np.sin(along) * np.cos(across), np.full(240, np.sin(across)), np.cos(along) * np.cos(across))
            )
        )
    return passes(parts)


def drilling() -> Moves:
    """Twelve holes in each of five planes, gone through twice."""
    parts = []
    for azimuth, tilt in ((0.0, 0.0), (20.0, 55.0), (200.0, 55.0), (110.0, 55.0), (290.0, 55.0)) * 2:
        parts += [directions(np.full(3, tilt), np.full(3, azimuth))] * 12
    return passes(parts)


PATHS = {
    "near-pole spiral": near_pole_spiral,
    "impeller over the C limit": impeller,
    "sphere, both poses": sphere,
    "drilling in five planes": drilling,
}


#: What the control's own way between two points may be off the great circle, degrees; and where it is looked at.
BETWEEN = 0.01
EIGHTHS = np.arange(1, 8) / 8.0


def off_between(machine: Machine, motion: Motion) -> float:
    """How far the tool axis is off the great circle in cuts, degrees, where the rotary axes turn evenly."""
    moves, rotary = motion.operation.moves, continuous_positions(machine, motion.rotary)
    cuts = np.flatnonzero(moves.kind[1:] != Kind.RAPID)
    begin, end = moves.axis[cuts], moves.axis[cuts + 1]
    angle = 2.0 * np.arcsin(np.minimum(0.5 * np.linalg.norm(end - begin, axis=1), 1.0))[:, None]
    worst, joints = 0.0, np.zeros((len(cuts), len(machine.axes)))
    for part in EIGHTHS:
        joints[:, list(machine.rotary)] = (1.0 - part) * rotary[cuts] + part * rotary[cuts + 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            wanted = (np.sin((1.0 - part) * angle) * begin + np.sin(part * angle) * end) / np.sin(angle)
        wanted = np.where(angle > 1e-9, wanted, begin)
        off = np.linalg.norm(forward(machine, joints)[1] - wanted, axis=1)
        worst = max(worst, float(np.degrees(2.0 * np.arcsin(0.5 * off)).max(initial=0.0)))
    return worst


def measured(machine: Machine, moves: Moves, choice: Choose) -> str:
    """Cells of the table: rewinds, degrees, points added, worst error without and with them, time, milliseconds."""
    took = []
    for _ in range(3):
        begin = time.process_time()
        state = choice(machine, moves, False)
        poses = poses_of_states(machine, moves, state, False)
        took.append(time.process_time() - begin)
    operation = Operation("", Tool(), Frame(), moves, Arcs.empty(), (), 1)
    planned = ChosenPoses(machine, "", operation, poses.rotary, state, False)
    beyond = int(((poses.outcome > 0) & (poses.outcome <= 5)).sum())
    note = f" and {beyond} over-travels" if beyond else ""
    over = rewind_rows(planned)
    kind = moves.kind.copy()
    kind[over] = Kind.RAPID  # a rewind leads there
    motion = Motion(replace(operation, moves=replace(moves, kind=kind)), poses.rotary, MachiningMode.TCP)
    led = linearize("", motion, PlanRequest(machine, 0.001, PlanOptions(axis_tolerance=BETWEEN), ControlCapabilities()))
    added = len(led.motion.operation.moves) - len(moves)
    held = "refused" if led.problems else f"{off_between(machine, led.motion):.4f}"
    errors = f"{off_between(machine, motion):.4f} / {held}"
    cells = f"{len(over)}{note} | {rotary_travel(machine, poses.rotary):.0f} | {added} | {errors}"
    return f"{cells} | {operation_seconds(machine, motion):.0f} | {1e3 * min(took):.1f}"


def straight_past() -> Moves:
    """Nine straight passes to and fro, 0.02 to 0.42 degrees from the pole."""
    parts = []
    for number, across in enumerate(np.linspace(-0.38, 0.42, 9)):
        along = np.linspace(-4.0, 4.0, 201) * (1.0 if number % 2 == 0 else -1.0)
        x, y = np.tan(np.radians(along)), np.full(201, np.tan(np.radians(across)))
        axis = np.column_stack((x, y, np.ones(201)))
        parts.append(axis / np.linalg.norm(axis, axis=1, keepdims=True))
    return passes(parts)


#: How the pole is looked after, by the settings that ask for it.
POLES = {
    "off": PlanOptions(),
    "hold, 0.5": PlanOptions(pole_strategy=PoleStrategy.HOLD, pole_angle=0.5),
    "spread, 0.5": PlanOptions(pole_strategy=PoleStrategy.SPREAD, pole_angle=0.5),
    "lean, 0.5": PlanOptions(pole_strategy=PoleStrategy.LEAN, pole_angle=0.5),
    "lower_feed": PlanOptions(lower_feed=True),
}


def at_pole(machine: Machine, moves: Moves, options: PlanOptions) -> str:
    """Cells of the table: share of the rapid speed, rows too fast, lean, time on the machine, milliseconds."""
    moves = replace(moves, tip=4.0 * moves.tip, feed=np.full(len(moves), 600.0))
    path = Toolpath("path", (Operation("", Tool(), Frame(), moves, Arcs.empty(), (), 1),))
    begin = time.perf_counter()
    motion = plan([path], machine, 0.001, options).motions[0]
    took = time.perf_counter() - begin
    rotary = motion.rotary
    share = speed_shares(machine, motion.operation, rotary).max(axis=1)
    deviations = motion.deviations
    joints = np.zeros((len(deviations.leaned_rotary), 5))
    joints[:, list(machine.rotary)] = deviations.leaned_rotary
    apart = np.linalg.norm(forward(machine, joints)[1] - moves.axis[deviations.leaned_rows], axis=1)
    lean = float(np.degrees(2.0 * np.arcsin(0.5 * apart)).max(initial=0.0))
    cells = (f"{100.0 * share.max():.0f} %", f"{int((share > 1.0).sum())}", f"{lean:.4f}")
    return " | ".join((*cells, f"{operation_seconds(machine, motion):.1f}", f"{1e3 * took:.0f}"))


def poles() -> None:
    """Print the table of the ways to handle the pole."""
    print("\n| path | machine | pole | rotary axis at most | rows too fast | lean | s | planned in ms |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- |")
    paths = {
        "near-pole spiral": (near_pole_spiral(), ("off", "lean, 0.5", "lower_feed")),
        "passes by the pole": (straight_past(), tuple(POLES)),
    }
    for title, (moves, modes) in paths.items():
        for name, machine in machines().items():
            if any(machine.axes[column].rapid is None for column in machine.rotary):
                continue
            for mode in modes:
                at_pole(machine, moves, POLES[mode])  # once for what is compiled at the first call
                print(f"| {title} ({len(moves)}) | {name} | {mode} | {at_pole(machine, moves, POLES[mode])} |")


def without_tcp(points: int) -> None:
    """Print the table of planning without TCP, from the poses to the points between: dense and coarse paths."""
    print("\n| machine | a point every | points | of them added | rewinds | points/s in | points/s out |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    for every in (1, 10):
        rows = path(0, points)[::every]
        upright = rows[:, 3:] + [0.0, 0.0, 0.6]  # within the reach of all machines
        axis = upright / np.linalg.norm(upright, axis=1, keepdims=True)
        moves = moves_of(axis, np.zeros(len(rows), bool))
        moves = replace(moves, tip=np.ascontiguousarray(rows[:, :3]))
        step = float(np.linalg.norm(np.diff(moves.tip, axis=0), axis=1).mean())
        toolpath = Toolpath("path", (Operation("", Tool(), Frame(), moves, Arcs.empty(), (), 1),))
        for name, model in machines().items():
            axes = tuple(a if a.is_rotary else replace(a, low=-np.inf, high=np.inf) for a in model.axes)
            machine = replace(model, axes=axes, workpiece_zero=(37.0, -21.0, 110.0), tool_length=83.7)
            best = float("inf")
            for _ in range(3):
                begin = time.process_time()
                planned = plan([toolpath], machine, 0.001, PlanOptions(tcp=False))
                best = min(best, time.process_time() - begin)
            out = len(planned.motions[0].operation.moves)
            rewinds = sum("to rewind" in problem.what for problem in planned.problems)
            cells = f"{step:.2f} mm | {out} | {out - len(rows)} | {rewinds}"
            print(f"| {name} | {cells} | {len(rows) / best:,.0f} | {out / best:,.0f} |")


def main() -> None:
    """Print all tables."""
    parser = argparse.ArgumentParser(description="Plan with the optimum and with the nearest neighbour.")
    parser.add_argument("--points", type=int, default=1_000_000, help="points of the second table")
    points = parser.parse_args().points
    head = "rewinds | degrees | points added | worst error, without them / with | machine s | planned in ms"
    print(f"| path | machine | poses | {head} |")
    print(f"|{' --- |' * 9}")
    for title, make in PATHS.items():
        moves = make()
        for name, machine in machines().items():
            for which, choice in (("nearest", choose_nearest_states), ("optimum", choose_states)):
                print(f"| {title} ({len(moves)}) | {name} | {which} | {measured(machine, moves, choice)} |")
    print("\n| machine | states | points/s |\n| --- | --- | --- |")
    rows = path(0, points)
    moves = moves_of(np.ascontiguousarray(rows[:, 3:]), np.zeros(points, bool))
    for name, machine in machines().items():
        best = float("inf")
        for _ in range(3):
            begin = time.perf_counter()
            state = choose_states(machine, moves, False)
            poses_of_states(machine, moves, state, False)
            best = min(best, time.perf_counter() - begin)
        print(f"| {name} | {len(states_of(machine))} | {points / best:,.0f} |")
    without_tcp(points)
    poles()


if __name__ == "__main__":
    main()
