"""What set-up fetches and makes once, so that the first start is quick: the default face and the demo database."""

from __future__ import annotations

from app.demo import demo_database
from app.terminal import clear_failures, note, progress_bar
from core.face.default_face import FaceUnavailable, default_face


def prepare() -> None:
    """Fetch the default face and build the demo database; without a network the face is left out, and said."""
    with progress_bar("preparing") as progress:
        try:
            default_face(progress.part(0.0, 0.3))
        except FaceUnavailable as error:
            note(f"efase: {error}")
        demo_database(progress.part(0.3, 1.0))


if __name__ == "__main__":
    with clear_failures():
        prepare()
