import csv
import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from core.actress.capture import GAP_FRAMES, markers_of
from core.actress.corpus import (
    RATE_HZ,
    actress_marker_set,
    comparison_sentences,
    database_sentences,
    demo_sentences,
    kept_markers,
    perform_details,
    planted_faults,
    record,
    recordings,
    transcript_of,
    tuning_sentences,
)
from core.actress.performance import bundled_marker_units, perform
from core.actress.texts import DEMO_FOLDER, words_of
from core.progress import Progress
from core.speech.emotion import EMOTIONS
from core.speech.phoneme import PAU, PHONEMES
from core.speech.transcript_files import read_transcript

REPO = Path(__file__).resolve().parents[3]
EVERY_SENTENCE = [*database_sentences(), *tuning_sentences(), *comparison_sentences(), *demo_sentences()]


@pytest.fixture(scope="module")
def corpus():
    return recordings()


def test_database_has_the_sizes_of_the_paper(corpus):
    phones = {emotion: 0 for emotion in EMOTIONS}
    for r in corpus:
        phones[r.emotion] += sum(phone != PAU for phone in r.transcript.phones)
    assert all(1300 < count < 1450 for count in phones.values())
    assert 5450 < sum(phones.values()) < 5650
    assert all(sum(r.emotion == emotion for r in corpus) >= 45 for emotion in EMOTIONS)
    assert len({r.sentence for r in corpus}) == len(corpus)


def test_speech_is_bundled_small():
    files = [path for path in DEMO_FOLDER.rglob("*") if path.is_file()]
    assert {path.stem for path in (DEMO_FOLDER / "audio").iterdir()} == {s.sentence for s in EVERY_SENTENCE}
    assert sum(path.stat().st_size for path in files) < 15e6


def test_labels_last_as_long_as_the_sound():
    soundfile = pytest.importorskip("soundfile")
    for spoken in EVERY_SENTENCE:
        transcript, sound = transcript_of(spoken), soundfile.info(spoken.audio)
        assert sound.samplerate == 16000 and sound.channels == 1
        assert abs(transcript.duration_s - sound.duration) < 0.05, spoken.sentence


def test_labels_are_phones_and_words_of_the_text():
    for spoken in EVERY_SENTENCE:
        transcript = transcript_of(spoken)
        assert set(transcript.phones) <= set(PHONEMES)
        assert [word.word for word in transcript.words] == words_of(spoken.text), spoken.sentence
        edges = {round(u.start_s, 3) for u in transcript.phonemes}
        assert all(round(word.start_s, 3) in edges for word in transcript.words), spoken.sentence


def test_demo_labels_are_files_an_aligner_could_have_written():
    for spoken in demo_sentences():
        bundled = transcript_of(spoken)
        read = read_transcript(spoken.phone_labels, bundled.duration_s)
        assert read.phones == bundled.phones
        assert all(abs(a.end_s - b.end_s) < 0.02 for a, b in zip(read.phonemes, bundled.phonemes))


def test_corpus_has_most_phonemes_of_the_set(corpus):
    spoken = {phone for r in corpus for phone in r.transcript.phones}
    # Festival's dictionary writes the syllabic consonants as schwa and consonant
    assert set(PHONEMES) - spoken == {"el", "em", "en"}


def _digest(sentences):
    digest = hashlib.sha256()
    for spoken in sentences:
        digest.update(record(spoken).positions.tobytes() + perform_details(spoken).gaze_deg.tobytes())
    return digest.hexdigest()


