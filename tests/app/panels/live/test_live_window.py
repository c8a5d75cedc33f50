"""The live window by mouse and keys: it listens, shows, records, sends, and outlives its devices."""

from __future__ import annotations

import time

import numpy as np
import pytest
import soundfile
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app import speech
from app.live.microphone import InputDevice
from app.live.source import FileSource, SourceLost
from app.panels.live import driver
from app.texts import live as texts
from core.document.project_file import read_project
from core.errors import UserFacingError
from core.media.audio import Audio
from tests.core.iface.linear_face import LinearFace

WAIT_MS = 20_000
RATE_HZ = 16_000
_LEFT = Qt.MouseButton.LeftButton


def click(widget):
    QTest.mouseClick(widget, _LEFT, pos=widget.rect().center())


@pytest.fixture
def sound_path(tmp_path):
    """Three seconds of noise under a swell; in the first second it clips."""
    n = 3 * RATE_HZ
    noise = 0.1 * np.random.default_rng(1).normal(size=n) * (1 + np.sin(np.arange(n) / RATE_HZ * 9))
    noise[2000:2003] = 1.0
    soundfile.write(tmp_path / "said.wav", noise, RATE_HZ)
    return tmp_path / "said.wav"


@pytest.fixture
def stand_in(monkeypatch):
    """What is learned from a database, and the microphones of this machine."""
    learned = {"expressions": ("happiness", "anger", "sadness")}

    def speaking_face(database, _progress):
        return LinearFace(database.markers.rest, expressions=learned["expressions"])

    monkeypatch.setattr(driver, "speaking_face", speaking_face)
    devices = InputDevice("Mic one", "ALSA"), InputDevice("Mic two", "ALSA", True)
    monkeypatch.setattr(driver, "input_devices", lambda _request, _progress: devices)
    return learned


@pytest.fixture
def live(qapp, settings_folder, stand_in, database_path, qtbot):
    """The live window by itself, over the tiny database."""
    from app.authoring import Authoring
    from app.panels.live.window import LiveWindow
    from app.theme import apply_theme

    apply_theme(qapp)
    authoring = Authoring(None)
    authoring.open_database(database_path)
    qtbot.waitUntil(lambda: authoring.document.database is not None, timeout=WAIT_MS)
    window = LiveWindow(authoring)
    opened(window, qtbot)
    yield window
    window.driver.stop()
    window.driver.take = None
    window.shut_down()
    authoring.shut_down()
    window.deleteLater()
    qapp.processEvents()


@pytest.fixture
def of_main(open_window, stand_in, database_path, qtbot):
    """The live window, opened from the main window's menu."""
    main = open_window()
    main.authoring.open_database(database_path)
    qtbot.waitUntil(lambda: main.authoring.document.database is not None, timeout=WAIT_MS)
    main.actions.by_name["live"].trigger()
    opened(main.tools.live, qtbot)
    yield main.tools.live
    main.tools.live.driver.stop()
    main.tools.live.driver.take = None


def opened(window, qtbot):
    window.open_now()
    qtbot.waitUntil(lambda: window.sources.count() == 5 and window.jobs.is_idle, timeout=WAIT_MS)
    with qtbot.waitActive(window):
        window.activateWindow()


def begun(window, sound_path, qtbot):
    window.choose_file(sound_path)
    click(window.listen_button)
    qtbot.waitUntil(lambda: window.delay.median_ms is not None, timeout=WAIT_MS)
    return window


@pytest.fixture
def speaking(live, sound_path, qtbot):
    """The live window as it speaks with a file."""
    return begun(live, sound_path, qtbot)


def pose(window):
    return np.array(window.view._displacements)


def test_the_face_speaks_with_a_file_and_its_delay_is_shown(speaking, qtbot):
    poses = [pose(speaking)]
    qtbot.waitUntil(lambda: np.abs(pose(speaking) - poses[0]).max() > 0.01, timeout=WAIT_MS)
    qtbot.waitUntil(lambda: speaking.delay.total.text() != "", timeout=WAIT_MS)
    parts = [float(value.text().split()[0]) for value in speaking.delay.values]
    assert parts[1] == pytest.approx(100.0, abs=10.0) and speaking.delay.median_ms > 100.0
    assert speaking.delay.drops.text() == texts.DROPS.format(n=0)
    assert speaking.listen_button.text() == texts.STOP and not speaking.pane.is_empty
    click(speaking.listen_button)
    assert not speaking.driver.is_listening and speaking.listen_button.text() == texts.LISTEN
    still = pose(speaking)
    qtbot.wait(150)
    np.testing.assert_array_equal(pose(speaking), still)
    QTest.keyClick(speaking, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: np.abs(pose(speaking) - still).max() > 0.01, timeout=WAIT_MS)


