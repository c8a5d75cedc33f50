import io
import struct
import zlib

import numpy as np
import pytest

from core.errors import UserFacingError
from core.media.picture import read_picture


def png(pixels):
    """A PNG file made by hand."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    height, width, _ = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def test_a_png_comes_back_pixel_for_pixel(tmp_path):
    pixels = np.random.default_rng(0).integers(0, 256, (12, 20, 3), dtype=np.uint8)
    path = tmp_path / "skin.png"
    path.write_bytes(png(pixels))
    np.testing.assert_array_equal(read_picture(path), pixels)
    np.testing.assert_array_equal(read_picture(io.BytesIO(png(pixels)), "skin"), pixels)


@pytest.mark.parametrize("content", [b"", b"no picture", b"\x89PNG\r\n\x1a\n" + b"\0" * 40])
def test_what_is_no_picture_is_one_sentence(tmp_path, content):
    path = tmp_path / "skin.png"
    path.write_bytes(content)
    with pytest.raises(UserFacingError, match="not a readable picture"):
        read_picture(path)


def test_a_missing_file_is_said(tmp_path):
    with pytest.raises(UserFacingError, match="There is no picture"):
        read_picture(tmp_path / "none.png")


def test_a_picture_too_large_is_refused(tmp_path):
    path = tmp_path / "wide.png"
    path.write_bytes(png(np.zeros((1, 9000, 3), np.uint8)))
    with pytest.raises(UserFacingError, match="9000 by 1 pixels"):
        read_picture(path)
