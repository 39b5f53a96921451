"""Settings of a post itself: what each changes, what it may be, and what holds where it is not given.

All other settings belong to a control, whose definition explains them.
"""

from collections.abc import Mapping
from typing import Final

from trunnion.cl import DIALECTS
from trunnion.controls.vocabulary import PROGRAM_CHOICES, PROGRAM_MEANINGS
from trunnion.messages import Wording, declared, phrase
from trunnion.model.motion import PoleStrategy
from trunnion.options.groups import POSTING
from trunnion.options.kinds import Choice, Number
from trunnion.options.option import Option
from trunnion.output.subprograms import MIN_SUBPROGRAM_BYTES
from trunnion.planning import PlanOptions
from trunnion.planning.options import AXIS_TOLERANCE_WITHOUT_TCP
from trunnion.records import dataclass

_PLANNED: Final = PlanOptions()

#: Greatest size in bytes: none that matters.
_UNLIMITED: Final = 1e12


@dataclass(frozen=True, slots=True, eq=False)
class RunSetting:
    """A setting of a post.

    meaning    what it changes, in sentences
    default    what holds where it is not given, in words
    choices    its values, the default first; empty: any text of its form
    bounds     lowest and highest value of a number; None: it is none
    form       what to write, such as ``MM``
    example    a value
    """

    meaning: str
    default: str = "none"
    choices: tuple[str, ...] = ()
    bounds: tuple[float, float] | None = None
    form: str = ""
    example: str = ""

    @property
    def allowed(self) -> Wording:
        """What it may be."""
        if self.choices:
            return phrase("either_of", words=self.choices)
        form = phrase("either_of", words=tuple(self.form.split(" or ")))
        if self.bounds is None:
            return phrase("form_such_as", form=form, example=self.example)
        low, high = self.bounds
        if high < _UNLIMITED:
            return phrase("form_from_to_such_as", form=form, low=low, high=high, example=self.example)
        return phrase("form_of_at_least_such_as", form=form, low=low, example=self.example)

    def fault(self, key: str, value: object) -> Wording:
        """Return the message about a value that cannot be; ``written`` says where it is no setting but an argument."""
        shown, written = repr(value), f"{key}={self.form}"
        meaning = declared(self.meaning, "meanings", key)
        if self.choices:
            choices = tuple(f"{key}={choice}" for choice in self.choices)
            return Wording("ARG220", "no_choice", value=shown, choices=choices, meaning=meaning)
        if self.bounds is None:
            return Wording("ARG220", "not_of_form", value=shown, written=written, example=self.example, meaning=meaning)
        low, high = self.bounds
        if high < _UNLIMITED:
            return Wording(
                "ARG220",
                "out_of_range",
                value=shown,
                written=written,
                low=low,
                high=high,
                example=self.example,
                meaning=meaning,
            )
        return Wording(
            "ARG220", "too_small", value=shown, written=written, low=low, example=self.example, meaning=meaning
        )


def _choice(meaning: str, *choices: str, default: str = "") -> RunSetting:
    return RunSetting(meaning, default or choices[0], choices)


def _declared(option: Option) -> RunSetting:
    """Return the setting for which an option stands, as the option is declared."""
    meaning = f"{option.help[:1].upper()}{option.help[1:]}."
    if isinstance(option.kind, Choice):
        return _choice(meaning, *option.kind.words)
    assert isinstance(option.kind, Number)
    bounds = option.kind.least, option.kind.most
    return RunSetting(
        meaning, bounds=bounds, form=option.kind.metavar, example=str(option.kind.how.parameter("example"))
    )


