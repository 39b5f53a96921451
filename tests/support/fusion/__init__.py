"""Programs of Autodesk's CAM systems: as streams of events of the post engine, and as the CL text that they are."""
