"""What is known of the speech of each sentence: where its words are, how late its motion is, how sure both are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.panels.importing.draft import ImportDraft
from app.texts import importing as texts
from core.errors import UserFacingError
from core.folders import cache_dir, data_dir
from core.importing.plan import ImportPlan, SentencePlan
from core.importing.report import SentenceReport
from core.importing.run import SURE, prepare
from core.importing.sound_offset import OffsetEstimate, mouth_opening, pooled_offset
from core.importing.work_cache import KeptSentence
from core.media.audio import load_audio
from core.progress import Progress
from core.speech.placing import GIVEN
from core.speech.second_listening import AlignmentConfidence, listen_again
from core.speech.textgrid import write_textgrid
from core.speech.transcript import Transcript

_AT_ONCE = 8
_KEPT = "import"


@dataclass(frozen=True)
class SpeechFacts:
    """The speech of one sentence.

    key : what it was worked out from; failure : why the sentence cannot be imported, or ""
    transcript, alignment : the words, and how they were placed (``given``, ``aligned``, ``recognised``, ``silence``)
    opening_mm : shape (n_frames,); offset : None where there is nothing to compare
    """

    key: object
    failure: str = ""
    transcript: Transcript | None = None
    alignment: str = ""
    opening_mm: np.ndarray | None = None
    rate_hz: float = 0.0
    offset: OffsetEstimate | None = None


class SpeechWork(QObject):
    """Works on sentences in the background, with the import's own cache, so that the build finds it done.

    renewed() : more is known
    """

    renewed = Signal()

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__(draft)
        self._draft = draft
        self.facts: dict[str, SpeechFacts] = {}
        self.confidence: dict[str, AlignmentConfidence] = {}

    def known(self, name: str) -> SpeechFacts | None:
        """Return what is known of a sentence as it is planned now."""
        sentence = next((s for s in self._draft.sentences if s.name == name), None)
        facts = self.facts.get(name)
        return facts if facts is not None and sentence and facts.key == key_of(self._draft.plan, sentence) else None

    def ask(self) -> None:
        """Work on what is not known yet."""
        plan = self._draft.plan
        unknown = tuple(s for s in plan.sentences if self.known(s.name) is None)
        if unknown and not self._draft.jobs.is_running("speech work"):
            request = replace(plan, sentences=unknown)
            self._draft.jobs.start("speech work", texts.WORKING_SPEECH, request, _work, self._on_worked)

    def _on_worked(self, found: Mapping[str, SpeechFacts]) -> None:
        for name, facts in found.items():
            before = self.facts.get(name)
            if before is None or before.transcript != facts.transcript:
                self.confidence.pop(name, None)
        self.facts.update(found)
        self.renewed.emit()

    def listen(self) -> None:
        """Judge the alignments, one sentence after the other, so that the list fills while it goes on."""
        if self._draft.jobs.is_running("listen"):
            return
        speaks = [s for s in self._draft.sentences if s.audio and (f := self.known(s.name)) and f.transcript
                  and any(u.phone != "pau" for u in f.transcript.phonemes)]  # fmt: skip
        waiting = [s for s in speaks if s.name not in self.confidence]
        if waiting:
            done = len(speaks) - len(waiting) + 1
            title = f"{texts.LISTENING_AGAIN} ({done}/{len(speaks)})"
            request = waiting[0], self.facts[waiting[0].name].transcript
            self._draft.jobs.start("listen", title, request, _listen, self._on_listened)

    def _on_listened(self, answer: tuple[str, AlignmentConfidence]) -> None:
        self.confidence[answer[0]] = answer[1]
        self.renewed.emit()
        self.listen()

    @property
    def session(self) -> OffsetEstimate | None:
        """The one offset of all sentences."""
        known = (self.known(s.name) for s in self._draft.sentences)
        return pooled_offset([f.offset for f in known if f is not None and f.offset is not None])

    def taken_out_s(self, sentence: SentencePlan) -> float:
        """Return what the build will shift a sentence by: its own offset, and what was measured and is sure."""
        facts = self.known(sentence.name)
        measured = {"keep": None, "session": self.session, "each": None if facts is None else facts.offset}
        found = measured[self._draft.plan.offsets]
        return sentence.offset_s + (found.offset_s if found is not None and found.confidence >= SURE else 0.0)

    def accept(self, name: str, transcript: Transcript) -> None:
        """Keep a reviewed alignment: it is written beside the user's other data, and the plan names it."""
        folder = data_dir() / "alignments" / self._draft.plan.name
        path = folder / f"{name}.TextGrid"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            write_textgrid(transcript, path)
        except (OSError, UserFacingError):
            self._draft.failed.emit(texts.CANNOT_KEEP.format(folder=folder), "")
            return
        before = self.facts[name]
        if before.transcript != transcript:
            self.confidence.pop(name, None)
        self._draft.change_sentences([name], texts.EDIT_ALIGNMENT, transcript=str(path))
        sentence = next(s for s in self._draft.sentences if s.name == name)
        self.facts[name] = replace(before, key=key_of(self._draft.plan, sentence), transcript=transcript,
                                   alignment=GIVEN)  # fmt: skip

    def is_accepted(self, sentence: SentencePlan) -> bool:
        """Whether its alignment was reviewed here."""
        return sentence.transcript is not None and sentence.transcript.startswith(str(data_dir() / "alignments"))


def key_of(plan: ImportPlan, sentence: SentencePlan) -> object:
    """Return all that the work on a sentence depends on, to be compared."""
    return (replace(sentence, emotion="neutral", offset_s=0.0), dict(plan.markers), dict(plan.landmarks), plan.rigid,
            plan.with_scale, plan.reading, plan.mending, plan.lexicon, plan.like)  # fmt: skip


def _work(plan: ImportPlan, progress: Progress) -> dict[str, SpeechFacts]:
    """Read, mend and align; a few sentences at once, for memory."""
    found = {}
    n = len(plan.sentences)
    for first in range(0, n, _AT_ONCE):
        few = replace(plan, sentences=plan.sentences[first : first + _AT_ONCE])
        stage = progress.part(first / n, min(first + _AT_ONCE, n) / n)
        worked, _ = prepare(few, cache_dir() / _KEPT, stage)
        for sentence, each in zip(few.sentences, worked):
            found[sentence.name] = _facts(plan, sentence, each)
    return found


def _facts(plan: ImportPlan, sentence: SentencePlan, worked: KeptSentence | SentenceReport) -> SpeechFacts:
    key = key_of(plan, sentence)
    if isinstance(worked, SentenceReport):
        return SpeechFacts(key, worked.failure)
    recording = worked.recording
    names = recording.marker_names
    lips = [names.index(plan.landmarks[lip]) if plan.landmarks.get(lip) in names else None
            for lip in ("upper_lip", "lower_lip")]  # fmt: skip
    opening = mouth_opening(recording.positions, *lips)
    return SpeechFacts(key, "", recording.transcript, worked.report.alignment, opening, recording.rate_hz,
                       worked.offset)  # fmt: skip


def _listen(request: tuple[SentencePlan, Transcript], progress: Progress) -> tuple[str, AlignmentConfidence]:
    sentence, transcript = request
    return sentence.name, listen_again(load_audio(Path(sentence.audio)), transcript, progress)
