"""The tests that take long: ``make.py quick`` leaves them out, but where they or their namesake have changed."""

from pathlib import Path

from tests.support.locations import TESTS

#: Files that take more than some three seconds of processor time, and folders of them: whole matrices, judges, fuzzing,
#: and long property tests.
SLOW = (
    "batch/test_cluster.py", "batch/test_divided_files.py", "batch/test_local.py", "builder/test_session.py",
    "cli/test_batch.py", "cli/test_convert.py", "cli/test_place.py", "cli/test_post.py", "cli/test_serving.py",
    "explanations/test_codes.py", "explanations/test_messages.py", "impeller/paths/test_stock_clearance.py",
    "jobs/post/test_inserts.py", "jobs/post/test_left_over_files.py", "simulation/collisions/test_check.py",
    "simulation/collisions/test_hull_gap.py", "simulation/meshes/test_step.py", "simulation/test_recall.py",
    "simulation/test_shares.py", "test_doc_examples.py", "twin/test_modelling_rules.py",
    "verification/recorded/test_recorded.py",
    "jobs/post/test_arc_travel.py", "jobs/post/test_fastest_feed_proof.py", "jobs/post/test_fastest_feeds.py",
    "jobs/post/test_hole_travel.py",
    "jobs/impeller/test_impeller_cutting.py", "jobs/impeller/test_impellers_on_machines.py",
    "jobs/post/papers/test_papers.py",
    "jobs/post_project/test_project_papers.py", "jobs/post_project/test_project_posting.py",
    "jobs/test_same_as_command.py",
    "hooks/test_hooks.py", "jobs/post/test_recipes.py", "jobs/post/test_shop_texts.py",
    "jobs/view/test_viewing_stock.py",
    "cli/test_cases.py", "cli/test_frozen_results.py", "cli/test_watch.py", "messages/test_cures.py",
    "builder/test_browser.py", "cl/test_scan.py", "cl/test_surface_normals.py", "cl/test_write.py",
    "conversion/test_angles.py", "conversion/test_leaving_the_part.py", "conversion/test_pairs.py",
    "conversion/test_round_trip.py", "conversion/test_settings_by_operation.py", "examples", "fuzz",
    "impeller/flank",
    "impeller/paths/test_blade_finish.py", "impeller/paths/test_channel.py", "impeller/paths/test_clearance.py",
    "impeller/paths/test_root_blend.py", "impeller/paths/test_tool_axes.py",
    "impeller/solid", "impeller/test_machining.py", "impeller/test_model.py", "jit/test_kernels.py", "linuxcnc",
    "machines/test_chains.py", "machines/test_turn_clearance.py", "matrix",
    "output/families/fanuc/test_haas.py", "output/families/fanuc/test_programs.py",
    "output/families/fanuc/test_vectors.py", "output/families/fidia/test_programs.py",
    "output/families/heidenhain/test_arcs.py", "output/families/heidenhain/test_holes.py",
    "output/families/heidenhain/test_normals.py", "output/families/heidenhain/test_planes.py",
    "output/families/heidenhain/test_toolpaths.py", "output/families/heidenhain/test_vectors.py",
    "output/families/heidenhain/test_without_tcp.py", "output/families/linuxcnc/test_holes.py",
    "output/families/sinumerik/test_planes.py", "output/test_approach_in_planes.py", "output/test_block_skip.py",
    "output/test_feeds_as_printed.py", "output/test_hole_positions.py", "output/test_holes.py",
    "output/test_holes_as_motion.py", "output/test_planes_at_limits.py", "output/test_small_tilts.py",
    "output/test_subprograms.py", "output/test_text_output.py", "output/test_tools_and_times.py",
    "output/test_turns_and_circles.py",
    "output/test_vectors.py", "planning/test_default_points.py", "planning/test_everywhere.py",
    "planning/test_linearization.py", "planning/test_optimizer.py", "planning/test_pole.py",
    "planning/test_read_back.py", "planning/test_rewind_without_tcp.py", "planning/test_without_tcp.py",
    "readers/families/fanuc/test_programs.py", "readers/families/fidia",
    "readers/families/heidenhain/test_planes.py", "readers/families/heidenhain/test_programs.py",
    "readers/families/linuxcnc/test_judge.py", "readers/families/linuxcnc/test_programs.py",
    "readers/families/sinumerik/test_flow.py", "readers/test_growing.py", "readers/test_kernels.py",
    "readers/test_time.py", "reporting/test_plot_series.py", "reporting/test_write.py", "schemas/test_agreement.py",
    "timing/test_fastest.py", "twin/recording/test_breaks.py", "twin/recording/test_network.py",
    "twin/recording/test_record.py",
    "verification/test_declared_deviations.py", "verification/test_declared_deviations_random.py",
    "verification/test_events.py", "verification/test_matching.py", "verification/test_mutations.py",
    "twin/test_security.py", "twin/test_served.py",
    "cli/test_startup.py", "conversion/test_states.py", "jobs/capability/test_fitting.py",
    "jobs/capability/test_reaching.py", "jobs/post/test_between_operations.py",
    "jobs/simulate/test_simulated_bodies.py", "jobs/simulate/test_turned_simulation.py", "jobs/test_public_api.py",
    "output/test_approach_of_heads.py", "placing/test_collisions.py", "readers/test_second_programs.py",
    "verification/test_turns.py", "viewer/test_bricks.py", "viewer/test_browser.py", "viewer/test_live.py",
    "viewer/test_stock.py", "viewer/test_tools.py",
)  # fmt: skip

_PLACES = frozenset(TESTS / name for name in SLOW)


def is_slow(path: Path) -> bool:
    """Whether a file of tests, or a folder that it is in, is one of the slow ones."""
    return not _PLACES.isdisjoint((path, *path.parents))
