"""A photo on a fitted face: the camera that took it, from points clicked on both, and the colours that it saw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import distance_transform_edt, gaussian_filter
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face.face import PARTS, Face
from core.face.own_face_raster import covered_pixels
from core.face.own_face_surface import vertex_normals
from core.face.own_face_texture import SIZE_PX, SkinTexels, sampled
from core.face.similarity import fit_similarity
from core.progress import SILENT, Progress

FEWEST = 6
FACES_CAMERA = (0.2, 0.5)  # cosine from which a place is seen, and from which it is seen well
EDGE = (0.012, 0.04)  # of the head's width: from its outline on, where a photo may show what lies behind
SOFT_PX = 5.0  # of a picture of 1024: seams between what is seen and what is filled are so wide
LIGHT_SHARE, TINT_SHARE, MOST_LIGHT = 0.7, 0.6, 1.7  # how much of the photo's light and its tint is taken out
SHADOW_PX = 640
BEHIND_MM = 4.0
WORST_SHARE = 0.06  # of the points' spread in the photo, that a camera may miss them by


@dataclass(frozen=True)
class PhotoCamera:
    """A pinhole camera: pixel = centre + focal · (x, -y) / -z of ``turn`` · place + ``shift``; it looks along -z.

    turn : shape (3, 3); shift : shape (3,), mm; focal_px : focal length; centre_px : shape (2,)
    error_px : root mean square of what it misses the clicked points by
    """

    turn: np.ndarray
    shift: np.ndarray
    focal_px: float
    centre_px: np.ndarray
    error_px: float

    def seen(self, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return pixels, shape (n, 2), x to the right and y down, and depths, shape (n,), mm, of ``places`` (n, 3)."""
        at = places @ self.turn.T + self.shift
        depth = np.maximum(-at[:, 2], 1e-6)
        return self.centre_px + self.focal_px * at[:, :2] * [1.0, -1.0] / depth[:, None], depth


def fit_camera(
    places: Mapping[str, np.ndarray], pixels: Mapping[str, np.ndarray], size_px: tuple[int, int]
) -> PhotoCamera:
    """Find the camera that sees ``places`` (mm, on the face) at ``pixels`` of a photo of width and height ``size_px``.

    Six numbers of its pose and its focal length, by least squares of the pixels missed. Raises `UserFacingError` for
    fewer than six common points, points outside of the photo, and points that no camera sees so.
    """
    keys = [key for key in places if key in pixels]
    if len(keys) < FEWEST:
        raise UserFacingError(f"The photo has {len(keys)} of the points, and {FEWEST} are needed.")
    source, target = np.array([places[key] for key in keys]), np.array([pixels[key] for key in keys], float)
    outside = (target < 0).any(axis=1) | (target > size_px).any(axis=1)
    if outside.any():
        raise UserFacingError(f"The point {keys[int(outside.argmax())]} lies outside of the photo.")
    spread = float(np.linalg.norm(target - target.mean(axis=0), axis=1).max())
    centre, middle = np.array(size_px) / 2.0, source.mean(axis=0)
    # seen from straight ahead by a portrait lens, as most photos of faces are
    flat = np.column_stack([(target - target.mean(axis=0)) * [1.0, -1.0], np.zeros(len(keys))])
    scale = max(fit_similarity((source - middle) * [1.0, 1.0, 0.0], flat).scale, 1e-6)
    focal = 1.6 * max(size_px)
    distance = focal / scale
    pan = (target.mean(axis=0) - centre) * [1.0, -1.0] / scale
    start = np.array([0.0, 0.0, 0.0, pan[0] / 100, pan[1] / 100, -distance / 100, np.log(focal)])

    def camera(x: np.ndarray, error: float = 0.0) -> PhotoCamera:
        turn = Rotation.from_rotvec(x[:3]).as_matrix()
        return PhotoCamera(turn, 100 * x[3:6] - turn @ middle, float(np.exp(x[6])), centre, error)

    def missed(x: np.ndarray) -> np.ndarray:
        # few points tell little of the focal length: a weak pull towards a portrait lens
        return np.append(((camera(x).seen(source)[0] - target) / spread).ravel(), 0.02 * (x[6] - start[6]))

    found = least_squares(missed, start, loss="soft_l1", f_scale=0.05, max_nfev=400).x
    miss = np.linalg.norm(camera(found).seen(source)[0] - target, axis=1)
    error = float(np.sqrt(np.square(miss).mean()))
    if not np.isfinite(error) or error > WORST_SHARE * spread:
        worst = keys[int(np.nan_to_num(miss, nan=np.inf).argmax())]
        raise UserFacingError(
            f"No camera sees the points as they are on the photo; {worst} is {miss.max():.0f} pixels off.",
            "Click it again; left is the character's left.",
        )
    return camera(found, error)


