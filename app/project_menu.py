"""The File menu's part on projects: new, open, recent, copies, versions."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QInputDialog, QMenu, QWidget

from app import texts
from app.actions import Actions
from app.project_jobs import is_unnamed
from app.project_keeper import ProjectKeeper
from app.settings import last_folder, recent_projects, remember_folder, window_settings
from app.versions import Versions
from core.document.project_file import SUFFIX


class ProjectMenu:
    """Puts the actions into a menu and asks for names."""

    def __init__(
        self, window: QWidget, actions: Actions, menu: QMenu, keeper: ProjectKeeper, versions: Versions
    ) -> None:
        self._window, self._keeper, self._versions = window, keeper, versions
        self._settings = window_settings()
        actions.add(menu, "new_project", texts.NEW_PROJECT, "Ctrl+N", keeper.new)
        actions.add(menu, "open_project", texts.OPEN_PROJECT, "Ctrl+Shift+O", self.ask_project)
        self.recent = menu.addMenu(texts.OPEN_RECENT)
        self.recent.aboutToShow.connect(self._fill_recent)
        actions.add(menu, "save", texts.ACTION_SAVE, "Ctrl+S", keeper.say_saved)
        actions.add(menu, "save_copy", texts.SAVE_COPY, "Ctrl+Shift+S", self.ask_copy)
        self.kept = menu.addMenu(texts.MENU_VERSIONS)
        actions.add(self.kept, "keep_version", texts.KEEP_VERSION, "Ctrl+Alt+V", self.ask_version)
        actions.add(self.kept, "toggle_version", texts.TOGGLE_VERSIONS, "`", versions.toggle)
        self.kept.addSeparator()
        self._n_fixed = len(self.kept.actions())
        self.kept.aboutToShow.connect(self._fill_versions)
        menu.addSeparator()

    def ask_project(self) -> None:
        """Choose a project."""
        name, _ = QFileDialog.getOpenFileName(
            self._window, texts.OPEN_PROJECT.replace("&", ""), last_folder(self._settings, "project"),
            texts.FILTER_PROJECT,
        )  # fmt: skip
        if name:
            remember_folder(self._settings, "project", Path(name))
            self._keeper.open(Path(name))

    def ask_copy(self) -> None:
        """Choose where a copy goes."""
        if self._keeper.file is None:
            return
        path = self._keeper.file.path
        speech = self._keeper.authoring.document.speech
        stem = path.stem
        if is_unnamed(path):
            stem = Path(speech.audio.path).stem if speech is not None and speech.audio.path else texts.UNNAMED_PROJECT
        start = Path(last_folder(self._settings, "project")) / f"{stem}{SUFFIX}"
        name, _ = QFileDialog.getSaveFileName(
            self._window, texts.SAVE_COPY.replace("&", ""), str(start), texts.FILTER_PROJECT
        )
        if name:
            remember_folder(self._settings, "project", Path(name))
            self._keeper.save_copy(Path(name))

    def ask_version(self) -> None:
        """Name what is on show."""
        title = texts.KEEP_VERSION.replace("&", "")
        name, wanted = QInputDialog.getText(self._window, title, texts.KEEP_VERSION_ASK)
        if wanted:
            self._versions.keep(name)

    def _fill_recent(self) -> None:
        self.recent.clear()
        for path in recent_projects(self._settings):
            name = texts.UNNAMED_PROJECT if is_unnamed(path) else path.stem
            action = self.recent.addAction(name.replace("&", "&&"), lambda path=path: self._keeper.open(path))
            action.setToolTip(str(path))
        self.recent.setToolTipsVisible(True)
        if self.recent.isEmpty():
            self.recent.addAction(texts.NO_RECENT).setEnabled(False)

    def _fill_versions(self) -> None:
        for action in self.kept.actions()[self._n_fixed :]:
            self.kept.removeAction(action)
            action.deleteLater()
        names = self._versions.names()
        for name in names:
            text = texts.SWITCH_VERSION.format(name=name).replace("&", "&&")
            self.kept.addAction(text, lambda name=name: self._versions.switch(name))
        forget = self.kept.addMenu(texts.FORGET_VERSION)
        forget.setEnabled(bool(names))
        for name in names:
            forget.addAction(name.replace("&", "&&"), lambda name=name: self._versions.forget(name))
