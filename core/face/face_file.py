"""A face in one compact file: compressed arrays, no pickles."""

from __future__ import annotations

import json
import os
import zipfile
import zlib
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import PARTS, Face
from core.face.look import Look

FACE_SUFFIX = ".npz"
FORMAT = 2
MOST_TEXELS = 3 * 8192 * 8192
# RuntimeError: an archive said to be encrypted or packed in an unknown way, JSON nested without end;
# MemoryError: an array said to be larger than any memory
UNREADABLE = (
    OSError, EOFError, KeyError, TypeError, ValueError, zipfile.BadZipFile, zlib.error, RuntimeError, OverflowError,
    MemoryError,
)  # fmt: skip


def save_face(face: Face, path: Path) -> None:
    """Write ``face``, making the folder if need be."""
    path.parent.mkdir(parents=True, exist_ok=True)
    write_arrays(
        path,
        format=np.int64(FORMAT),
        name=np.str_(face.name),
        credit=np.str_(face.credit),
        positions=face.positions,
        triangles=face.triangles,
        part=face.part,
        uv=np.zeros((0, 2), np.float32) if face.uv is None else face.uv,
        landmark_names=np.array(list(face.landmarks), np.str_),
        landmark_vertices=np.array(list(face.landmarks.values()), np.int64),
        unit_names=np.array(list(face.units), np.str_),
        units=np.array(list(face.units.values()), np.float32).reshape(len(face.units), len(face.positions), 3),
        look=np.str_(json.dumps(face.look.as_dict())),
        mask_names=np.array(list(face.masks), np.str_),
        masks=np.array(list(face.masks.values()), np.float32).reshape(len(face.masks), len(face.positions)),
        is_kin=np.bool_(face.is_kin),
        **({} if face.texture is None else {"texture": face.texture}),
    )


def write_arrays(path: Path, **arrays: np.ndarray) -> None:
    """Write compressed arrays beside ``path`` and swap them in, so that no half-written file is ever seen."""
    beside = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        with open(beside, "wb") as file:
            np.savez_compressed(file, **arrays)
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Read what `write_arrays` wrote; raises one of `UNREADABLE`."""
    # np.load leaves a file that it opened itself open when it is no archive
    with open(path, "rb") as file, np.load(file, allow_pickle=False) as data:
        return dict(data)


def read_face(path: Path) -> Face:
    """Read what `save_face` wrote; `UserFacingError` if the file is missing, damaged or another version's."""
    try:
        data = read_arrays(path)
        if int(data["format"]) != FORMAT:
            raise UserFacingError(f"{path} is a face of another version of the workstation.")
        face = Face(
            name=str(data["name"]),
            positions=data["positions"],
            triangles=data["triangles"],
            part=data["part"],
            uv=data["uv"] if len(data["uv"]) else None,
            landmarks=dict(zip(data["landmark_names"].tolist(), data["landmark_vertices"].tolist())),
            units=dict(zip(data["unit_names"].tolist(), data["units"])),
            credit=str(data["credit"]),
            look=Look.from_dict(json.loads(str(data["look"]))),
            masks=dict(zip(data["mask_names"].tolist(), data["masks"])),
            # files of our characters were written before these two
            is_kin=bool(data.get("is_kin", False)),
            texture=data.get("texture"),
        )
    except UNREADABLE as error:
        raise UserFacingError(f"{path} is not a readable face file.") from error
    _check(face, path)
    return face


def _check(face: Face, path: Path) -> None:
    count = len(face.positions)
    numbers = [*face.landmarks.values(), int(face.triangles.min(initial=0)), int(face.triangles.max(initial=0))]
    sound = (
        face.positions.shape == (count, 3)
        and np.isfinite(face.positions).all()
        and face.triangles.ndim == 2
        and face.triangles.shape[1] == 3
        and face.part.shape == (count,)
        and face.part.max(initial=0) < len(PARTS)
        and all(0 <= number < count for number in numbers)
        and all(unit.shape == (count, 3) and np.isfinite(unit).all() for unit in face.units.values())
        and all(mask.shape == (count,) and np.isfinite(mask).all() for mask in face.masks.values())
        and (face.uv is None or (face.uv.shape == (count, 2) and np.isfinite(face.uv).all()))
        and (face.texture is None or _is_picture(face.texture))
    )
    if not sound:
        raise UserFacingError(f"{path} is damaged: its arrays do not belong together.")


def _is_picture(texture: np.ndarray) -> bool:
    return texture.dtype == np.uint8 and texture.ndim == 3 and texture.shape[2] == 3 and 0 < texture.size <= MOST_TEXELS