def test_keys_and_slider_change_the_expression_smoothly(speaking, qtbot):
    shown = []
    speaking.driver.heard.connect(lambda frame: shown.append(frame.live.strengths))
    QTest.keyClick(speaking, Qt.Key.Key_3)
    assert speaking.expression.button("anger").isChecked()
    qtbot.waitUntil(lambda: bool(shown) and shown[-1]["anger"] > 0.95, timeout=WAIT_MS)
    speaking.expression.slider.setFocus()
    for _ in range(5):
        QTest.keyClick(speaking.expression.slider, Qt.Key.Key_PageDown)
    assert speaking.expression.intensity == 0.5
    qtbot.waitUntil(lambda: shown[-1]["anger"] < 0.55, timeout=WAIT_MS)
    click(speaking.expression.button("sadness"))
    qtbot.waitUntil(lambda: shown[-1]["sadness"] > 0.45, timeout=WAIT_MS)
    QTest.keyClick(speaking, Qt.Key.Key_1)
    qtbot.waitUntil(lambda: shown[-1]["sadness"] < 0.05, timeout=WAIT_MS)
    steps = np.diff([list(strengths.values()) for strengths in shown], axis=0)
    assert np.abs(steps).max() < 0.2 and not speaking.expression.slider.isEnabled()


def test_a_file_is_chosen_in_the_list(live, sound_path, choose):
    choose(sound_path)
    live.sources.setFocus()
    QTest.keyClick(live.sources, Qt.Key.Key_End)
    assert live.sources.currentText() == "said.wav"


def test_clipping_is_marked_until_the_mark_is_clicked(speaking, qtbot):
    qtbot.waitUntil(speaking.meter.clip.isChecked, timeout=WAIT_MS)
    click(speaking.meter.clip)
    qtbot.wait(200)
    assert not speaking.meter.clip.isChecked()


