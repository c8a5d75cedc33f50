"""What an import did to the data, sentence by sentence; it travels in the database's ``report``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field

KEY = "import"


@dataclass(frozen=True)
class SentenceReport:
    """What was done to one sentence.

    failure : why it was left out, or ""
    seconds, rate_hz, markers : of the capture; markers counts those that are kept
    gaps_filled, gap_samples : gaps that were filled and the marker samples in them; gaps_left : longer ones, masked
    spikes_cut, spike_samples : excursions taken out and filled again; swaps_undone : spans of two markers exchanged
    rigid_residual_mm : root mean square of the near-rigid markers after head stabilisation, or None
    offset_s, offset_confidence : measured lateness of the motion and how sure that is (0..1), or None
    offset_taken_out_s : what was shifted
    alignment : ``given``, ``aligned``, ``recognised`` or ``silence`` (no sound: nothing is said)
    alignment_confidence : 0..1, the least sure word's, or None
    notes : sentences for the user
    """

    sentence: str
    failure: str = ""
    seconds: float = 0.0
    rate_hz: float = 0.0
    markers: int = 0
    gaps_filled: int = 0
    gap_samples: int = 0
    gaps_left: int = 0
    spikes_cut: int = 0
    spike_samples: int = 0
    swaps_undone: int = 0
    rigid_residual_mm: float | None = None
    offset_s: float | None = None
    offset_confidence: float | None = None
    offset_taken_out_s: float = 0.0
    alignment: str = ""
    alignment_confidence: float | None = None
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ImportReport:
    """All sentences of an import.

    rows : one a sentence, in the plan's order
    session_offset_s, session_offset_confidence : the one offset measured over all sentences, or None
    n_resumed : sentences whose work a killed run had left
    """

    rows: tuple[SentenceReport, ...]
    session_offset_s: float | None = None
    session_offset_confidence: float | None = None
    n_resumed: int = field(default=0, compare=False)

    @property
    def failures(self) -> tuple[SentenceReport, ...]:
        """The sentences that were left out."""
        return tuple(row for row in self.rows if row.failure)

    @property
    def taken(self) -> tuple[SentenceReport, ...]:
        """The sentences that are in the database."""
        return tuple(row for row in self.rows if not row.failure)

    def total(self, name: str) -> float:
        """Return the sum of a column over the sentences that are in the database."""
        return sum(getattr(row, name) for row in self.taken)

    def as_dict(self) -> dict[str, object]:
        """Return it as plain JSON, for the database."""
        return {
            "rows": [asdict(row) for row in self.rows],
            "session_offset_s": self.session_offset_s,
            "session_offset_confidence": self.session_offset_confidence,
        }

    @classmethod
    def from_dict(cls, data: Mapping) -> ImportReport:
        """Inverse of `as_dict`; `TypeError` or `KeyError` for what is no report."""
        rows = tuple(SentenceReport(**{**row, "notes": tuple(row.get("notes", ()))}) for row in data["rows"])
        return cls(rows, data["session_offset_s"], data["session_offset_confidence"])

    def in_words(self) -> str:
        """Say in a few lines what was done."""
        residuals = [row.rigid_residual_mm for row in self.taken if row.rigid_residual_mm is not None]
        lines = [
            f"imported {len(self.taken)} of {len(self.rows)} sentences: {self.total('gaps_filled'):.0f} gaps filled "
            f"({self.total('gap_samples'):.0f} samples), {self.total('gaps_left'):.0f} too long, "
            f"{self.total('spikes_cut'):.0f} spikes cut, {self.total('swaps_undone'):.0f} swaps undone"
        ]
        if residuals:
            lines.append(f"near-rigid markers: {max(residuals):.2f} mm RMS at most after head stabilisation")
        if self.session_offset_s is not None:
            late = f"{abs(self.session_offset_s) * 1000:.0f} ms {'late' if self.session_offset_s >= 0 else 'early'}"
            lines.append(f"motion against sound: {late} (confidence {self.session_offset_confidence:.2f})")
        lines += [f"left out '{row.sentence}': {row.failure}" for row in self.failures]
        return "\n".join(lines)


def told_by(report: Mapping) -> str:
    """Return what a database's ``report`` tells of its import, in words; "" when it tells of none, or nonsense."""
    if KEY not in report:
        return ""
    try:
        return ImportReport.from_dict(report[KEY]).in_words()
    except (TypeError, KeyError, ValueError, AttributeError):
        return ""
