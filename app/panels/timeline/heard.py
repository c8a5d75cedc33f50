"""What the wave lane shows of the sound, made in the background."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal

from app import texts
from app.authoring import Authoring
from app.panels.timeline.wave import Peaks
from core.document.change import Change
from core.media.audio import Audio
from core.progress import Progress
from core.speech.spectrogram import Spectrogram


class HeardSound(QObject):
    """Peaks of the wave, and the spectrogram if it is wanted; None until they are made.

    changed() : there is something else to show
    """

    changed = Signal()

    def __init__(self, authoring: Authoring, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._authoring = authoring
        self.peaks: Peaks | None = None
        self.spectrogram: Spectrogram | None = None
        self._wants_spectrogram = False
        authoring.document.changed.connect(self.on_document_changed)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Look at another sound."""
        if not change & Change.SPEECH:
            return
        self.peaks = self.spectrogram = None
        speech = self._authoring.document.speech
        if speech is not None:
            self._authoring.jobs.start("peaks", "", speech.audio, _peaks, self._show_peaks)
            self.want_spectrogram(self._wants_spectrogram)

    def want_spectrogram(self, wanted: bool) -> None:
        """Make the spectrogram of this sound and of those to come, or none."""
        self._wants_spectrogram = wanted
        speech = self._authoring.document.speech
        if wanted and speech is not None:
            title = texts.MAKING_SPECTROGRAM
            self._authoring.jobs.start("spectrogram", title, speech.audio, _spectrogram, self._show_spectrogram)
        else:
            self._authoring.jobs.cancel("spectrogram")
            self._show_spectrogram(None)

    def _show_peaks(self, peaks: Peaks) -> None:
        self.peaks = peaks
        self.changed.emit()

    def _show_spectrogram(self, spectrogram: Spectrogram | None) -> None:
        self.spectrogram = spectrogram
        self.changed.emit()


def _peaks(audio: Audio, _progress: Progress) -> Peaks:
    return Peaks.of(audio)


def _spectrogram(audio: Audio, _progress: Progress) -> Spectrogram:
    return Spectrogram.of(audio)
