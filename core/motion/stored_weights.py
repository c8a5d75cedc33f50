"""Search weights that a database carries: they can change after it was built, its content does not."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.database import MotionDatabase, open_database
from core.search.weights import SearchWeights


def store_weights(database: MotionDatabase, weights: SearchWeights, record: Mapping[str, object]) -> MotionDatabase:
    """Make ``weights`` those of the stored ``database``, keep how they were found, and return it as it is now.

    The untuned weights stay in ``record``; the content hash stays as it is. The file is written anew beside itself and
    swapped in. Raises `UserFacingError` when it was never stored or cannot be written.
    """
    return _rewritten(database, weights, {**record, "untuned_weights": database.untuned_weights.as_dict()})


def forget_weights(database: MotionDatabase) -> MotionDatabase:
    """Give the stored ``database`` its untuned weights back; errors as in `store_weights`."""
    return _rewritten(database, database.untuned_weights, {})


def _rewritten(database: MotionDatabase, weights: SearchWeights, tuning: Mapping[str, object]) -> MotionDatabase:
    import h5py

    if database.path is None:
        raise UserFacingError(f"The database '{database.name}' has no file to keep weights in.")
    path = Path(database.path)
    # changed in memory, for HDF5 ends the process when a disk fills up under it
    with h5py.File(path, "r+", driver="core", backing_store=False) as file:
        file.attrs["weights"] = json.dumps(weights.as_dict())
        file.attrs["tuning"] = json.dumps(dict(tuning))
        file.flush()
        image = file.id.get_file_image()
    with swapped_in(path) as beside:
        beside.write_bytes(image)
    return open_database(path)
