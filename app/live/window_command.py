"""`efase live --window`: the live window by itself, doing what the command line asks for."""

from __future__ import annotations

import time

from app.live.command import LiveJob, checked
from app.live.take import save_take
from app.texts import live as texts
from core.errors import UserFacingError
from core.progress import SILENT, Progress

_LOOK_EVERY_MS = 50


def run_in_window(job: LiveJob, progress: Progress = SILENT) -> dict[str, object]:
    """Show the session in a window until it is closed or the time is up; return the object of ``--json``.

    A file plays over and over. Beside what `app.live.command.run` returns there is ``painted_ms``, the whole delay up
    to the painted face, median of its last two seconds.

    Raises `UserFacingError` when there is no display, or what is asked for cannot be opened.
    """
    from PySide6.QtCore import QTimer

    from app.authoring import Authoring
    from app.main import _application
    from app.panels.live.window import LiveWindow

    emotion, device = checked(job)
    app = _application()
    authoring = Authoring()
    live = LiveWindow(authoring)
    failures: list[UserFacingError] = []
    driver, document, began_s = live.driver, authoring.document, 0.0

    def fail(sentence: str, remedy: str) -> None:
        if driver.source is None and not live.delay.has_parts:  # nothing was shown yet, and nothing will be
            failures.append(UserFacingError(sentence, remedy))
            live.close()

    def look() -> None:
        nonlocal began_s
        if not began_s and document.database is not None and not authoring.jobs.is_running("database"):
            began_s = time.perf_counter()
            begin()
        elif job.seconds is not None and live.delay.has_parts and time.perf_counter() - began_s > job.seconds:
            live.close()

    def begin() -> None:
        nonlocal began_s
        live.open_now()
        if job.file is not None:
            live.choose_file(job.file)
        live.expression.choose(emotion, job.intensity)
        driver.records_at_once = job.project is not None
        if job.stream is not None:
            live.address.setText(job.stream)
            live.send_button.setChecked(True)
        driver.listen(device, job.file)

    authoring.failed.connect(lambda *said: fail(*said) if document.database is None else None)
    driver.failed.connect(fail)
    authoring.open_database(job.database)
    live.show()
    live.pane.show_empty(texts.OPENING)
    timer = QTimer(interval=_LOOK_EVERY_MS)
    timer.timeout.connect(look)
    timer.start()
    app.exec()
    timer.stop()
    painted_ms, session, source, take = live.delay.median_ms, driver.session, driver.last_source, driver.take
    live.shut_down()
    authoring.shut_down()
    if failures:
        raise failures[0]
    if session is None:
        raise UserFacingError(texts.CLOSED_EARLY)
    warnings, outputs = [], []
    if take is not None and job.project is not None:
        warnings += save_take(take, job.project, document.database, document.face, progress)
        outputs.append(str(job.project))
    return {"source": source.name, "rate_hz": source.rate_hz, **session.figures(), "painted_ms": painted_ms,
            "warnings": warnings, "outputs": outputs}  # fmt: skip
