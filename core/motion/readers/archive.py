"""Members of zip archives, unpacked within bounds that the archive cannot set."""

from __future__ import annotations

import zipfile

# deflate packs no more than this many bytes into one
_MOST_PACKED = 1032


class TooLarge(ValueError):
    """The member is larger than its reader wants."""


def read_member(archive: zipfile.ZipFile, member: zipfile.ZipInfo, archive_bytes: int, largest: int) -> bytes:
    """Return the bytes of ``member``; memory is asked for only as the file's own size allows.

    Raises `TooLarge` beyond ``largest`` bytes, `ValueError` for sizes that cannot be true, and what zipfile raises for
    damage.
    """
    if member.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise ValueError("it is packed in a way that is not read")
    packing = _MOST_PACKED if member.compress_type == zipfile.ZIP_DEFLATED else 1
    if member.compress_size > archive_bytes or member.file_size > packing * member.compress_size:
        raise ValueError("its sizes cannot be true")
    if member.file_size > largest:
        raise TooLarge
    with archive.open(member) as stream:
        raw = stream.read(member.file_size)
    if len(raw) != member.file_size:
        raise ValueError("it is truncated")
    return raw
