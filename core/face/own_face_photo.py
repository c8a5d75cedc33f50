"""A photo on a fitted face: the camera that took it, from points clicked on both, and the colours that it saw."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from core.errors import UserFacingError
from core.face.binding import similarity
from core.face.face import PARTS, Face
from core.face.own_face_closing import vertex_normals
from core.face.own_face_raster import covered_pixels
from core.face.own_face_texture import SIZE_PX, SkinTexels, sampled
from core.progress import SILENT, Progress

FEWEST = 6
FACES_CAMERA = (0.15, 0.5)  # cosine from which a place is seen, and from which it is seen well
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
    scale = max(similarity((source - middle) * [1.0, 1.0, 0.0], flat)[0], 1e-6)
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
    sure *= depth < _nearest_depth(face, camera, pixels) + BEHIND_MM
    colours = sampled(photo, np.stack([pixels[:, 1] - 0.5, pixels[:, 0] - 0.5]))
    progress.step(0.7)
    whole = np.zeros((size_px, size_px, 4))
    whole[texels.rows, texels.columns] = np.column_stack([colours, sure])
    # the unwrapping is as symmetrical as the head that it was made from
    other = whole[:, ::-1][texels.rows, texels.columns]
    lack = (1.0 - sure) * other[:, 3]
    total = np.maximum(sure + lack, 1e-9)
    mixed = (colours * sure[:, None] + other[:, :3] * lack[:, None]) / total[:, None]
    return texels.picture(mixed, np.minimum(sure + lack, 1.0))


def _nearest_depth(face: Face, camera: PhotoCamera, pixels: np.ndarray) -> np.ndarray:
    """Return how near the skin is that the camera sees in the directions of ``pixels``, mm."""
    skin = face.triangles[(face.part[face.triangles] == PARTS.index("skin")).all(axis=1)]
    at, depth = camera.seen(face.positions.astype(float))
    low = at.min(axis=0)
    scale = (SHADOW_PX - 1) / max(float(np.ptp(at, axis=0).max()), 1e-6)
    owner, bary = covered_pixels(((at - low) * scale)[skin], SHADOW_PX, SHADOW_PX, depth[skin])
    seen = np.where(owner >= 0, np.einsum("hwk,hwk->hw", bary, depth[skin][owner]), np.inf)
    where = np.clip(((pixels - low) * scale).astype(int), 0, SHADOW_PX - 1)
    return seen[where[:, 1], where[:, 0]]
