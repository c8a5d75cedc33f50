from difflib import SequenceMatcher
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from core.actress.corpus import database_sentences, transcript_of
from core.errors import UserFacingError
from core.media.audio import Audio, load_audio, resampled
from core.progress import Cancelled, Progress
from core.speech.aligner import align, recognise
from core.speech.spoken_words import spoken_words

REPOSITORY = Path(__file__).resolve().parents[3]
DATA = REPOSITORY / "../shared/data"
GRID = DATA / "grid-s1"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="the shared test data is not beside the repository")


def grid_clip(clip):
    """Return the sound of a clip and the corpus's own (word, start_s, end_s)."""
    rows = [line.split() for line in (GRID / f"align/{clip}.align").read_text().splitlines()]
    words = [(word, int(start) / 25_000, int(end) / 25_000) for start, end, word in rows if word not in ("sil", "sp")]
    return load_audio(GRID / f"audio/{clip}.flac"), words


def grid_clips(step):
    return [path.stem for path in sorted((GRID / "align").glob("*.align"))[::step]]


def assert_covers(transcript, duration_s):
    edges = [(u.start_s, u.end_s) for u in transcript.phonemes]
    assert edges[0][0] == 0 and edges[-1][1] == duration_s
    assert all(a[1] == b[0] for a, b in pairwise(edges))
    assert all(a < b for a, b in edges)


@needs_data
def test_words_start_where_the_grid_corpus_says():
    errors_s = []
    for clip in grid_clips(45):
        audio, words = grid_clip(clip)
        transcript = align(audio, " ".join(word for word, _, _ in words))
        assert_covers(transcript, audio.duration_s)
        assert [w.word for w in transcript.words] == [word for word, _, _ in words]
        assert transcript.phonemes[0].phone == transcript.phonemes[-1].phone == "pau"
        errors_s += [w.start_s - start_s for w, (_, start_s, _) in zip(transcript.words, words)]
    assert len(errors_s) > 60
    assert np.median(np.abs(errors_s)) <= 0.03
    assert np.mean(np.abs(errors_s) < 0.1) > 0.9


def test_phones_stand_where_festival_put_them():
    """Festival made this speech, so its labels are the truth about it."""
    errors_s, total = [], 0
    for spoken in database_sentences()[::30]:
        truth = [u for u in transcript_of(spoken).phonemes if u.phone != "pau"]
        ours = [u for u in align(load_audio(spoken.audio), spoken.text).phonemes if u.phone != "pau"]
        total += len(truth)
        matcher = SequenceMatcher(None, [u.phone for u in ours], [u.phone for u in truth], autojunk=False)
        for a, b, size in matcher.get_matching_blocks():
            pairs = zip(ours[a : a + size], truth[b : b + size])
            errors_s += [mine.start_s - true.start_s for mine, true in pairs]
    assert len(errors_s) / total > 0.9
    assert np.median(np.abs(errors_s)) < 0.02
    assert np.mean(np.abs(errors_s) < 0.05) > 0.9


@needs_data
def test_spelling_case_and_sound_format_do_not_matter():
    audio, words = grid_clip("bbaf4p")
    plain = align(audio, "bin blue at f four please")
    fancy = align(resampled(audio, 44_100), "“Bin blue—at F, 4… [beat] please!”")
    assert [w.word.lower() for w in fancy.words] == [w.word for w in plain.words] == [word for word, _, _ in words]
    assert fancy.phones == plain.phones
    assert plain.warnings == () and fancy.warnings == ("Not taken as spoken: '[beat]'.",)
    for one, two in zip(plain.phonemes, fancy.phonemes):
        assert one.start_s == pytest.approx(two.start_s, abs=0.03)


@needs_data
def test_loudness_does_not_matter():
    audio, _ = grid_clip("bbaf4p")
    quiet = Audio(audio.samples * np.float32(0.01), audio.rate_hz)
    loud = Audio(audio.samples * np.float32(50), audio.rate_hz)
    expected = align(audio, "bin blue at f four please")
    assert align(quiet, "bin blue at f four please") == expected
    assert align(loud, "bin blue at f four please") == expected


@needs_data
def test_a_lexicon_decides_and_a_guess_warns():
    audio, _ = grid_clip("bbaf4p")
    lexicon = {"blurgh": [("b", "l", "uw")]}
    known = align(audio, "bin blurgh at f four please", lexicon)
    assert known.phones == align(audio, "bin blue at f four please").phones
    assert known.words[1].word == "blurgh"
    assert known.warnings == ()
    guessed = align(audio, "bin bloo at f four please")
    assert "'bloo'" in guessed.warnings[0] and "'b l uw'" in guessed.warnings[0]


@needs_data
def test_a_text_that_does_not_fit_is_refused_and_says_why():
    audio, _ = grid_clip("bbaf4p")
    with pytest.raises(UserFacingError, match=r"60 words cannot be said in 2\.98 s"):
        align(audio, "one " * 60)
    with pytest.raises(UserFacingError, match=r"does not fit .*bbaf4p\.flac.*from .* to .* s is not heard"):
        align(audio, "she will never give them money for shoes")


