"""What the command line says of a page that is served."""

import sys
import webbrowser
from collections.abc import Callable


def announce(*, browser: bool) -> Callable[[str], None]:
    """Return what to do when a page can be opened: print its address and, unless told not to, open it."""

    def ready(address: str) -> None:
        print(address, flush=True)
        print("Ctrl-C ends it", file=sys.stderr)
        if browser:
            webbrowser.open(address)

    return ready
