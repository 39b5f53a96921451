"""An impeller of others, given by the flanks of its blades: Turbo3D, MIT licence, (c) 2024 Akash Jangid.

Flanks are bilinear patches. Axis Y there, Z here. The hub is a published Bézier curve; a shroud is not published, the
one here is 6 mm above the hub at the outlet and 14 mm at the inlet.
"""

import csv
from pathlib import Path

import numpy as np

from trunnion.arrays import Floats

#: Control points of radius and height from the inlet to the outlet.
HUB = np.array([(8.0931, 39.9256), (17.8791, 4.7883), (17.7835, 11.9424), (50.0931, 1.9256)])
SHROUD = np.array([(22.0, 39.9256), (24.0, 22.0), (30.0, 14.0), (50.0931, 7.9)])


def flanks(folder: Path, solid: str = "2624") -> list[Floats]:
    """Corners (2, 2, 3) of both flanks of a blade: by height, and from the axis outwards or inwards."""
    found: dict[str, Floats] = {}
    with (folder / "blade_flanks.csv").open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["solid"] == solid:
                points = found.setdefault(row["surf"], np.zeros((2, 10, 3)))
                points[int(row["rail"]), int(row["cp"])] = [float(row[axis]) for axis in "zxy"]
    return [points[:, [0, -1]] for points in found.values()]


def mean_curve(patches: list[Floats], control: Floats, count: int = 25) -> Floats:
    """Points (count, 3) halfway between two flanks on a Bézier curve of radius and height that is turned about Z."""
    t = np.linspace(0.0, 1.0, count)[:, None]
    radius, height = (
        (1 - t) ** 3 * control[0]
        + 3 * t * (1 - t) ** 2 * control[1]
        + 3 * t**2 * (1 - t) * control[2]
        + t**3 * control[3]
    ).T
    angles = []
    for patch in patches:
        up = (height / patch[1, 0, 2])[:, None]
        first, last = ((1.0 - up) * patch[0, k, :2] + up * patch[1, k, :2] for k in (0, 1))
        way = last - first
        a, b = (way**2).sum(axis=1), (first * way).sum(axis=1)
        c = (first**2).sum(axis=1) - radius**2
        root = np.sqrt(b**2 - a * c)
        (share,) = [s for s in ((-b + root) / a, (-b - root) / a) if ((s > -0.01) & (s < 1.01)).all()]
        place = first + share[:, None] * way
        angles.append(np.arctan2(place[:, 1], place[:, 0]))
    turn = (angles[1] - angles[0] + np.pi) % (2.0 * np.pi) - np.pi
    angle = angles[0] + turn / 2.0
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle), height))


def patch_distances(patch: Floats, points: Floats) -> Floats:
    """Distance (k,) of points (k, 3) to a bilinear patch, by Gauss and Newton's method."""
    at = np.full((len(points), 2), 0.5)
    for _ in range(60):
        low, high = (patch[k, 0] + at[:, :1] * (patch[k, 1] - patch[k, 0]) for k in (0, 1))
        place = low + at[:, 1:] * (high - low)
        along = (1.0 - at[:, 1:]) * (patch[0, 1] - patch[0, 0]) + at[:, 1:] * (patch[1, 1] - patch[1, 0])
        slopes = np.stack((along, high - low), axis=2)
        gram = np.einsum("kij,kil->kjl", slopes, slopes)
        right = np.einsum("kij,ki->kj", slopes, points - place)
        at = at + np.linalg.solve(gram, right[:, :, None])[:, :, 0]
    return np.asarray(np.linalg.norm(points - place, axis=1))


def table(patches: list[Floats]) -> str:
    """The table of points of the blade: hub, shroud, and halfway between."""
    curves = [mean_curve(patches, control) for control in (HUB, (HUB + SHROUD) / 2.0, SHROUD)]
    names = ",".join(f"{name}_{axis}_mm" for name in ("hub", "middle", "tip") for axis in "xyz")
    rows = [",".join(f"{value:.4f}" for value in row) for row in np.hstack(curves)]
    return "\n".join([names, *rows]) + "\n"
