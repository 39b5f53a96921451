"""Programs of Autodesk's CAM systems: one for each kind of thing that a post is told."""

import math
from collections.abc import Callable
from typing import Any, Final

from tests.support.fusion.streams import COOLANTS, LEVEL, FusionTool, Plane, Stream, Vector

MILL: Final = FusionTool()
BALL: Final = FusionTool(
    2,
    "MILLING_END_BALL",
    8.0,
    4.0,
    stated=("MILL", "DIAMETER", 8.0, "CORNER", 4.0),
    name="BALL D8",
    holder="HSK-A63 ER32",
)
DRILL: Final = FusionTool(
    5,
    "DRILL",
    6.0,
    angle=118.0,
    stated=("DRILL", "DIAMETER", 6.0, "TIP", 118.0),
    name="DRILL D6",
    length=60.0,
    flutes=45.0,
)


def tilted(about_z: float, about_x: float) -> Plane:
    """A work plane that is turned about Z, and then about its own X."""
    s, c, t, u = (f(math.radians(each)) for each in (about_z, about_x) for f in (math.sin, math.cos))
    return (c, s, 0.0), (-s * u, c * u, t), (s * t, -c * t, u)


def leaning(tilt: float, turn: float) -> Vector:
    """A tool axis that leans by ``tilt`` towards the direction ``turn``."""
    a, b = math.radians(tilt), math.radians(turn)
    return math.sin(a) * math.cos(b), math.sin(a) * math.sin(b), math.cos(a)


def square(job: Stream, size: float, depth: float) -> None:
    """Down, around a square, and up."""
    job.rapid(size, size, 5.0)
    job.line(size, size, -depth, feed=300.0)
    for x, y in ((-size, size), (-size, -size), (size, -size), (size, size)):
        job.line(x, y, -depth)
    job.rapid(size, size, 50.0)


def three_axes() -> Stream:
    """A profile with notes, and a stop between two operations of one tool."""
    job = Stream("PLATE")
    job.say(("comment", "made by hand"), "PPRINT/made by hand")
    with job.section("Face, top", MILL, (30.0, 30.0, 50.0), parameters={"notes": "clamp at 20 mm\ntwo bolts"}):
        square(job, 25.0, 1.0)
    job.say(("command", "OPTIONAL_STOP"), "OPSTOP")
    with job.section("Profil außen", MILL, (30.0, 30.0, 50.0), spindle=5200.0):
        square(job, 20.0, 2.5)
    return job


def planes() -> Stream:
    """Three sides in tilted planes, with a tool in a holder."""
    job = Stream("SIDES")
    for name, plane in (("TOP", LEVEL), ("SIDE 1", tilted(90.0, 35.0)), ("SIDE 2", tilted(-30.0, 50.0))):
        with job.section(name, BALL, (12.0, 12.0, 90.0), plane=plane):
            job.rapid(12.0, 12.0, 62.0)
            job.line(12.0, 12.0, 58.25, feed=250.0)
            job.line(-12.0, 12.0, 58.25)
            job.arc((-12.0, 0.0, 58.25), (0.0, 0.0, 1.0), 180.0, [(-24.0, 0.0, 58.25), (-12.0, -12.0, 58.25)], 12.0)
            job.rapid(-12.0, -12.0, 90.0)
    return job


HOLES: Final[list[Vector]] = [(-20.0, -10.0, 0.0), (0.0, 10.0, 0.0), (20.0, -10.0, -3.0)]