def test_a_device_that_goes_away_is_told_and_the_next_listen_works(live, monkeypatch, qtbot):
    asked = []

    class Fleeting(FileSource):
        """A microphone of 0.4 s, the first time."""

        def __init__(self, device=None):
            super().__init__(Audio(0.1 * np.ones(RATE_HZ // 5 * 2 if not asked else 60 * RATE_HZ), RATE_HZ))
            self.fails, self.name = not asked, "Mic two"
            asked.append(device)

        def blocks(self):
            yield from super().blocks()
            if self.fails:
                raise SourceLost("Mic two is gone.", "Plug it in again.")

    monkeypatch.setattr(driver, "Microphone", Fleeting)
    live.sources.setCurrentIndex(2)
    click(live.listen_button)
    qtbot.waitUntil(lambda: live.message.text != "", timeout=WAIT_MS)
    assert live.message.text == "Mic two is gone. Plug it in again."
    assert live.listen_button.text() == texts.LISTEN and asked[0].name == "Mic two"
    click(live.listen_button)
    n = live.driver.session.n_frames
    qtbot.waitUntil(lambda: live.driver.session.n_frames > n + 5, timeout=WAIT_MS)
    assert live.message.text == "" and len(asked) == 2


def test_a_muted_or_quiet_device_is_told(live, monkeypatch, qtbot):
    from app.panels.live import window

    monkeypatch.setattr(window, "_QUIET_S", 0.3)
    monkeypatch.setattr(driver, "Microphone", lambda device: FileSource(Audio(np.zeros(RATE_HZ * 60), RATE_HZ)))
    click(live.listen_button)
    qtbot.waitUntil(lambda: "nothing but silence" in live.pane.info.whole_text, timeout=WAIT_MS)


def test_what_was_recorded_opens_in_the_main_window(of_main, sound_path, choose, tmp_path, monkeypatch, qtbot):
    def nothing_heard(*_args, **_how):
        raise UserFacingError("Nobody speaks.")

    monkeypatch.setattr(speech, "load_speech", nothing_heard)
    window, main, told = begun(of_main, sound_path, qtbot), of_main.parent(), []
    assert not window.keep_button.isEnabled() and not window.has_unsaved_take
    QTest.keyClick(window, Qt.Key.Key_4)
    click(window.record_button)
    qtbot.waitUntil(lambda: (window.driver.recorded_s or 0) > 0.6, timeout=WAIT_MS)
    monkeypatch.setattr(main, "_gives_up", told.append)
    main.close()
    assert told == [texts.CLOSE_UNSAVED] and main.isVisible()
    choose("", tmp_path / "spoken")  # the first dialog is left
    click(window.record_button)
    assert window.record_button.text() == texts.RECORD and window.driver.take is not None
    click(window.keep_button)
    path = tmp_path / "spoken.efase"
    qtbot.waitUntil(lambda: str(path) in window.status.note, timeout=WAIT_MS)
    content, audio = read_project(path)
    assert content.engine == "iface" and audio.duration_s > 0.5
    assert [span.emotion for span in content.modifiers] == ["sadness"]
    assert not window.has_unsaved_take
    click(window.listen_button)
    click(window.open_button)
    qtbot.waitUntil(lambda: main.keeper.file is not None and main.keeper.file.path == path, timeout=WAIT_MS)
    assert main.authoring.document.engine == "iface"


def test_alone_the_window_asks_before_a_take_is_lost(speaking, qtbot):
    QTest.keyClick(speaking, Qt.Key.Key_R)
    qtbot.waitUntil(lambda: (speaking.driver.recorded_s or 0) > 0.3, timeout=WAIT_MS)
    source = speaking.driver.source
    assert not speaking.close() and speaking.message.text == texts.CLOSE_LOSES
    assert source._closed.is_set() and not speaking.driver.is_listening
    assert speaking.close()


def test_frames_are_sent_only_when_asked_for_and_where(speaking, monkeypatch, qtbot):
    sent = []

    class Told:
        n_sent = n_refused = 0

        def send(self, positions):
            sent.append(positions.shape)
            self.n_sent += 1

        def close(self):
            sent.append("closed")

    monkeypatch.setattr(driver, "open_outgoing", lambda address, database: asked.append(str(address)) or Told())
    asked = []
    assert speaking.address.text() == "" and not speaking.send_button.isChecked()
    QTest.keyClicks(speaking.address, "somewhere")
    click(speaking.send_button)
    assert "'somewhere' is no address" in speaking.message.text and not speaking.send_button.isChecked()
    speaking.address.clear()
    QTest.keyClicks(speaking.address, "osc://127.0.0.1:39539")
    assert sent == [] and speaking.expression.emotion == "neutral"  # figures typed here are no keys of emotions
    click(speaking.send_button)
    qtbot.waitUntil(lambda: len(sent) > 3, timeout=WAIT_MS)
    assert asked == ["osc://127.0.0.1:39539"]
    qtbot.waitUntil(lambda: speaking.sent.text() != "", timeout=WAIT_MS)
    click(speaking.send_button)
    assert sent[-1] == "closed" or "closed" in sent
    qtbot.wait(150)
    assert sent.count("closed") == 1 and sent.index("closed") >= len(sent) - 2


def test_emotions_that_were_not_learned_are_not_offered(live, stand_in, sound_path, qtbot):
    stand_in["expressions"] = ("anger",)
    live.expression.choose("happiness")
    live.choose_file(sound_path)
    click(live.listen_button)
    qtbot.waitUntil(lambda: not live.expression.button("happiness").isEnabled(), timeout=WAIT_MS)
    assert live.expression.emotion == "neutral" and live.expression.button("anger").isEnabled()
    QTest.keyClick(live, Qt.Key.Key_2)
    assert live.expression.emotion == "neutral"


def test_learning_can_be_given_up_and_what_cannot_be_learned_is_told(live, sound_path, monkeypatch, qtbot):
    def slowly(_database, progress):
        while True:
            progress.step(0.5)
            time.sleep(0.01)

    def not_at_all(_database, _progress):
        raise UserFacingError("Nothing can be learned.")

    live.choose_file(sound_path)
    monkeypatch.setattr(driver, "speaking_face", slowly)
    click(live.listen_button)
    qtbot.waitUntil(lambda: live.status.job == texts.LEARNING, timeout=WAIT_MS)
    assert live.listen_button.text() == texts.STOP and not live.record_button.isEnabled()
    click(live.status.cancel_button)
    qtbot.waitUntil(lambda: live.listen_button.text() == texts.LISTEN, timeout=WAIT_MS)
    monkeypatch.setattr(driver, "speaking_face", not_at_all)
    click(live.listen_button)
    qtbot.waitUntil(lambda: live.message.text == "Nothing can be learned.", timeout=WAIT_MS)
    qtbot.waitUntil(lambda: live.listen_button.text() == texts.LISTEN, timeout=WAIT_MS)


def test_a_host_that_is_not_known_leaves_the_stream_off(live, monkeypatch, qtbot):
    def no_host(_address, _database):
        raise UserFacingError("The host is not known.")

    monkeypatch.setattr(driver, "open_outgoing", no_host)
    live.address.setText("udp://nobody:1")
    click(live.send_button)
    qtbot.waitUntil(lambda: live.message.text == "The host is not known.", timeout=WAIT_MS)
    qtbot.waitUntil(lambda: not live.send_button.isChecked(), timeout=WAIT_MS)


def test_a_file_that_is_no_sound_is_one_sentence(live, tmp_path):
    (tmp_path / "no.wav").write_bytes(b"nothing")
    live.choose_file(tmp_path / "no.wav")
    click(live.listen_button)
    assert "no.wav" in live.message.text and not live.driver.is_listening
