"""The markers of an actor: names, where they rest, and what part each plays."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

# Anatomical points that the face needs to know by name, whatever a studio calls its markers.
LANDMARKS = (
    "nose_bridge", "nose_tip", "outer_eye_left", "outer_eye_right", "inner_eye_left", "inner_eye_right",
    "mouth_corner_left", "mouth_corner_right", "upper_lip", "lower_lip", "chin",
    "brow_left", "brow_right", "cheek_left", "cheek_right", "upper_lid_left", "upper_lid_right",
)  # fmt: skip


@dataclass(frozen=True)
class MarkerSet:
    """Markers of one capture; any number of them.

    names : one for each of the K markers, unique
    rest : float64, shape (K, 3), millimetres, head space (x to the actor's left, y up, z forward), of the neutral
        face with closed mouth; the origin marker rests at 0
    groups : marker names by part: ``origin`` (one), ``rigid`` (near-rigid, for head motion; empty = all),
        ``jaw`` (chin, moves with the jaw bone), ``upper_lip``, ``lower_lip``, ``lips`` (all of the mouth)
    landmarks : anatomical name (see `LANDMARKS`) to marker name, as many as the set has;
        ``lower_lip`` plays the part of the paper's marker #79
    """

    names: tuple[str, ...]
    rest: np.ndarray
    groups: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    landmarks: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        rest = np.asarray(self.rest, float)
        if rest.shape != (len(self.names), 3):
            raise ValueError(f"rest has shape {rest.shape}; {len(self.names)} markers need ({len(self.names)}, 3)")
        if len(set(self.names)) != len(self.names):
            raise ValueError("marker names repeat")
        object.__setattr__(self, "rest", rest)

    def __len__(self) -> int:
        return len(self.names)

    def indices(self, names: Sequence[str]) -> np.ndarray:
        """Return rows of ``names``, int, shape (len(names),); `KeyError` for a stranger."""
        row = {name: k for k, name in enumerate(self.names)}
        return np.array([row[name] for name in names], int)

    def group(self, name: str) -> np.ndarray:
        """Return rows of the group ``name``; empty if the set has none of it."""
        return self.indices(self.groups.get(name, ()))

    def landmark(self, name: str) -> int | None:
        """Return the row of an anatomical landmark, or None."""
        marker = self.landmarks.get(name)
        return None if marker is None else self.names.index(marker)

    def to_json(self) -> str:
        """Serialise all but the rest pose, for the database."""
        return json.dumps({"names": list(self.names), "groups": {k: list(v) for k, v in self.groups.items()},
                           "landmarks": dict(self.landmarks)})  # fmt: skip

    @classmethod
    def from_json(cls, text: str, rest: np.ndarray) -> MarkerSet:
        """Inverse of `to_json`."""
        data = json.loads(text)
        groups = {name: tuple(members) for name, members in data["groups"].items()}
        return cls(tuple(data["names"]), rest, groups, data["landmarks"])
