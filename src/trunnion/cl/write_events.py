"""Events of a toolpath as statements of a CL file."""

from trunnion.cl.write_points import axis_texts, number_text
from trunnion.model.toolpath import (
    BlockSkip,
    Coolant,
    CutterComp,
    CycleOff,
    CycleOn,
    Dwell,
    Event,
    From,
    GoHome,
    Insert,
    LoadTool,
    Message,
    SelectTool,
    SetMode,
    SpindleOff,
    SpindleOn,
    Stop,
    UnknownStatement,
)


def event_statement(event: Event) -> str:
    """The statement of an event."""
    match event:
        case LoadTool():
            return f"LOAD/TOOL,{event.number}" + (f",ADJUST,{event.adjust}" if event.adjust else "")
        case SelectTool():
            return f"SELECT/TOOL,{event.number}"
        case SpindleOn():
            return f"SPINDL/RPM,{number_text(event.rpm, 4)},{event.sense.value}"
        case SpindleOff():
            return "SPINDL/OFF"
        case Coolant():
            return f"COOLNT/{event.kind}"
        case CutterComp():
            words = [event.side, event.plane, str(event.register or "")]
            return f"CUTCOM/{','.join(word for word in words if word)}"
        case Dwell():
            return f"DELAY/{number_text(event.amount, 3)}" + (",REV" if event.revolutions else "")
        case Stop():
            return ("OPSTOP" if event.optional else "STOP") + (f"/{event.text}" if event.text else "")
        case Message():
            return f"{'DISPLY' if event.display else 'PPRINT'}/{event.text}"
        case Insert():
            return f"INSERT/{event.text}"
        case BlockSkip():
            return f"OPSKIP/{'ON' if event.on else 'OFF'}"
        case CycleOn():
            return _cycle(event)
        case CycleOff():
            return "CYCLE/OFF"
        case From():
            tip = [number_text(value, 6) for value in event.tip]
            return f"FROM/{','.join([*tip, *axis_texts(event.axis)])}"
        case GoHome():
            return "GOHOME"
        case SetMode():
            major, *words = event.words
            return major + (f"/{','.join(words)}" if words else "")
        case UnknownStatement():
            return event.text
    raise TypeError(type(event).__name__)


def _cycle(event: CycleOn) -> str:
    """A cycle: its mode words, then couplets and words without numbers, each in their order."""
    values = list(event.values)
    parts = list(event.mode)
    if values and parts and values[0][0] == parts[-1]:
        parts += [number_text(number, 4) for number in values.pop(0)[1]]
    for word, after in event.words:
        while word in (name for name, _ in values) and values[0][0] != word:
            parts += _couplet(*values.pop(0))
        parts += [text for text in (word, after) if text]
        if values and values[0][0] == word:
            parts += _couplet(*values.pop(0))[1:]
    for word, numbers in values:
        parts += _couplet(word, numbers)
    return f"CYCLE/{','.join(parts)}"


def _couplet(word: str, numbers: tuple[float, ...]) -> list[str]:
    return [word, *(number_text(number, 4) for number in numbers)]
