from core.actress.labels import SentenceLabels, read_transcripts, write_labels
from core.speech.transcript import WordUtterance


def test_labels_come_back(tmp_path):
    labels = {
        "n01": SentenceLabels([("pau", 0.1), ("ay", 0.25), ("pau", 0.5)], [("pau", 0.1), ("i", 0.25), ("pau", 0.5)]),
        "n02": SentenceLabels([("hh", 0.1), ("iy", 0.2)], [("he's", 0.2)]),
    }
    write_labels(tmp_path / "labels.csv", labels)
    read = read_transcripts(tmp_path / "labels.csv")
    assert list(read) == ["n01", "n02"]
    assert read["n01"].phones == ("pau", "ay", "pau") and read["n01"].duration_s == 0.5
    assert read["n01"].words == (WordUtterance("i", 0.1, 0.25),)
    assert [u.end_s for u in read["n02"].phonemes] == [0.1, 0.2]
    assert read["n02"].words == (WordUtterance("he's", 0.0, 0.2),)
