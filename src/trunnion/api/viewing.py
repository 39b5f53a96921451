"""A program on its machine, as a page for a browser."""

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Literal

from trunnion.api.arguments import check_path, check_paths
from trunnion.api.observer import SILENT, Observer
from trunnion.api.reading import FilePath, MachineLike, ToolpathLike, as_machine, as_run, as_toolpaths
from trunnion.api.settings import set_up_machine
from trunnion.api.simulation_result import NO_CALL
from trunnion.api.targets import check_output_name
from trunnion.api.verifying import rapid_feed_of, verify
from trunnion.api.viewing_stock import view_simulation, with_stock
from trunnion.errors import InputError
from trunnion.files import OutputPlace, atomic_file
from trunnion.model.run import Run
from trunnion.model.toolpath import Toolpath
from trunnion.readers.program.source_text import decode
from trunnion.simulation.meshes import load_mesh
from trunnion.simulation.tools.choice import choose_tools, tools_of_toolpaths
from trunnion.simulation.tools.library import read_tools
from trunnion.simulation.tools.profile import ToolShape
from trunnion.simulation.tools.text import parse_tool
from trunnion.verification import restore_rapids
from trunnion.viewer.content import ViewContent, view_content
from trunnion.viewer.page import render_view


def check_view_name(file: FilePath) -> OutputPlace:
    """The place of a page, which is found out before any work.

    Raises
    ------
    InputError
        If its name ends otherwise, or it cannot be written.
    """
    return check_output_name("output", file, (".html",), "the view is a page")


def prepare_view(
    nc: FilePath,
    *,
    machine: MachineLike,
    cl: ToolpathLike | Iterable[ToolpathLike] = (),
    subprograms: Sequence[FilePath] = (),
    stock: FilePath | None = None,
    part: FilePath | None = None,
    fixtures: Sequence[FilePath] = (),
    tools: Iterable[str] = (),
    libraries: Sequence[FilePath] = (),
    unit: Literal["mm", "inch"] | None = None,
    near: float | None = None,
    cell: float | None = None,
    accuracy: float | None = None,
    zero: str | Iterable[float] | None = None,
    tool_length: str | float | None = None,
    observer: Observer = SILENT,
) -> ViewContent:
    """Read a program, run and verify it, and put together what a page shows; arguments as ``write_view``.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no reader knows the control.
    """
    place, others = check_path("nc", nc), check_paths("subprograms", subprograms)
    placed = set_up_machine(as_machine(machine), zero, tool_length)
    simulated = view_simulation(
        placed, stock=stock, part=part, fixtures=fixtures, tools=tools, libraries=libraries, unit=unit, near=near,
        cell=cell, accuracy=accuracy,
    )  # fmt: skip
    run = restore_rapids(as_run(place, placed, others), rapid_feed_of(placed))
    toolpaths = as_toolpaths(cl, None, False, observer)
    verification = verify(run, machine=placed, cl=toolpaths, observer=observer)
    around = [load_mesh(mesh, name=f"fixture {k}") for k, mesh in enumerate(check_paths("fixtures", fixtures), 1)]
    design = None if part is None else load_mesh(check_path("part", part), name="part")
    bodies = _known_tools(run, tools, libraries, unit, toolpaths)
    texts = [decode(Path(file).read_bytes()) for file in run.files]
    content = view_content(verification, texts, bodies, design, around)
    return content if simulated is None else with_stock(content, simulated, run, toolpaths, observer)


def write_view(
    nc: FilePath,
    *,
    machine: MachineLike,
    output: FilePath,
    cl: ToolpathLike | Iterable[ToolpathLike] = (),
    subprograms: Sequence[FilePath] = (),
    stock: FilePath | None = None,
    part: FilePath | None = None,
    fixtures: Sequence[FilePath] = (),
    tools: Iterable[str] = (),
    libraries: Sequence[FilePath] = (),
    unit: Literal["mm", "inch"] | None = None,
    near: float | None = None,
    cell: float | None = None,
    accuracy: float | None = None,
    zero: str | Iterable[float] | None = None,
    tool_length: str | float | None = None,
    observer: Observer = SILENT,
) -> None:
    """Show an NC program on its machine, block by block, on a page that works offline.

    Parameters
    ----------
    nc
        The program.
    machine
        The machine that runs it: a name, a path or a ``Machine``.
    output
        The page, ``.html``. An older file is replaced when the new one is complete.
    cl
        Its CL files: the page then names the CL line of each block, and what the proof finds.
    subprograms
        Files of the subprograms that it calls. No others are opened.
    stock, near, cell, accuracy
        As for ``simulate``: the page then shows the stock as it is cut, how far it is from ``part`` in the end, and
        what the simulation finds. Without ``stock`` nothing is simulated.
    part, fixtures
        Meshes in the workpiece frame.
    tools, libraries, unit
        Tools as ``simulate`` has them. Without ``stock``, one whose form nothing states is drawn as a needle.
    zero, tool_length
        As for ``verify``. Without a zero, the part is drawn at the machine's zero.
    observer
        Receives progress and warnings.

    Raises
    ------
    InputError
        When a file or an argument cannot be used, or no reader knows the control.

    Examples
    --------
    >>> import trunnion
    >>> trunnion.write_view("tests/golden/yl569/2_hub_rough.expected.mpf", machine="yl569", output="view.html")
    """
    place = check_view_name(output)
    content = prepare_view(
        nc, machine=machine, cl=cl, subprograms=subprograms, stock=stock, part=part, fixtures=fixtures, tools=tools,
        libraries=libraries, unit=unit, near=near, cell=cell, accuracy=accuracy, zero=zero, tool_length=tool_length,
        observer=observer,
    )  # fmt: skip
    if content.stock is not None:
        with observer.progress("states of the stock", len(content.stock.page_states), "states") as tell:
            content.stock.packed(tell)
    with atomic_file(place, inputs=list(map(Path, content.scene["files"]))) as sink:
        sink.writelines(render_view(content, embedded=True))


def _known_tools(
    run: Run, tools: Iterable[str], libraries: Sequence[FilePath], unit: str | None, toolpaths: Sequence[Toolpath]
) -> dict[str, ToolShape]:
    """The bodies of the tools whose form something states."""
    read = [read_tools(path, unit or "") for path in check_paths("libraries", libraries)]
    diameters = {number: wide for library in reversed(read) for number, wide in library.diameters.items()}
    stated = [parse_tool(tool, diameters) for tool in tools]
    of_cl_files = tools_of_toolpaths(toolpaths)
    found: dict[str, ToolShape] = {}
    for name in run.tools:
        try:
            found[name] = choose_tools([name or NO_CALL], stated, read, of_cl_files)[name or NO_CALL]
        except InputError:
            continue  # drawn as a needle, which the page says
    return found
