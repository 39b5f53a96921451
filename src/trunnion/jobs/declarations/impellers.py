"""Commands for impellers, and curves through measured points."""

from typing import Final

from trunnion.jobs.job import Job, job
from trunnion.messages import phrase
from trunnion.options.groups import CUTTING, JSON, MACHINE, SETTINGS
from trunnion.options.kinds import Choice, FileIn, FileOut, Text, length
from trunnion.options.option import Many, Option

_IMPELLER: Final = job(
    "impeller", "make an impeller from measured points",
    Option(
        "step", "", Choice(("model", "cut"), "TASK"),
        "model: a closed mesh or solid of it; cut: CL files and a proven program", own=True,
    ),
    Option("file", "", FileIn("IMPELLER", leads="impeller"), "definition of the impeller (.toml)"),
    Option(
        "output", "--output", FileOut("FILE|FOLDER", folder=True),
        "the mesh (.stl, .ply, .3mf or .glb), a picture of it (.png), or a STEP file (.stp); folder of a cut",
    ),
    Option(
        "tolerance", "--tolerance", length(phrase("kind_tolerance"), "0.001"),
        "model: how far facets may be off, by default 0.01; faces of STEP, by default 0.005",
    ),
    MACHINE.but(help="cut: machine that runs the program"),
    Option(
        "operations", "--operation", Text("NAME"),
        "cut: make this operation of the definition only; may be repeated", many=Many.REPEAT,
    ),
    CUTTING.only("cell").but(
        cell={"help": "cut: simulate the program in cells of this width, and compare the part with the model"}
    ),
    SETTINGS.but(help="cut: settings as for post; may be repeated"),
    JSON,
    run="impeller:run",
    examples=[
        ("trunnion impeller model wheel.toml --output wheel.stl", "a closed mesh"),
        ("trunnion impeller cut wheel.toml --machine yl569 --output wheel", "CL files and a proven program"),
    ],
)  # fmt: skip

_ENDS: Final = "natural (no curvature), tangent:X,Y,Z or derivative:X,Y,Z (by the parameter, which goes from 0 to 1)"

_CURVE: Final = job(
    "curve", "fit curves to measured points; no machine is needed",
    Option("file", "", FileIn("POINTS"), "table of points (.csv): columns x, y, z, or tip_x, tip_y, …"),
    Option("start", "--start", Text("END"), f"how curves begin: {_ENDS}", default="natural"),
    Option("end", "--end", Text("END"), "how they end", default="natural"),
    Option(
        "parameterization", "--parameterization", Choice(("chord-length", "centripetal"), "NAME"),
        "how far apart the parameters of two points are: chord-length or centripetal",
        default="chord-length",
    ),
    Option(
        "tolerance", "--tolerance", length(phrase("kind_tolerance"), "0.001"),
        "pass the points within it, with few control points",
    ),
    Option(
        "fair", "--fair", length(phrase("kind_tolerance"), "0.001"), "first move points by as much, for an even curve"
    ),
    Option(
        "scale", "--scale", length(phrase("kind_scale"), "0.75", "FACTOR"), "multiply the points by it",
        default=1.0, own=True,
    ),
    JSON,
    Option(
        "picture", "--picture", FileOut("FILE", (".svg",), phrase("curves_are_svg")),
        "curves with their curvature combs (.svg)", own=True,
    ),
    run="curve:run",
    examples=[
        ("trunnion curve points.csv", "a curve through all points"),
        ("trunnion curve points.csv --tolerance 0.01 --picture points.svg", "near them, and drawn"),
    ],
)  # fmt: skip

JOBS: Final[tuple[Job, ...]] = (_IMPELLER, _CURVE)
