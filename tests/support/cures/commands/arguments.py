"""Cures of messages about arguments: of commands, and of functions of the library."""

from typing import Final

from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_VERIFY: Final = "trunnion verify part.mpf --machine yl569"
_BATCH: Final = "mkdir in\ncp part.mpf in/a.mpf\ntrunnion batch in --action verify --machine yl569 --results out"
_CALL: Final = "trunnion.verify('part.mpf', machine='yl569', columns=False)"
_JOBS: Final = (
    'write jobs.toml \'results = "out"\\n[[job]]\\naction = "verify"\\nfiles = ["*.mpf"]\\nmachine = "yl569"\\n\'\n'
    "cp part.mpf a.mpf\ntrunnion batch jobs.toml"
)
_MANIFEST: Final = f"{_POST} --output out.mpf --manifest out.json\ntrunnion verify out.json"
_PLACE: Final = "trunnion place part.cls --machine yl569 --turn 0"
_READ: Final = "trunnion.verify(trunnion.read_program('part.mpf', machine='yl569'), machine='yl569')"

_POSTED: Final = f"{_POST} --output out.mpf\ntrunnion verify out.mpf --machine yl569"
_SEVERAL: Final = "mkdir out\ntrunnion post part.cls two.cls --machine yl569 --output out --listing a.html"
_CUBE: Final = "--stock box:9,9,9 --cell 1 --zero 0,0,0"
_FASTEST: Final = (
    f"{_POST} --set feed=fastest --set feed_limit=5000 --output out.mpf\n"
    "trunnion verify out.mpf --machine yl569 --cl part.cls --feed-limit 5000"
)
_SIMULATED: Final = _BATCH.replace("verify", "simulate --stock box:9,9,9 --tool 5=flat:10,length=60,flutes=30")
_BESIDE: Final = (
    f"mkdir in\ncp part.cls in/a.cls\n{_POST} --output in/a.mpf\n"
    "trunnion batch in --action verify --machine yl569 --results out --files *.mpf --cl /part.cls"
)
_TWICE: Final = "trunnion.post('part.cls', machine='yl569', units='mm', settings={'cl_units': 'mm'})"