@needs_data
def test_what_the_text_leaves_out_and_what_is_not_heard_are_warned_of():
    one, words = grid_clip("bbaf4p")
    two, _ = grid_clip("lrae3s")
    both = Audio(np.concatenate([one.samples, two.samples]), one.rate_hz)
    short = align(both, "bin blue at f four please")
    assert any("leaves out" in warning for warning in short.warnings)
    text = " ".join(word for word, _, _ in words)
    wrong = align(both, f"{text} my uncle shows them mushrooms")
    assert any("hardly heard" in warning for warning in wrong.warnings)


@pytest.mark.parametrize("text", ["", "  \n", "...", "— ! 😀", "[laughs]"])
def test_a_text_without_words_is_refused(text):
    noise = np.random.default_rng(0).normal(0, 0.1, 16_000).astype("f4")
    with pytest.raises(UserFacingError, match="has no word"):
        align(Audio(noise, 16_000), text)


def silences():
    rng = np.random.default_rng(0)
    n = 24_000
    return {
        "digital": np.zeros(n),
        "hiss": rng.normal(0, 0.05, n),
        "hum": 0.3 * np.sin(2 * np.pi * 50 * np.arange(n) / 16_000),
        "faint": rng.normal(0, 1e-4, n),
        "shortest": np.zeros(800),
        "constant": np.full(n, 0.5),
    }


@pytest.mark.parametrize("kind", silences())
def test_sound_without_speech_is_one_pause(kind):
    audio = Audio(silences()[kind].astype("f4"), 16_000)
    text, transcript = recognise(audio)
    assert text == ""
    assert transcript.phones == ("pau",)
    assert_covers(transcript, audio.duration_s)
    assert "No speech" in transcript.warnings[0]
    with pytest.raises(UserFacingError, match="no speech to place the text in"):
        align(audio, "hello")


@pytest.mark.parametrize("seed", range(3))
def test_any_noise_is_survived(seed):
    rng = np.random.default_rng(seed)
    bursts = rng.normal(0, 0.2, 32_000) * np.repeat(rng.random(20) ** 3, 1600)
    audio = Audio(bursts.astype("f4"), 16_000)
    assert_covers(recognise(audio)[1], audio.duration_s)


@needs_data
def test_speech_is_recognised_without_a_transcript():
    audio = load_audio(DATA / "nvidia-a2f-audio/Claire_sadness.wav")
    text, transcript = recognise(audio)
    assert_covers(transcript, audio.duration_s)
    # TIMIT's sentence, which the file's own words show it to be
    said = set(spoken_words("are those shy Eurasian footwear cowboy chaps or jolly earth-moving headgear"))
    assert len(said & set(text.split())) >= 6
    assert " ".join(w.word for w in transcript.words) == text
    assert len(transcript.phones) > 35
    assert text in transcript.warnings[0]


@needs_data
def test_progress_rises_and_can_cancel():
    audio, _ = grid_clip("bbaf4p")

    class Watched(Progress):
        seen = ()

        def step(self, fraction, message=""):
            self.seen = (*self.seen, fraction)

    watched = Watched()
    align(audio, "bin blue at f four please", progress=watched)
    assert len(watched.seen) >= 2
    assert list(watched.seen) == sorted(watched.seen) and 0 <= min(watched.seen) <= max(watched.seen) <= 1

    class Stop(Progress):
        def step(self, fraction, message=""):
            raise Cancelled

    with pytest.raises(Cancelled):
        align(audio, "bin blue at f four please", progress=Stop())
    with pytest.raises(Cancelled):
        recognise(audio, progress=Stop())


def join(clips):
    sounds, words, start_s = [], [], 0.0
    for clip in clips:
        audio, said = grid_clip(clip)
        words += [(word, start_s + a, start_s + b) for word, a, b in said]
        sounds.append(audio.samples)
        start_s += audio.duration_s
    return Audio(np.concatenate(sounds), 16_000), words


@needs_data
def test_a_minute_is_aligned_in_pieces():
    audio, words = join(grid_clips(20)[:20])
    transcript = align(audio, " ".join(word for word, _, _ in words))
    assert_covers(transcript, audio.duration_s)
    assert [w.word for w in transcript.words] == [word for word, _, _ in words]
    errors_s = [w.start_s - start_s for w, (_, start_s, _) in zip(transcript.words, words)]
    assert np.median(np.abs(errors_s)) <= 0.03


@needs_data
@pytest.mark.prove
def test_ten_minutes_are_aligned_and_heard():
    audio, words = join(grid_clips(2)[:202])
    assert audio.duration_s > 600
    transcript = align(audio, " ".join(word for word, _, _ in words))
    assert_covers(transcript, audio.duration_s)
    errors_s = [w.start_s - start_s for w, (_, start_s, _) in zip(transcript.words, words)]
    assert np.median(np.abs(errors_s)) <= 0.03
    assert np.max(np.abs(errors_s)) < 3
    text, heard = recognise(audio)
    assert_covers(heard, audio.duration_s)
    assert len(text.split()) > 600
