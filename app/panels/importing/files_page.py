"""Files: which captures, and what is known of each."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QComboBox, QFileDialog, QHBoxLayout, QPushButton

from app.icons import dot
from app.panels.importing.draft import ImportDraft
from app.panels.importing.page import Page
from app.panels.importing.reading_row import ReadingRow
from app.panels.importing.sentence_table import SentenceTable
from app.panels.pane import label
from app.settings import last_folder, remember_folder, window_settings
from app.texts import importing as texts
from app.theme import STEP, theme
from core.speech.emotion import EMOTIONS

_FOLDER = "captures"


class FilesPage(Page):
    """A table of sentences; dropped files join it."""

    def __init__(self, draft: ImportDraft) -> None:
        super().__init__(draft, texts.FILES, texts.FILES_HINT, texts.FILES_EMPTY)
        self._settings = window_settings()
        self.setAcceptDrops(True)
        self.reading = ReadingRow(draft)
        self.body.addWidget(self.reading)
        self.table = SentenceTable(draft)
        self.body.addWidget(self.table, 1)
        self.found = label()
        self.emotion = QComboBox(toolTip=texts.EMOTION_TIP)
        for emotion in EMOTIONS:
            self.emotion.addItem(dot(theme().emotion[emotion]), emotion)
        self.leave_out = QPushButton(texts.LEAVE_OUT, toolTip=texts.LEAVE_OUT_TIP)
        below = QHBoxLayout()
        below.setSpacing(STEP)
        below.addWidget(label(texts.EMOTION_OF_SELECTED, "plain"))
        below.addWidget(self.emotion)
        below.addWidget(self.leave_out)
        below.addStretch(1)
        below.addWidget(self.found)
        self.body.addLayout(below)
        self.add_files = QPushButton(texts.ADD_FILES, toolTip=texts.ADD_FILES_TIP)
        self.add_folder = QPushButton(texts.ADD_FOLDER, toolTip=texts.ADD_FOLDER_TIP)
        buttons = QHBoxLayout()
        buttons.setSpacing(STEP)
        buttons.addWidget(self.add_files)
        buttons.addWidget(self.add_folder)
        buttons.addStretch(1)
        self.layout().addLayout(buttons)
        self.add_files.clicked.connect(self.ask_files)
        self.add_folder.clicked.connect(self.ask_folder)
        self.leave_out.clicked.connect(self.on_leave_out)
        self.emotion.activated.connect(lambda row: self.on_emotion(EMOTIONS[row]))
        self.table.emotion_asked.connect(self.on_emotion)
        self.table.removal_asked.connect(self.on_leave_out)
        self.table.selectionModel().selectionChanged.connect(lambda *_: self._enable())

    @property
    def state(self) -> str:
        """See `Page.state`."""
        n = len(self.draft.sentences)
        bad = sum(bool(facts.problem) for facts in self.draft.facts.values())
        return "" if not n else texts.STATE_PROBLEMS.format(n=n, bad=bad) if bad else texts.STATE_FILES.format(n=n)

    def refresh(self) -> None:
        """See `Page.refresh`."""
        self.reading.renew()
        self.table.sentences.renew()
        self._enable()
        facts = [self.draft.facts[s.name] for s in self.draft.sentences if s.name in self.draft.facts]
        seconds = sum(f.n_frames / f.rate_hz for f in facts if f.rate_hz)
        parts = [texts.FILES_FOUND.format(n=len(self.draft.sentences),
                                          minutes=f"{int(seconds // 60)}:{seconds % 60:04.1f} min")]  # fmt: skip
        found = self.draft.survey
        if found is not None and found.motionless:
            parts.append(texts.FILES_APART.format(n=len(found.motionless)))
        if found is not None and found.unused:
            parts.append(texts.FILES_UNUSED.format(n=len(found.unused)))
            self.found.setToolTip("\n".join(found.unused[:40]))
        self.found.setText(" · ".join(parts))

    # Reactions

    def ask_files(self) -> None:
        """Choose files."""
        names, _ = QFileDialog.getOpenFileNames(self, texts.ADD_FILES, last_folder(self._settings, _FOLDER))
        self._add([Path(name) for name in names])

    def ask_folder(self) -> None:
        """Choose a folder."""
        name = QFileDialog.getExistingDirectory(self, texts.ADD_FOLDER, last_folder(self._settings, _FOLDER))
        self._add([Path(name)] if name else [])

    def on_emotion(self, emotion: str) -> None:
        """Set the emotion of all selected sentences."""
        self.draft.change_sentences(self.table.chosen, texts.EDIT_EMOTION, emotion=emotion)

    def on_leave_out(self) -> None:
        """Take the selected sentences out of the plan."""
        self.draft.remove_sentences(self.table.chosen)

    def _add(self, paths: list[Path]) -> None:
        if paths:
            remember_folder(self._settings, _FOLDER, paths[0])
            self.draft.add_files(paths)

    def _enable(self) -> None:
        chosen = set(self.table.chosen)
        self.leave_out.setEnabled(bool(chosen))
        self.emotion.setEnabled(bool(chosen))
        felt = [s.emotion for s in self.draft.sentences if s.name in chosen]
        if felt:
            self.emotion.setCurrentText(felt[0])

    # Qt

    def dragEnterEvent(self, event) -> None:
        """Take files."""
        if event.mimeData().hasUrls():
            event.acceptProposedAction()

    def dropEvent(self, event) -> None:
        """Add what is dropped."""
        self._add([Path(url.toLocalFile()) for url in event.mimeData().urls() if url.isLocalFile()])
        event.acceptProposedAction()