def cycles() -> Stream:
    """Every cycle that CL data can say, and those that are written as moves."""
    job = Stream("HOLES")
    start = (-30.0, 0.0, 60.0)
    bore = FusionTool(7, "BORING_BAR", 20.0, stated=("MILL", "DIAMETER", 20.0), name="BORE D20")
    with job.section("DRILLING", DRILL, start):
        job.holes("drilling", "DRILL", HOLES, 12.5)
        job.holes("counter-boring", "FACE,DWELL,0.500000", HOLES, 2.0, dwell=0.5)
        job.holes(
            "chip-breaking", "DRILL,BRKCHP,STEP,3.000000", HOLES, 12.0, incrementalDepth=3.0, accumulatedDepth=12.0
        )
        job.holes(
            "deep-drilling", "DRILL,DEEP,STEP,5.000000,1.000000,2.000000", HOLES, 25.0, incrementalDepth=5.0,
            incrementalDepthReduction=1.0, minimumIncrementalDepth=2.0,
        )  # fmt: skip
        job.holes("chip-breaking", "", HOLES, 12.0, incrementalDepth=3.0, accumulatedDepth=6.0)
        job.holes("gun-drilling", "", HOLES[:1], 20.0)
    with job.section(
        "REAMING", FusionTool(6, "REAMER", 6.0, stated=("MILL", "DIAMETER", 6.0), name="REAMER D6"), start
    ):
        job.holes("reaming", "REAM", HOLES, 10.0, retractFeedrate=150.0)
        job.holes("reaming", "", HOLES[:1], 10.0, retractFeedrate=400.0)
    with job.section("BORING", bore, start):
        job.holes("boring", "BORE,DWELL,0.250000", HOLES, 8.0, dwell=0.25)
        job.holes("stop-boring", "BORE,DRAG", HOLES, 8.0)
        job.holes("bore-milling", "", HOLES[:1], 8.0)
    return job


def threads() -> Stream:
    """Taps of both hands, with pecks too."""
    job = Stream("THREADS")
    for number, hand, kind, is_left in ((8, "RIGHT", "tapping", False), (9, "LEFT", "left-tapping", True)):
        tap = FusionTool(
            number, f"TAP_{hand}_HAND", 8.0, stated=("MILL", "DIAMETER", 8.0), name=f"TAP M8 {hand}", pitch=1.25,
            is_clockwise=not is_left,
        )  # fmt: skip
        with job.section(f"M8 {hand}", tap, (-30.0, 0.0, 60.0), spindle=500.0):
            job.holes(kind, "TAP", HOLES, 14.0, feed="MMPR,1.25")
            job.holes(
                f"{hand.lower()}-tapping-with-chip-breaking", "TAP,BRKCHP,STEP,4.000000", HOLES, 14.0, feed="MMPR,1.25",
                incrementalDepth=4.0,
            )  # fmt: skip
    return job


def five_axes() -> Stream:
    """A path whose tool axis turns, between two of three axes."""
    job = Stream("BLADE")
    with job.section("ROUGH", BALL, (30.0, 30.0, 80.0)):
        square(job, 25.0, 0.5)
    first = leaning(20.0, 0.0)
    with job.section("SWARF", BALL, (25.0, 0.0, 80.0), axis=first):
        job.rapid5((25.0, 0.0, 20.0), first)
        job.line5((25.0, 0.0, 1.0), first, feed=300.0)
        for turn in range(10, 181, 10):
            x, y = 25.0 * math.cos(math.radians(turn)), 25.0 * math.sin(math.radians(turn))
            job.line5((x, y, 1.0 + turn / 200.0), leaning(20.0 + turn / 30.0, turn))
        job.rapid(-25.0, 0.0, 80.0)
    return job