def _digest_elsewhere(every):
    """The same in a new process with other hashing and one thread."""
    code = (
        "import hashlib; from core.actress.corpus import *\n"
        "digest = hashlib.sha256()\n"
        f"for spoken in database_sentences()[::{every}]:\n"
        "    digest.update(record(spoken).positions.tobytes() + perform_details(spoken).gaze_deg.tobytes())\n"
        "print(digest.hexdigest())"
    )
    environment = os.environ | {"PYTHONHASHSEED": "77", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    other = subprocess.run([sys.executable, "-c", code], cwd=REPO, env=environment, capture_output=True, text=True)
    assert other.returncode == 0, other.stderr
    return other.stdout.strip()


def test_same_bytes_in_another_process_and_after_other_random_numbers():
    np.random.seed(1)  # noqa: NPY002 - the global generator must not matter
    assert _digest(database_sentences()[::30]) == _digest_elsewhere(30)


@pytest.mark.prove
def test_same_bytes_for_the_whole_corpus():
    assert _digest(database_sentences()) == _digest_elsewhere(1)


def test_recordings_cover_their_transcripts(corpus):
    for r in corpus:
        assert r.positions.dtype == np.float32
        assert r.positions.shape[1:] == (102, 3) == (len(r.marker_names), 3)
        assert 0 <= len(r.positions) / RATE_HZ - r.transcript.duration_s < 1 / RATE_HZ + 1e-9
        assert r.audio is not None and r.audio.exists()


def test_gaps_are_few_and_short(corpus):
    lengths = []
    for r in corpus:
        lost = np.isnan(r.positions).any(axis=2)
        assert np.array_equal(lost, np.isnan(r.positions).all(axis=2))
        for marker in lost.T[lost.any(axis=0)]:
            edges = np.flatnonzero(np.diff(np.concatenate([[0], marker, [0]])))
            lengths += list(edges[1::2] - edges[::2])
    assert 0.5 * len(corpus) < len(lengths) < 5 * len(corpus)
    assert GAP_FRAMES[0] <= min(lengths) and np.mean(np.array(lengths) <= GAP_FRAMES[1]) > 0.95


def test_head_moves_rigidly_and_noise_is_that_of_a_capture_system(corpus):
    units = bundled_marker_units()
    for r, spoken in list(zip(corpus, database_sentences()))[::25]:
        still = markers_of(perform(r.transcript, r.emotion, r.sentence), units)
        whole = ~np.isnan(r.positions).any(axis=(1, 2))
        for fault in planted_faults():
            if fault.sentence == r.sentence:
                whole[round(fault.start_s * RATE_HZ) : round(fault.end_s * RATE_HZ)] = False
        for f in np.flatnonzero(whole)[::40]:
            a, b = still[f] - still[f].mean(axis=0), r.positions[f] - r.positions[f].mean(axis=0)
            u, _, vt = np.linalg.svd(a.T @ b)
            rotation = u @ vt
            assert np.linalg.det(rotation) > 0
            residual = np.sqrt((((a @ rotation) - b) ** 2).sum(axis=1).mean())
            assert 0.1 < residual < 0.3, spoken.sentence


def test_kept_markers_are_those_of_the_table():
    with open(REPO / "resources" / "markers" / "actress-102.csv", encoding="utf-8", newline="") as lines:
        rows = [row for row in csv.DictReader(lines) if row["kept"] == "1"]
    markers = actress_marker_set()
    assert markers.names == kept_markers() == tuple(row["marker"] for row in rows)
    assert len(markers) == 90
    for row in rows:
        for group in filter(None, row["groups"].split(";")):
            assert row["marker"] in markers.groups[group]
    assert dict(markers.landmarks) == {row["landmark"]: row["marker"] for row in rows if row["landmark"]}
    assert sum(len(members) for members in markers.groups.values()) == sum(
        len(list(filter(None, row["groups"].split(";")))) for row in rows
    )
    assert np.allclose(markers.rest[markers.group("origin")], 0)


def test_emotions_are_told_apart_by_the_nearest_mean_of_sentence_averages(corpus):
    units = bundled_marker_units()
    averages = np.array([markers_of(perform(r.transcript, r.emotion, r.sentence), units).mean(axis=0) for r in corpus])
    emotions = np.array([r.emotion for r in corpus])
    texts = np.array([r.text for r in corpus])
    right = 0
    for average, emotion, text in zip(averages, emotions, texts):
        known = texts != text
        means = {e: averages[known & (emotions == e)].mean(axis=0) for e in set(emotions)}
        right += min(means, key=lambda e: np.linalg.norm(means[e] - average)) == emotion
    assert right >= 0.95 * len(corpus)


def test_progress_reaches_the_end():
    class Listener(Progress):
        fractions: list[float] = []  # noqa: RUF012

        def step(self, fraction, message=""):
            self.fractions.append(fraction)

    recordings(Listener())
    assert Listener.fractions == sorted(Listener.fractions) and Listener.fractions[-1] == 1.0
