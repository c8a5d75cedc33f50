"""Where the workstation keeps its own files: data that is costly to fetch, and caches that can be made again."""

from __future__ import annotations

import os
from pathlib import Path


def data_dir() -> Path:
    """Return the folder of fetched assets: ``$EFASE_DATA_DIR``, else the platform's data folder of the user."""
    return _folder("EFASE_DATA_DIR", "user_data_dir")


def cache_dir() -> Path:
    """Return the folder of what can be computed again: ``$EFASE_CACHE_DIR``, else the platform's cache folder."""
    return _folder("EFASE_CACHE_DIR", "user_cache_dir")


def _folder(variable: str, kind: str) -> Path:
    chosen = os.environ.get(variable)
    if chosen:
        return Path(chosen).expanduser()
    import platformdirs

    return Path(getattr(platformdirs, kind)("efase", appauthor=False))
