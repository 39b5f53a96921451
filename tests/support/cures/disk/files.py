"""Cures of messages about files: those that are read, and those that are written."""

from typing import Final

from tests.support.cures.cure import Cure
from tests.support.cures.scripts import script

_POST: Final = "trunnion post part.cls --machine yl569"
_OUT: Final = f"{_POST} --output out.mpf"
_EDITED: Final = f"{_OUT}\nappend out.mpf ;EDITED\n{_OUT}"
_FOREIGN: Final = f"write out.mpf M30\n{_OUT}"
_NEXT: Final = _OUT.replace("part.cls", "two.cls")
_BOTH: Final = "trunnion post part.cls a/part.cls --machine yl569 --output out"
_DIVIDED: Final = "trunnion post part.cls --machine matsuura_mx330 --output out.nc --set programs=operations"
_NAMED: Final = _DIVIDED.replace("matsuura_mx330", "yl569").replace("out.nc", "out.mpf")
_INFO: Final = "trunnion info part.cls --json a.json"
_BACKSLASH: Final = "'a\\b.cls'"
_MANIFEST: Final = f"{_OUT} --manifest out.json"


def _manifest(variant: str, pattern: str, new: str) -> Cure:
    """A manifest in which something is changed, and the one that the post has written."""
    text = f"{_MANIFEST}\ncp out.json other.json\nedit other.json '{pattern}' '{new}'\ntrunnion verify other.json"
    return script(f"FIL330 {variant}", text, "verify other.json", "verify out.json")