def photo_texture(
    face: Face, uv: np.ndarray, photo: np.ndarray, camera: PhotoCamera, size_px: int = SIZE_PX,
    progress: Progress = SILENT,
) -> np.ndarray:  # fmt: skip
    """Return the colours of a photo on the fitted face, uint8, shape (size, size, 3).

    What the camera does not see takes the colour of the other side of the face, and what neither shows is filled.
    """
    progress.step(0.0, "laying the photo on the face")
    texels = SkinTexels(face, uv, size_px)
    positions = face.positions.astype(float)
    facing = texels.mixed(vertex_normals(positions, face.triangles))
    facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-12)
    places = texels.mixed(positions)
    eye = -camera.turn.T @ camera.shift
    towards = eye - places
    towards /= np.linalg.norm(towards, axis=1, keepdims=True)
    low, high = FACES_CAMERA
    sure = np.clip((np.einsum("ij,ij->i", facing, towards) - low) / (high - low), 0.0, 1.0)
    pixels, depth = camera.seen(places)
    height, width = photo.shape[:2]
    sure *= ((pixels > 0.5) & (pixels < np.array([width, height]) - 0.5)).all(axis=1)
    progress.step(0.4)
    nearest, inside = _seen_surface(face, camera, pixels)
    low, high = EDGE
    sure *= (depth < nearest + BEHIND_MM) * np.clip((inside - low) / (high - low), 0.0, 1.0)
    sure = _softened(texels, sure)
    colours = sampled(photo, np.stack([pixels[:, 1] - 0.5, pixels[:, 0] - 0.5]))
    colours = without_light(colours, facing, sure)
    progress.step(0.7)
    whole = np.zeros((size_px, size_px, 4))
    whole[texels.rows, texels.columns] = np.column_stack([colours, sure])
    # the unwrapping is as symmetrical as the head that it was made from
    other = whole[:, ::-1][texels.rows, texels.columns]
    lack = (1.0 - sure) * other[:, 3]
    total = np.maximum(sure + lack, 1e-9)
    mixed = (colours * sure[:, None] + other[:, :3] * lack[:, None]) / total[:, None]
    return texels.picture(mixed, np.minimum(sure + lack, 1.0))


def without_light(colours: np.ndarray, normals: np.ndarray, sure: np.ndarray) -> np.ndarray:
    """Take the light out of a photo's colours (n, 3), 0..255: the renderer brings its own.

    normals : shape (n, 3), unit; sure : shape (n,), how well each colour is known

    Light that comes from afar depends on the normal alone, and smoothly: nine spherical harmonics hold 99 % of it
    (Ramamoorthi and Hanrahan 2001). They are fitted to the logarithm of each colour, robustly, since brows and hair are
    dark by themselves. Some of it stays, as skin is not of one colour all round a head either.
    """
    known = np.flatnonzero(sure > 0.5)
    if len(known) < 100:
        return colours
    known = known[:: max(1, len(known) // 20_000)]
    basis = _harmonics(normals)
    brightness = np.log(np.maximum(colours, 4.0))
    weights = np.ones((len(known), 1))
    for _ in range(8):
        fit = np.linalg.lstsq(basis[known] * weights, brightness[known] * weights, rcond=None)[0]
        off = np.linalg.norm(brightness[known] - basis[known] @ fit, axis=1, keepdims=True)
        weights = np.sqrt(1.0 / (1.0 + (off / max(1.5 * float(np.median(off)), 1e-3)) ** 2))
    light = basis @ fit
    light = np.median(light[known], axis=0) - light
    grey = light.mean(axis=1, keepdims=True)
    factor = np.exp(LIGHT_SHARE * grey + TINT_SHARE * (light - grey))
    return np.clip(colours * np.clip(factor, 1.0 / MOST_LIGHT, MOST_LIGHT), 0.0, 255.0)


def _harmonics(normals: np.ndarray) -> np.ndarray:
    x, y, z = normals.T
    return np.column_stack([np.ones(len(x)), x, y, z, x * y, x * z, y * z, x * x - y * y, 3.0 * z * z - 1.0])


def _softened(texels: SkinTexels, sure: np.ndarray) -> np.ndarray:
    """Smooth what is known how well over the picture, never to more than it was."""
    whole, there = np.zeros((2, texels.size_px, texels.size_px))
    whole[texels.rows, texels.columns] = sure
    there[texels.rows, texels.columns] = 1.0
    reach = SOFT_PX * texels.size_px / 1024
    mean = gaussian_filter(whole, reach) / np.maximum(gaussian_filter(there, reach), 1e-6)
    t = np.clip(2.0 * mean[texels.rows, texels.columns] - 1.0, 0.0, 1.0)
    return sure * t * t * (3.0 - 2.0 * t)


def _seen_surface(face: Face, camera: PhotoCamera, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how near the skin is that the camera sees at ``pixels``, mm, and how far from the head's outline that is.

    The latter as a fraction of the head's width.
    """
    skin = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    at, depth = camera.seen(face.positions.astype(float))
    low = at.min(axis=0)
    scale = (SHADOW_PX - 3) / max(float(np.ptp(at, axis=0).max()), 1e-6)
    owner, bary = covered_pixels(((at - low) * scale + 1.0)[skin], SHADOW_PX, SHADOW_PX, depth[skin])
    seen = np.where(owner >= 0, np.einsum("hwk,hwk->hw", bary, depth[skin][owner]), np.inf)
    eyes = [face.landmarks["outer_eye_left"], face.landmarks["outer_eye_right"]]
    # twice the eyes' distance is about the width of a head, however wide its shoulders are
    width = 2.0 * max(float(np.linalg.norm(np.subtract(*at[eyes]))) * scale, 1.0)
    inside = distance_transform_edt(owner >= 0) / width
    where = np.clip(((pixels - low) * scale + 1.0).astype(int), 0, SHADOW_PX - 1)
    return seen[where[:, 1], where[:, 0]], inside[where[:, 1], where[:, 0]]
