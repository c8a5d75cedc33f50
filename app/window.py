"""The main window: control panel, four panes, timeline, and the lines that tell what goes on."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QByteArray, QEvent, Qt
from PySide6.QtWidgets import QApplication, QInputDialog, QMessageBox, QSplitter, QVBoxLayout, QWidget

from app import texts
from app.actions import Actions, ButtonKeys
from app.asking import AskingWindow
from app.authoring import Authoring
from app.emotion_colours import emotion_colours
from app.garbage import MainThreadGarbage
from app.icons import icon, renew_icons
from app.menus import make_menus
from app.panels.control import WIDTH_PX, ControlPanel
from app.panels.export_dialog import ExportDialog
from app.panels.isomap import IsomapPane
from app.panels.lexicon import LexiconDialog
from app.panels.motion import MotionPane
from app.panels.preview import PreviewPane
from app.panels.status import StatusLine
from app.panels.strip_dialog import StripDialog
from app.panels.timeline.bar import TimelinePane
from app.panels.timeline.timeline import Timeline
from app.panels.video import VideoPane
from app.theme import apply_theme
from app.tool_windows import ToolWindows
from app.versions import Versions
from core.document.change import Change

DEMO_START = "demo-neutral"
HIGHEST_START_FRAME = 10**7
_SIZE = (1600, 1000)


class MainWindow(AskingWindow):
    """Arranges the panes and joins them."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__(authoring)
        self.versions = Versions(self.keeper, self)
        self.setWindowTitle(texts.APPLICATION)
        self.setWindowIcon(icon("workstation"))
        self.setAcceptDrops(True)
        emotion_colours.put_on()
        self.control = ControlPanel(authoring)
        self.motion = MotionPane(authoring)
        self.video = VideoPane(authoring)
        self.isomap = IsomapPane(authoring)
        self.preview = PreviewPane(authoring)
        self.timeline = Timeline(authoring)
        self.status = StatusLine(authoring.jobs)
        self._arrange()
        self._button_keys = ButtonKeys(self)
        self.actions = Actions(self)
        self.lexicon = LexiconDialog(authoring.jobs, self)
        self.export_dialog = ExportDialog(authoring, self.settings, self)
        self.strip_dialog = StripDialog(authoring, self.settings, self)
        self.tools = ToolWindows(self)
        make_menus(self)
        self._join()
        self._restore_layout()
        self._garbage = MainThreadGarbage(self)
        self.timeline.setFocus()  # so that Space plays from the start, and is not typed into the transcript

    # Making

    def _arrange(self) -> None:
        def splitter(orientation: Qt.Orientation, name: str, *widgets: QWidget) -> QSplitter:
            made = QSplitter(orientation, objectName=name, childrenCollapsible=False, handleWidth=1)
            for widget in widgets:
                made.addWidget(widget)
            return made

        across, down = Qt.Orientation.Horizontal, Qt.Orientation.Vertical
        upper = splitter(across, "upper", self.motion, self.video)
        lower = splitter(across, "lower", self.isomap, self.preview)
        panes = splitter(down, "panes", upper, lower)
        body = splitter(across, "body", self.control, panes)
        self.timeline_pane = TimelinePane(self.timeline)
        whole = splitter(down, "whole", body, self.timeline_pane)
        body.setStretchFactor(1, 1)
        whole.setStretchFactor(0, 1)
        self._splitters = [upper, lower, panes, body, whole]
        # two panes whose columns stay in line read as one grid
        upper.splitterMoved.connect(lambda *_: lower.setSizes(upper.sizes()))
        lower.splitterMoved.connect(lambda *_: upper.setSizes(lower.sizes()))
        centre = QWidget()
        column = QVBoxLayout(centre)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.message)
        column.addWidget(whole, 1)
        column.addWidget(self.status)
        self.setCentralWidget(centre)

    def default_layout(self) -> None:
        """Give every pane the room that it has at first."""
        room = self.screen().availableSize()
        width, height = min(_SIZE[0], room.width()), min(_SIZE[1], room.height())
        self.resize(width, height)
        upper, lower, panes, body, whole = self._splitters
        for row in (upper, lower):
            row.setSizes([(width - WIDTH_PX) // 2, (width - WIDTH_PX) // 2])
        panes.setSizes([height * 9 // 20, height * 7 // 20])
        body.setSizes([WIDTH_PX, width - WIDTH_PX])
        strip = self.timeline_pane.sizeHint().height()
        whole.setSizes([height - strip, strip])

    def _join(self) -> None:
        authoring, control = self.authoring, self.control
        authoring.failed.connect(self.message.say)
        authoring.noted.connect(self.status.say)
        authoring.film.changed.connect(self._enable_save)
        control.engine.polish.region_chosen.connect(self.timeline.set_region)
        emotion_colours.changed.connect(self.timeline.renew)
        self.isomap.previewed.connect(self.preview.show_pick)
        self.preview.pin_asked.connect(self.isomap.pin_kept)
        control.speech.speech_asked.connect(self.ask_speech)
        control.speech.transcript_asked.connect(self.ask_transcript)
        control.emotion.emotions_asked.connect(self.ask_emotions)
        control.face.face_asked.connect(self.ask_face)
        control.database.database_asked.connect(self.ask_database)
        self.video.save_button.clicked.connect(self.ask_save_film)
        self.video.reference_asked.connect(self.ask_reference)
        authoring.document.changed.connect(self.on_document_changed)
        self.keeper.opened.connect(self._show_title)
        self._enable_save()

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Say in the title what is being worked on, and in the menu at which rate."""
        if change & Change.ALIGNMENT:
            self._show_title()
        if change & Change.OUTPUT:
            self._show_output()

    def _show_title(self) -> None:
        speech = self.authoring.document.speech
        sound = "" if speech is None or speech.audio.path is None else Path(speech.audio.path).name
        self.setWindowTitle(" · ".join(part for part in (self.keeper.name, sound, texts.APPLICATION) if part))

    def _show_output(self) -> None:
        output, by_name = self.authoring.document.output, self.actions.by_name
        by_name["head"].setChecked(output.head_moves)
        by_name[f"{texts.MENU_FRAME_RATE}/{output.frame_rate}"].setChecked(True)
        self.motion.on_playhead_moved(self.authoring.view.playhead_s)

    def on_theme(self, name: str) -> None:
        """Dress everything in another theme, and remember it."""
        self.settings.setValue("theme", name)
        apply_theme(QApplication.instance(), name)
        emotion_colours.put_on()
        emotion_colours.changed.emit()
        renew_icons(self)

    def ask_start_frame(self) -> None:
        """Ask for the number of the first frame."""
        now, title = self.authoring.document.output.start_frame, texts.ACTION_START_FRAME.replace("&", "")
        number, wanted = QInputDialog.getInt(self, title, texts.START_FRAME_ASK, now, 0, HIGHEST_START_FRAME)
        if wanted:
            self.authoring.set_start_frame(number)

    def frame_view(self) -> None:
        """Frame the pane that has the focus; without one, both faces."""
        focused = QApplication.focusWidget()
        if focused is self.isomap.canvas:
            self.isomap.frame_view()
        elif focused is self.timeline:
            self.timeline.zoom_all()
        else:
            self.look("frame_view")

    def look(self, how: str) -> None:
        """Move the camera of the face that has the focus; without one, of both."""
        focused = QApplication.focusWidget()
        views = [self.motion.face_view, self.preview.face_view]
        for view in [focused] if focused in views else views:
            getattr(view, how)()

    def _enable_save(self) -> None:
        self.actions.by_name["save_film"].setEnabled(self.authoring.film.path is not None)

    def about(self) -> None:
        """Say what this is, and whose face and licences."""
        rig = self.authoring.rig
        credit = rig.face.credit if rig is not None and rig.face.credit else texts.ABOUT_DEFAULT_FACE
        QMessageBox.about(self, texts.ABOUT_TITLE, texts.ABOUT.format(face=credit))

    def _gives_up_export(self) -> bool:
        answer = QMessageBox.question(self, texts.APPLICATION, texts.EXPORT_IS_RUNNING)
        return answer == QMessageBox.StandardButton.Yes

    def _gives_up(self, what: str) -> bool:
        box = QMessageBox(QMessageBox.Icon.Warning, texts.APPLICATION, what, parent=self)
        close = box.addButton(texts.CLOSE_ANYWAY, QMessageBox.ButtonRole.DestructiveRole)
        keep = box.addButton(texts.KEEP_OPEN, QMessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(keep)
        box.setEscapeButton(keep)
        box.exec()
        return box.clickedButton() is close

    # Layout

    def _restore_layout(self) -> None:
        self.default_layout()
        geometry = self.settings.value("geometry")
        if isinstance(geometry, QByteArray):
            self.restoreGeometry(geometry)
        for splitter in self._splitters:
            state = self.settings.value(f"splitters/{splitter.objectName()}")
            if isinstance(state, QByteArray):
                splitter.restoreState(state)

    def _save_layout(self) -> None:
        self.settings.setValue("geometry", self.saveGeometry())
        for splitter in self._splitters:
            self.settings.setValue(f"splitters/{splitter.objectName()}", splitter.saveState())
        self.settings.sync()

    # Qt

    def event(self, event) -> bool:
        """Show the hint for what is under the pointer in our own status line."""
        if event.type() == QEvent.Type.StatusTip:
            self.status.hint(event.tip())
            return True
        if event.type() == QEvent.Type.WindowActivate:
            self.authoring.curating.refresh()  # another window may have removed motion nodes
        return super().event(event)

    def closeEvent(self, event) -> None:
        """Remember the layout and stop everything; a film that is being written is not given up without a word."""
        if self.authoring.jobs.is_running("export") and not self._gives_up_export():
            event.ignore()
            return
        unsaved = self.keeper.last_save_refused()
        if unsaved and not self._gives_up(texts.CLOSE_UNSAVED.format(why=unsaved)):
            event.ignore()
            return
        if not all(self._gives_up(question) for question in self.tools.unsaved()):
            event.ignore()
            return
        self._save_layout()
        self.keeper.close()
        self.tools.shut_down()
        self.authoring.shut_down()
        for pane in (self.motion, self.preview):
            pane.face_view.release()
        self.video.release()
        self._button_keys.stop()
        self._garbage.stop()
        super().closeEvent(event)

    def dragEnterEvent(self, event) -> None:
        """Take files."""
        if event.mimeData().hasUrls() and event.mimeData().urls()[0].isLocalFile():
            event.acceptProposedAction()

    def dropEvent(self, event) -> None:
        """Open a file."""
        self.open_file(Path(event.mimeData().urls()[0].toLocalFile()))
