"""The plan that the assistant's pages fill in, and what was learnt of its files meanwhile."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QUndoCommand, QUndoStack

from app.jobs import JobRunner
from app.panels.importing.captures import CaptureFacts, read_facts
from app.texts import importing as texts
from core.actress.corpus import actress_marker_set
from core.errors import UserFacingError
from core.importing.plan import ImportPlan, Reading, SentencePlan, read_plan, write_plan
from core.importing.proposals import with_proposals
from core.importing.survey import Survey, survey
from core.progress import Progress


class ImportDraft(QObject):
    """One plan, changed by whole plans, so that undo is the plan before.

    changed() : the plan is another; learnt() : something was read from its files; measured() : a page knows more
    current : name of the sentence that the pages speak of
    failed(sentence, remedy), noted(sentence) : for the window
    """

    changed = Signal()
    learnt = Signal()
    measured = Signal()
    failed = Signal(str, str)
    noted = Signal(str)

    def __init__(self, jobs: JobRunner, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.jobs = jobs
        self.plan: ImportPlan | None = None
        self.survey: Survey | None = None
        self.facts: dict[str, CaptureFacts] = {}
        self.current = ""
        self.undo_stack = QUndoStack(self)
        self._paths: tuple[Path, ...] = ()
        jobs.failed.connect(self.failed)

    @property
    def sentences(self) -> tuple[SentencePlan, ...]:
        """What is imported so far."""
        return () if self.plan is None else self.plan.sentences

    @property
    def folder(self) -> Path | None:
        """Where the first capture lies."""
        return Path(self.sentences[0].motion).parent if self.sentences else None

    # Files

    def add_files(self, paths: Iterable[Path]) -> None:
        """Look at more files and folders, together with those that were chosen before."""
        self._paths = tuple(dict.fromkeys((*self._paths, *paths)))
        self.jobs.start("survey", texts.SURVEYING, self._paths, _look, self._on_surveyed, self._on_refused)

    def start_over(self) -> None:
        """Forget all files."""
        self.jobs.cancel("survey")
        self._paths, self.survey = (), None
        self._take(None)
        self.undo_stack.clear()

    def _on_refused(self, error: UserFacingError) -> None:
        self._paths = self._paths[:-1] if self.plan is not None else ()
        self.failed.emit(error.message, error.remedy)

    def _on_surveyed(self, found: _Found) -> None:
        self.survey = found.survey
        if found.plan is None:
            self._paths = ()
            self.failed.emit(texts.NO_MOTION, texts.NO_MOTION_REMEDY)
            return
        if self.plan is None:
            self._take(found.plan)
        else:  # what was decided stays; only sentences are added
            known = {s.name for s in self.sentences}
            added = tuple(s for s in found.plan.sentences if s.name not in known)
            self.change(texts.EDIT_FILES, sentences=(*self.sentences, *added))
        if found.trouble is not None:
            self.failed.emit(*found.trouble)
        self.read_facts()

    def set_reading(self, reading: Reading) -> None:
        """Read all files otherwise."""
        if self.plan is not None and reading != self.plan.reading:
            self.change(texts.EDIT_READING, reading=reading)
            self.facts = {}
            self.read_facts()

    def read_facts(self) -> None:
        """Read rate, frames and markers of every sentence that is not known yet."""
        unknown = tuple(s for s in self.sentences if s.name not in self.facts)
        if unknown:
            request = unknown, self.plan.reading
            self.jobs.start("facts", texts.READING, request, read_facts, self._on_facts)

    def _on_facts(self, facts: Mapping[str, CaptureFacts]) -> None:
        self.facts.update(facts)
        self.learnt.emit()
        if not self.plan.rigid and not self.plan.landmarks and self.first_facts() is not None:
            self.jobs.start("propose", texts.MATCHING, self.plan, _proposals, self._on_proposals)

    def _on_proposals(self, proposed: ImportPlan) -> None:
        names = ("markers", "origin", "rigid", "groups", "landmarks", "reading")
        axes_before = self.plan.reading.axes
        self.change(texts.EDIT_PROPOSALS, **{name: getattr(proposed, name) for name in names})
        if self.plan.reading.axes != axes_before:
            self.facts = {}
            self.read_facts()

    def first_facts(self) -> CaptureFacts | None:
        """Return what is known of the first sentence that can be read."""
        known = (self.facts.get(s.name) for s in self.sentences)
        return next((facts for facts in known if facts is not None and not facts.problem), None)

    # The plan

    def change(self, label: str, **fields: object) -> None:
        """Change fields of the plan; one entry of the undo stack, none when nothing changes."""
        after = replace(self.plan, **fields)
        if after != self.plan:
            self.undo_stack.push(_PlanChange(self, self.plan, after, label))

    def change_sentences(self, names: Iterable[str], label: str, **fields: object) -> None:
        """Change fields of some sentences."""
        chosen = set(names)
        self.change(label, sentences=tuple(replace(s, **fields) if s.name in chosen else s for s in self.sentences))

    def remove_sentences(self, names: Iterable[str]) -> None:
        """Leave sentences out."""
        gone = set(names)
        self.change(texts.EDIT_LEAVE_OUT, sentences=tuple(s for s in self.sentences if s.name not in gone))

    def show(self, plan: ImportPlan | None) -> None:
        """Make ``plan`` the plan; for the undo stack."""
        self.plan = plan
        self.changed.emit()

    def _take(self, plan: ImportPlan | None) -> None:
        self.facts = {}
        self.undo_stack.clear()
        self.show(plan)

    def load(self, path: Path) -> None:
        """Go on with a plan that was saved."""
        try:
            plan = read_plan(path)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self._paths = ()
        self._take(plan)
        self.noted.emit(texts.PLAN_LOADED.format(path=path))
        self.read_facts()

    def save(self, path: Path) -> None:
        """Keep the plan in a file, for another day or the command line."""
        try:
            write_plan(self.plan, path)
        except UserFacingError as error:
            self.failed.emit(error.message, error.remedy)
            return
        self.noted.emit(texts.PLAN_SAVED.format(path=path))


class _PlanChange(QUndoCommand):
    def __init__(self, draft: ImportDraft, before: ImportPlan, after: ImportPlan, label: str) -> None:
        super().__init__(label)
        self._draft, self._before, self._after = draft, before, after

    def redo(self) -> None:
        """See `QUndoCommand`."""
        self._draft.show(self._after)

    def undo(self) -> None:
        """See `QUndoCommand`."""
        self._draft.show(self._before)


@dataclass(frozen=True)
class _Found:
    survey: Survey
    plan: ImportPlan | None
    trouble: tuple[str, str] | None = None


def _look(paths: tuple[Path, ...], progress: Progress) -> _Found:
    """Survey the files and propose what they leave open, as `efase import` does; a job."""
    found = survey(paths, progress.part(0.0, 0.5))
    if not found.sentences:
        return _Found(found, None)
    plan = found.plan(paths[0].resolve().stem)
    if plan.rigid and plan.landmarks:
        return _Found(found, plan)
    progress.step(0.5, texts.MATCHING)
    try:
        return _Found(found, _proposals(plan, progress))
    except UserFacingError as error:
        return _Found(found, plan, (error.message, error.remedy))


def _proposals(plan: ImportPlan, _progress: Progress) -> ImportPlan:
    return with_proposals(plan, actress_marker_set())
