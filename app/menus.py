"""The menus of the main window: every command once, with its key."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtGui import QKeySequence

from app import texts
from app.actions import frame_rate_options
from app.project_menu import ProjectMenu
from app.settings import window_settings
from app.texts import compare, curves, importing, live, own_face, poses, strips, tracking, units
from core.speech.emotion import EMOTIONS

if TYPE_CHECKING:
    from app.window import MainWindow


def make_menus(window: MainWindow) -> None:
    """Fill the menu bar; ``window.actions`` finds each action again by name."""
    for menu in (_file, _edit, _motion, _map, _timeline, _view, _help):
        menu(window)


def _file(window: MainWindow) -> None:
    """Projects, and what goes in and out."""
    a, authoring, add = window.actions, window.authoring, window.actions.add
    file = a.menu(texts.MENU_FILE)
    window.project_menu = ProjectMenu(window, a, file, window.keeper, window.versions)
    add(file, "speech", texts.OPEN_SPEECH, "Ctrl+O", window.ask_speech)
    add(file, "captured", texts.OPEN_CAPTURED, "", window.ask_captured)
    add(file, "transcript", texts.OPEN_TRANSCRIPT, "Ctrl+T", window.ask_transcript)
    add(file, "emotions", texts.OPEN_EMOTIONS, "", window.ask_emotions)
    add(file, "face", texts.OPEN_FACE, "", window.ask_face)
    add(file, "own_face", own_face.ACTION, "", lambda: window.tools.own_face.open_now())
    add(file, "database", texts.OPEN_DATABASE, "Ctrl+D", window.ask_database)
    add(file, "demo_database", texts.OPEN_DEMO_DATABASE, "", authoring.open_database)
    add(file, "import", importing.ACTION, "Ctrl+I", lambda: window.tools.importing.open_now())
    add(file, "track", tracking.ACTION, "", lambda: window.tools.tracking.open_now())
    add(file, "save_emotions", texts.SAVE_EMOTIONS, "", window.ask_save_emotions)
    add(file, "lexicon", texts.LEXICON_ACTION, "", window.lexicon.open_now)
    file.addSeparator()
    add(file, "save_film", texts.SAVE_FILM, "", window.ask_save_film)
    add(file, "export", texts.EXPORT_ACTION, "Ctrl+E", window.export_dialog.open_for)
    add(file, "strip", strips.ACTION, "", window.strip_dialog.open_for)
    file.addSeparator()
    add(file, "quit", texts.ACTION_QUIT, "Ctrl+Q", window.close)


def _edit(window: MainWindow) -> None:
    """Back and forth."""
    a, authoring = window.actions, window.authoring
    edit = a.menu(texts.MENU_EDIT)
    for name, make, prefix, keys in (
        ("undo", authoring.undo_stack.createUndoAction, texts.ACTION_UNDO, "Ctrl+Z"),
        ("redo", authoring.undo_stack.createRedoAction, texts.ACTION_REDO, "Ctrl+Shift+Z"),
    ):
        action = make(window, prefix)
        action.setShortcut(QKeySequence(keys))
        edit.addAction(action)
        a.by_name[name] = action


def _motion(window: MainWindow) -> None:
    """Synthesis and transport."""
    a, authoring, add = window.actions, window.authoring, window.actions.add
    motion = a.menu(texts.MENU_MOTION)
    add(motion, "synthesise", texts.SYNTHESISE, ["Ctrl+Return", "Ctrl+Enter"], window.control.synthesise)
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
    a.add_choice(
        motion,
        texts.MENU_FRAME_RATE,
        frame_rate_options(),
        authoring.document.output.frame_rate,
        authoring.set_frame_rate,
    )
    add(motion, "start_frame", texts.ACTION_START_FRAME, "", window.ask_start_frame)
    motion.addSeparator()
    add(motion, "compare", compare.ACTION, "Ctrl+Shift+M", lambda: window.tools.compare.open_now())
    add(motion, "key_poses", poses.ACTION, "", lambda: window.tools.key_poses.open_now())
    add(motion, "units", units.ACTION, "", lambda: window.tools.units.open_now())
    add(motion, "live", live.ACTION, "Ctrl+Shift+F", lambda: window.tools.live.open_now())


def _map(window: MainWindow) -> None:
    """Picking, pinning and pruning."""
    a, authoring, add = window.actions, window.authoring, window.actions.add
    pins = a.menu(texts.MENU_MAP)
    add(pins, "pin", texts.ACTION_PIN, "P", window.isomap.pin_kept)
    add(pins, "unpin", texts.ACTION_UNPIN, "Shift+P", authoring.unpin)
    pins.addSeparator()
    add(pins, "play_node", texts.ACTION_PLAY_NODE, "Ctrl+Space", window.isomap.play_selected)
    add(pins, "remove_nodes", texts.ACTION_REMOVE, "", window.isomap.remove_selected)
    add(pins, "restore_nodes", texts.ACTION_RESTORE, "", window.isomap.restore_selected)
    add(pins, "next_suspect", texts.ACTION_NEXT_SUSPECT, "F8", window.isomap.step_suspects)
    pins.addSeparator()
    add(pins, "suspects", texts.ACTION_SUSPECTS, "", window.isomap.suspects_button.click)
    add(pins, "removed", texts.ACTION_REMOVED, "", window.isomap.removed_button.click)
    add(pins, "pca", texts.ACTION_PCA, "", window.isomap.pca_button.click)


def _timeline(window: MainWindow) -> None:
    """Utterances, zoom and brush."""
    a, authoring, add = window.actions, window.authoring, window.actions.add
    time = a.menu(texts.MENU_TIMELINE)
    add(time, "previous", texts.ACTION_PREVIOUS, "[", lambda: authoring.step_slot(-1))
    add(time, "next", texts.ACTION_NEXT, "]", lambda: authoring.step_slot(1))
    time.addSeparator()
    add(time, "zoom_in", texts.ACTION_ZOOM_IN, ["+", "="], lambda: window.timeline.zoom(1.5))
    add(time, "zoom_out", texts.ACTION_ZOOM_OUT, "-", lambda: window.timeline.zoom(1 / 1.5))
    add(time, "zoom_all", texts.ACTION_ZOOM_ALL, "0", window.timeline.zoom_all)
    add(time, "curves", curves.ACTION, "Ctrl+Shift+G", window.timeline_pane.bar.curves.click)

    time.addSeparator()
    add(time, "rename", texts.ACTION_RENAME, "F2", window.timeline.rename_selected)
    add(time, "split", texts.ACTION_SPLIT, "Ctrl+Shift+K", window.timeline.split_at_playhead)
    add(time, "merge", texts.ACTION_MERGE, "Ctrl+J", window.timeline.merge_selected)
    add(time, "lock", texts.ACTION_LOCK, "Ctrl+Shift+L", authoring.lock)
    add(time, "unlock", texts.ACTION_UNLOCK, "", authoring.unlock)
    time.addSeparator()
    for e, emotion in enumerate(EMOTIONS):
        add(time, f"brush_{emotion}", texts.ACTION_BRUSH.format(emotion=emotion), str(e + 1),
            lambda emotion=emotion: window.timeline.set_brush(emotion))  # fmt: skip


def _view(window: MainWindow) -> None:
    """Cameras, layout, theme."""
    a, authoring, add = window.actions, window.authoring, window.actions.add
    view = a.menu(texts.MENU_VIEW)
    add(view, "frame_view", texts.ACTION_FRAME_VIEW, "F", window.frame_view)
    add(view, "front", texts.ACTION_FRONT, "Ctrl+1", lambda: window.look("frame_view"))
    add(view, "side", texts.ACTION_SIDE, "Ctrl+2", lambda: window.look("look_from_side"))
    view.addSeparator()
    head = add(view, "head", texts.ACTION_HEAD, "", lambda: authoring.set_head_moves(head.isChecked()))
    head.setCheckable(True)
    head.setChecked(authoring.document.output.head_moves)
    view.addSeparator()
    add(view, "reset_layout", texts.ACTION_RESET_LAYOUT, "", window.default_layout)
    chosen = window_settings().value("theme", "dark")
    a.add_choice(view, texts.MENU_THEME, texts.THEMES, chosen, window.on_theme)


def _help(window: MainWindow) -> None:
    """Everything by name."""
    a, add = window.actions, window.actions.add
    help_menu = a.menu(texts.MENU_HELP)
    add(help_menu, "commands", texts.ACTION_COMMANDS, "Ctrl+K", window.choose_command)
    add(help_menu, "about", texts.ACTION_ABOUT, "", window.about)
