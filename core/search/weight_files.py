"""Files of search weights: JSON with the weights, and how they were found."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from core.errors import UserFacingError
from core.media.swap_in import swapped_in
from core.search.weights import SearchWeights


def write_weights(path: Path, weights: SearchWeights, record: Mapping[str, object]) -> None:
    """Write weights and how they were found; raises `UserFacingError` when the file cannot be written."""
    with swapped_in(path) as beside:
        beside.write_text(json.dumps({**record, "weights": weights.as_dict()}, indent=1) + "\n", encoding="utf-8")


def read_weights(path: Path) -> tuple[SearchWeights, dict[str, object]]:
    """Read what `write_weights` wrote: weights, and their record; raises `UserFacingError` naming the file."""
    try:
        record = json.loads(path.read_bytes())
        return SearchWeights.from_dict(record["weights"]), record
    except OSError as error:
        raise UserFacingError(f"The weights '{path}' cannot be read: {error.strerror}.") from error
    except UserFacingError as error:
        raise UserFacingError(f"'{path}' holds no search weights: {error.message}") from error
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise UserFacingError(
            f"'{path}' holds no search weights.", "`efase tune --output FILE.json` writes such a file."
        ) from error
