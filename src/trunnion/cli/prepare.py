"""``trunnion prepare``: what commands need, compiled for this computer before they need it."""

from trunnion.cli.printing import print_result
from trunnion.cli.progress import progress
from trunnion.cli.wording import in_words
from trunnion.jit.ahead import all_kernels, compile_all
from trunnion.jit.store import cache_folder, remove_former
from trunnion.jobs.job import Given
from trunnion.jobs.kernels import needed
from trunnion.messages import phrase


def run(given: Given) -> int:
    """Compile what is missing of everything, or of what a command needs; remove what former versions left."""
    kernels = needed(given.work) if given.work else all_kernels()
    missing = sum(not each.is_kept for each in kernels)
    with progress("prepare", missing, " kernels", delay=0) as advance:
        made = compile_all(kernels, advance)
    folder = cache_folder()
    if folder is not None:
        remove_former(folder)
    print_result(in_words(phrase("kernels_ready", count=len(kernels), made=made)))
    return 0
