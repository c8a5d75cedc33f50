"""Edits at random, and a process that makes them into a project file until it is killed."""

from __future__ import annotations

import random
import sys
import threading
from concurrent.futures import Future
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import MappingProxyType

import numpy as np

from core.document.change import Change
from core.document.content import ProjectContent
from core.document.curation_edits import RemoveMotionNodes, RestoreMotionNodes
from core.document.document import Document, Edit
from core.document.edits import (
    FieldEdit,
    PinMotionNode,
    SetControls,
    SetEmotion,
    SetEngine,
    SetFace,
    SetHolds,
    SetOutput,
    SetPolish,
    SetReferenceVideo,
    SetSpeech,
)
from core.document.parts import FaceChoice, ReferenceVideo, Speech
from core.document.project_file import ProjectFile
from core.document.project_writer import ProjectWriter
from core.document.transcript_edits import MergePhonemes, MovePhonemeBoundary, RenamePhoneme, SplitPhoneme
from core.errors import UserFacingError
from core.media.audio import Audio
from core.motion.curation import Removal
from core.search.weights import SearchWeights
from core.speech.emotion import EMOTIONS
from core.speech.emotion_painting import erased, painted
from core.speech.phoneme import PHONEMES
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.synthesis.control_edits import ControlKey
from core.synthesis.polish import REGIONS
from core.synthesis.registry import ENGINES

RATE_HZ = 8000


def made_speech(seed: int, n_phones: int = 9) -> Speech:
    """Return noise with phones of 0.1 s, reproducibly."""
    rng = np.random.default_rng(seed)
    phones = [str(p) for p in rng.choice(PHONEMES, n_phones)]
    utterances = [PhonemeUtterance(phone, 0.1 * i, 0.1 * (i + 1)) for i, phone in enumerate(phones)]
    duration_s = round(0.1 * n_phones, 6)
    transcript = Transcript.covering(utterances, [WordUtterance("word", 0.1, 0.4)], duration_s)
    samples = (rng.integers(-90, 90, round(duration_s * RATE_HZ)) / 32768).astype(np.float32)
    return Speech(Audio(samples, RATE_HZ, Path(f"speech-{seed}.wav")), transcript, f"text {seed} ✓")


def random_edit(document: Document, chance: random.Random) -> Edit | None:
    """Return an edit of ``document``; None where the one that was drawn cannot be."""
    n_slots = 0 if document.speech is None else len(document.speech.transcript.phonemes)
    slot, node = chance.randrange(max(n_slots, 1)), f"s{chance.randrange(8)}:{chance.randrange(12)}"
    times_s = sorted(chance.uniform(0.0, 1.0) for _ in range(2))
    nodes = [f"s{chance.randrange(8)}:{chance.randrange(12)}" for _ in range(chance.randrange(1, 4))]
    only_here = chance.random() < 0.5
    makers = [
        lambda: PinMotionNode.on(document, slot, chance.choice((node, node, None))),
        lambda: SetEmotion.on(
            document,
            painted(document.modifiers, *times_s, chance.choice(EMOTIONS), round(chance.random(), 2)),
            "Paint",
            chance.choice((None, 1)),
        ),
        lambda: SetEmotion.on(document, erased(document.modifiers, *times_s), "Erase"),
        lambda: MovePhonemeBoundary.on(document, slot, chance.uniform(0.0, 1.0), chance.choice((None, 2))),
        lambda: RenamePhoneme.on(document, slot, chance.choice(PHONEMES)),
        lambda: SplitPhoneme.on(document, slot),
        lambda: MergePhonemes.on(document, slot),
        lambda: RemoveMotionNodes.on(document, nodes, Removal("me", "2026-01-01T00:00:00+00:00", "spike"), only_here),
        lambda: RestoreMotionNodes.on(document, nodes, only_here),
        lambda: SetFace.on(document, chance.choice((None, FaceChoice("ben"), FaceChoice("a.obj", "a.csv")))),
        lambda: SetReferenceVideo.on(document, ReferenceVideo("actor.mp4", chance.uniform(-1, 1)), 3),
        lambda: SetOutput.on(document, replace(document.output, start_frame=chance.randrange(100))),
        lambda: SetPolish.on(
            document,
            replace(document.polish, expression=chance.uniform(0, 3)).with_curve(
                chance.choice(REGIONS), tuple((float(k), chance.uniform(0, 3)) for k in range(chance.randrange(4)))
            ),
            "Polish",
            chance.choice((None, 4)),
        ),
        lambda: SetControls.on(
            document,
            document.controls.with_keys("jawOpen", (ControlKey(chance.uniform(0, 1), chance.uniform(-1, 1), 0.1),))
            .smoothing("mouthPucker", *times_s)
            .muting("mouthClose", chance.random() < 0.5),
            "Curves",
            chance.choice((None, 5)),
        ),
        lambda: FieldEdit.setting(
            document, "Weigh", Change.WEIGHTS, weights=chance.choice((None, SearchWeights(pnt=chance.uniform(1, 5e4))))
        ),
        lambda: SetEngine.on(document, chance.choice(tuple(ENGINES))),
        lambda: SetHolds.on(document, chance.random() < 0.5),
        lambda: FieldEdit.setting(
            document, "Lock", Change.CONSTRAINTS, locks=MappingProxyType({**document.locks, slot: node})
        ),
    ]
    if n_slots == 0 or chance.random() < 0.03:
        return SetSpeech.on(document, made_speech(chance.randrange(4)))
    try:
        return chance.choice(makers)()
    except UserFacingError:
        return None


def edit_until_killed(path: Path, seed: int) -> None:
    """Edit the project at ``path`` for ever, as a window does; tell each state's number before it is handed over to be
    written, and once it is on disk.
    """
    chance, document, project = random.Random(seed), Document(), ProjectWriter(ProjectFile.open(path))
    voice = threading.Lock()
    undone: list[Edit] = []
    number = 0

    def tell(*words: object) -> None:
        with voice:
            print(*words, flush=True)

    def tell_done(number: int, saved: Future[bool]) -> None:
        if saved.result():
            tell("done", number)

    while True:
        edit = random_edit(document, chance)
        if edit is None:
            continue
        if chance.random() < 0.2 and undone:
            document.revert(undone.pop())
        else:
            document.apply(edit)
            undone.append(edit)
            del undone[:-50]
        content = ProjectContent.of(document, others={"number": number + 1})
        if document.speech is None:
            continue
        number += 1
        tell("begin", number, content.to_json())
        saved = project.save(content, document.speech.audio)
        saved.add_done_callback(partial(tell_done, number))
        # now a drag, now one edit after the other
        if number % 100 > 40:
            saved.result()


if __name__ == "__main__":
    edit_until_killed(Path(sys.argv[1]), int(sys.argv[2]))
