import pytest

from core.actress.corpus import comparison_sentences, record, recordings, tuning_sentences
from core.actress.separability import emotion_accuracies, head_space


def test_emotions_are_told_apart_but_not_by_every_single_frame():
    """Trained on a third of the database, tried on half of the sentences that no emotion of it holds."""
    seen = recordings()[::3]
    unseen = [record(spoken) for spoken in [*tuning_sentences(), *comparison_sentences()][::2]]
    assert not {r.text for r in seen} & {r.text for r in unseen}
    share = emotion_accuracies(seen, unseen)
    assert share["window"] > 0.85 and share["sentence"] > 0.85
    assert 0.6 < share["frame"] < 0.97
    assert share["frame"] < share["window"]


def test_head_space_takes_the_head_out():
    spoken = tuning_sentences()[0]
    face = head_space(record(spoken))
    assert face.shape[1:] == (90, 3)
    # foreheads hardly move: what is left there is noise and skin
    assert abs(face[:, 0]).max() < 6
    assert face.std(axis=0).max() < 12


@pytest.mark.prove
def test_emotions_of_the_whole_corpus():
    share = emotion_accuracies(recordings(), [record(s) for s in (*tuning_sentences(), *comparison_sentences())])
    assert share["sentence"] > 0.9 and share["frame"] < 0.97
