"""Places in a program that is not written, told so that its user finds them: by the names that its files would have,
and where the text of a template of theirs stands, by the template and its line in the definition.

In:     errors and findings with places in the hidden files in which a program is made.
Out:    the same, as they are told.
"""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import field, replace

from trunnion.errors import InputError, Problem
from trunnion.jobs.result_output import Target
from trunnion.messages import Wording, phrase
from trunnion.model.template_passage import TemplatePassage
from trunnion.output.changed_words import Changer
from trunnion.records import dataclass
from trunnion.verification import Check, Place, Verification


@dataclass(frozen=True, slots=True, eq=False)
class ProgramPlaces:
    """What is known of the places of a program.

    passages  takes where texts of templates stand while it is written
    changers  takes which functions have changed words, by file and line of the CL file
    """

    target: Target
    passages: list[TemplatePassage] = field(default_factory=list)
    changers: dict[tuple[str, int], Changer] = field(default_factory=dict)

    @contextmanager
    def told(self) -> Iterator[None]:
        """Tell what a reader cannot follow by the names of the files, and by the template that has written it."""
        try:
            yield
        except InputError as error:
            raise InputError([self._told(problem) for problem in error.problems]) from error

    def _told(self, problem: Problem) -> Problem:
        files = self.target.files
        beside = {str(path): path.name for path in files.other_paths}
        if problem.file == str(files.path):
            return self._by_template(replace(problem, file=self.target.name), "")
        if problem.file in beside:
            name = beside[problem.file]
            return self._by_template(replace(problem, file=name), name)
        return problem

    def _by_template(self, problem: Problem, file: str) -> Problem:
        written = self._written_by(file, problem.line)
        return replace(problem, wording=problem.wording.within("with_note", note=written)) if written else problem

    def explained(self, verification: Verification) -> Verification:
        """Return findings of checks that failed, with the template that has written their blocks."""
        if not self.passages and not self.changers:
            return verification
        checks = tuple(check if check.passed else self._checked(check) for check in verification.checks)
        return replace(verification, checks=checks)

    def _checked(self, check: Check) -> Check:
        return replace(check, places=tuple(self._place(place) for place in check.places))

    def _place(self, place: Place) -> Place:
        written = self._written_by(place.nc_file, place.nc_line)
        if not written and (by := self.changers.get((place.cl_file, place.cl_line))) is not None:
            written = phrase("words_changed", source=by.title, file=by.file, line=by.line).what
        return replace(place, wording=place.wording.within("with_note", note=written)) if written else place

    def _written_by(self, file: str, line: int) -> str:
        for passage in self.passages:
            text = passage.text_at(file, line)
            if text is not None:
                return phrase("text_of_template", text=text.strip(), **_named(passage)).what
        return ""

    def cause(self, checks: Sequence[Check]) -> Wording | None:
        """Which template is likely to have made checks fail, a phrase; None if none of the user's is near."""
        places = [place for check in checks if not check.passed for place in check.places if place.nc_line]
        for place in places:
            for passage in self.passages:
                if passage.text_at(place.nc_file, place.nc_line) is not None:
                    return phrase("block_of_template", block=place.block_name, **_named(passage))
        for place in places:
            if (by := self.changers.get((place.cl_file, place.cl_line))) is not None:
                named = {"source": by.title, "file": by.file, "line": by.line}
                return phrase("words_of_block_changed", block=place.block_name, **named)
        if self.changers:
            by = next(iter(self.changers.values()))
            return phrase("words_of_program_changed", source=by.title, file=by.file, line=by.line)
        if not places:
            return None
        first = min(places, key=lambda each: (each.nc_file, each.nc_line))
        above = [each for each in self.passages if each.file == first.nc_file and each.line < first.nc_line]
        if not above:
            return None
        nearest = max(above, key=lambda each: each.line)
        return phrase("block_below_template", block=first.block_name, **_named(nearest))


def _named(passage: TemplatePassage) -> dict[str, object]:
    """Return the parameters by which messages name the template of a passage."""
    file, line = passage.source
    return {"source": passage.title, "file": file, "line": line}
