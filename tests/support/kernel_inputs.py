"""The test that makes up arguments for each kernel, which is then judged (``tests/jit/test_judged_kernels.py``)."""

from typing import Final

#: Module of a test and its name, and what it is called with: a text, or a name of the module -> kernels that it calls.
INPUTS: Final[dict[tuple[str, ...], tuple[str, ...]]] = {
    ("cl.test_nci", "test_no_pairs_and_no_bytes_end_in_anything_but_a_problem"): ("cl.pair_scan.pair_scan",),
    ("cl.test_scan", "test_axes_are_settled_as_by_the_twin"): ("cl.scan.fill_modal_axes",),
    ("cl.test_scan", "test_the_walk_finds_the_statements_of_its_twin"): ("cl.scan.scan",),
    ("cl.test_surface_normals", "test_contact_points_are_those_that_a_plain_look_finds"): (
        "cl.surface_normals._scan_contact_points",
    ),
    ("cl.test_write", "test_every_dialect_says_a_toolpath_whole_or_refuses_it"): ("cl.writers.points._format_axis",),
    ("cl.test_write", "test_near_a_coordinate_axis_the_direction_of_the_lean_is_kept"): (
        "cl.writers.points._format_points",
    ),
    ("controls.test_words", "test_half_way_cases_of_a_cl_file_round_like_printf"): ("controls.words.round_column",),
    ("impeller.flank.test_fit", "test_deviations_are_those_of_the_slow_twin"): (
        "impeller.flank.deviation_kernel.least_distances",
    ),
    ("impeller.paths.test_channel", "test_nothing_is_cut_and_nothing_is_left"): ("impeller.paths.channel_passes.thin",),
    ("impeller.paths.test_clearance", "test_a_curved_body_is_as_far_as_its_samples"): (
        "impeller.paths.clearance_kernel.part_distances",
    ),
    ("impeller.paths.test_thinning", "test_what_is_left_out_is_within_the_tolerances"): (
        "impeller.paths.thinning.thin_rows",
    ),
    ("impeller.paths.test_tool_axes", "test_in_a_wedge_axes_turn_where_they_must"): (
        "impeller.paths.clearance_kernel.least_margins",
    ),
    ("impeller.test_blade", "test_a_wedge_has_flat_flanks_that_touch_all_its_balls"): ("impeller.blade.blade_frames",),
    ("impeller.test_blade", "test_derivatives_of_a_surface_are_those_of_its_points"): (
        "geometry.surface_kernel.surface_points",
    ),
    ("impeller.test_blade", "test_the_distance_to_a_plane_blade_is_that_of_arithmetic"): (
        "impeller.blade.blade_samples",
        "impeller.blade.blade_distances",
    ),
    ("machines.test_chains", "test_the_kernel_puts_the_tool_where_a_product_of_matrices_does"): (
        "machines.forward.forward_rows",
    ),
    ("machines.test_links", "test_an_axis_moves_what_stands_on_it_and_nothing_below"): ("machines.links.link_rows",),
    ("machines.test_reach", "test_volumes_are_those_that_trials_find"): ("machines.reach.volumes.count_cells",),
    ("model.test_turning_lines", "test_even_turns_reach_what_dense_samples_reach"): (
        "model.turning_lines.write_beyond",
    ),
    ("output.test_block_writer", "test_the_kernel_writes_what_its_slow_twin_writes"): (
        "output.blocks.block_kernel.write_blocks",
    ),
    ("output.test_vectors", "test_axes_stand_where_rotary_words_would_have_them"): (
        "timing.row_feeds.fill_feeds",
        "verification.kinematics.axis_motion_kernel.axis_motion_rows",
        "verification.deviations.point_deviations.compare_rows",
        "planning.linearization.intermediate_points._fill_branches",
        "verification.matching.intermediate_points._follow",
        "verification.deviations.linearization.write_linearization_errors",
    ),
    ("placing.test_against_brute_force", "test_the_margin_of_any_place_is_that_of_its_worst_row"): (
        "placing.rotary_angles._fill_angles",
        "placing.extremes._find_extremes",
    ),
    ("placing.test_collisions", "test_no_place_of_a_dense_grid_keeps_bodies_farther_apart", "name='matsuura_mx330'"): (
        "placing.collisions.nearest_moment.course_pose",
    ),
    ("placing.test_collisions", "test_the_nearest_moment_is_that_of_many_poses"): (
        "placing.axis_equations._fill_forms",
        "placing.collisions.nearest_moment.nearest_moment",
    ),
    ("placing.test_goals", "test_costs_are_the_sums_that_they_say_and_planes_stay_below_them", "goal=Goal.TIME"): (
        "placing.goals._cost",
    ),
    ("placing.test_inscribed_box", "test_every_corner_fits_and_no_other_box_is_larger"): (
        "placing.extremes._fill_blocks",
    ),
    ("planning.test_linearization", "test_the_tool_stays_within_its_tolerances"): (
        "planning.linearization.leg_division.divide_rows",
    ),
    ("planning.test_optimizer", "test_no_path_through_the_states_is_cheaper"): (
        "machines.inverse.solutions.solve_rows",
        "planning.poses.optimizer.find_cheapest",
        "planning.poses.optimizer.trace_back",
    ),
    ("planning.test_optimizer", "test_the_nearest_neighbour_of_the_planner_is_that_of_the_tests"): (
        "planning.poses.optimizer.find_nearest",
    ),
    ("planning.test_optimizer", "test_without_a_choice_one_pass_finds_the_optimum"): (
        "planning.poses.nearest_path.solve_rotary",
        "planning.poses.nearest_path.follow_nearest",
        "planning.poses.placement.place_rows",
    ),
    ("planning.test_pole", "test_in_solved_regions_no_rotary_axis_is_too_fast"): (
        "planning.speed.rotary_speed._speed_shares",
        "planning.pole.lean_limits._least_lean",
        "planning.pole.lean_limits._second_angle_ranges",
        "planning.pole.lean_limits._limit_steps",
    ),
    ("readers.families.heidenhain.test_programs", "test_blocks_lead_where_the_twin_says"): (
        "model.axis_positions.write_joints",
        "machines.forward.tool_axis_rows",
        "model.axis_positions.resolve_turns",
        "readers.families.heidenhain.scan_kernel.read_blocks",
    ),
    ("readers.test_kernels", "test_the_kernel_and_the_interpreter_read_any_words_alike"): (
        "readers.scan.letter_blocks.read_blocks",
        "readers.scan.rows.execute_blocks",
    ),
    ("readers.test_kernels", "test_vectors_are_followed_on_the_near_branch"): ("model.axis_positions.resolve_vectors",),
    ("readers.test_scanned_circles", "test_circles_are_read_alike", "family='sinumerik'"): (
        "readers.scan.circles.find_circles",
    ),
    ("simulation.collisions.test_against_sampling", "test_no_point_moves_further_than_the_bound"): (
        "simulation.collisions.clearance.motion_bounds",
        "simulation.collisions.clearance.relative_pose",
    ),
    ("simulation.collisions.test_queries", "test_the_box_of_all_crossings"): (
        "simulation.collisions.queries.crossing_box",
    ),
    ("simulation.collisions.test_queries", "test_the_deepest_of_all_points"): (
        "simulation.collisions.queries.deepest_point",
    ),
    ("simulation.collisions.test_hull_gap", "test_hulls_are_as_far_apart_as_their_meshes"): (
        "simulation.collisions.hull_gap.pose_gap",
        "simulation.collisions.queries.point_depths",
        "simulation.collisions.hull_gap.gaps_at",
    ),
    ("simulation.cutting.test_removal", "test_five_axis_strokes_are_as_dense_stamping_has_them"): (
        "simulation.cutting.cut_kernel.bin_sweeps",
        "simulation.cutting.cut_kernel.cut_tile",
    ),
    ("simulation.cutting.test_removal", "test_what_is_missing_from_the_design_is_found_with_the_row_that_took_it"): (
        "simulation.stock.differences.common_stretches",
        "simulation.stock.differences.difference_stretches",
        "simulation.stock.differences.thinner_here",
        "simulation.stock.deviation.twice_to_surface",
    ),
    ("simulation.meshes.test_picture", "test_what_is_nearer_hides_what_is_behind_and_both_have_their_colours"): (
        "simulation.meshes.picture.draw_triangles",
    ),
    ("simulation.stock.test_spans", "test_solids_that_overlap_are_one"): (
        "simulation.stock.spans.mesh_crossings",
        "simulation.stock.spans.pair_crossings",
    ),
    (
        "simulation.stock.test_surface_points",
        "test_area_and_deviation_of_a_slot_that_is_too_deep_and_one_that_is_missing",
    ): (
        "simulation.stock.surface.fill_centres",
        "simulation.stock.surface.nearest_ends",
    ),
    ("timing.test_limits", "test_the_passes_find_what_lowering_without_order_finds"): (
        "timing.speed_kernel.plan_speeds",
    ),
    ("timing.test_limits", "test_the_speed_that_a_piece_reaches_is_the_highest_of_its_phases", "dynamics=EVEN"): (
        "timing.speed_kernel.fill_reached",
    ),
    ("timing.test_limits", "test_the_speed_that_a_piece_reaches_is_the_highest_of_its_phases", "dynamics=SMOOTH"): (
        "timing.jerk_kernel.fill_stretches",
        "timing.jerk_kernel.lower_nodes",
        "timing.phase_kernel.check_nodes",
        "timing.phase_kernel.run_stretches",
    ),
    ("verification.test_run_time", "test_no_axis_is_faster_than_it_can_be_and_no_row_than_its_feed"): (
        "machines.inverse.solutions.slide_rows",
    ),
}
