"""Training of the modern face: the same features, more of them, louder and softer, and in noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from core.iface.descent import DescentSettings, descend
from core.iface.heard_takes import HeardTake
from core.iface.lessons import heard_in_noise, heard_windows, shown_parameters, silence_of, units_of, usable_takes
from core.iface.modern_face import ModernFace
from core.iface.motion_unit import NEUTRAL, MotionUnits
from core.motion.marker_set import MarkerSet
from core.progress import SILENT, Progress


@dataclass(frozen=True)
class ModernSettings:
    """What was chosen on held-out sentences (see `docs/iface.md`).

    n_back, n_ahead : frames of the window; hidden : units of the two layers
    n_nets : perceptrons that are averaged
    lip_weight : an error of the lip gap counts as much as this times the same length of any other deformation
    loudness : standard deviation of the loudness that each sentence is given anew in each pass, nepers of energy
    noise_share : of the sentences that are heard in noise, where their takes have it
    n_utterance, n_expression : motion units, a share of the variance each
    """

    n_back: int = 3
    n_ahead: int = 3
    hidden: tuple[int, ...] = (128, 64)
    n_nets: int = 4
    lip_weight: float = 4.0
    loudness: float = 1.5
    noise_share: float = 0.3
    n_utterance: float = 0.98
    n_expression: float = 0.9
    descent: DescentSettings = field(default_factory=DescentSettings)


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
    hearing = _Hearing(takes, settings, silence)
    rest, mixing, wanted, told = _lesson(takes, units, markers, settings.lip_weight)
    nets = []
    for n in range(settings.n_nets):
        stage = progress.part(0.05 + 0.95 * n / settings.n_nets, 0.05 + 0.95 * (n + 1) / settings.n_nets)
        stage.step(0.0, f"perceptron {n + 1} of {settings.n_nets}")
        with threadpool_limits(1):  # batches are too small to share out, and the sums of one thread are always the same
            net = descend(hearing, wanted, told, settings.hidden, settings.descent, seed * settings.n_nets + n, stage)
        nets.append(net.taking(hearing.mean, hearing.scale).giving(rest, mixing))
    progress.step(1.0, "trained")
    neutral = markers.rest.astype(np.float32)
    return ModernFace(units, neutral, silence, settings.n_back, settings.n_ahead, tuple(nets))


class _Hearing:
    """The windows of all used frames, heard anew in each pass: louder or softer, with noise or without."""

    def __init__(self, takes: Sequence[HeardTake], settings: ModernSettings, silence: np.ndarray) -> None:
        n_noisy = min(len(take.in_noise) for take in takes)
        n_window = settings.n_back + 1 + settings.n_ahead
        quiet = heard_windows(takes, settings.n_back, settings.n_ahead, silence)
        used = np.concatenate([take.features[take.used] for take in takes])
        mean, scale = used.mean(axis=0, dtype=float), used.std(axis=0, dtype=float).clip(1e-6)
        self.mean, self.scale = np.tile(mean, n_window), np.tile(scale, n_window)
        self._heard = [self._standard(quiet)]
        for i in range(n_noisy):
            noisy = [heard_in_noise(take, i) for take in takes]
            self._heard.append(
                self._standard(heard_windows(noisy, settings.n_back, settings.n_ahead, silence_of(noisy)))
            )
        self._n_frames = [int(take.used.sum()) for take in takes]
        self._loudness = settings.loudness / scale[0]
        self._chances = np.full(1 + n_noisy, settings.noise_share / max(1, n_noisy))
        self._chances[0] = 1.0 - settings.noise_share if n_noisy else 1.0

    def __call__(self, rng: np.random.Generator) -> np.ndarray:
        """Return the windows of one pass, standardised, float32."""
        which = rng.choice(len(self._heard), len(self._n_frames), p=self._chances)
        stops = np.cumsum(self._n_frames)
        heard = np.concatenate([self._heard[w][b - n : b] for w, n, b in zip(which, self._n_frames, stops)])
        louder = rng.normal(0.0, self._loudness, len(self._n_frames)).astype(np.float32)
        heard[:, ::10] += np.repeat(louder, self._n_frames)[:, None]
        return heard

    def _standard(self, heard: np.ndarray) -> np.ndarray:
        return ((heard - self.mean) / self.scale).astype(np.float32)


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
