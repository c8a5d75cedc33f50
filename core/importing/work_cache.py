"""Finished sentences of an import, kept until its database is written, so that a killed import goes on."""

from __future__ import annotations

import hashlib
import json
import zipfile
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from core.batch.stamps import stamp
from core.importing.plan import ImportPlan, SentencePlan
from core.importing.report import SentenceReport
from core.importing.sentence_work import WorkedSentence
from core.importing.sound_offset import OffsetEstimate
from core.media.swap_in import swapped_in
from core.motion.recording import Recording
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance

# Raised whenever the work on a sentence changes.
_VERSION = 2
_UNREADABLE = (OSError, ValueError, KeyError, TypeError, IndexError, EOFError, zipfile.BadZipFile)


@dataclass(frozen=True)
class KeptSentence:
    """What of `WorkedSentence` the build needs."""

    recording: Recording
    report: SentenceReport
    offset: OffsetEstimate | None


def cache_path(folder: Path, plan: ImportPlan, sentence: SentencePlan) -> Path:
    """Return where the work on ``sentence`` is kept; the name changes with its files and with all that steers it."""
    steering = asdict(replace(plan, sentences=(sentence,), name="", offsets="keep", rate_hz=120.0, n_dims=25,
                              hold_out=""))  # fmt: skip
    files = (sentence.motion, sentence.audio, sentence.transcript, plan.lexicon, plan.like, plan.reading.shape_names,
             plan.reading.shape_sheet)  # fmt: skip
    stamps = [(str(Path(f).resolve()), *stamp(Path(f))) for f in files if f is not None]
    text = json.dumps([_VERSION, steering, stamps], sort_keys=True)
    return folder / f"{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"


def keep(path: Path, worked: WorkedSentence) -> None:
    """Write the work on a sentence, whole or not at all."""
    recording, transcript = worked.recording, worked.recording.transcript
    told = {
        "marker_names": recording.marker_names, "rate_hz": recording.rate_hz, "text": recording.text,
        "phonemes": [[u.phone, u.start_s, u.end_s] for u in transcript.phonemes],
        "words": [[w.word, w.start_s, w.end_s] for w in transcript.words],
        "duration_s": transcript.duration_s, "warnings": transcript.warnings, "report": asdict(worked.report),
        "offset": None if worked.offset is None else [worked.offset.offset_s, worked.offset.confidence],
    }  # fmt: skip
    curve = np.zeros((2, 0)) if worked.offset is None else np.stack([worked.offset.lags_s, worked.offset.agreement])
    with swapped_in(path) as beside, beside.open("wb") as file:
        np.savez(file, positions=recording.positions, curve=curve, told=np.array(json.dumps(told)))


def kept(path: Path, sentence: SentencePlan) -> KeptSentence | None:
    """Return the work that was kept, or None when there is none that is whole."""
    if not path.is_file():
        return None
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            positions, curve, told = archive["positions"], archive["curve"], json.loads(str(archive["told"]))
        report = told["report"]
        transcript = Transcript(
            tuple(PhonemeUtterance(*u) for u in told["phonemes"]), tuple(WordUtterance(*w) for w in told["words"]),
            told["duration_s"], tuple(told["warnings"]),
        )  # fmt: skip
        recording = Recording(
            sentence.name, sentence.emotion, positions, tuple(told["marker_names"]), told["rate_hz"], transcript,
            told["text"], None if sentence.audio is None else Path(sentence.audio),
        )  # fmt: skip
        offset = None if told["offset"] is None else OffsetEstimate(*told["offset"], *curve)
        return KeptSentence(recording, SentenceReport(**{**report, "notes": tuple(report["notes"])}), offset)
    except _UNREADABLE:
        return None
