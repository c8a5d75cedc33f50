"""Starts the workstation's window, or draws a picture of it."""

from __future__ import annotations

import logging
import sys
from pathlib import Path

from core.folders import cache_dir

log = logging.getLogger("window")

PICTURE_SIZE = (1600, 1000)
_PICTURE_LIMIT_MS = 180_000
_SETTLE_MS = 600
# Painting takes and gives Python's lock dozens of times, and each time waits this long for a busy worker; at Python's
# own 5 ms that adds up to a third of a second.
_SWITCH_S = 0.0005


def run_window(project_or_audio: Path | None = None) -> int:
    """Open the window and stay until it is closed; returns the exit code.

    Raises `UserFacingError` when there is no display.
    """
    app = _application()
    window = _window()
    _tell_unexpected(window)
    window.show()
    _start(window, project_or_audio)
    return app.exec()


def picture_of_window(path: Path, size: tuple[int, int] = PICTURE_SIZE) -> None:
    """Draw the real window at work on a demo sentence into the PNG ``path``. It needs a screen, if a virtual one.

    Raises `UserFacingError` when the window does not come to show all four panes.
    """
    from PySide6.QtCore import QEventLoop, QTimer

    from core.errors import UserFacingError

    app = _application()
    window = _window()
    window.resize(*size)
    window.show()
    _show_demo(window)
    troubles: list[str] = []
    window.authoring.failed.connect(lambda sentence, remedy: troubles.append(f"{sentence} {remedy}".strip()))
    loop = QEventLoop()
    limit = QTimer(singleShot=True, interval=_PICTURE_LIMIT_MS)
    limit.timeout.connect(loop.quit)
    limit.start()
    watch = QTimer(interval=100)
    watch.timeout.connect(lambda: loop.quit() if _shows_everything(window) else None)
    watch.start()
    loop.exec()
    complete = _shows_everything(window)
    watch.stop()
    limit.stop()
    if complete:
        QTimer.singleShot(_SETTLE_MS, loop.quit)
        loop.exec()
        window.resize(*size)
        app.processEvents()
        picture = window.grab()
        complete = picture.save(str(path), "PNG")
        troubles.append(f"'{path}' cannot be written.")
    window.close()
    if not complete:
        raise UserFacingError(troubles[0] if troubles else "The window did not fill within three minutes.")


def _shows_everything(window) -> bool:
    authoring = window.authoring
    full = not any(pane.is_empty for pane in (window.motion, window.video, window.isomap, window.preview))
    return full and window.video.video_view.has_frame and authoring.jobs.is_idle


def _application():
    from PySide6.QtCore import QLoggingCategory
    from PySide6.QtGui import QGuiApplication, QSurfaceFormat
    from PySide6.QtWidgets import QApplication

    from app.display import require_display
    from app.settings import window_settings
    from app.theme import THEMES, apply_theme

    sys.setswitchinterval(_SWITCH_S)
    if QApplication.instance() is None:
        require_display()
    # it reports each graphics library that a machine lacks; what goes wrong with a film is told in its pane
    QLoggingCategory.setFilterRules("qt.multimedia*=false")
    shape = QSurfaceFormat()
    shape.setVersion(3, 3)
    shape.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    shape.setDepthBufferSize(24)
    shape.setSamples(0)
    QSurfaceFormat.setDefaultFormat(shape)
    QGuiApplication.setDesktopFileName("efase")
    app = QApplication.instance() or QApplication(sys.argv[:1])
    app.setApplicationName("efase")
    name = window_settings().value("theme", "dark")
    apply_theme(app, name if name in THEMES else "dark")
    return app


def _window():
    from app.authoring import Authoring
    from app.window import MainWindow

    return MainWindow(Authoring())


def _start(window, project_or_audio: Path | None) -> None:
    """Open what was asked for, or what was open last, once the window is on screen; the first time, the demo."""
    from PySide6.QtCore import QTimer

    from core.document.project_file import SUFFIX

    def begin() -> None:
        is_project = project_or_audio is not None and project_or_audio.suffix.lower() == SUFFIX
        wants_file = project_or_audio is not None and not is_project
        if wants_file:
            window.keeper.new()
            window.authoring.open_database()
            window.open_file(project_or_audio)
        elif window.keeper.start(project_or_audio):
            _show_demo(window)

    window.keeper.began_empty.connect(lambda: _show_demo(window))
    QTimer.singleShot(0, begin)


def _show_demo(window) -> None:
    """Animate a demo sentence in whatever project is open, if any."""
    from app.window import DEMO_START

    window.authoring.open_database()
    window.authoring.open_demo_sentence(DEMO_START)


def _tell_unexpected(window) -> None:
    """Write what should not happen to the log and say so in the window, rather than in a terminal nobody sees."""
    from app import texts

    handler = logging.FileHandler(_log_path(), encoding="utf-8")
    handler.setFormatter(logging.Formatter("%(asctime)s %(name)s %(levelname)s %(message)s"))
    logging.getLogger().addHandler(handler)

    def tell(kind, error, trace) -> None:
        log.error("unexpected", exc_info=(kind, error, trace))
        window.message.say(texts.UNEXPECTED.format(what=texts.SHOWING, error=kind.__name__))

    sys.excepthook = tell


def _log_path() -> Path:
    folder = cache_dir()
    folder.mkdir(parents=True, exist_ok=True)
    return folder / "workstation.log"


def main(arguments: list[str]) -> int:
    """Answer ``python -m app.main [--picture PATH | FILE]``."""
    from core.errors import UserFacingError

    try:
        if arguments[:1] == ["--picture"] and len(arguments) == 2:
            picture_of_window(Path(arguments[1]))
            return 0
        return run_window(Path(arguments[0]) if arguments else None)
    except UserFacingError as error:
        print(f"efase: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
