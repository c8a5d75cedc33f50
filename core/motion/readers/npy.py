"""Arrays of numbers and texts from .npy and .npz files, and nothing else of what these can hold.

numpy's own reader asks for the memory that a header declares before it looks at how much there is, and warns of files
that Python 2 wrote; so the header is read here (numpy.lib.format, versions 1 to 3) and the bytes are counted first.
"""

from __future__ import annotations

import math
import re
import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.motion.readers.archive import TooLarge, read_member

# an hour of 148 points at 120 Hz is 384 MiB; more is refused before memory is asked for
LARGEST_BYTES = 1 << 30
_MAGIC = b"\x93NUMPY"
_HEADER = re.compile(
    r"\{'descr': '(?P<descr>[<>|=]?[biufUS]\d{0,6})', *'fortran_order': (?P<fortran>True|False), *"
    r"'shape': \((?P<shape>[\d, L]{0,200})\),? *\} *\n?"
)
_UNREADABLE = (
    OSError,
    ValueError,
    EOFError,
    KeyError,
    NotImplementedError,
    RuntimeError,
    zipfile.BadZipFile,
    zlib.error,
)


def read_npy(path: Path) -> np.ndarray:
    """Read the array of a .npy file; raises `UserFacingError` for what is missing, cut, pickled, or no such file."""
    try:
        if path.stat().st_size > LARGEST_BYTES:
            raise UserFacingError(f"'{path}' is larger than 1 GiB.", "Cut it into takes.")
        return parse_npy(path.read_bytes())
    except OSError as error:
        raise UserFacingError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except ValueError as error:
        raise UserFacingError(f"'{path}' is no readable array: {error}.") from error


def read_npz(path: Path, wanted: Collection[str] | None = None) -> dict[str, np.ndarray]:
    """Read the arrays of a .npz archive that are among ``wanted`` (None: all); absent ones are left out.

    Raises `UserFacingError` for what is missing, damaged, pickled, or more than 1 GiB in all.
    """
    arrays: dict[str, np.ndarray] = {}
    left = LARGEST_BYTES
    try:
        archive_bytes = path.stat().st_size
        with path.open("rb") as file, zipfile.ZipFile(file) as archive:
            for member in archive.infolist():
                name = member.filename.removesuffix(".npy")
                if wanted is not None and name not in wanted:
                    continue
                raw = read_member(archive, member, archive_bytes, left)
                left -= len(raw)
                arrays[name] = parse_npy(raw)
    except TooLarge as error:
        raise UserFacingError(f"The arrays of '{path}' are larger than {LARGEST_BYTES >> 20} MiB.") from error
    except _UNREADABLE as error:
        raise UserFacingError(f"'{path}' is no readable archive of arrays.") from error
    return arrays


def parse_npy(raw: bytes) -> np.ndarray:
    """Read the bytes of a .npy file; raises `ValueError` that says what is wrong. The array cannot be written to."""
    if raw[:6] != _MAGIC or len(raw) < 12 or raw[6] not in (1, 2, 3):
        raise ValueError("it is not in numpy's format")
    at = 10 if raw[6] == 1 else 12
    length = int.from_bytes(raw[8:at], "little")
    match = _HEADER.fullmatch(raw[at : at + length].decode("latin-1"))
    if match is None:
        raise ValueError("it holds something other than numbers and texts")
    try:
        dtype = np.dtype(match["descr"])
    except TypeError as error:
        raise ValueError("it holds numbers of no known kind") from error
    # Python 2 wrote long numbers with an L
    shape = tuple(int(n) for n in match["shape"].replace("L", "").replace(" ", "").split(",") if n)
    count = math.prod(shape)
    body = memoryview(raw)[at + length :]
    if dtype.itemsize == 0 or len(shape) > 8 or count * dtype.itemsize != len(body):
        raise ValueError("its size is not what its header says")
    array = np.frombuffer(body, dtype, count)
    return array.reshape(shape, order="F" if match["fortran"] == "True" else "C")
