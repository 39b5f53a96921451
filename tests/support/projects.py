"""Projects of small CL files, in folders of their own."""

from pathlib import Path

OPERATION = """TOOL PATH/{name},TOOL,D10
TLDATA/MILL,10.0000,0.0000,75.0000,0.0000,0.0000
MSYS/{origin},1.0000000,0.0000000,0.0000000,0.0000000,1.0000000,0.0000000
INTOL/0.01
OUTTOL/0.01
{start}RAPID
GOTO/0.0,0.0,50.0,0.0,0.0,1.0
FEDRAT/MMPM,500.0
GOTO/10.0,0.0,5.0
{end}END-OF-PATH
"""
START = "LOAD/TOOL,1,ADJUST,1\nSPINDL/RPM,4000.0000,CLW\n"


def operation(name: str, start: str = START, end: str = "", origin: str = "0.0,0.0,0.0") -> str:
    """A CL file of one operation, or a piece of one of several."""
    return OPERATION.format(name=name, start=start, end=end, origin=origin)


#: Of two operations: the second goes on with tool and spindle of the first.
TWO = operation("FACE") + operation("SLOT 2", start="")

#: The YL569 cannot lean a tool so far.
OUT_OF_REACH = operation("LEANING").replace("10.0,0.0,5.0", "10.0,0.0,5.0,0.0,0.7071068,-0.7071068")

#: One set-up, one program.
PROJECT = """\
machine = "yl569"
cl = ["top.cls"]
output = "top.mpf"
settings = { title = "TOP" }
"""

#: Two set-ups of one stock, on one machine.
SETUPS = """\
machine = "yl569"
stock = "box:60,60,20,-10,-30,-20"
cell_mm = 2.0

[[setup]]
name = "top"
cl = ["top.cls"]
output = "top.mpf"

[[setup]]
name = "bottom"
cl = ["bottom.cls"]
output = "bottom.mpf"
work_offset = "G55"
"""


def project(folder: Path, text: str = PROJECT, name: str = "part.toml", **cl: str) -> Path:
    """Write a project and its CL files: ``top``, ``bottom`` and others by their names, each of two operations."""
    folder.mkdir(parents=True, exist_ok=True)
    for stem, content in ({"top": TWO, "bottom": operation("BELOW")} | cl).items():
        (folder / f"{stem}.cls").write_text(content, encoding="utf-8")
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


def contents(folder: Path) -> dict[str, bytes]:
    """Every file of a folder, hidden or not."""
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}
