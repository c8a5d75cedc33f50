"""One way to train either variant of the face on a motion database."""

from __future__ import annotations

from dataclasses import replace

from core.errors import UserFacingError
from core.iface.heard_takes import database_takes
from core.iface.model_file import MODERN, PAPER, VARIANTS, FaceModel
from core.iface.modern_training import train_modern_face
from core.iface.paper_training import train_paper_face
from core.motion.database import MotionDatabase
from core.progress import SILENT, Progress

# In which each sentence is heard besides its clean sound; the paper's face hears the clean sound alone.
N_NOISES = 2


def train_face(
    database: MotionDatabase, variant: str = MODERN, seed: int = 0, progress: Progress = SILENT
) -> FaceModel:
    """Train on the sentences of ``database`` that have sound; what it holds out is not touched.

    The same database, variant and seed give the same face. Raises `UserFacingError` without sound or neutral speech,
    and for a variant that there is not.
    """
    check_variant(variant)
    audible = tuple(s for s in database.sentences if database.audio_bytes(s.name) is not None)
    if not audible:
        raise UserFacingError(
            f"The database '{database.name}' keeps no sound, so nothing can be learned of it by ear.",
            "Build it anew from a corpus with sound.",
        )
    heard = progress.part(0.0, 0.2)
    takes = database_takes(replace(database, sentences=audible), heard, N_NOISES if variant == MODERN else 0)
    train = progress.part(0.2, 1.0)
    if variant == PAPER:
        face = train_paper_face(takes, database.markers.rest, seed, train)
    else:
        face = train_modern_face(takes, database.markers, seed, train)
    return FaceModel(face, variant, database.markers.names, database.name, database.content_hash, seed)


def check_variant(variant: str) -> None:
    """Raise `UserFacingError` for a variant that there is not."""
    if variant not in VARIANTS:
        raise UserFacingError(f"There is no variant '{variant}' of the face.", f"Choose {' or '.join(VARIANTS)}.")
