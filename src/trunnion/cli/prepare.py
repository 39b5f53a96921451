"""``trunnion prepare``: everything compiled for this computer, before it is needed."""

from trunnion.cli.printing import print_result
from trunnion.cli.progress import progress
from trunnion.cli.wording import in_words
from trunnion.jit.ahead import all_kernels, compile_all
from trunnion.jobs.job import Given
from trunnion.messages import phrase


def run(given: Given) -> int:
    """Compile what is not compiled yet."""
    kernels = all_kernels()
    missing = sum(not each.is_kept for each in kernels)
    with progress("prepare", missing, " kernels", delay=0) as advance:
        made = compile_all(kernels, advance)
    print_result(in_words(phrase("kernels_ready", count=len(kernels), made=made)))
    return 0
