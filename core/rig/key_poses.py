"""An artist's poses: how her character shapes each key lip shape, and what that makes of captured frames."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from core.animeme.cross_mapping import bounded_least_squares, solve_controls, solve_shares, units_at_markers
from core.errors import UserFacingError
from core.face.face import Face
from core.media.swap_in import swapped_in
from core.motion.marker_set import MarkerSet
from core.rig.control_names import control_mixing
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig
from core.speech.text_file import read_text
from core.synthesis.marker_motion import MarkerMotion

FORMAT = "efase-key-poses"
VERSION = 1


@dataclass(frozen=True)
class KeyPoses:
    """Key lip shapes as captured, and as posed on one rig.

    keys : names of the N key lip shapes; markers : names of the K lip markers
    lips_mm : float64, shape (N, K, 3), where the markers stand, from rest
    controls : names of the U controls of the rig; values : float64, shape (N, U), each in [0, 1]
    """

    rig: str
    keys: tuple[str, ...]
    markers: tuple[str, ...]
    lips_mm: np.ndarray
    controls: tuple[str, ...]
    values: np.ndarray

    def with_pose(self, key: str, values: dict[str, float]) -> KeyPoses:
        """Return poses of which one is another; controls that are not named rest.

        Raises `UserFacingError` for a key or a control that there is not, and for a value outside [0, 1].
        """
        if key not in self.keys:
            raise UserFacingError(f"There is no key lip shape '{key[:40]}'.", f"There are {', '.join(self.keys)}.")
        row = np.zeros(len(self.controls))
        for name, value in values.items():
            if name not in self.controls:
                raise UserFacingError(f"The rig '{self.rig}' has no control '{name[:60]}'.")
            if not 0.0 <= value <= 1.0:
                raise UserFacingError(f"Control '{name}' of key lip shape '{key}' is {value:g}, not within 0 and 1.")
            row[self.controls.index(name)] = value
        changed = self.values.copy()
        changed[self.keys.index(key)] = row
        return replace(self, values=changed)

    def save(self, path: str | Path) -> None:
        """Write JSON; raises `UserFacingError` when the file cannot be written."""
        posed = [
            {"name": key, "controls": {n: round(v, 6) for n, v in zip(self.controls, row) if v}, "lips_mm": lips}
            for key, row, lips in zip(self.keys, self.values.tolist(), np.round(self.lips_mm, 4).tolist())
        ]
        data = {"format": FORMAT, "version": VERSION, "rig": self.rig, "controls": self.controls,
                "markers": self.markers, "keys": posed}  # fmt: skip
        with swapped_in(path) as beside:
            beside.write_text(json.dumps(data, indent=1) + "\n", encoding="utf-8", newline="\n")


def resting_poses(
    rig: str, controls: tuple[str, ...], markers: MarkerSet, lips: np.ndarray, lips_mm: np.ndarray
) -> KeyPoses:
    """Name key lip shapes and leave all their controls at rest; see `default_poses`."""
    keys = tuple(f"lips{n + 1}" for n in range(len(lips_mm)))
    names = tuple(markers.names[k] for k in lips)
    at_rest = np.zeros((len(keys), len(controls)))
    return KeyPoses(rig, keys, names, np.asarray(lips_mm, float), controls, at_rest)


def default_poses(face: Face, markers: MarkerSet, lips: np.ndarray, lips_mm: np.ndarray) -> KeyPoses:
    """Pose ``face`` for each key lip shape by least squares at its lip markers, for an artist to go on from.

    lips : int, shape (K,), rows of ``markers``; lips_mm : shape (N, K, 3), mm from rest
    """
    names, units = units_at_markers(face, markers)
    values = solve_controls(lips_mm, units[:, lips])
    return replace(resting_poses(face.name, names, markers, lips, lips_mm), values=values)


def first_poses(rig: Rig, face: Face, markers: MarkerSet, lips: np.ndarray, lips_mm: np.ndarray) -> KeyPoses:
    """Pose any rig for an artist to go on from: as ``face`` would, where controls match by name, else at rest.

    face : one with ARKit's units that the markers can be laid on, such as the default face; see `default_poses`
    """
    known = default_poses(face, markers, lips, lips_mm)
    values = np.clip(known.values @ control_mixing(known.controls, rig.names), 0.0, 1.0)
    return replace(known, rig=rig.face.name, controls=rig.names, values=values)


def posed_controls(poses: KeyPoses, rig: Rig, motion: MarkerMotion) -> ControlTrack:
    """Return the controls of ``rig`` for captured or synthesised lips.

    Shares α >= 0 of the key lip shapes come from the lip markers; V = Σ α_k V_k is what the poses make of them, and
    the controls are those in [0, 1] that come nearest to it, min |V − V_C|² over the vertices. Raises
    `UserFacingError` when the poses are another rig's, or the motion lacks their markers.
    """
    _check_rig(poses, rig)
    missing = [name for name in poses.markers if name not in motion.markers.names]
    if missing:
        raise UserFacingError(f"The motion has no lip marker '{missing[0]}', which the poses were made with.")
    rows = [motion.markers.names.index(name) for name in poses.markers]
    shares = solve_shares(motion.displacements[:, rows].astype(float), poses.lips_mm)
    return share_controls(poses, rig, ControlTrack(poses.keys, shares, motion.rate_hz))


def share_controls(poses: KeyPoses, rig: Rig, shares: ControlTrack) -> ControlTrack:
    """Return the controls of ``rig`` for shares of the key lip shapes over time; see `posed_controls`.

    shares : its controls are the keys of ``poses``, in any order
    """
    _check_rig(poses, rig)
    wanted = shares.arranged(poses.keys).values @ poses.values
    values = wanted.copy()
    beyond = ((wanted < 0) | (wanted > 1)).any(axis=1)
    if beyond.any():
        # |(c − c')B|² with all vertices in B is |(c − c')L|² with LLᵀ = BBᵀ
        basis = rig.deltas.reshape(len(rig.names), -1).astype(float)
        sizes, axes = np.linalg.eigh(basis @ basis.T)
        root = axes * np.sqrt(np.maximum(sizes, 0.0))
        values[beyond] = bounded_least_squares(root, wanted[beyond] @ root)
    return ControlTrack(rig.names, values, shares.rate_hz, shares.start_frame)


def _check_rig(poses: KeyPoses, rig: Rig) -> None:
    if poses.controls != rig.names:
        raise UserFacingError(
            f"The poses were made for '{poses.rig}', whose controls are not those of the rig '{rig.face.name}'."
        )


def load_key_poses(path: str | Path) -> KeyPoses:
    """Read what `KeyPoses.save` wrote, or an artist's own; raises `UserFacingError` that says what is wrong with it."""
    try:
        data = json.loads(read_text(path, "file of poses"))
    except (ValueError, RecursionError) as error:
        raise UserFacingError(f"'{path}' is no JSON.") from error
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise UserFacingError(f"'{path}' holds no poses of key lip shapes.")
    if data.get("version") != VERSION:
        raise UserFacingError(f"'{path}' was written by a newer workstation.")
    controls, markers, keys = (_listed(data, name, path) for name in ("controls", "markers", "keys"))
    for name, texts in (("controls", controls), ("markers", markers)):
        if not all(isinstance(text, str) for text in texts) or len(set(texts)) != len(texts):
            raise UserFacingError(f"'{path}': the list '{name}' must hold names, each once.")
    lips, names = [], []
    for n, key in enumerate(keys):
        if not isinstance(key, dict) or not isinstance(key.get("name"), str) or key["name"] in names:
            raise UserFacingError(f"'{path}': key {n + 1} has no name, or one used before.")
        names.append(key["name"])
        try:
            shape = np.array(key.get("lips_mm"), float)
        except (TypeError, ValueError) as error:
            raise UserFacingError(f"'{path}': key '{key['name']}' has lips that are no numbers.") from error
        if shape.shape != (len(markers), 3) or not np.isfinite(shape).all():
            raise UserFacingError(f"'{path}': key '{key['name']}' needs a place for each of {len(markers)} markers.")
        lips.append(shape)
    rest = np.zeros((len(names), len(controls)))
    poses = KeyPoses(str(data.get("rig", "")), tuple(names), tuple(markers), np.array(lips), tuple(controls), rest)
    for key in keys:
        values = key.get("controls", {})
        numbers = isinstance(values, dict) and all(
            isinstance(v, int | float) and math.isfinite(v) for v in values.values()
        )
        if not numbers:
            raise UserFacingError(f"'{path}': the controls of key '{key['name']}' are no numbers.")
        try:
            poses = poses.with_pose(key["name"], values)
        except UserFacingError as error:
            raise UserFacingError(f"'{path}': {error.message}", error.remedy) from error
    return poses


def _listed(data: dict, name: str, path: str | Path) -> list:
    found = data.get(name)
    if not isinstance(found, list) or not found:
        raise UserFacingError(f"'{path}' has no list '{name}'.")
    return found
