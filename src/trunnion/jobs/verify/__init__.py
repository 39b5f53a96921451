"""An NC program against its CL files, a recording, or another program."""
