"""Tool libraries: our own in TOML, and those that people have.

In:     a file: TOML, the JSON or ``.tools`` of Autodesk's CAM, a tool bit of FreeCAD, LinuxCNC's tool table.
Out:    a ``ToolLibrary``: tools with their sizes, and those that cannot be made a body, with the reason.

A library may come from anyone: reading one runs nothing, opens no other file (but those that a TOML file extends),
and refuses what grows beyond all measure.
"""

from trunnion.simulation.tools.library.library import LibraryTool, ToolLibrary, UnusableTool
from trunnion.simulation.tools.library.reading import read_tools

__all__ = ["LibraryTool", "ToolLibrary", "UnusableTool", "read_tools"]
