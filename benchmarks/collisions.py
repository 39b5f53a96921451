"""Collision checking of a five-axis program: ten pairs of bodies of 5 120 facets each.

    PYTHONPATH=src python benchmarks/collisions.py [blocks]

The tool goes to and fro over a dome while the table tilts and turns with it. Spindle nose and holder stand over table,
cradle, two cheeks and a clamp.
"""

import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from unittest import mock

import numpy as np

from trunnion.arrays import Floats
from trunnion.machines import Machine, load_machine
from trunnion.readers import run_program
from trunnion.simulation.collisions import Body, BodyKind, check_collisions
from trunnion.simulation.collisions.queries import PairQuery
from trunnion.simulation.meshes import TriangleMesh

SIDES, RINGS = 64, 40
BLOCKS = 100_000


def drum(name: str, radius: float, low: float, high: float, centre: tuple[float, float] = (0.0, 0.0)) -> TriangleMesh:
    """Return a round body of 5 120 facets, a little barrelled, about a line along Z."""
    about = 2.0 * np.pi * np.arange(SIDES) / SIDES
    heights = np.linspace(low, high, RINGS)
    radii = radius * (0.98 + 0.02 * np.sin(np.linspace(0.0, np.pi, RINGS)))
    points = [[centre[0], centre[1], low]]
    for height, size in zip(heights, radii, strict=True):
        points += [[centre[0] + size * np.cos(a), centre[1] + size * np.sin(a), height] for a in about]
    points.append([centre[0], centre[1], high])
    top, faces = len(points) - 1, []
    for k in range(SIDES):
        m = (k + 1) % SIDES
        faces.append((0, 1 + m, 1 + k))
        for ring in range(RINGS - 1):
            a, b = 1 + ring * SIDES, 1 + (ring + 1) * SIDES
            faces += [(a + k, a + m, b + m), (a + k, b + m, b + k)]
        faces.append((top - SIDES + k, top - SIDES + m, top))
    return TriangleMesh(np.array(points), np.array(faces), name)


def program(blocks: int) -> str:
    """Zigzag on a dome, with a leaning tool."""
    lines = ["G710 G90 G54", "TRAORI", "G0 X0 Y0 Z60", "F3000"]
    share = np.linspace(0.0, 1.0, blocks)
    lines_over = max(blocks // 250, 1)
    x = 50.0 * (2.0 * np.abs(2.0 * ((share * lines_over) % 1.0) - 1.0) - 1.0)
    y = -50.0 + 100.0 * share
    z = np.sqrt(100.0**2 - x**2 - y**2) - 60.0
    tilt, turn = 5.0 + 20.0 * np.abs(x) / 50.0, 60.0 * np.sin(6.0 * np.pi * share)
    for row in np.stack((x, y, z, tilt, turn), axis=1).tolist():
        lines.append("G1 X{:.3f} Y{:.3f} Z{:.3f} B{:.3f} C=DC({:.3f})".format(*row[:4], row[4] % 360.0))
    return "\n".join([*lines, "M30", ""])


def bodies(machine: Machine) -> list[Body]:
    """Two bodies of the head over five of the table: ten pairs."""
    up = np.array([0.0, 0.0, machine.spindle_point[2]])

    def of_head(mesh: TriangleMesh) -> Body:
        moved: Floats = np.eye(4)
        moved[:3, 3] = up
        return Body(mesh.name, "spindle", mesh.moved(moved), BodyKind.MACHINE)

    head = [of_head(drum("spindle nose", 45.0, 0.0, 120.0)), of_head(drum("holder", 20.0, -60.0, 0.0))]
    table = [
        Body("table", "C", drum("table", 160.0, -110.0, -50.0), BodyKind.MACHINE),
        Body("cradle", "B", drum("cradle", 150.0, -240.0, -120.0), BodyKind.MACHINE),
        Body("cheek -", "B", drum("cheek -", 40.0, -240.0, 60.0, (0.0, -270.0)), BodyKind.MACHINE),
        Body("cheek +", "B", drum("cheek +", 40.0, -240.0, 60.0, (0.0, 270.0)), BodyKind.MACHINE),
        Body("clamp", "C", drum("clamp", 15.0, -50.0, 20.0, (90.0, 0.0)), BodyKind.MACHINE),
    ]
    return head + table


def check_times(blocks: int) -> list[float]:
    """Check a program without and with near misses, and print what it took; the wall seconds of both."""
    machine = load_machine("yl569", {"spindle": {"gauge_point_mm": [0, 0, 450]}})
    machine = replace(machine, workpiece_zero=(0.0, 0.0, 40.0), tool_length=120.0, bodies=())
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "dome.mpf"
        path.write_text(program(blocks), encoding="utf-8")
        run = run_program(path, machine)
    assert not run.errors, run.errors[:3]
    iron = bodies(machine)
    print(f"{len(run)} rows, {len(iron)} bodies of {len(iron[0].mesh.faces)} facets, 10 pairs")
    asked = 0
    original = PairQuery.distance

    def counted(query: PairQuery, pose: Floats) -> float:
        nonlocal asked
        asked += 1
        return original(query, pose)

    check_collisions(run, iron[:2], {})  # kernels are loaded
    times = []
    for near in (0.0, 2.0):
        asked = 0
        start, cpu = time.perf_counter(), time.process_time()
        with mock.patch.object(PairQuery, "distance", counted):
            found = check_collisions(run, iron, {}, near=near)
        seconds, cpu = time.perf_counter() - start, time.process_time() - cpu
        times.append(seconds)
        print(
            f"near {near:g} mm: {seconds:.2f} s ({cpu:.2f} s of processor time), {asked} distances, "
            f"{len(run) * 10 / asked:.0f} rows and pairs for each, {len(found)} findings"
        )
        for each in found[:5]:
            print(f"    {each.between}: rows {each.rows[0]} to {each.rows[1]}, {each.depth:.2f} mm deep")
    return times


if __name__ == "__main__":
    check_times(int(sys.argv[1]) if len(sys.argv) > 1 else BLOCKS)
