"""One plain colour a vertex, so that an exported character is not grey in other programs."""

from __future__ import annotations

import numpy as np

from core.face.face import PARTS, Face

WHITE_OF_EYE = (0.72, 0.68, 0.64)
PUPIL = (0.01, 0.01, 0.01)
IRIS_DEG, PUPIL_DEG = 30.0, 16.0  # the rings of our eyeballs stand at 11, 22 and 45 degrees
COLOURS = {
    "upper_teeth": (0.70, 0.64, 0.53), "lower_teeth": (0.70, 0.64, 0.53), "tongue": (0.35, 0.10, 0.10),
    "mouth_socket": (0.14, 0.03, 0.03),
}  # fmt: skip


def vertex_colours(face: Face) -> np.ndarray:
    """Return linear RGB of the vertices, float32, shape (V, 3), 0..1, from the face's look, parts and masks.

    Textures, brows and wrinkles, which our own pictures paint, are left out.
    """
    look = face.look
    colours = np.tile(np.float32(look.skin), (len(face.positions), 1))
    if "lips" in face.masks:
        share = face.masks["lips"][:, None] * look.lip_tint
        colours += share * (np.float32(look.lips) - colours)
    if "hair" in face.masks and look.hair_mm:
        colours[face.masks["hair"] > 0] = look.hair
    for part, colour in COLOURS.items():
        colours[face.vertices_of(part)] = colour
    for name in PARTS:
        if name.startswith("lashes"):
            colours[face.vertices_of(name)] = look.hair
    for name in ("eye_left", "eye_right"):
        ball = face.vertices_of(name)
        if len(ball):
            outwards = face.positions[ball] - face.positions[ball].mean(axis=0)
            angle_deg = np.degrees(np.arctan2(np.hypot(outwards[:, 0], outwards[:, 1]), outwards[:, 2]))
            colours[ball] = WHITE_OF_EYE
            colours[ball[angle_deg < IRIS_DEG]] = look.iris
            colours[ball[angle_deg < PUPIL_DEG]] = PUPIL
    return np.clip(colours, 0.0, 1.0)
