"""The shapes of the generic face on the fitted one: turned and stretched as the skin was, and closing as they did."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from core.face.blink_fitting import fitted_blink
from core.face.eyelids import eye_opening
from core.face.face import Face
from core.face.lip_contact import LipContact

BLINKS = {"eyeBlinkLeft": "left", "eyeBlinkRight": "right"}
JAW, LIPS_TOGETHER = "jawOpen", "mouthClose"


def carried_shapes(generic: Face, frames: np.ndarray, fitted: Face) -> dict[str, np.ndarray]:
    """Return the units of ``fitted``: those of ``generic``, each displacement by its vertex's frame.

    frames : shape (V, 3, 3), see `core.face.own_face_parts.place_parts`
    returns : unit name to float32, shape (V, 3), mm

    After that the blinks are stretched until the lids meet on this face, and the shape that shuts the lips over an
    open jaw until they do.
    """
    units = {name: np.einsum("vxy,vy->vx", frames, unit).astype(np.float32) for name, unit in generic.units.items()}
    for name, side in BLINKS.items():
        ball = fitted.positions[fitted.vertices_of(f"eye_{side}")]
        if name in units and len(ball):
            rim = eye_opening(fitted, ball)
            units[name] = fitted_blink(fitted.positions, units[name], rim, ball).astype(np.float32)
    _shut_lips(generic, fitted, units)
    return units


def _shut_lips(generic: Face, fitted: Face, units: Mapping[str, np.ndarray]) -> None:
    """Let the lips, shut over an open jaw, be as far apart as on the generic face in its own measure; in place."""
    contact = LipContact.of(replace(fitted, units={}))
    if contact is None or JAW not in units or LIPS_TOGETHER not in units:
        return
    scale = fitted.outer_eye_distance / generic.outer_eye_distance
    before = generic.units[JAW] + generic.units[LIPS_TOGETHER]
    now = units[JAW] + units[LIPS_TOGETHER]
    upper, lower = contact.upper, contact.lower
    miss = scale * (before[upper] - before[lower]) - (now[upper] - now[lower])
    for axis in range(3):
        change = miss[:, axis] / 2
        units[LIPS_TOGETHER][contact.vertices, axis] += contact.spread @ np.concatenate([change, -change]).astype(
            np.float32
        )
