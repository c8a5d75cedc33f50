"""Can the four emotions be told apart? A simple classifier on captures that it has not seen.

``python -m core.actress.separability`` prints the answer; needs a minute.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from core.actress.corpus import actress_marker_set, comparison_sentences, record, recordings, tuning_sentences
from core.motion.head_space import in_head_space
from core.motion.recording import Recording
from core.speech.emotion import EMOTION_INDEX, EMOTIONS

FRAME_STEP = 6
WINDOW_S = 1.0
N_COMPONENTS = 25


def head_space(recording: Recording) -> np.ndarray:
    """Return the kept markers of a recording less their rest, head motion taken out; (n_frames, n_kept, 3), mm."""
    markers = actress_marker_set()
    return in_head_space(recording, markers, with_scale=False).face - markers.rest


def emotion_accuracies(seen: Sequence[Recording], unseen: Sequence[Recording]) -> dict[str, float]:
    """Train linear discriminants on ``seen`` and return which share of ``unseen`` they name rightly; chance is 0.25.

    returns : ``frame``, from the markers of a single frame; ``window``, from mean and spread of every marker over
        one second; ``sentence``, the same over the whole sentence
    """
    from sklearn.decomposition import PCA
    from sklearn.discriminant_analysis import LinearDiscriminantAnalysis
    from sklearn.pipeline import make_pipeline

    faces = {recording.sentence: head_space(recording) for recording in (*seen, *unseen)}

    def samples(recordings: Sequence[Recording], kind: str) -> tuple[np.ndarray, np.ndarray]:
        rows, labels = [], []
        for recording in recordings:
            face = faces[recording.sentence].reshape(len(faces[recording.sentence]), -1)
            if kind == "frame":
                found = list(face[::FRAME_STEP])
            else:
                length = len(face) if kind == "sentence" else min(len(face), round(WINDOW_S * recording.rate_hz))
                spans = [face[f : f + length] for f in range(0, len(face) - length + 1, length)]
                found = [np.concatenate([span.mean(axis=0), span.std(axis=0)]) for span in spans]
            rows += found
            labels += [EMOTION_INDEX[recording.emotion]] * len(found)
        return np.array(rows), np.array(labels)

    accuracies = {}
    for kind in ("frame", "window", "sentence"):
        rows, labels = samples(seen, kind)
        judge = make_pipeline(PCA(N_COMPONENTS, random_state=0), LinearDiscriminantAnalysis()).fit(rows, labels)
        accuracies[kind] = float(judge.score(*samples(unseen, kind)))
    return accuracies


if __name__ == "__main__":
    held_out = [record(spoken) for spoken in (*tuning_sentences(), *comparison_sentences())]
    for name, share in emotion_accuracies(recordings(), held_out).items():
        print(f"one of {len(EMOTIONS)} emotions from one {name}: {share:.1%} right")
