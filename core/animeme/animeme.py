"""The dominated animeme model: phonemes in, control curves out (Kuo, Chuang, Chen, Lin and Chen 2012, section 5)."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core.animeme.design import Scene
from core.animeme.form import AnimemeForm
from core.animeme.levels import N_PHONEMES, levels_of, sharing
from core.animeme.utterances import Nearby, Utterances
from core.errors import UserFacingError
from core.face.face_file import UNREADABLE, read_arrays
from core.media.swap_in import swapped_in
from core.rig.control_track import ControlTrack
from core.speech.emotion import EmotionModifier
from core.speech.phoneme import PHONEMES
from core.speech.transcript import Transcript

FORMAT = "efase-animemes 1"


@dataclass(frozen=True, eq=False)
class AnimemeModel:
    """Coefficients and widths of the animemes of every phoneme for U controls.

    names : of the controls
    rest : float64, shape (U,), their values at rest, which equation 1 is added to
    widths : float64, shape (n_groups, 2, n_phonemes), σ1 and σ2; controls of one group share them
    group : int, shape (U,), of each control
    coefficients : level name to float64, shape (n_rows, degree + 1, U); see `core.animeme.levels`
    span_s : float64, shape (2, n_phonemes), shortest and longest duration of each phoneme that was learnt from
    content : hex digest of what it was learnt from, "" if unknown
    """

    form: AnimemeForm
    names: tuple[str, ...]
    rest: np.ndarray
    widths: np.ndarray
    group: np.ndarray
    coefficients: Mapping[str, np.ndarray]
    span_s: np.ndarray
    content: str = ""

    def curves(
        self, transcript: Transcript, rate_hz: float, modifiers: Sequence[EmotionModifier] = (),
        n_frames: int | None = None, holds: bool = False,
    ) -> ControlTrack:  # fmt: skip
        """Speak ``transcript`` (equation 1).

        modifiers : emotion spans; the animemes of the emotions are mixed by them, phoneme by phoneme
        n_frames : as many as cover the transcript when absent
        holds : keep a phoneme that is longer than any that was learnt from at its middle (see `dominance.held`)
        """
        if n_frames is None:
            n_frames = max(1, round(transcript.duration_s * rate_hz))
        utterances = Utterances.of([transcript], [modifiers])
        return ControlTrack(self.names, self.values(utterances, [np.arange(n_frames) / rate_hz], holds), rate_hz)

    def values(self, utterances: Utterances, times_s: Sequence[np.ndarray], holds: bool = False) -> np.ndarray:
        """Evaluate equation 1 at any times of any sentences; float64, shape (n_frames, U)."""
        scene = self.scene(utterances, times_s, holds)
        polynomials = self.polynomials(utterances)
        values = np.empty((scene.n_frames, len(self.names)))
        for g, widths in enumerate(self.widths):
            mine = self.group == g
            values[:, mine] = scene.matrix(scene.weights(widths)) @ polynomials[:, mine]
        return values + self.rest

    def polynomials(self, utterances: Utterances) -> np.ndarray:
        """Return the coefficients of equation 2 of each occurrence, shape (J (degree + 1), U); see `Scene.powers`."""
        shared = sharing(levels_of(self.form, {}), self.form.degree, utterances, self.span_s)
        stacked = np.concatenate([table.reshape(-1, len(self.names)) for table in self.coefficients.values()])
        return shared @ stacked

    def scene(self, utterances: Utterances, times_s: Sequence[np.ndarray], holds: bool = False) -> Scene:
        """Lay sentences over their frames as this model does."""
        nearby = Nearby.of(utterances, times_s, self.form.neighbours)
        return Scene(self.form, utterances, nearby, self.span_s[1] if holds else None)

    def rule(
        self, transcript: Transcript, rate_hz: float, n_frames: int, control: str | None = None, holds: bool = False
    ) -> np.ndarray:
        """Return how strongly each phoneme rules each frame, float64, shape (n_phonemes said, n_frames).

        Normalised forms sum to 1 in each frame. ``control`` matters where controls have widths of their own.
        """
        group = 0 if control is None else int(self.group[self.names.index(control)])
        scene = self.scene(Utterances.of([transcript]), [np.arange(n_frames) / rate_hz], holds)
        ruling = np.zeros((len(scene.utterances), n_frames))
        ruling[scene.nearby.utterance, scene.nearby.frame] = scene.weights(self.widths[group]).value
        return ruling

    def save(self, path: Path) -> None:
        """Write the model; raises `UserFacingError` when it cannot be written."""
        head = {"format": FORMAT, "form": self.form.as_dict(), "controls": list(self.names),
                "phonemes": list(PHONEMES), "content": self.content}  # fmt: skip
        with swapped_in(path) as beside, beside.open("wb") as file:
            np.savez_compressed(
                file, head=np.str_(json.dumps(head)), rest=self.rest, widths=self.widths, group=self.group,
                span_s=self.span_s, **{f"level_{name}": table for name, table in self.coefficients.items()},
            )  # fmt: skip


def load_animemes(path: Path) -> AnimemeModel:
    """Read what `AnimemeModel.save` wrote; raises `UserFacingError` for what is missing, damaged or another thing."""
    path = Path(path)
    try:
        arrays = read_arrays(path)
        head = json.loads(str(arrays["head"]))
        if head["format"] != FORMAT or head["phonemes"] != list(PHONEMES):
            raise UserFacingError(f"'{path}' holds animemes of another version of the workstation.", "Train them anew.")
        form, names = AnimemeForm.from_dict(head["form"]), tuple(str(name) for name in head["controls"])
        shapes = {level.name: (level.n_rows, level.degree + 1, len(names)) for level in levels_of(form, {})}
        tables = {name: arrays[f"level_{name}"].astype(float) for name in shapes}
        rest, widths, span_s = (arrays[name].astype(float) for name in ("rest", "widths", "span_s"))
        group = arrays["group"].astype(int)
        content = str(head["content"])
    except FileNotFoundError as error:
        raise UserFacingError(f"There are no animemes at '{path}'.", "Make them with `efase train animeme`.") from error
    except UNREADABLE as error:
        raise UserFacingError(f"'{path}' is no file of animemes, or it is damaged.", "Train them anew.") from error
    sound = (
        all(tables[name].shape == shape for name, shape in shapes.items())
        and rest.shape == group.shape == (len(names),)
        and widths.ndim == 3 and widths.shape[1:] == span_s.shape == (2, N_PHONEMES)
        and len(names) and len(set(names)) == len(names)
        and all(np.isfinite(a).all() for a in (rest, widths, span_s, *tables.values()))
        and widths.min(initial=1) > 0 and span_s.min() > 0
        and 0 <= group.min(initial=0) <= group.max(initial=0) < len(widths)
    )  # fmt: skip
    if not sound:
        raise UserFacingError(f"'{path}' is damaged: its arrays do not belong together.", "Train them anew.")
    return AnimemeModel(form, names, rest, widths, group, tables, span_s, content)
