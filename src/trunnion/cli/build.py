"""``trunnion build``: the definition of a machine, set up in a browser."""

from pathlib import Path

from trunnion.builder.server import builder_application
from trunnion.builder.session import BuilderSession
from trunnion.cli.printing import announce
from trunnion.cli.wording import page_speech, said
from trunnion.errors import InputError, Problem
from trunnion.jobs.job import Given
from trunnion.machines import shipped_machines
from trunnion.messages import Wording
from trunnion.viewer.serving import serve, take_port


def run(given: Given) -> int:
    """Serve the builder until the user ends it."""
    file = Path(given.file) if given.file else None
    if file is not None and file.suffix != ".toml":
        raise InputError(
            Problem(
                str(file),
                0,
                Wording(
                    "ARG130",
                    "builder_starts_from_shipped" if str(file) in shipped_machines() else "builder_wants_definition",
                ),
            )
        )
    session = BuilderSession(file.parent, file.name) if file is not None else BuilderSession(Path())
    session.start()
    speech, announced = page_speech(), announce(said("ctrl_c_ends"), browser=given.browser)
    with take_port(given.host, given.port) as listening:
        serve(lambda access: builder_application(session, access, speech), listening, announced)
    return 0
