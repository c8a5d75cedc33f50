"""Markers: which captured marker is which of the database."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtWidgets import QComboBox, QFileDialog, QHBoxLayout, QPushButton, QSplitter

from app import texts as window_texts
from app.authoring import Authoring
from app.panels.importing.draft import ImportDraft
from app.panels.importing.marker_choice import (
    FILE,
    OPEN,
    OURS,
    OWN,
    MatchPicture,
    MatchRequest,
    fields_for_own,
    fields_for_set,
    is_own,
    markers_of_database,
    match,
)
from app.panels.importing.match_table import WEAK, MatchTable
from app.panels.importing.match_view import Cloud, MatchView
from app.panels.importing.page import Page
from app.panels.pane import ElidedLabel, label
from app.settings import last_folder, window_settings
from app.texts import importing as texts
from app.theme import STEP
from core.motion.marker_set import MarkerSet

_TABLE_PX = 430


class MarkersPage(Page):
    """Proposes, and lets two clicks decide otherwise."""

    def __init__(self, draft: ImportDraft, authoring: Authoring) -> None:
        super().__init__(draft, texts.MARKERS, texts.MARKERS_HINT, texts.FILES_FIRST)
        self._authoring = authoring
        self._picture: MatchPicture | None = None
        self._drawn: MatchPicture | None = None
        self._asked: tuple | None = None
        self._file_markers: MarkerSet | None = None
        top = QHBoxLayout()
        top.setSpacing(STEP)
        self.wanted = QComboBox(toolTip=texts.WANTED_TIP)
        for key, text in ((OWN, texts.WANTED_OWN), (OURS, texts.WANTED_OURS), (FILE, texts.WANTED_FILE)):
            self.wanted.addItem(text, key)
        self.again = QPushButton(texts.MATCH_AGAIN, toolTip=texts.MATCH_AGAIN_TIP)
        top.addWidget(label(texts.WANTED, "plain"))
        top.addWidget(self.wanted)
        top.addWidget(self.again)
        top.addStretch(1)
        self.body.addLayout(top)
        self.view, self.table = MatchView(), MatchTable()
        split = QSplitter(childrenCollapsible=False, handleWidth=1)
        split.addWidget(self.view)
        split.addWidget(self.table)
        split.setStretchFactor(0, 1)
        split.setSizes([2 * _TABLE_PX, _TABLE_PX])
        self.body.addWidget(split, 1)
        self.alone = ElidedLabel()
        below = QHBoxLayout()
        below.addWidget(self.alone, 1)
        below.addWidget(label(texts.MATCH_LEGEND))
        self.body.addLayout(below)
        self.wanted.activated.connect(lambda _: self.on_wanted(self.wanted.currentData()))
        self.again.clicked.connect(lambda: self.on_wanted(self.wanted.currentData()))
        self.view.paired.connect(self.on_pair)
        self.view.chosen.connect(self.table.choose)
        self.table.chosen.connect(self.view.choose)
        self.table.pairs.asked.connect(self.on_pair)

    @property
    def state(self) -> str:
        """See `Page.state`."""
        plan = self.draft.plan
        facts = self.draft.first_facts()
        if plan is None or facts is None:
            return ""
        if is_own(plan):
            n = len(plan.markers) or len(facts.names)
            return texts.STATE_OWN.format(n=n, landmarks=len(plan.landmarks))
        wanted = len(self._picture.wanted) if self._picture is not None and not self._picture.own else len(plan.markers)
        return texts.STATE_MATCHED.format(n=len(plan.markers), wanted=wanted)

    def pairs(self) -> dict[str, str]:
        """Return captured name to wanted name, or for own markers to the landmark that it is."""
        plan = self.draft.plan
        if is_own(plan):
            captured = {theirs: ours for ours, theirs in plan.markers.items()}
            return {captured.get(name, name): anatomy for anatomy, name in plan.landmarks.items()}
        return dict(plan.markers)

    def refresh(self) -> None:
        """See `Page.refresh`."""
        facts = self.draft.first_facts()
        if facts is None:
            return
        own = is_own(self.draft.plan)
        self._offer_open_database()
        if own != (self.wanted.currentData() == OWN):
            self.wanted.setCurrentIndex(self.wanted.findData(OWN if own else OURS))
        asked = (facts.names, own, self.wanted.currentData(), self._file_markers)
        if asked != self._asked:
            self._asked = asked
            self._start(own, self._on_picture)
        elif self._picture is not None:
            self._show()

    def _offer_open_database(self) -> None:
        database, row = self._authoring.document.database, self.wanted.findData(OPEN)
        if row >= 0:
            self.wanted.setItemText(row, texts.WANTED_OPEN.format(name=database.name)) if database else None
        elif database is not None:
            self.wanted.insertItem(2, texts.WANTED_OPEN.format(name=database.name), OPEN)

    def _start(self, own: bool, done) -> None:
        facts, wanted = self.draft.first_facts(), None
        if self.wanted.currentData() == OPEN:
            wanted = self._authoring.document.database.markers
        elif self.wanted.currentData() == FILE:
            wanted = self._file_markers
        request = MatchRequest(facts.names, facts.sample, None if own else wanted, own)
        self.draft.jobs.start("match", texts.MATCHING, request, match, done)

    def _on_picture(self, picture: MatchPicture) -> None:
        self._picture = picture
        self._show()

    def _show(self) -> None:
        picture, pairs, facts = self._picture, self.pairs(), self.draft.first_facts()
        found = Cloud(facts.names, picture.matching.placed)
        wanted = Cloud(picture.wanted.names, picture.places)
        if self._drawn is not picture:
            self._drawn = picture
            titles = texts.CAPTURED, texts.ON_THE_FACE_OWN if picture.own else texts.ON_THE_FACE
            self.view.show_clouds(found, wanted, picture.face, titles)
        how = picture.how
        doubtful = frozenset(f for f, w in pairs.items() if how.get((f, w), ("", 1.0, 0.0))[1] < WEAK)
        self.view.show_pairs(pairs, doubtful, picture.own)
        current = self.table.currentIndex()
        self.table.pairs.show_pairs(facts.names, picture.wanted.names, pairs, how, picture.own)
        if current.isValid():
            self.table.setCurrentIndex(self.table.pairs.index(current.row(), 1))
        alone = [name for name in picture.wanted.names if name not in pairs.values()]
        self.alone.setText(texts.ALONE.format(names=", ".join(alone)) if alone else "")

    # Reactions

    def on_wanted(self, which: str) -> None:
        """Match anew, to another set or to the same."""
        if which == FILE:
            name, _ = QFileDialog.getOpenFileName(self, texts.WANTED_FILE,
                                                  last_folder(window_settings(), "database"),
                                                  window_texts.FILTER_DATABASE)  # fmt: skip
            if name:
                self.draft.jobs.start("wanted", texts.MATCHING, Path(name), markers_of_database, self._on_file_markers)
            else:
                self.refresh()
            return
        self._start(which == OWN, self._propose)

    def _on_file_markers(self, markers: MarkerSet) -> None:
        self._file_markers = markers
        self._start(False, self._propose)

    def _propose(self, picture: MatchPicture) -> None:
        self._picture = picture
        self._asked = (self.draft.first_facts().names, picture.own, self.wanted.currentData(), self._file_markers)
        if picture.own:
            fields = fields_for_own(self.draft.plan, picture.landmarks, picture.groups)
        else:
            fields = fields_for_set(self.draft.plan, picture.wanted, picture.matching.markers)
        self.draft.change(texts.EDIT_MATCH, **fields)
        self._show()

    def on_pair(self, found: str, wanted: str) -> None:
        """Join two markers, or with no ``wanted`` take a pair apart; either's former pair gives way."""
        pairs = {f: w for f, w in self.pairs().items() if f != found and w != wanted}
        if wanted:
            pairs[found] = wanted
        plan, edit = self.draft.plan, texts.EDIT_MATCH if wanted else texts.EDIT_UNMATCH
        if self._picture.own:
            names = plan.markers or {name: name for name in self.draft.first_facts().names}
            landmarks = {anatomy: names[f] for f, anatomy in pairs.items()}
            self.draft.change(edit, landmarks=landmarks)
        else:
            self.draft.change(edit, **fields_for_set(plan, self._picture.wanted, pairs))
