"""One sentence as it is stored: where its frames are, and what is said in it."""

from __future__ import annotations

from dataclasses import dataclass

from core.motion.database_checks import check_spoken
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance


@dataclass(frozen=True)
class CapturedSentence:
    """One sentence of the database: where its frames are, and what is said in it."""

    name: str
    emotion: str
    text: str
    start_frame: int
    stop_frame: int
    transcript: Transcript

    def as_entry(self) -> dict[str, object]:
        """Return it as plain JSON, for the database."""
        transcript = self.transcript
        return {
            "name": self.name, "emotion": self.emotion, "text": self.text,
            "frames": [self.start_frame, self.stop_frame], "duration_s": transcript.duration_s,
            "phonemes": [[u.phone, u.start_s, u.end_s] for u in transcript.phonemes],
            "words": [[w.word, w.start_s, w.end_s] for w in transcript.words],
        }  # fmt: skip

    @classmethod
    def from_entry(cls, entry: dict) -> CapturedSentence:
        """Inverse of `as_entry`; raises `Unsound`, or what a made-up entry makes Python raise."""
        transcript = Transcript(
            tuple(PhonemeUtterance(*u) for u in entry["phonemes"]),
            tuple(WordUtterance(*w) for w in entry["words"]),
            entry["duration_s"],
        )
        check_spoken(entry["emotion"], transcript)
        return cls(entry["name"], entry["emotion"], entry["text"], *entry["frames"], transcript)