def arcs() -> Stream:
    """Arcs of both senses in three planes, and a full circle."""
    job = Stream("ARCS")
    with job.section("ARCS", BALL, (20.0, 0.0, 50.0)):
        job.rapid(20.0, 0.0, 20.0)
        job.line(20.0, 0.0, 10.0, feed=300.0)
        job.arc((10.0, 0.0, 10.0), (0.0, 0.0, 1.0), 90.0, [(10.0, 10.0, 10.0)], 10.0)
        job.arc((10.0, 0.0, 10.0), (0.0, 0.0, -1.0), 90.0, [(20.0, 0.0, 10.0)], 10.0)
        leg, high = 15.0 * math.sqrt(0.5), 10.0 * math.sqrt(3.0)
        job.arc((20.0, 0.0, 25.0), (0.0, -1.0, 0.0), 45.0, [(20.0 + leg, 0.0, 25.0 - leg)], 15.0)
        job.arc((20.0, 0.0, 25.0), (0.0, 1.0, 0.0), 45.0, [(20.0, 0.0, 10.0)], 15.0)
        job.arc((20.0, 0.0, 16.0), (1.0, 0.0, 0.0), 90.0, [(20.0, 6.0, 16.0)], 6.0)
        job.arc((20.0, 0.0, 16.0), (-1.0, 0.0, 0.0), 90.0, [(20.0, 0.0, 10.0)], 6.0)
        job.arc(
            (0.0, 0.0, 10.0),
            (0.0, 0.0, -1.0),
            360.0,
            [(-10.0, -high, 10.0), (-10.0, high, 10.0), (20.0, 0.0, 10.0)],
            20.0,
        )
        job.rapid(20.0, 0.0, 50.0)
    return job


def helix() -> Stream:
    """Three turns down, and a quarter up."""
    job = Stream("HELIX")
    with job.section("RAMP", MILL, (15.0, 0.0, 40.0)):
        job.rapid(15.0, 0.0, 2.0)
        job.line(15.0, 0.0, 0.0, feed=300.0)
        high = 7.5 * math.sqrt(3.0)
        ends = [(-7.5, high), (-7.5, -high), (15.0, 0.0)] * 3
        job.arc(
            (0.0, 0.0, 0.0),
            (0.0, 0.0, 1.0),
            1080.0,
            [(x, y, -0.5 * k) for k, (x, y) in enumerate(ends, 1)],
            15.0,
            rise=-4.5,
        )
        job.arc((0.0, 0.0, -4.5), (0.0, 0.0, 1.0), 90.0, [(0.0, 15.0, -3.0)], 15.0, rise=1.5)
        job.rapid(0.0, 15.0, 40.0)
    return job


def inches() -> Stream:
    """Inches: a square, an arc and holes."""
    job = Stream("INCHES", inch=True, stock=((-2.5, -2.5, -2.0), (2.5, 2.5, 0.0)))
    mill = FusionTool(3, diameter=0.5, stated=("MILL", "DIAMETER", 0.5), name="EM 1/2", length=1.75, flutes=1.0)
    drill = FusionTool(
        4, "DRILL", 0.25, angle=118.0, stated=("DRILL", "DIAMETER", 0.25, "TIP", 118.0), name="DRILL 1/4", length=2.5,
        flutes=2.0,
    )  # fmt: skip
    with job.section("CONTOUR", mill, (1.0, 1.0, 2.0), spindle=6000.0):
        job.rapid(1.0, 1.0, 0.2)
        job.line(1.0, 1.0, -0.125, feed=12.0)
        job.line(-1.0, 1.0, -0.125, feed=40.0)
        job.arc(
            (-1.0, 0.0, -0.125), (0.0, 0.0, 1.0), 180.0, [(-2.0, 0.0, -0.125), (-1.0, -1.0, -0.125)], 1.0, feed=25.5
        )
        job.rapid(-1.0, -1.0, 2.0)
    with job.section("HOLES", drill, (1.0, 0.0, 2.0), spindle=3000.0):
        job.holes(
            "deep-drilling", "DRILL,DEEP,STEP,0.250000", [(0.5, 0.5, 0.0), (-0.5, 0.5, -0.1)], 1.2, feed="IPM,9.5",
            rapid=0.1, clearance=0.6, incrementalDepth=0.25,
        )  # fmt: skip
    return job