#: Settings of the post by their names; all others belong to the control, whose templates print them.
RUN_SETTINGS: Final[Mapping[str, RunSetting]] = {
    "cl_units": _choice("Length unit of the CL files.", "mm", "inch", default="what the files say"),
    "dialect": _choice("What the CL files are written in.", *DIALECTS, default="what their content says"),
    "cutcom": _choice(
        "What the points under CUTCOM are where the CL files do not say it: those of the tool's centre, so that the "
        "control corrects by a difference, or those of the contour, so that it adds the radius.",
        "centreline",
        "contour",
        default="what the CL files say; else centreline",
    ),
    "compensation": RunSetting(
        "What becomes of CUTCOM: programmed, or left_out, so that the tool's centre goes along the points and no "
        "radius corrects it; OPERATION:left_out is that of one alone. Points of a contour are refused without CUTCOM.",
        "programmed",
        form="programmed or left_out or OPERATION:left_out",
        example="WALL:left_out",
    ),
    "spindle": RunSetting(
        "Speed of the spindle, rev/min, of operations without a SPINDL that cut while it stands or with another tool; "
        "OPERATION:RPM is that of one alone. Clockwise; with a minus counter-clockwise.",
        form="RPM or OPERATION:RPM",
        example="8000,DRILL:1200",
    ),
    "missing_feed": RunSetting(
        "Feed of cuts and holes that have none in the CL file, mm/min; with MMPR behind it mm a revolution. A tap "
        "takes its pitch alone, such as TAP:1.25MMPR; an operation may have both.",
        form="MM_MIN or OPERATION:MM_MIN",
        example="300,TAP:1.25MMPR",
    ),
    "feed_rapid_from": RunSetting(
        "Feed from which on lines of the CL file are rapids, mm/min, for CAM systems that write a high feed in place "
        "of RAPID; OPERATION:MM_MIN is that of one alone. Holes, arcs and splines stay what they are.",
        form="MM_MIN or OPERATION:MM_MIN",
        example="5000,FACE:3000",
    ),
    "open_cycle": RunSetting(
        "What becomes of a cycle of the CL file that is still on where another operation begins: it ends there, or "
        "goes_on, and the points of that operation are holes too. Every point before is a hole. OPERATION:ends is "
        "that of one alone; without it such a CL file is refused.",
        "refused",
        form="ends or goes_on or OPERATION:ends",
        example="HOLES:goes_on,FACE:ends",
    ),
    "spline_tolerance": RunSetting(
        "How far the points that splines (NURBS) of CL files become may leave them between each other.",
        "the smaller of INTOL and OUTTOL, from 0.0001 to 0.01; 0.001 without them",
        bounds=(1e-4, 1.0),
        form="MM",
        example="0.002",
    ),
    "zero": RunSetting(
        "Position of the workpiece zero on the machine, mm. With it, and tool_length for linear axes along the "
        "tool, every linear axis is checked against its limits; without it only whether the program fits into the "
        "travel somewhere. G54=X,Y,Z,G55=X,Y,Z gives each work offset its own; one that is left out is not known.",
        "the definition's workpiece.zero_mm",
        form="X,Y,Z",
        example="0,0,120.5",
    ),
    "tcp": _choice(
        "With off the program holds positions of linear and rotary axes instead of the tip, with points inserted. With "
        "m114 (iTNC 530) it holds the tip, which the control places at the ends of blocks alone, with points inserted.",
        "on",
        "off",
        "m114",
        default="on where the control has TCP",
    ),
    "tool_length": RunSetting(
        "Length from the spindle's gauge point to the tip. Limits of linear axes are checked with it; without TCP it "
        "is required on machines whose head turns the tool. 1=MM,2=MM gives tools their own by number or name; of "
        "those left out a tool library or the CL file may have it.",
        bounds=(0.0, 1e4),
        form="MM",
        example="120.5",
    ),
    "tip_tolerance": RunSetting(
        "Without TCP: how far the tip may leave its line between CL points.",
        f"{_PLANNED.tip_tolerance:g}",
        bounds=(1e-4, 10.0),
        form="MM",
        example="0.005",
    ),
    "axis_tolerance": RunSetting(
        "How far the tool axis may leave its great circle between CL points.",
        f"{AXIS_TOLERANCE_WITHOUT_TCP:g} without TCP; with TCP none, and the proof judges by the control's",
        bounds=(1e-3, 10.0),
        form="DEGREES",
        example="0.05",
    ),
    "numbers": _choice(
        "Which blocks have numbers: all, none, or only the first of each operation.",
        "on",
        "off",
        "operations",
        default="as the control's definition says",
    ),
    "first_block": RunSetting(
        "Number of the first block; the others follow by the step of the control's definition.",
        "as the control's definition says",
        bounds=(0, 99999999),
        form="NUMBER",
        example="100",
    ),
    "listing": _choice(
        "What the listing has besides the tip and both rotary axes: nothing, or the positions of the linear axes.",
        "tip",
        "slides",
    ),
    "programs": _choice(
        "One file with all operations, or a main program that calls a subprogram for each operation.",
        "one",
        "operations",
    ),
    "split": RunSetting(
        "Largest size of a subprogram; a larger operation continues in further files.",
        bounds=(MIN_SUBPROGRAM_BYTES, _UNLIMITED),
        form="BYTES",
        example="1000000",
    ),
    "first_number": RunSetting(
        "Number of the first subprogram, where subprograms have numbers. Programs whose subprograms are in one folder, "
        "or in one memory, need numbers of their own.",
        "as the control's definition says",
        bounds=(1, 9999),
        form="NUMBER",
        example="2001",
    ),
    "rewind": _choice(
        "Insert a retract where a rotary axis must rewind in the cut, or refuse such a program.", "insert", "none"
    ),
    "frame": _choice(
        "The program's coordinate system: that of the first operation, or the CAM's absolute one.", "first", "absolute"
    ),
    "mode": RunSetting(
        "Machining mode: auto, three-axis, tilted or tcp, of all operations or of one.",
        "auto",
        form="MODE or OPERATION:MODE",
        example="OP1:tcp,OP2:tilted",
    ),
    "drills_sideways": _choice(
        "With allowed a drill, tap, reamer or boring bar may move sideways at a feed: it cuts chamfers or grooves.",
        "refused",
        "allowed",
    ),
    "cycles": _choice("With off holes become motion wherever motion can make them.", "on", "off"),
    "tool_retract": RunSetting(
        "How far the tool leaves along its axis, at rapid, before it goes home from a tilted or simultaneous "
        "operation.",
        bounds=(0.0, 1e4),
        form="MM",
        example="50",
    ),
    "limit_margin": RunSetting(
        "How far the planner keeps axes from the limits of their travel, mm and degrees; the proof judges the limits.",
        "0",
        bounds=(0.0, 1e3),
        form="NUMBER",
        example="0.5",
    ),
    "clearance": RunSetting(
        "How far the tool retracts along its axis for a rewind: a distance, up to a plane, or out of a sphere, mm.",
        f"{_PLANNED.clearance.value:g}",
        form="MM or plane:Z or sphere:R",
        example="plane:120",
    ),
    "pole": _choice(
        "What is done near the pole where a rotary axis would be too fast: off changes nothing, hold keeps its angle, "
        "spread turns it evenly along the path, lean tilts the tool axis just enough.",
        *PoleStrategy,
    ),
    "pole_angle": RunSetting(
        "How far the tool axis may lean near the pole.",
        f"{_PLANNED.pole_angle:g}",
        bounds=(1e-3, 10.0),
        form="DEGREES",
        example="0.1",
    ),
    "lower_feed": _choice("With yes the feed is lowered where a rotary axis would be too fast.", "no", "yes"),
    "feed": _choice(
        "With fastest each block at feed has the feed that the axes reach in it, within their speeds, accelerations "
        "and jerks, and at most that of the CL file. Feeds per revolution and of holes stay.",
        "programmed",
        "fastest",
    ),
    "feed_limit": RunSetting(
        "With feed=fastest: the greatest feed of cuts, in place of those of the CL file. Tool and material must bear "
        "it.",
        "the feeds of the CL file",
        bounds=(0.1, 99999.0),
        form="MM_MIN",
        example="8000",
    ),
    **{option.setting: _declared(option) for option in POSTING},
    **{key: RunSetting(PROGRAM_MEANINGS[key], words[0], words) for key, words in PROGRAM_CHOICES.items()},
}
