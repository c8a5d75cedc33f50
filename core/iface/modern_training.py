"""Training of the modern face: first which phones are heard, louder and softer and in noise, then how they move it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from core.iface.descent import DescentSettings, descend
from core.iface.ear import FRAMES_AROUND
from core.iface.ear_training import train_ears
from core.iface.heard_takes import HeardTake
from core.iface.lessons import shown_parameters, silence_of, units_of, usable_takes
from core.iface.modern_face import ModernFace, told
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.iface.perceptrons import Perceptron
from core.iface.speech_features import N_CEPSTRA
from core.iface.varied_speech import VariedSpeech
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress
from core.speech.phoneme import PHONEMES


@dataclass(frozen=True)
class ModernSettings:
    """What was chosen on held-out sentences (see `docs/iface.md`).

    n_back, n_ahead : frames of the window
    n_ears, ear_hidden, ear : perceptrons that tell phones and are averaged, units of their layers, how they are trained
    n_nets, hidden, descent : the same of those that move the face
    cepstra_weight : what the ten cepstra of a frame count beside the phones
    lip_weight : an error of the lip gap counts as much as this times the same length of any other deformation
    loudness : standard deviation of the loudness that each sentence is given anew, nepers of energy
    noise_share : of the sentences that are heard in noise, where their takes have it
    n_hearings : how often all sentences are heard anew to learn moving from
    n_utterance, n_expression : motion units, a share of the variance each
    """

    n_back: int = 6
    n_ahead: int = 3
    n_ears: int = 3
    ear_hidden: tuple[int, ...] = (256, 256)
    ear: DescentSettings = field(default_factory=lambda: DescentSettings(8, step=2e-3, noise=1.0))
    n_nets: int = 4
    hidden: tuple[int, ...] = (256, 128)
    descent: DescentSettings = field(default_factory=lambda: DescentSettings(20, step=2e-3, batch=128, noise=0.1))
    cepstra_weight: float = 0.15
    lip_weight: float = 4.0
    loudness: float = 1.5
    noise_share: float = 0.3
    n_hearings: int = 4
    n_utterance: float = 0.98
    n_expression: float = 0.9


def train_modern_face(
    takes: Sequence[HeardTake], markers: MarkerSet, seed: int = 0, progress: Progress = SILENT,
    settings: ModernSettings | None = None,
) -> ModernFace:  # fmt: skip
    """Train on the used frames of ``takes``, displacements of ``markers`` from their rest pose.

    Raises `UserFacingError` without neutral speech; progress may cancel it between passes.
    """
    from threadpoolctl import threadpool_limits

    settings, takes = settings or ModernSettings(), usable_takes(takes)
    progress.step(0.0, "motion units")
    units, silence = units_of(takes, settings.n_utterance, settings.n_expression), silence_of(takes)
    around = settings.n_back, settings.n_ahead
    speech = VariedSpeech(takes, *around, silence, settings.loudness, settings.noise_share)
    with threadpool_limits(1):  # batches are too small to share out, and the sums of one thread are always the same
        half = progress.part(0.05, 0.5)
        ears = train_ears(speech, settings.n_ears, settings.ear_hidden, settings.ear, seed, half)
        lesson = _lesson(takes, units, markers, settings.lip_weight)
        nets = _train_nets(speech, ears, lesson, settings, seed, progress.part(0.5, 1.0))
    progress.step(1.0, "trained")
    neutral = markers.rest.astype(np.float32)
    return ModernFace(units, neutral, silence, *around, ears, nets)


def _train_nets(
    speech: VariedSpeech, ears: tuple[Perceptron, ...], lesson: tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray],
    settings: ModernSettings, seed: int, progress: Progress,
) -> tuple[Perceptron, ...]:  # fmt: skip
    """Train on what the ears tell of the used frames, in a few hearings that each sentence is drawn from anew."""
    rest, mixing, wanted, told_of = lesson
    rng = np.random.default_rng(seed)
    hearings = []
    for h in range(settings.n_hearings):
        progress.step(0.2 * h / settings.n_hearings, "listening")
        hearings.append([
            told(ears, context, len(take))[take.used] for take, context in zip(speech.takes, speech.contexts(rng))
        ])  # fmt: skip
    n_cepstra = settings.n_back + 1 + settings.n_ahead - FRAMES_AROUND
    n_phones = (n_cepstra - FRAMES_AROUND) * len(PHONEMES)
    cepstra = np.concatenate([take.features[take.used, :N_CEPSTRA] for take in speech.takes])
    mean = np.concatenate([np.zeros(n_phones), np.tile(cepstra.mean(axis=0, dtype=float), n_cepstra)])
    spread = cepstra.std(axis=0, dtype=float).clip(1e-6) / settings.cepstra_weight
    scale = np.concatenate([np.ones(n_phones), np.tile(spread, n_cepstra)])

    def heard(rng: np.random.Generator) -> np.ndarray:
        which = rng.integers(len(hearings), size=len(speech.takes))
        return ((np.concatenate([hearings[w][t] for t, w in enumerate(which)]) - mean) / scale).astype(np.float32)

    nets = []
    for n in range(settings.n_nets):
        stage = progress.part(0.2 + 0.8 * n / settings.n_nets, 0.2 + 0.8 * (n + 1) / settings.n_nets)
        stage.step(0.0, f"perceptron {n + 1} of {settings.n_nets}")
        net = descend(heard, wanted, told_of, settings.hidden, settings.descent, seed * settings.n_nets + n, stage)
        nets.append(net.taking(mean, scale).giving(rest, mixing))
    return tuple(nets)


def _lesson(
    takes: Sequence[HeardTake], units: MotionUnits, markers: MarkerSet, lip_weight: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return what the nets learn: MUPs of all states side by side, turned so that equal errors count equally.

    Outputs y mean MUPs ``rest + y @ mixing``. A take tells of its own state only.
    """
    states = (NEUTRAL, *units.expressions)
    stops = np.cumsum([units.n_parameters(state) for state in states])
    n_frames = [int(take.used.sum()) for take in takes]
    n_out = int(stops[-1])
    rest, mixing, turn = np.zeros(n_out), np.zeros((n_out, n_out)), np.zeros((n_out, n_out))
    wanted, told = (np.zeros((sum(n_frames), n_out), np.float32) for _ in range(2))
    emotion = np.repeat([states.index(take.emotion) for take in takes], n_frames)
    parameters = [shown_parameters([take for take in takes if take.emotion == state], units) for state in states]
    size = max(1e-6, *(float(shown.std(axis=0).max(initial=0.0)) for shown in parameters))
    for k, (state, shown, stop) in enumerate(zip(states, parameters, stops)):
        mine = slice(stop - units.n_parameters(state), stop)
        rest[mine] = shown.mean(axis=0)
        weighed = _weighed(units, state, markers, lip_weight)
        turn[mine, mine], mixing[mine, mine] = weighed / size, np.linalg.inv(weighed) * size
        wanted[emotion == k, mine] = (shown - rest[mine]) @ turn[mine, mine]
        told[emotion == k, mine] = 1.0
    return rest, mixing, wanted, told


def _weighed(units: MotionUnits, state: str, markers: MarkerSet, lip_weight: float) -> np.ndarray:
    """Return the root of I + (w² - 1) g gᵀ, g being the direction of MUPs that opens the lips."""
    n_parameters = units.n_parameters(state)
    upper, lower = markers.landmark("upper_lip"), markers.landmark("lower_lip")
    if upper is None or lower is None:
        return np.eye(n_parameters)
    each = units.deformations(np.eye(n_parameters), state) - units.deformations(np.zeros(n_parameters), state)
    opens = each[:, upper, 1] - each[:, lower, 1]
    length = float(np.linalg.norm(opens))
    if length < 1e-9:
        return np.eye(n_parameters)
    return np.eye(n_parameters) + (lip_weight - 1.0) * np.outer(opens, opens) / length**2
