"""What the animator looks at: not part of the work, so nothing here undoes."""

from __future__ import annotations

from typing import ClassVar

from psygnal import Signal

from core.document.document import Document
from core.speech.phoneme import PAU


class ViewState:
    """The selected utterance is one idea, the playhead another, the map on show a third.

    slot : selected phoneme slot, or None
    span : first and last selected slot; more than ``slot`` after `extend_to`
    playhead_s : seconds
    map_phone : phone whose Isomap is shown, or None
    """

    slot_selected: ClassVar[Signal] = Signal()
    playhead_moved: ClassVar[Signal] = Signal(float)
    map_chosen: ClassVar[Signal] = Signal()

    def __init__(self, document: Document) -> None:
        self._document = document
        self.slot: int | None = None
        self._span_end: int | None = None
        self._phone_selected: str | None = None
        self.playhead_s = 0.0
        self.map_phone: str | None = None

    def select_slot(self, slot: int | None) -> None:
        """Select an utterance; the map of its phone comes up, unless it is silence or has none."""
        self.slot = self._span_end = slot
        phone = self._phone_selected = self.slot_phone
        if phone is not None and phone != PAU and self._has_map(phone) and phone != self.map_phone:
            self.map_phone = phone
            self.map_chosen.emit()
        self.slot_selected.emit()

    def extend_to(self, slot: int) -> None:
        """Select everything from the selected utterance to ``slot``."""
        if self.slot is None:
            self.select_slot(slot)
        elif slot != self._span_end:
            self._span_end = slot
            self.slot_selected.emit()

    def fit(self) -> None:
        """Select nothing that the speech no longer has; where another phone is said in the slot, its map comes up."""
        speech = self._document.speech
        n_slots = 0 if speech is None else len(speech.transcript.phonemes)
        if self.slot is not None and max(self.slot, self._span_end) >= n_slots:
            self.select_slot(n_slots - 1 if n_slots else None)
        elif self.slot_phone != self._phone_selected:
            self.select_slot(self.slot)
        else:
            self.slot_selected.emit()

    def show_map(self, phone: str | None) -> None:
        """Show the map of ``phone`` without touching the selection."""
        if phone != self.map_phone:
            self.map_phone = phone
            self.map_chosen.emit()

    def move_playhead(self, time_s: float) -> None:
        """Move the playhead, within the speech."""
        speech = self._document.speech
        time_s = min(max(time_s, 0.0), speech.transcript.duration_s if speech is not None else 0.0)
        if time_s != self.playhead_s:
            self.playhead_s = time_s
            self.playhead_moved.emit(time_s)

    @property
    def span(self) -> tuple[int, int] | None:
        """First and last selected slot, or None."""
        return None if self.slot is None else (min(self.slot, self._span_end), max(self.slot, self._span_end))

    @property
    def slot_phone(self) -> str | None:
        """The phone of the selected utterance."""
        speech = self._document.speech
        if speech is None or self.slot is None or self.slot >= len(speech.transcript.phonemes):
            return None
        return speech.transcript.phonemes[self.slot].phone

    @property
    def map_slot(self) -> int | None:
        """The selected slot if the map on show is its own: the one that a pick on the map is meant for."""
        return self.slot if self.slot_phone is not None and self.slot_phone == self.map_phone else None

    def slot_at(self, time_s: float) -> int | None:
        """Return the slot that is spoken at ``time_s``."""
        speech = self._document.speech
        if speech is None:
            return None
        for slot, utterance in enumerate(speech.transcript.phonemes):
            if utterance.start_s <= time_s < utterance.end_s:
                return slot
        return len(speech.transcript.phonemes) - 1

    def _has_map(self, phone: str) -> bool:
        database = self._document.database
        return database is None or phone in database.maps  # before a database is open every phone may have one