def set_ups() -> Stream:
    """Two set-ups, each with its work offset."""
    job = Stream("TWO SIDES", has_offsets=True)
    other = {"origin": (0.0, 0.0, -50.0), "x": (1.0, 0.0, 0.0), "y": (0.0, -1.0, 0.0)}
    with job.section("FIRST SIDE", MILL, (30.0, 30.0, 50.0), offset=1):
        square(job, 25.0, 1.0)
    with job.section("SECOND SIDE", MILL, (30.0, 30.0, 50.0), offset=2, wcs=other):
        square(job, 20.0, 1.0)
    return job


def pattern() -> Stream:
    """One operation at three places, which the engine gives as three."""
    job = Stream("PATTERN")
    for x in (-30.0, 0.0, 30.0):
        with job.section("POCKET", MILL, (x, 0.0, 50.0), pattern=7):
            job.rapid(x, 0.0, 5.0)
            job.line(x, 0.0, -2.0, feed=200.0)
            job.line(x, 10.0, -2.0)
            job.rapid(x, 10.0, 50.0)
    return job


def manual() -> Stream:
    """Every kind of Manual NC, between operations, in one, and behind the last."""
    job = Stream(
        "MANUAL", inserts={"OPEN_DOOR": "M238", "ACTION:PALLET 2": "M260", "VERIFY": "", "CALL:WARMUP": "M277"}
    )
    job.say(("comment", "before all"), "PPRINT/before all")
    job.say(("passThrough", "M225\nM226"), "INSERT/M225", "INSERT/M226")
    job.say(("command", "OPEN_DOOR"), "INSERT/M238")
    job.say(("parameter", "action", "Pallet 2"), "INSERT/M260")
    job.say(("command", "VERIFY"))
    with job.section("ONE", MILL, (30.0, 30.0, 50.0)):
        job.say(("comment", "in the path"), "PPRINT/in the path")
        job.say(("dwell", 1.5), "DELAY/1.500000")
        square(job, 25.0, 1.0)
        job.say(("command", "LOCK_MULTI_AXIS"))
    job.say(("command", "STOP"), "STOP")
    job.say(("dwell", 2.0), "DELAY/2.000000")
    job.say(("parameter", "display", "turn the part"), "DISPLY/turn the part")
    job.say(("parameter", "print", "half done"), "PPRINT/half done")
    job.say(("parameter", "call-subprogram", "WARMUP"), "INSERT/M277")
    with job.section("TWO", MILL, (30.0, 30.0, 50.0), optional=False):
        square(job, 20.0, 1.0)
    job.say(("comment", "the end"), "PPRINT/the end")
    job.say(("command", "OPTIONAL_STOP"), "OPSTOP")
    return job


def probing() -> Stream:
    """A probing cycle as an event with a name."""
    job = Stream("PROBING", properties={"probing": "events"})
    probe = FusionTool(20, "PROBE", 6.0, stated=None, name="PROBE", coolant="OFF")
    with job.section("PROBE TOP", probe, (0.0, 0.0, 50.0), spindle=0.0):
        words = {"depth": 5.0, "feedrate": 700.0, "probeClearance": 4.0, "probeOvertravel": 6.0, "approach": "negative"}
        point = {"point": (5.0, 5.0, 5.0), "stock": 0.0, "retract": 5.0, "clearance": 20.0}
        job._event("cycle", "probing-z", words, [point])
        job.lines += [
            "RAPID", "GOTO/5.000000,5.000000,20.000000", "FEDRAT/MMPM,700.000000", "GOTO/5.000000,5.000000,5.000000",
            "PROBE/Z,CLEARANCE,20.000000,DEPTH,5.000000,FEEDRATE,700.000000,PROBE-CLEARANCE,4.000000,"
            "PROBE-OVERTRAVEL,6.000000,RETRACT,5.000000,STOCK,0.000000",
            "RAPID", "GOTO/5.000000,5.000000,20.000000",
        ]  # fmt: skip
    with job.section("FACE", MILL, (30.0, 30.0, 50.0)):
        square(job, 25.0, 1.0)
    return job


