"""The tests that take long: ``make.py quick`` leaves them out."""

#: Folders and files that ``make.py quick`` leaves out: whole matrices, judges, fuzzing, and long property tests.
SLOW = (
    "api/test_concurrent_proof.py", "cl/test_write.py", "conversion", "examples", "files/test_output.py", "fuzz",
    "jit", "linuxcnc", "machines/test_chains.py", "machines/test_turn_clearance.py", "matrix",
    "output/families/fanuc", "output/families/heidenhain", "output/families/linuxcnc/test_holes.py",
    "output/families/sinumerik/test_planes.py", "output/test_hole_positions.py", "output/test_holes.py",
    "output/test_holes_as_motion.py", "output/test_planes_at_limits.py", "output/test_small_tilts.py",
    "output/test_subprograms.py", "output/test_vectors.py", "planning/test_everywhere.py",
    "planning/test_optimizer.py", "planning/test_pole.py", "planning/test_read_back.py",
    "planning/test_without_tcp.py", "readers/families", "readers/test_kernels.py", "readers/test_time.py",
    "reporting/test_write.py", "verification/test_declared_deviations.py",
    "verification/test_declared_deviations_random.py", "verification/test_mutations.py",
)  # fmt: skip
