"""What the window remembers between two starts: its layout, folders, theme."""

from __future__ import annotations

import os
from pathlib import Path

from PySide6.QtCore import QSettings

_MOST_RECENT = 10


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


def recent_projects(settings: QSettings) -> list[Path]:
    """Return the projects that were open lately and are still there, newest first."""
    names = settings.value("projects/recent", [])
    names = [names] if isinstance(names, str) else names or []
    return [path for path in map(Path, names) if path.is_file()]


def last_project(settings: QSettings) -> Path | None:
    """Return what was open when a window was last closed, or None."""
    name = settings.value("projects/last", "")
    return Path(name) if name and Path(name).is_file() else None


def remember_project(settings: QSettings, path: Path, is_open: bool = True) -> None:
    """Put a project first among the recent ones; when it is open, the next start opens it."""
    path = path.absolute()
    names = [str(path), *(str(p) for p in recent_projects(settings) if p != path)]
    settings.setValue("projects/recent", names[:_MOST_RECENT])
    if is_open:
        settings.setValue("projects/last", str(path))
    settings.sync()


def forget_project(settings: QSettings, path: Path) -> None:
    """Drop a project that is no more, or cannot be opened."""
    path = path.absolute()
    settings.setValue("projects/recent", [str(p) for p in recent_projects(settings) if p != path])
    if settings.value("projects/last", "") == str(path):
        settings.remove("projects/last")
    settings.sync()