def spindle() -> Stream:
    """A left-hand mill, whose speed changes in the path."""
    job = Stream("LEFT")
    left = FusionTool(11, name="LEFT D10", is_clockwise=False)
    with job.section("LEFT", left, (30.0, 30.0, 50.0)):
        square(job, 25.0, 1.0)
        job.say(("speed", 2500.0), "SPINDL/RPM,2500.000000,CCLW")
        square(job, 20.0, 1.0)
        job.say(("command", "STOP_SPINDLE"), "SPINDL/OFF")
        job.say(("command", "START_SPINDLE"), "SPINDL/RPM,2500.000000,CCLW")
        square(job, 15.0, 1.0)
    return job


def coolants() -> Stream:
    """Every kind of coolant; the mixed ones as lines of the program."""
    kinds = COOLANTS[1:5] + COOLANTS[:1] + COOLANTS[5:]
    job = Stream("COOLANT", inserts={f"COOLANT_{kind}": f"M{270 + n}" for n, kind in enumerate(kinds)})
    for n, kind in enumerate(kinds):
        with job.section(f"COOLANT {n}", FusionTool(coolant=kind), (30.0, 30.0, 50.0)):
            square(job, 25.0 - n, 1.0)
    return job


def compensation() -> Stream:
    """Radius compensation in the control (points of the contour) and for wear (of the centre)."""
    job = Stream("COMPENSATION")
    for number, kind, side, word in ((1, "control", 1, "LEFT,CONTACT,1"), (2, "wear", 2, "RIGHT,2")):
        tool = FusionTool(number, name=f"MILL {number}")
        with job.section(f"EDGE {kind}", tool, (0.0, -40.0, 50.0), parameters={"operation:compensationType": kind}):
            job.rapid(0.0, -40.0, 5.0)
            job.line(0.0, -40.0, -1.0, feed=300.0)
            job.say(("compensation", side), f"CUTCOM/{word}")
            job.line(0.0, -20.0, -1.0)
            job.line(0.0, 20.0, -1.0)
            job.say(("compensation", 0), "CUTCOM/OFF")
            job.line(0.0, 40.0, -1.0)
            job.rapid(0.0, 40.0, 50.0)
    return job


def tools() -> Stream:
    """Tools of every form; those that cannot be said are UNKNOWN, with a warning."""
    job = Stream("TOOLS")
    b = math.radians(10.0)
    centre = 3.0 - 1.0 * (1.0 - math.sin(b)) / math.cos(b)
    forms: list[tuple[str, float, float, float, tuple[Any, ...] | None, dict[str, Any]]] = [
        ("MILLING_END_BULLNOSE", 12.0, 2.0, 0.0, ("MILL", "DIAMETER", 12.0, "CORNER", 2.0), {}),
        ("MILLING_FACE", 50.0, 0.8, 0.0, ("MILL", "DIAMETER", 50.0, "CORNER", 0.8), {}),
        ("MILLING_TAPERED", 6.0, 1.0, 10.0,
         ("MILL", "DIAMETER", 6.0, "CORNER", 1.0, "TAPER", 10.0, "CENTRE", centre, 1.0), {}),
        ("MILLING_CHAMFER", 10.0, 0.0, 45.0, ("DRILL", "DIAMETER", 10.0, "TIP", 90.0),
         {"others": (("tipDiameter", 0.0),)}),
        ("MILLING_CHAMFER", 10.0, 0.0, 45.0, ("MILL", "DIAMETER", 2.0, "TAPER", 45.0, "LENGTH", 4.0),
         {"others": (("tipDiameter", 2.0),), "has_lengths": False}),
        ("MILLING_SLOT", 20.0, 0.5, 0.0, ("TCUTTER", "DIAMETER", 20.0, "CORNER", 0.5, "UPPER", 0.5, "LENGTH", 4.0),
         {"flutes": 4.0, "has_lengths": False}),
        ("DRILL_SPOT", 8.0, 0.0, 90.0, ("DRILL", "DIAMETER", 8.0, "TIP", 90.0), {}),
        ("COUNTER_BORE", 15.0, 0.0, 0.0, ("MILL", "DIAMETER", 15.0), {}),
        *((kind, 9.0, 1.0, 0.0, None, {}) for kind in (
            "DRILL_CENTER", "MILLING_RADIUS", "MILLING_DOVETAIL", "MILLING_LOLLIPOP", "MILLING_FORM", "MILLING_THREAD",
            "COUNTER_SINK", "UNSPECIFIED",
        )),
    ]  # fmt: skip
    for n, (kind, d, r, angle, stated, more) in enumerate(forms):
        tool = FusionTool(30 + n, kind, d, r, angle, stated, name=f"{kind} {n}", **more)
        with job.section(f"TOOL {n}", tool, (30.0, 30.0, 50.0)):
            job.rapid(30.0, 30.0, 5.0)
            job.line(20.0, 30.0, 4.0)
            job.rapid(20.0, 30.0, 50.0)
    return job


