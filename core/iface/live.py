"""A face that speaks with whoever speaks: blocks of sound in, frames of markers out, without any device."""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np

from core.errors import UserFacingError
from core.iface.expression_ease import ExpressionEase
from core.iface.speaking import SpeakingFace
from core.iface.speech_features import RATE_HZ, SAMPLE_RATE_HZ, SpeechFeatureStream
from core.media.audio import RATES_HZ

NEUTRAL = "neutral"


@dataclass(frozen=True, eq=False)
class LiveFrame:
    """One frame of the face.

    frame : counted from the start; it stands at ``time_s`` = frame / 30 of the sound
    positions : float32, shape (n_markers, 3), mm, head space
    asked : the emotion and intensity that were asked for; strengths : expression to the strength that is shown
    heard_s : seconds of sound that had come in when it was made
    compute_s : what it took to make, from the sound in hand
    """

    frame: int
    positions: np.ndarray
    asked: tuple[str, float]
    strengths: dict[str, float]
    heard_s: float
    compute_s: float

    @property
    def time_s(self) -> float:
        """When it stands, in seconds of the sound."""
        return self.frame / RATE_HZ


class LiveFace:
    """Takes mono sound at any rate, in blocks of any size, and gives each frame as soon as what it needs is heard.

    The frames do not depend on how the sound was cut into blocks, and are those of
    ``face.motion(speech_features(sound), strengths)`` for the whole.

    asked : the emotion and intensity that the next frames go to
    faulty : samples that were no finite numbers, taken as silence
    """

    def __init__(self, face: SpeakingFace, rate_hz: int, emotion: str = NEUTRAL, intensity: float = 1.0) -> None:
        """Begin to listen at ``rate_hz`` samples a second.

        Raises `UserFacingError` for a rate outside 4,000 to 768,000 Hz, and an emotion that the face does not have.
        """
        import soxr

        lowest, highest = RATES_HZ
        if not lowest <= rate_hz <= highest:
            raise UserFacingError(
                f"The sound has a rate of {rate_hz} Hz.", f"Rates from {lowest} to {highest} Hz can be heard."
            )
        self.face, self.rate_hz = face, rate_hz
        self._resampler = None
        if rate_hz != SAMPLE_RATE_HZ:
            self._resampler = soxr.ResampleStream(rate_hz, SAMPLE_RATE_HZ, 1, dtype="float32")
        self._features, self._stream = SpeechFeatureStream(), face.stream()
        self._ease = ExpressionEase(face.expressions)
        self.ask(emotion, intensity)
        self._ease = ExpressionEase(face.expressions, self._goal())  # what it begins with it does not come to
        self._strengths = dict.fromkeys(face.expressions, 0.0)
        self._n_heard, self._n_given, self._n_samples, self.faulty = 0, 0, 0, 0

    def ask(self, emotion: str, intensity: float = 1.0) -> None:
        """Let the face go smoothly to an emotion at an intensity, 0..1.

        Raises `UserFacingError` for one that it does not have.
        """
        if emotion != NEUTRAL and emotion not in self.face.expressions:
            known = ", ".join((NEUTRAL, *self.face.expressions))
            raise UserFacingError(f"This face was not trained on '{emotion}'.", f"It knows {known}.")
        self.asked = emotion, 0.0 if emotion == NEUTRAL else float(np.clip(intensity, 0.0, 1.0))
        self._ease.ask(self._goal())

    def accept(self, samples: np.ndarray) -> list[LiveFrame]:
        """Take the next sound, shape (n,), -1..1; return the frames that it completes."""
        began_s = time.perf_counter()
        samples = np.asarray(samples, np.float32)
        good = np.isfinite(samples)
        if not good.all():
            self.faulty += int((~good).sum())
            samples = np.where(good, samples, np.float32(0.0))
        samples = np.clip(samples, -1.0, 1.0)  # as every recording of it will be
        self._n_samples += len(samples)
        if self._resampler is not None:
            samples = self._resampler.resample_chunk(samples)
        return self._frames(self._features.accept(samples), began_s)

    def finish(self) -> list[LiveFrame]:
        """The sound is over: return the frames that still waited for more, at the strengths of the last one."""
        began_s = time.perf_counter()
        frames = []
        if self._resampler is not None:
            rest = self._resampler.resample_chunk(np.zeros(0, np.float32), last=True)
            frames = self._frames(self._features.accept(rest), began_s)
            began_s = time.perf_counter()
        return frames + self._made(self._stream.finish(), began_s)

    def _goal(self) -> dict[str, float]:
        emotion, intensity = self.asked
        return {} if emotion == NEUTRAL else {emotion: intensity}

    def _frames(self, features: np.ndarray, began_s: float) -> list[LiveFrame]:
        frames: list[LiveFrame] = []
        for row in features:
            self._n_heard += 1
            if self._n_heard > self.face.n_ahead:  # a frame is due, and only frames move the expression on
                self._strengths = self._ease.step()
            frames += self._made(self._stream.accept(row[None], self._strengths), began_s)
            began_s = time.perf_counter()
        return frames

    def _made(self, positions: np.ndarray, began_s: float) -> list[LiveFrame]:
        compute_s = (time.perf_counter() - began_s) / max(1, len(positions))
        heard_s = self._n_samples / self.rate_hz
        first, self._n_given = self._n_given, self._n_given + len(positions)
        return [
            LiveFrame(first + m, shape, self.asked, self._strengths, heard_s, compute_s)
            for m, shape in enumerate(positions)
        ]
