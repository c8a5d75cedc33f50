"""What the window remembers between two starts: its layout, folders, theme."""

from __future__ import annotations

import os
from pathlib import Path

from PySide6.QtCore import QSettings


def window_settings() -> QSettings:
    """Return the settings: in ``$EFASE_CONFIG_DIR/window.ini`` when that is set, else where the platform keeps them."""
    folder = os.environ.get("EFASE_CONFIG_DIR")
    if folder:
        return QSettings(str(Path(folder).expanduser() / "window.ini"), QSettings.Format.IniFormat)
    return QSettings(QSettings.Format.IniFormat, QSettings.Scope.UserScope, "efase", "window")


def last_folder(settings: QSettings, kind: str) -> str:
    """Return the folder from which a file of ``kind`` was last opened."""
    folder = settings.value(f"folders/{kind}", "")
    return folder if folder and Path(folder).is_dir() else str(Path.home())


def remember_folder(settings: QSettings, kind: str, path: Path) -> None:
    """Remember where a file of ``kind`` was opened."""
    settings.setValue(f"folders/{kind}", str(path.parent))