def rest() -> Stream:
    """What is seldom: no name, a comment of the program, a tool by hand, an operation that may be skipped."""
    job = Stream("REST", comment="second clamping", stock=None)
    job._said.append("PPRINT/second clamping")
    with job.section("OPERATION 1", MILL, (30.0, 30.0, 50.0), parameters={"operation-comment": ""}, offset=0):
        square(job, 25.0, 1.0)
        square(job, 24.0, 1.0)
    by_hand = FusionTool(12, name="BY HAND", others=(("manualToolChange", True),))
    with job.section("SKIPPED", by_hand, (30.0, 30.0, 50.0), optional=True):
        square(job, 20.0, 1.0)
    left = FusionTool(
        9, "TAP_LEFT_HAND", 8.0, stated=("MILL", "DIAMETER", 8.0), name="TAP M8 LEFT", pitch=1.0, is_clockwise=False
    )
    with job.section("LEFT TAP", left, (-30.0, 0.0, 60.0), spindle=500.0):
        job.holes("tapping", "TAP", HOLES, 14.0, feed="MMPR,1")
    return job


def depths() -> Stream:
    """Holes of one cycle with depths and heights of their own, and radius compensation to the end."""
    job = Stream("DEPTHS")
    with job.section("HOLES", DRILL, (0.0, 0.0, 60.0)):
        points = []
        for x, top, depth, rapid, clearance in ((0.0, 0.0, 10.0, 2.0, 20.0), (20.0, 5.0, 12.5, 2.0, 15.0)):
            heights = {"stock": top, "retract": top + rapid, "clearance": top + clearance, "depth": depth}
            points.append({"point": (x, 0.0, top - depth), **heights})
            job.lines += [
                f"CYCLE/DRILL,RAPTO,{rapid:.6f},FEDTO,{-depth:.6f},RTRCTO,{clearance:.6f},MMPM,150.000000",
                f"GOTO/{x:.6f},0.000000,{top:.6f}", "CYCLE/OFF",
            ]  # fmt: skip
        job._event("cycle", "drilling", {"feedrate": 150.0}, points)
        job.rapid(0.0, 0.0, 60.0)
    with job.section("EDGE", MILL, (0.0, -40.0, 50.0), parameters={"operation:compensationType": "wear"}):
        job.rapid(0.0, -40.0, 5.0)
        job.line(0.0, -40.0, -1.0, feed=300.0)
        job.say(("compensation", 1), "CUTCOM/LEFT,1")
        job.line(0.0, -20.0, -1.0)
        job.line(0.0, 20.0, -1.0)
        job.lines.append("CUTCOM/OFF")
    return job


STREAMS: Final[dict[str, Callable[[], Stream]]] = {
    each.__name__: each
    for each in (
        three_axes, planes, cycles, threads, five_axes, arcs, helix, inches, set_ups, pattern, manual, probing, spindle,
        coolants, compensation, tools, rest, depths,
    )
}  # fmt: skip