CURES: Final = (
    script("ARG130 clamping_without_cl", f"{_POSTED} --turn 0.001", "--turn", "--cl part.cls --turn"),
    script("ARG130 fastest_feed_without_cl", f"{_POSTED} --feed fastest", "fastest", "fastest --cl part.cls"),
    script("ARG130 hooks_without_cl",
           f"write shop.py 'def on_block(block, context):\\n    return None\\n'\n{_POSTED} --hooks shop.py",
           "--hooks", "--cl part.cls --hooks"),
    script("ARG120 suggested_project", "trunnion post project.toml --suggest a.toml", " --suggest a.toml", ""),
    script("ARG130 file_jobs_states", f"{_JOBS} --action verify", " --action verify", ""),
    script("ARG130 machine_of_one_program",
           "trunnion fit part.mpf part.mpf --machines yl569 --turns 180 --machine yl569 --tool-length 100",
           "part.mpf part.mpf", "part.mpf"),
    script("ARG130 machine_of_one_program",
           "trunnion fit part.cls two.cls --machines yl569 --turns 180 --machine yl569",
           " --machine yl569", ""),
    script("ARG130 missing", _BATCH.replace(" --results out", ""), "--machine", "--results out --machine"),
    script("ARG130 missing_action", _BATCH.replace(" --action verify", ""), "--machine", "--action verify --machine"),
    script("ARG130 missing_machine_of_programs", _BATCH.replace(" --machine yl569", ""), "verify",
           "verify --machine yl569"),
    script("ARG130 missing_stock", _SIMULATED.replace("--stock box:9,9,9 ", ""), "--tool", "--stock box:9,9,9 --tool"),
    script("ARG130 missing_machine", _PLACE.replace(" --machine yl569", ""), "--turn", "--machine yl569 --turn"),
    script("ARG130 missing_machine_of_program", "trunnion verify part.mpf", "part.mpf", "part.mpf --machine yl569"),
    script("ARG130 missing_what_is_viewed", "trunnion view --output a.html --machine yl569", "view", "view part.mpf"),
    script("ARG130 no_cl_file", "trunnion.describe_cl([])", "[]", "['part.cls']"),
    script("ARG130 no_cl_file", "trunnion.post([], machine='yl569')", "[]", "['part.cls']"),
    script("ARG130 no_file", "trunnion.place([], machine='yl569', turns=[0])", "[]", "['part.cls']"),
    script("ARG130 not_for_manifest", f"{_MANIFEST} --feed fastest", " --feed fastest", ""),
    script("ARG130 not_for_manifest", f"{_MANIFEST} --feed fastest", "--feed fastest", "--cl part.cls"),
    script("ARG130 only_for_cl_files", "trunnion convert part.mpf --machine yl569 --to-cl --units mm", " --units mm",
           ""),
    script("ARG130 only_for_programs", "trunnion fit part.cls --machines yl569 --turns 180 --zero 0,0,0",
           " --zero 0,0,0", ""),
    script("ARG130 only_for_simulation", f"{_POST} {_CUBE} --output out.mpf", f" {_CUBE}", ""),
    script("ARG130 only_for_simulation", f"{_POST} {_CUBE} --output out.mpf", "--stock", "--simulate --stock"),
    script("ARG130 only_with_fastest_feed", _FASTEST, "--cl part.cls", "--cl part.cls --feed fastest"),
    script("ARG130 one_paper_for_several_programs", _SEVERAL,
           " --listing a.html", ""),
    script("ARG130 one_paper_for_several_programs", _SEVERAL,
           "part.cls two.cls --machine yl569 --output out", "part.cls --machine yl569 --output out/part.mpf"),
    script("ARG130 processes_computer_workers", f"{_BATCH} --scheduler tcp://localhost:1 --workers 2",
           "--scheduler tcp://localhost:1 ", ""),
    script("ARG130 scheduler", f"{_BATCH} --workers 1 --wait 5", " --wait 5", ""),
    script("ARG130 tls_without_scheduler", f"{_BATCH} --workers 1 --tls-ca part.mpf", " --tls-ca part.mpf", ""),
    script("ARG140 no_fusion_here", "trunnion fusion install", "install", "install --folder posts"),
    script("ARG130 simulations", f"{_BATCH} --workers 1 --tiles 2", " --tiles 2", ""),
    script("ARG130 project_among_files", "trunnion place project.toml two.cls --turn 0", " two.cls", ""),
    script("ARG130 setup_without_project", f"{_PLACE} --setup A", "part.cls --machine yl569 --turn 0 --setup A",
           "project.toml --turn 0"),
    script("ARG130 sheet_without_apply", f"{_PLACE} --sheet a.html", "--sheet", "--apply out.mpf --sheet"),
    script("ARG130 resolved_without_machine", "trunnion machines --resolved", "machines", "machines yl569"),
    script("ARG130 resolved_without_machine", "trunnion machines --resolved", "machines", "machines ours.toml"),
    script("ARG130 setting_too", _TWICE, ", settings={'cl_units': 'mm'}", ""),
    script("ARG130 setting_too", _TWICE, ", units='mm'", ""),
    script("ARG130 stdin_twice", "trunnion info - -", "info - -", "info part.cls"),
    script("ARG130 verified_without_columns", f"trunnion.write_report({_CALL}, 'a.html')", "columns=False",
           "columns=True"),
    script("ARG140 data_and_program_to_stdout", f"{_POST} --output - --json -", "--json -", "--json a.json"),
    script("ARG140 data_and_program_to_stdout", f"{_POST} --output - --json -", "--output -", "--output out.mpf"),
    script("ARG140 two_to_stdout", f"{_VERIFY} --report - --json -", "--report -", "--report a.html"),
    script("ARG140 file_name_too_long", f"{_VERIFY} --json {'a' * 300}", "a" * 300, "a.json"),
    script("ARG140 no_file_name", f"{_VERIFY} --json ''", "''", "a.json"),
    script("ARG140 is", f"{_SIMULATED} --tiles 99999", "99999", "2"),
    script("ARG140 no_mapping", "trunnion.post('part.cls', machine='yl569', settings=5)", "=5", "={'tolerance': 0.01}"),
    script("ARG140 no_name_of_setting", "trunnion.post('part.cls', machine='yl569', settings={5: 1})", "{5:",
           "{'tolerance':"),
    script("ARG140 no_name_beside", _BESIDE, "/part.cls", '"{folder}/{stem}.cls"'),
    script("ARG140 no_setting", f"{_POST} --set tolerance", "tolerance", "tolerance=0.01"),
    script("ARG140 no_switch", "trunnion.post('part.cls', machine='yl569', strict='yes')", "'yes'", "False"),
    script("ARG140 no_tolerance", "trunnion.diff('part.mpf', 'part.mpf', machine='yl569', tolerance='x')", "'x'",
           "0.001"),
    script("ARG140 not_of_kind", f"{_VERIFY} --tolerance x", "--tolerance x", "--tolerance 0.1"),
    script("ARG140 too_many_orientations", "trunnion place part.cls --machine yl569 --turns 0.1 --tilt 5 --tilt 10",
           "--turns 0.1", "--turns 180"),
    script("ARG140 unknown_word", f"{_VERIFY} --frame x", "--frame x", "--frame first"),
    script("ARG140 unknown_word_but_near", f"{_VERIFY} --frame frist", "frist", "first"),
    script("ARG140 unusable", "trunnion.read_cl(None)", "None", "'part.cls'"),
    script("ARG140 unusable_type", "trunnion.read_cl([])", "[]", "'part.cls'"),
    script("ARG170 subprograms_after_reading", _READ[:-1] + ", subprograms=['SUB.SPF'])", ", subprograms=['SUB.SPF']",
           ""),
    script("ARG170 read_for_other_machine", _READ[:-8] + "'dmu65')", "'dmu65'", "'yl569'"),
    script("ARG170 read_with_other_setup", _READ[:-1] + ", zero=(1, 2, 3))",
           "trunnion.read_program('part.mpf', machine='yl569')", "'part.mpf'"),
    script("ARG190 dialect_of_written",
           "trunnion convert part.mpf --machine yl569 --to-cl --output a.cls --dialect clsf", "--dialect",
           "--to-dialect"),
    script("ARG190 earlier_option", f"{_VERIFY} --offset G54", "--offset", "--work-offset"),
)  # fmt: skip
