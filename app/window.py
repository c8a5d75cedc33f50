"""The main window: control panel, four panes, timeline, and the lines that tell what goes on."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QByteArray, QEvent, Qt
from PySide6.QtGui import QKeySequence
from PySide6.QtWidgets import QApplication, QFileDialog, QMainWindow, QMessageBox, QSplitter, QVBoxLayout, QWidget

from app import texts
from app.actions import Actions, ButtonKeys, frame_rate_options
from app.authoring import Authoring
from app.icons import icon
from app.loading import SpeechRequest, face_beside_markers
from app.panels.commands import Choosable, Chooser, commands
from app.panels.control import WIDTH_PX, ControlPanel
from app.panels.export_dialog import ExportDialog
from app.panels.isomap import IsomapPane
from app.panels.message_bar import MessageBar
from app.panels.motion import MotionPane
from app.panels.preview import PreviewPane
from app.panels.status import StatusLine
from app.panels.timeline.bar import TimelinePane
from app.panels.timeline.timeline import Timeline
from app.panels.video import VideoPane
from app.project_keeper import ProjectKeeper
from app.project_menu import ProjectMenu
from app.settings import last_folder, remember_folder, window_settings
from app.versions import Versions
from core.document.change import Change
from core.document.document import FaceChoice
from core.document.parts import ReferenceVideo
from core.document.project_file import SUFFIX
from core.speech.emotion import EMOTIONS

DEMO_START = "demo-neutral"
_SIZE = (1600, 1000)
_DATABASE_SUFFIXES = (".h5", ".hdf5")
_FACE_SUFFIXES = (".obj", ".ply", ".glb", ".gltf", ".npz")


class MainWindow(QMainWindow):
    """Arranges the panes and lends them menus, shortcuts and file dialogs."""

    def __init__(self, authoring: Authoring) -> None:
        super().__init__()
        self.authoring = authoring
        self.keeper = ProjectKeeper(authoring, self)
        self.versions = Versions(self.keeper, self)
        self._settings = window_settings()
        self.setWindowTitle(texts.APPLICATION)
        self.setWindowIcon(icon("workstation"))
        self.setAcceptDrops(True)
        self.control = ControlPanel(authoring)
        self.motion = MotionPane(authoring)
        self.video = VideoPane(authoring)
        self.isomap = IsomapPane(authoring)
        self.preview = PreviewPane(authoring, self.motion.face_view)
        self.timeline = Timeline(authoring)
        self.message = MessageBar()
        self.status = StatusLine(authoring.jobs)
        self._arrange()
        self._button_keys = ButtonKeys(self)
        QApplication.instance().installEventFilter(self._button_keys)
        self.actions = Actions(self)
        self.chooser = Chooser(self)
        self.export_dialog = ExportDialog(authoring, self._settings, self)
        self._make_menus()
        self._join()
        self._restore_layout()
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

    def _default_layout(self) -> None:
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

    def _make_menus(self) -> None:
        a, authoring, add = self.actions, self.authoring, self.actions.add
        file = a.menu(texts.MENU_FILE)
        self.project_menu = ProjectMenu(self, a, file, self.keeper, self.versions)
        add(file, "speech", texts.OPEN_SPEECH, "Ctrl+O", self.ask_speech)
        add(file, "captured", texts.OPEN_CAPTURED, "", self.ask_captured)
        add(file, "transcript", texts.OPEN_TRANSCRIPT, "Ctrl+T", self.ask_transcript)
        add(file, "emotions", texts.OPEN_EMOTIONS, "", self.ask_emotions)
        add(file, "face", texts.OPEN_FACE, "", self.ask_face)
        add(file, "database", texts.OPEN_DATABASE, "Ctrl+D", self.ask_database)
        add(file, "demo_database", texts.OPEN_DEMO_DATABASE, "", authoring.open_database)
        file.addSeparator()
        add(file, "save_film", texts.SAVE_FILM, "", self.ask_save_film)
        add(file, "export", texts.EXPORT_ACTION, "Ctrl+E", self.export_dialog.open_for)
        file.addSeparator()
        add(file, "quit", texts.ACTION_QUIT, "Ctrl+Q", self.close)

        edit = a.menu(texts.MENU_EDIT)
        for name, make, prefix, keys in (
            ("undo", authoring.undo_stack.createUndoAction, texts.ACTION_UNDO, "Ctrl+Z"),
            ("redo", authoring.undo_stack.createRedoAction, texts.ACTION_REDO, "Ctrl+Shift+Z"),
        ):
            action = make(self, prefix)
            action.setShortcut(QKeySequence(keys))
            edit.addAction(action)
            a.by_name[name] = action

        motion = a.menu(texts.MENU_MOTION)
        add(motion, "synthesise", texts.SYNTHESISE, ["Ctrl+Return", "Ctrl+Enter"], self.control.synthesise)
        motion.addSeparator()
        add(motion, "play", texts.ACTION_PLAY, "Space", authoring.play_or_pause)
        add(motion, "shuttle_back", texts.ACTION_SHUTTLE_BACK, "J", lambda: authoring.shuttle(-1))
        add(motion, "shuttle_stop", texts.ACTION_SHUTTLE_STOP, "K", lambda: authoring.shuttle(0))
        add(motion, "shuttle_on", texts.ACTION_SHUTTLE_ON, "L", lambda: authoring.shuttle(1))
        add(motion, "loop", texts.ACTION_LOOP, "Ctrl+L", authoring.toggle_loop)
        add(motion, "back", texts.ACTION_BACK, "Left", lambda: authoring.step_frame(-1))
        add(motion, "forward", texts.ACTION_FORWARD, "Right", lambda: authoring.step_frame(1))
        add(motion, "to_start", texts.ACTION_TO_START, "Home", lambda: authoring.seek(0.0))
        add(motion, "to_end", texts.ACTION_TO_END, "End", lambda: authoring.seek(authoring.player.duration_s))
        a.add_choice(motion, texts.MENU_FRAME_RATE, frame_rate_options(), authoring.film.fps_name, self.on_frame_rate)

        pins = a.menu(texts.MENU_MAP)
        add(pins, "pin", texts.ACTION_PIN, "P", self.isomap.pin_kept)
        add(pins, "unpin", texts.ACTION_UNPIN, "Shift+P", authoring.unpin)
        pins.addSeparator()
        add(pins, "play_node", texts.ACTION_PLAY_NODE, "Ctrl+Space", self.isomap.play_selected)
        add(pins, "remove_nodes", texts.ACTION_REMOVE, "", self.isomap.remove_selected)
        add(pins, "restore_nodes", texts.ACTION_RESTORE, "", self.isomap.restore_selected)
        add(pins, "next_suspect", texts.ACTION_NEXT_SUSPECT, "F8", self.isomap.step_suspects)
        pins.addSeparator()
        add(pins, "suspects", texts.ACTION_SUSPECTS, "", self.isomap.suspects_button.click)
        add(pins, "removed", texts.ACTION_REMOVED, "", self.isomap.removed_button.click)
        add(pins, "pca", texts.ACTION_PCA, "", self.isomap.pca_button.click)

        time = a.menu(texts.MENU_TIMELINE)
        add(time, "previous", texts.ACTION_PREVIOUS, "[", lambda: authoring.step_slot(-1))
        add(time, "next", texts.ACTION_NEXT, "]", lambda: authoring.step_slot(1))
        time.addSeparator()
        add(time, "zoom_in", texts.ACTION_ZOOM_IN, ["+", "="], lambda: self.timeline.zoom(1.5))
        add(time, "zoom_out", texts.ACTION_ZOOM_OUT, "-", lambda: self.timeline.zoom(1 / 1.5))
        add(time, "zoom_all", texts.ACTION_ZOOM_ALL, "0", self.timeline.zoom_all)

        time.addSeparator()
        add(time, "rename", texts.ACTION_RENAME, "F2", self.timeline.rename_selected)
        add(time, "split", texts.ACTION_SPLIT, "Ctrl+Shift+K", self.timeline.split_at_playhead)
        add(time, "merge", texts.ACTION_MERGE, "Ctrl+J", self.timeline.merge_selected)
        add(time, "lock", texts.ACTION_LOCK, "Ctrl+Shift+L", authoring.lock)
        add(time, "unlock", texts.ACTION_UNLOCK, "", authoring.unlock)
        time.addSeparator()
        for e, emotion in enumerate(EMOTIONS):
            add(time, f"brush_{emotion}", texts.ACTION_BRUSH.format(emotion=emotion), str(e + 1),
                lambda emotion=emotion: self.timeline.set_brush(emotion))  # fmt: skip

        view = a.menu(texts.MENU_VIEW)
        add(view, "frame_view", texts.ACTION_FRAME_VIEW, "F", self.frame_view)
        add(view, "front", texts.ACTION_FRONT, "Ctrl+1", lambda: self._look("frame_view"))
        add(view, "side", texts.ACTION_SIDE, "Ctrl+2", lambda: self._look("look_from_side"))
        view.addSeparator()
        head = add(view, "head", texts.ACTION_HEAD, "", lambda: authoring.set_head_moves(head.isChecked()))
        head.setCheckable(True)
        head.setChecked(authoring.document.output.head_moves)
        view.addSeparator()
        add(view, "reset_layout", texts.ACTION_RESET_LAYOUT, "", self._default_layout)
        chosen = self._settings.value("theme", "dark")
        a.add_choice(view, texts.MENU_THEME, texts.THEMES, chosen, self.on_theme)

        help_menu = a.menu(texts.MENU_HELP)
        add(help_menu, "commands", texts.ACTION_COMMANDS, "Ctrl+K", self.choose_command)
        add(help_menu, "about", texts.ACTION_ABOUT, "", self.about)

    def _join(self) -> None:
        authoring, control = self.authoring, self.control
        authoring.failed.connect(self.message.say)
        authoring.noted.connect(self.status.say)
        authoring.film.changed.connect(self._enable_save)
        self.isomap.previewed.connect(self.preview.show_pick)
        self.preview.pin_asked.connect(self.isomap.pin_kept)
        control.speech_asked.connect(self.ask_speech)
        control.transcript_asked.connect(self.ask_transcript)
        control.emotions_asked.connect(self.ask_emotions)
        control.face_asked.connect(self.ask_face)
        control.database_asked.connect(self.ask_database)
        self.video.save_button.clicked.connect(self.ask_save_film)
        self.video.reference_asked.connect(self.ask_reference)
        authoring.document.changed.connect(self.on_document_changed)
        self.keeper.opened.connect(self._show_title)
        self._enable_save()

    # Asking for files

    def _ask_file(self, kind: str, title: str, pattern: str) -> Path | None:
        name, _ = QFileDialog.getOpenFileName(self, title, last_folder(self._settings, kind), pattern)
        if not name:
            return None
        remember_folder(self._settings, kind, Path(name))
        return Path(name)

    def ask_speech(self) -> None:
        """Choose a sound file; it is recognised at once, and can be given its words afterwards."""
        path = self._ask_file("speech", texts.OPEN_SPEECH, texts.FILTER_SOUND)
        if path is not None:
            self.open_file(path)

    def choose_command(self) -> None:
        """Show everything that can be done now, to be searched by typing."""
        self.chooser.open(texts.COMMANDS_HINT, commands(self))

    def ask_captured(self) -> None:
        """Choose a sentence that was captured, to compare what is synthesised with it."""

        def choose(names: dict[str, str]) -> None:
            self.chooser.open(texts.CAPTURED_HINT, [
                Choosable(f"{text}   ({name})", lambda name=name: self.authoring.open_captured(name))
                for name, text in names.items()
            ])  # fmt: skip

        self.authoring.list_captured(choose)

    def ask_transcript(self) -> None:
        """Choose a transcript for the sound."""
        speech = self.authoring.document.speech
        if speech is None:
            self.message.say(texts.SYNTHESISE_NEEDS_SPEECH + ".")
            return
        path = self._ask_file("speech", texts.OPEN_TRANSCRIPT, texts.FILTER_TRANSCRIPT)
        if path is not None:
            self.authoring.load_speech(SpeechRequest.with_file(speech.audio, path))

    def ask_emotions(self) -> None:
        """Choose an emotion specification."""
        path = self._ask_file("speech", texts.OPEN_EMOTIONS, texts.FILTER_EMOTIONS)
        if path is not None:
            self.authoring.load_emotions(path)

    def ask_face(self) -> None:
        """Choose a face."""
        path = self._ask_file("face", texts.OPEN_FACE, texts.FILTER_FACE)
        if path is not None:
            self._open_face(path)

    def ask_database(self) -> None:
        """Choose a motion database."""
        path = self._ask_file("database", texts.OPEN_DATABASE, texts.FILTER_DATABASE)
        if path is not None:
            self.authoring.open_database(path)

    def ask_reference(self) -> None:
        """Choose a film of the actor."""
        path = self._ask_file("reference", texts.VIDEO_REFERENCE, texts.FILTER_REFERENCE)
        if path is not None:
            self.authoring.set_reference_video(ReferenceVideo(str(path)))

    def ask_save_film(self) -> None:
        """Choose where a copy of the film goes."""
        if self.authoring.film.path is None:
            return
        start = Path(last_folder(self._settings, "film")) / "synthesis.avi"
        name, _ = QFileDialog.getSaveFileName(self, texts.SAVE_FILM, str(start), texts.FILTER_VIDEO)
        if name:
            path = Path(name) if Path(name).suffix.lower() == ".avi" else Path(f"{name}.avi")
            remember_folder(self._settings, "film", path)
            self.authoring.film.save(path)

    def open_file(self, path: Path) -> None:
        """Open whatever ``path`` is: a project, speech, a motion database or a face."""
        suffix = path.suffix.lower()
        if suffix == SUFFIX:
            self.keeper.open(path)
        elif suffix in _DATABASE_SUFFIXES:
            self.authoring.open_database(path)
        elif suffix in _FACE_SUFFIXES:
            self._open_face(path)
        else:
            self.message.hide()
            self.authoring.load_speech(SpeechRequest.beside(path))

    def _open_face(self, path: Path) -> None:
        """A mesh alone does not tell where markers sit; ask for that file when it is not beside the mesh."""
        face = face_beside_markers(path)
        if face.marker_file is None:
            markers = self._ask_file("face", texts.OPEN_MARKERS.format(face=path.name), texts.FILTER_MARKERS)
            face = FaceChoice(face.name, None if markers is None else str(markers))
        self.authoring.set_face(face)

    # Reactions

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Say in the title what is being worked on."""
        if change & Change.ALIGNMENT:
            self._show_title()

    def _show_title(self) -> None:
        speech = self.authoring.document.speech
        sound = "" if speech is None or speech.audio.path is None else Path(speech.audio.path).name
        self.setWindowTitle(" · ".join(part for part in (self.keeper.name, sound, texts.APPLICATION) if part))

    def on_frame_rate(self, name: str) -> None:
        """Take another output rate."""
        self.authoring.set_frame_rate(name)
        self.motion.on_playhead_moved(self.authoring.view.playhead_s)

    def on_theme(self, name: str) -> None:
        """Remember another theme; it dresses the next window."""
        self._settings.setValue("theme", name)
        self.status.say(texts.THEME_NEXT_START)

    def frame_view(self) -> None:
        """Frame the pane that has the focus; without one, both faces."""
        focused = QApplication.focusWidget()
        if focused is self.isomap.canvas:
            self.isomap.frame_view()
        elif focused is self.timeline:
            self.timeline.zoom_all()
        else:
            self._look("frame_view")

    def _look(self, how: str) -> None:
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

    # Layout

    def _restore_layout(self) -> None:
        self._default_layout()
        geometry = self._settings.value("geometry")
        if isinstance(geometry, QByteArray):
            self.restoreGeometry(geometry)
        for splitter in self._splitters:
            state = self._settings.value(f"splitters/{splitter.objectName()}")
            if isinstance(state, QByteArray):
                splitter.restoreState(state)

    def _save_layout(self) -> None:
        self._settings.setValue("geometry", self.saveGeometry())
        for splitter in self._splitters:
            self._settings.setValue(f"splitters/{splitter.objectName()}", splitter.saveState())
        self._settings.sync()

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
        """Remember the layout and stop everything."""
        self._save_layout()
        self.keeper.close()
        self.authoring.shut_down()
        for pane in (self.motion, self.preview):
            pane.face_view.release()
        self.video.release()
        QApplication.instance().removeEventFilter(self._button_keys)
        super().closeEvent(event)

    def dragEnterEvent(self, event) -> None:
        """Take files."""
        if event.mimeData().hasUrls() and event.mimeData().urls()[0].isLocalFile():
            event.acceptProposedAction()

    def dropEvent(self, event) -> None:
        """Open a file."""
        self.open_file(Path(event.mimeData().urls()[0].toLocalFile()))
