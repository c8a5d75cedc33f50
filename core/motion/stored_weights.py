"""Search weights that a database carries: they can change after it was built, its content does not."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.motion.database import MotionDatabase, open_database
from core.search.weight_files import read_weights
from core.search.weights import SearchWeights

SEARCH, AS_PRINTED = "search", "as_printed"  # what was tuned: the search as it is used, or as the paper prints it


def store_tuned(database: MotionDatabase, record: Mapping[str, object]) -> MotionDatabase:
    """Keep tuned weights with the stored ``database``, and return it as it is now.

    record : how they were found, ``weights`` and ``tuned`` (`SEARCH`: they are in use from now on, `AS_PRINTED`: see
        `MotionDatabase.paper_weights`) among it
    The untuned weights stay at hand; the content hash stays as it is. The file is written anew beside itself and
    swapped in. Raises `UserFacingError` when it was never stored or cannot be written.
    """
    kept = {kind: database.tuning[kind] for kind in (SEARCH, AS_PRINTED) if kind in database.tuning}
    tuned = SearchWeights.from_dict(record["weights"])
    return _rewritten(
        database,
        tuned if record["tuned"] == SEARCH else database.weights,
        {**kept, record["tuned"]: dict(record), "untuned_weights": database.untuned_weights.as_dict()},
    )


def forget_weights(database: MotionDatabase) -> MotionDatabase:
    """Give the stored ``database`` its untuned weights back; errors as in `store_tuned`."""
    return _rewritten(database, database.untuned_weights, {})


def named_weights(name: str, database: MotionDatabase) -> SearchWeights:
    """Weights by name: ``tuned`` (those of the database), ``default`` (its untuned ones), or a JSON file's."""
    if name == "tuned":
        return database.weights
    return database.untuned_weights if name == "default" else read_weights(Path(name))[0]


def _rewritten(database: MotionDatabase, weights: SearchWeights, tuning: Mapping[str, object]) -> MotionDatabase:
    import h5py

    if database.path is None:
        raise UserFacingError(f"The database '{database.name}' has no file to keep weights in.")
    path = Path(database.path)
    # changed in memory, for HDF5 ends the process when a disk fills up under it; so there is nothing to lock
    with h5py.File(path, "r+", driver="core", backing_store=False, locking=False) as file:
        file.attrs["weights"] = json.dumps(weights.as_dict())
        file.attrs["tuning"] = json.dumps(dict(tuning))
        file.flush()
        image = file.id.get_file_image()
    with swapped_in(path) as beside:
        beside.write_bytes(image)
    return open_database(path)