CURES: Final = (
    script("FIL110 file_not_found", "trunnion verify other.mpf --machine yl569", "other.mpf", "part.mpf"),
    script("FIL110 ", "trunnion verify other.mpf --machine yl569", "other.mpf", "part.mpf"),
    script("FIL110 no_such_folder", "trunnion batch in --action verify --machine yl569 --results out", "trunnion batch",
           "mkdir in\ncp part.mpf in/a.mpf\ntrunnion batch"),
    script("FIL130 folder_not", "mkdir in\ntrunnion verify in --machine yl569", "verify in", "verify part.mpf"),
    script("FIL140 cannot_unpacked", "write part.zip 'PK\x03\x04 damaged'\ntrunnion info part.zip", "info part.zip",
           "info part.cls"),
    script("FIL150 tar_archive_not", "tar part.tar part.cls\ntrunnion info part.tar", "info part.tar", "info part.cls"),
    script("FIL150 tar_archive_not", "tar part.tar part.cls\ntrunnion info part.tar",
           "tar part.tar part.cls\ntrunnion info part.tar",
           "zip part.zip part.cls\ntrunnion info part.zip"),
    script("FIL150 not_read", "zip in.zip part.cls\nzip part.zip in.zip\ntrunnion info part.zip", "info part.zip",
           "info in.zip"),
    script("FIL180 empty", "zip part.zip\ntrunnion info part.zip", "zip part.zip", "zip part.zip part.cls"),
    script("FIL180 no_cl_file", "append part.mpf ''\nzip part.zip part.mpf\ntrunnion info part.zip",
           "zip part.zip part.mpf", "zip part.zip part.cls"),
    script("FIL180 one_cl_files", "zip part.zip part.cls two.cls\ntrunnion.read_cl('part.zip')", "read_cl",
           "describe_cl"),
    script("FIL180 one_cl_files", "zip part.zip part.cls two.cls\ntrunnion.read_cl('part.zip')", "'part.zip'",
           "'part.cls'"),
    script("FIL190 no_stream", "trunnion.post('part.cls', machine='yl569', output=type('', (), {'write': 5}))",
           "output=type('', (), {'write': 5})", "output=io.BytesIO()"),
    script("FIL190 stream_text", "trunnion.read_cl(io.StringIO('A'))", "io.StringIO('A')",
           "Path('part.cls').open('rb')"),
    script("FIL190 takes_text", "trunnion.post('part.cls', machine='yl569', output=io.StringIO())", "StringIO",
           "BytesIO"),
    script("FIL210 cannot_written_folder",
           "mkdir out.mpf\ntrunnion.post('part.cls', machine='yl569', output='out.mpf')",
           "output='out.mpf'", "output='out.mpf/a.mpf'"),
    script("FIL220 no_folder_for_results", f"{_POST} --output out/", "trunnion", "mkdir out\ntrunnion"),
    script("FIL220 no_folder_for_results", f"{_POST} --output out/", "out/", "out.mpf"),
    script("FIL210 cannot_name_file", "trunnion.post('part.cls', machine='yl569', output='a\\0b.mpf')", "a\\0b", "ab"),
    script("FIL220 cannot_written_no", f"{_POST} --output out/a.mpf", "trunnion", "mkdir out\ntrunnion"),
    script("FIL220 cannot_written_no", f"{_POST} --output out/a.mpf", "out/a.mpf", "a.mpf"),
    script("FIL220 no_folder_for_programs", f"{_POST.replace('part.cls', 'part.cls two.cls')} --output out", "trunnion",
           "mkdir out\ntrunnion"),
    script("FIL220 no_folder_for_programs", f"{_POST.replace('part.cls', 'part.cls two.cls')} --output out",
           "--output out", "--output out.mpf"),
    script("FIL240 would_written_over", f"{_POST} --output part.cls", "--output part.cls", "--output out.mpf"),
    script("FIL240 would_written_twice", f"{_OUT} --report a.json --json a.json", "--json a.json", "--json b.json"),
    script("FIL240 over_program_of_other", f"mkdir out\nmkdir a\ncp part.cls a/part.cls\n{_BOTH}",
           "cp part.cls a/part.cls\n" + _BOTH,
           "cp part.cls a/other.cls\n" + _BOTH.replace("a/part", "a/other")),
    script("FIL250 kept", f"{_FOREIGN} --set edited=keep\n{_OUT}", f"{_FOREIGN} --set edited=keep\n", ""),
    script("FIL250 edited_since", _EDITED, f"EDITED\n{_OUT}", f"EDITED\n{_OUT} --set edited=keep"),
    script("FIL250 edited_since", _EDITED, f"EDITED\n{_OUT}", f"EDITED\n{_OUT} --set edited=replace"),
    script("FIL250 edited_since", _EDITED, f"EDITED\n{_OUT}", f"EDITED\n{_POST} --output other.mpf"),
    script("FIL250 of_somebody_else", _FOREIGN, _OUT, f"{_OUT} --set edited=keep"),
    script("FIL250 of_somebody_else", _FOREIGN, _OUT, f"{_OUT} --set edited=replace"),
    script("FIL250 of_somebody_else", _FOREIGN, _OUT, f"{_POST} --output other.mpf"),
    script("FIL250 no_such_output", f"{_OUT} --listing two.cls", "--listing two.cls", "--listing two.lst"),
    script("FIL250 no_such_output", f"write a.html ours\n{_OUT} --report a.html", "write a.html ours\n", ""),
    script("FIL250 of_another_command", f"trunnion verify part.mpf --machine yl569 --report a.json\n{_INFO}", _INFO,
           _INFO.replace("a.json", "b.json")),
    script("FIL250 definition_exists", "write mill.toml 'x = 5'\ntrunnion new mill.toml --like yl569", "new mill.toml",
           "new mine.toml"),
    script("FIL260 other_ending", "trunnion verify part.mpf --machine yl569 --report a.txt", "a.txt", "a.html"),
    script("FIL270 several_files_without_output", _POST.replace("part.cls", "part.cls two.cls"), "yl569",
           "yl569 --output out.mpf"),
    script("FIL270 several_files_without_output", f"mkdir out\n{_POST.replace('part.cls', 'part.cls two.cls')}",
           "yl569", "yl569 --output out"),
    script("FIL280 file_left_over", f"{_OUT} --listing a.html\n{_NEXT}", _NEXT, f"{_NEXT} --listing a.html"),
    script("FIL280 file_left_over", f"{_OUT} --listing a.html\n{_NEXT}", _NEXT, f"rm a.html\n{_NEXT}"),
    script("FIL280 files_left_over", f"{_OUT} --listing a.html --report b.html\n{_NEXT}", _NEXT,
           f"rm a.html\nrm b.html\n{_NEXT}"),
    script("FIL280 files_left_over", f"{_OUT} --listing a.html --report b.html\n{_NEXT}", _NEXT,
           f"{_NEXT} --listing a.html --report b.html"),
    script("FIL320 project_elsewhere", f"mkdir a\n{_OUT} --suggest a/part.toml", "a/part.toml", "part.toml"),
    script("FIL320 manifest_elsewhere", f"mkdir a\n{_OUT} --manifest a/out.json", "a/out.json", "out.json"),
    script("FIL320 never_in_project",
           f"cp part.cls 'a\\b.cls'\n{_OUT.replace('part.cls', _BACKSLASH)} --suggest a.toml", "a\\b.cls", "b.cls"),
    _manifest("no_list_of_files", "^.*$", "[]"),
    _manifest("no_files", r'"files": \[.*?\]', '"files": []'),
    _manifest("no_such_list", r'"files": \[.*?\]', '"files": 5'),
    _manifest("other_schema", '"schema": [0-9]+', '"schema": 99'),
    _manifest("nothing_of_a_post", '"what": "program"', '"what": "song"'),
    _manifest("no_name_beside", '"name": "out.mpf"', '"name": "../out.mpf"'),
    _manifest("other_program", '"program": "out.mpf"', '"program": "b.mpf"'),
    _manifest("no_cl_files", r'"cl": \[.*?\]', '"cl": []'),
    _manifest("checks_contradict", r'"overruled": \[.*?\]', '"overruled": ["tip"]'),
    _manifest("file_twice", r'"files": \[(.*?)\]', r'"files": [\1, {"name": "out.mpf", "what": "report", "bytes": 1}]'),
    script("FIL340 not_on_every_system", "trunnion new 'our mill?.toml' --like yl569", "'our mill?.toml'",
           "our_mill.toml"),
    script("FIL340 name_of_shipped_machine", "trunnion new dmu65.toml --like yl569", "dmu65.toml", "our_dmu65.toml"),
    script("FIL250 number_of_other_file", f"write O1001.nc M30\n{_DIVIDED}", "write O1001.nc M30\n", ""),
    script("FIL250 number_of_other_file", f"write O1001.nc M30\n{_DIVIDED}", _DIVIDED,
           f"{_DIVIDED} --set first_number=2001"),
    script("FIL250 name_of_other_file", f"write OP1.spf M30\nwrite OP1.SPF M30\n{_NAMED}",
           "write OP1.spf M30\nwrite OP1.SPF M30\n", ""),
)  # fmt: skip
