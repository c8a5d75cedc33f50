"""A film is made when what it shows changed, and only then."""

from __future__ import annotations

import numpy as np

WAIT_MS = 60_000


def test_removing_a_node_that_nothing_uses_keeps_the_film(animated, qtbot):
    authoring, film = animated.authoring, animated.authoring.film
    qtbot.waitUntil(lambda: film.path is not None and authoring.jobs.is_idle, timeout=WAIT_MS)
    path, document = film.path, authoring.document
    dearest = int(np.where(np.isfinite(document.prices), document.prices, -1.0).min(axis=0).argmax())
    before, positions = document.answer, document.motion.positions
    authoring.remove_nodes([document.database.nodes.name(dearest)], "a spike")
    qtbot.waitUntil(lambda: document.answer is not before and authoring.jobs.is_idle, timeout=WAIT_MS)
    assert np.array_equal(document.motion.positions, positions)
    assert film.path == path and path.is_file()
    authoring.set_frame_rate("25")
    assert film.path is None
    qtbot.waitUntil(lambda: film.path is not None, timeout=WAIT_MS)
    assert film.path != path


def test_the_window_names_the_device_that_answers_after_one_was_lost(animated, qtbot, monkeypatch):
    from core.search.compute import DeviceFailed

    authoring = animated.authoring
    qtbot.waitUntil(lambda: authoring.jobs.is_idle, timeout=WAIT_MS)
    told = []
    authoring.backend_changed.connect(lambda *words: told.append(words))

    class Gone:
        report = authoring._backends._kernels[authoring.document.database.content_hash][0].report

        def __getattr__(self, _):
            def fail(*_):
                raise DeviceFailed("The device is gone.")

            return fail

    kernels, _ = authoring._backends._kernels[authoring.document.database.content_hash]
    kernels._kernels = Gone()
    before = authoring.document.answer
    authoring.paint_emotion(0.1, 0.5, "anger")
    qtbot.waitUntil(lambda: authoring.document.answer is not before and authoring.jobs.is_idle, timeout=WAIT_MS)
    assert [name for name, _ in told] == ["numpy"] and "The device is gone." in told[0][1]
    assert "numpy" in animated.control.engine.facts.text()
    assert "The device is gone." in animated.control.engine.facts.toolTip()
