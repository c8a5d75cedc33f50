"""The pictures of a film without its sound, to the last bit as they were."""

from __future__ import annotations

from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in


def without_sound(film: Path, path: Path) -> None:
    """Write the pictures of ``film`` to ``path``, a film of the same kind; nothing is encoded anew.

    Raises `UserFacingError` for a film that cannot be read, and for a target that cannot be written.
    """
    import av

    try:
        with (
            swapped_in(path) as beside,
            av.open(str(film)) as source,
            av.open(str(beside), "w", format="mp4" if path.suffix.lower() == ".mp4" else "avi") as target,
        ):
            pictures = source.streams.video[0]
            copied = target.add_stream_from_template(pictures)
            for packet in source.demux(pictures):
                if packet.dts is not None:
                    packet.stream = copied
                    target.mux(packet)
    except (av.FFmpegError, IndexError) as error:
        raise UserFacingError(f"The film '{film}' cannot be copied without its sound.") from error
