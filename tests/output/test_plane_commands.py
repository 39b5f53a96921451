"""A tilted plane is one object: every control's way to say it gives the same matrix."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.support.examples import examples
from trunnion.arrays import Floats
from trunnion.controls import load_control
from trunnion.families import load_reader
from trunnion.machines import load_machine
from trunnion.output.coordinates.euler_angles import euler_zxz_angles
from trunnion.output.families.heidenhain import writer as heidenhain
from trunnion.output.families.sinumerik import writer as sinumerik
from trunnion.readers.program.options import DEFAULT_OPTIONS

#: Whole thousandths of a degree: beside the place where two turns become one, their angles lose half of the digits.
ANGLES = st.integers(-179999, 180000).map(lambda n: n / 1000)
PLACES = st.tuples(*[st.integers(-100000, 100000).map(lambda n: n / 1000)] * 3)
MODES = ("57", "27", "39", "45", "30", "54")

YL569, HS664RT = load_machine("yl569"), load_machine("hs664rt")
#: Klartext refuses a plane that the tool cannot stand on: this machine reaches all of them.
DMU65 = replace(
    (shipped_machines := load_machine("dmu65")),
    axes=tuple(replace(axis, low=-360.0, high=360.0) if axis.is_rotary else axis for axis in shipped_machines.axes),
)
SINUMERIK = dict(load_control(YL569.control).settings)
KLARTEXT = dict(load_control(DMU65.control).settings)


def turned(axis: int, degrees: float) -> Floats:
    """Right-handed about X, Y or Z, by Rodrigues' formula."""
    k = np.zeros((3, 3))
    one, two = (axis + 1) % 3, (axis + 2) % 3
    k[one, two], k[two, one] = -1.0, 1.0
    return np.eye(3) + math.sin(math.radians(degrees)) * k + (1.0 - math.cos(math.radians(degrees))) * k @ k


def frame_of(text: str, family: str, folder: Path) -> tuple[Floats, Floats]:
    """Matrix and origin of the frame in which a control works after a program."""
    machine = {"fidia_nc15": HS664RT, "sinumerik_840d": YL569}.get(family, DMU65)
    path = folder / "PLANE.NC"
    path.write_text(text, encoding="utf-8")
    interpreter = load_reader(family).interpreter(path, machine, DEFAULT_OPTIONS)
    interpreter.run()
    frame = interpreter.control.frame
    return frame.linear.copy(), frame.shift.copy()


def full(value: object) -> str:
    """A number with all its digits."""
    return f"{float(str(value)):.17f}"


def klartext(matrix: Floats, origin: tuple[float, float, float]) -> dict[str, str]:
    """The ways of Klartext."""
    said = {
        name: full(value)
        for name, value in heidenhain.template_values(KLARTEXT, matrix).items()
        if name[-2:-1] == "_" and value is not None
    }
    head = "".join(
        f"CYCL DEF 7.{k + 1} {name}{full(value)}\n" for k, (name, value) in enumerate(zip("XYZ", origin, strict=True))
    )
    shift = "BEGIN PGM P MM\nCYCL DEF 7.0 DATUM SHIFT\n" + head
    spatial = [said[f"spatial_{name}"] for name in "abc"]
    vectors = [said[f"{kind}_{name}"] for kind in ("base", "normal") for name in "xyz"]
    words = " ".join(
        f"{word}{value}" for word, value in zip(("BX", "BY", "BZ", "NX", "NY", "NZ"), vectors, strict=True)
    )
    angles = " ".join(f"{word}{value}" for word, value in zip(("SPA", "SPB", "SPC"), spatial, strict=True))
    cycle = " ".join(f"{word}{value}" for word, value in zip("ABC", spatial, strict=True))
    return {
        "PLANE SPATIAL": f"{shift}PLANE SPATIAL {angles} STAY\n",
        "PLANE VECTOR": f"{shift}PLANE VECTOR {words} STAY\n",
        "cycle 19": f"{shift}CYCL DEF 19.0 WORKING PLANE\nCYCL DEF 19.1 {cycle}\n",
    }


def siemens(matrix: Floats, origin: tuple[float, float, float]) -> dict[str, str]:
    """The ways of a Sinumerik."""
    x, y, z = map(full, origin)
    ways = {}
    for mode in MODES:
        said = sinumerik.template_values(SINUMERIK | {"plane": "cycle800", "swivel_mode": mode}, matrix)
        turns = ",".join(full(said[f"plane_{which}"]) for which in ("first", "second", "third"))
        ways[f"CYCLE800, mode {mode}"] = f'CYCLE800(0,"",0,{mode},{x},{y},{z},{turns},0,0,0,0,0,1)\n'
    said = sinumerik.template_values(SINUMERIK | {"plane": "frames"}, matrix)
    ways["frames"] = f"TRANS X{x} Y{y} Z{z}\n" + "".join(
        f"AROT {name}{full(said[f'plane_{which}'])}\n"
        for name, which in zip("XYZ", ("first", "second", "third"), strict=True)
    )
    return ways


def fanuc(matrix: Floats, origin: tuple[float, float, float]) -> str:
    x, y, z, i, j, k = map(full, (*origin, *euler_zxz_angles(matrix)))
    return f"G68.2 X{x} Y{y} Z{z} I{i} J{j} K{k}\n"


def spellings(matrix: Floats, origin: tuple[float, float, float], folder: Path) -> dict[str, tuple[Floats, Floats]]:
    """What every control but those that take a plane from the rotary axes makes of its spelling."""
    found = {way: frame_of(text, "sinumerik_840d", folder) for way, text in siemens(matrix, origin).items()}
    found |= {way: frame_of(text, "heidenhain_tnc640", folder) for way, text in klartext(matrix, origin).items()}
    return found | {"G68.2": frame_of(fanuc(matrix, origin), "fanuc_30i", folder)}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("planes")


@settings(max_examples=examples(15))
@given(a=ANGLES, b=ANGLES, c=ANGLES, origin=PLACES)
def test_any_plane_is_the_same_however_it_is_said(
    folder: Path, a: float, b: float, c: float, origin: tuple[float, float, float]
) -> None:
    matrix = turned(0, a) @ turned(1, b) @ turned(2, c)
    for way, (linear, shift) in spellings(matrix, origin, folder).items():
        np.testing.assert_allclose(linear, matrix, rtol=0, atol=1e-9, err_msg=way)
        np.testing.assert_allclose(shift, origin, rtol=0, atol=1e-9, err_msg=way)


@settings(max_examples=examples(15))
@given(tilt=st.integers(-109999, 109999).map(lambda n: n / 1000), turn=ANGLES)
def test_the_plane_on_which_the_tool_stands_is_the_same_by_all_spellings(
    folder: Path, tilt: float, turn: float
) -> None:
    """G154 takes the plane from A and C of its machine, whose tool axis is Rz(C) Rx(A) z."""
    matrix = turned(2, turn) @ turned(0, tilt)
    taken, shift = frame_of(f"G71\nG90\nG1 C{full(turn)} A{full(tilt)} F3000\nG154\n", "fidia_nc15", folder)
    np.testing.assert_allclose(taken, matrix, rtol=0, atol=1e-9)
    np.testing.assert_allclose(shift, 0.0, rtol=0, atol=1e-9)
    for way, (linear, _) in spellings(matrix, (0.0, 0.0, 0.0), folder).items():
        np.testing.assert_allclose(linear, taken, rtol=0, atol=1e-9, err_msg=way)
