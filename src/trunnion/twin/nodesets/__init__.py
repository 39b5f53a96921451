"""NodeSets of the companion specifications, as the OPC Foundation publishes them, with their licence."""

from importlib.resources import files
from typing import Final

#: Files in the order in which they build on each other; whether all of their nodes must be sound. The one for CNC
#: systems also holds some 600 nodes of examples that hang nowhere; they are left out.
NODESETS: Final = (
    ("Opc.Ua.Di.NodeSet2.xml", True),
    ("Opc.Ua.IA.NodeSet2.xml", True),
    ("Opc.Ua.Machinery.NodeSet2.xml", True),
    ("Opc.Ua.MachineTool.NodeSet2.xml", True),
    ("Opc.Ua.CNC.NodeSet.xml", False),
)

CNC: Final = "http://opcfoundation.org/UA/CNC"
MACHINE_TOOL: Final = "http://opcfoundation.org/UA/MachineTool/"
MACHINERY: Final = "http://opcfoundation.org/UA/Machinery/"
DEVICES: Final = "http://opcfoundation.org/UA/DI/"


def nodeset(name: str) -> str:
    """Return the text of a NodeSet."""
    return files(__name__).joinpath(name).read_text(encoding="utf-8")
