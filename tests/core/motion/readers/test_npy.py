"""Arrays are read as numpy wrote them; what a header says beyond the file's own size is refused."""

import io
import pickle
import tracemalloc
import zipfile

import numpy as np
import pytest

from core.errors import UserFacingError
from core.motion.readers.npy import parse_npy, read_npy, read_npz


@pytest.mark.parametrize(
    "array",
    [
        np.arange(6.0).reshape(2, 3), np.asfortranarray(np.arange(6).reshape(2, 3)), np.float32(7.5), np.zeros((0, 3)),
        np.array(["a", "bcä"]), np.array([b"x"]), np.array([True, False]), np.arange(4, dtype=">i2"),
    ],
    ids=lambda array: f"{array.dtype}-{array.shape}",
)  # fmt: skip
@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_what_numpy_writes_is_read_back(array, version):
    stream = io.BytesIO()
    np.lib.format.write_array(stream, np.asanyarray(array), version)
    read = parse_npy(stream.getvalue())
    np.testing.assert_array_equal(read, array)
    assert read.dtype == array.dtype


def header(text: str, body: bytes = b"") -> bytes:
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode() + body


def test_lists_of_names_that_python_2_wrote_are_read():
    raw = header("{'descr': '<U2', 'fortran_order': False, 'shape': (2L,), }   \n", "abcd".encode("utf-32-le"))
    assert parse_npy(raw).tolist() == ["ab", "cd"]


@pytest.mark.parametrize(
    "raw",
    [
        b"", b"\x93NUMPY", b"PK\x03\x04" * 9,
        header("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }\n", b"x"),
        header("{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999,), }\n", b"12345678"),
        header("{'descr': '<f8', 'fortran_order': False, 'shape': (1,), }\n", b"1234567"),
        header("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,), }\n", b"12345678"),
        header("__import__('os')\n"), header("{'descr': '<f3', 'fortran_order': False, 'shape': (), }\n", b"123"),
    ],
)  # fmt: skip
def test_what_is_no_plain_array_is_refused_before_memory_is_asked_for(tmp_path, raw):
    path = tmp_path / "a.npy"
    path.write_bytes(raw)
    tracemalloc.start()
    try:
        with pytest.raises(UserFacingError, match="no readable array"):
            read_npy(path)
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()


def test_pickles_are_never_run(tmp_path):
    class Bomb:
        def __reduce__(self):
            return (open, (str(tmp_path / "ran"), "w"))

    np.save(tmp_path / "a.npy", np.array([Bomb()], object), allow_pickle=True)
    (tmp_path / "b.npy").write_bytes(pickle.dumps(Bomb()))
    for name in ("a.npy", "b.npy"):
        with pytest.raises(UserFacingError):
            read_npy(tmp_path / name)
    assert not (tmp_path / "ran").exists()


def test_an_archive_gives_what_is_asked_for_and_believes_no_size(tmp_path):
    np.savez_compressed(tmp_path / "a.npz", a=np.zeros(1000), b=np.ones(3))
    assert set(read_npz(tmp_path / "a.npz")) == {"a", "b"}
    assert set(read_npz(tmp_path / "a.npz", ("b", "c"))) == {"b"}
    with zipfile.ZipFile(tmp_path / "c.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        text = "{'descr': '<f8', 'fortran_order': False, 'shape': (400000000,), }\n"
        archive.writestr("a.npy", header(text, bytes(8)))
    with pytest.raises(UserFacingError, match="no readable archive"):
        read_npz(tmp_path / "c.npz")


@pytest.mark.parametrize("packing", [zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED])
def test_sizes_that_an_archive_makes_up_ask_for_no_memory(tmp_path, packing):
    path = tmp_path / "a.npz"
    with zipfile.ZipFile(path, "w", packing) as archive:
        archive.writestr("a.npy", header("{'descr': '<f8', 'fortran_order': False, 'shape': (90,), }\n", bytes(720)))
        packed = archive.getinfo("a.npy").compress_size
    raw = path.read_bytes()
    at = raw.rindex(b"PK\x01\x02") + 20
    sizes = (700_000_000).to_bytes(4, "little")
    assert int.from_bytes(raw[at : at + 4], "little") == packed
    path.write_bytes(raw[:at] + 2 * sizes + raw[at + 8 :])
    tracemalloc.start()
    try:
        with pytest.raises(UserFacingError, match="no readable archive"):
            read_npz(path)
        assert tracemalloc.get_traced_memory()[1] < 1e6
    finally:
        tracemalloc.stop()
