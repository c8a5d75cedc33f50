"""The face preview: the captured frame under the pointer, or the one that is in use."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtWidgets import QPushButton

from app import texts
from app.authoring import Authoring
from app.panels.face_view import FaceView
from app.panels.map_pick import MapPick
from app.panels.pane import Choice, ElidedLabel, Pane
from core.document.change import Change
from gpu.gl.face import Style


class PreviewPane(Pane):
    """Bottom right: one captured or interpolated frame.

    pin_asked() : tie the node on show to the selected utterance
    """

    pin_asked = Signal()

    def __init__(self, authoring: Authoring) -> None:
        self.face_view = FaceView()
        super().__init__(texts.PREVIEW, self.face_view, texts.ISOMAP_EMPTY)
        self._authoring = authoring
        self.pick: MapPick | None = None
        self.style = Choice([
            (Style.MARKERS.value, texts.MARKERS, texts.MARKERS_TIP),
            (Style.TEXTURED.value, texts.TEXTURED, texts.TEXTURED_TIP),
        ])  # fmt: skip
        self.style.group.idClicked.connect(lambda _: self.face_view.set_style(Style(self.style.key)))
        self.header.addWidget(self.style)
        self.caption = ElidedLabel()
        self.caption.setContentsMargins(4, 0, 0, 0)
        self.footer.addWidget(self.caption, 1)
        self.pin_button = QPushButton(texts.PIN)
        self.pin_button.setProperty("role", "quiet")
        self.pin_button.clicked.connect(self.pin_asked)
        self.footer.addWidget(self.pin_button)
        authoring.rig_changed.connect(self.on_rig_changed)
        authoring.document.changed.connect(self.on_document_changed)
        authoring.view.slot_selected.connect(self._show_pinning)
        self.on_document_changed(Change.NODES, None)

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other markers; a pick of another database means nothing any more."""
        database = self._authoring.document.database
        if change & Change.NODES:
            self.pick = None
            self.face_view.set_markers(None if database is None else database.markers)
            self.caption.setText("" if database is None else texts.PREVIEW_REST)
            if database is None:
                self.show_empty(texts.ISOMAP_EMPTY)
            else:
                self.show_content()
        self._show_pinning()

    def on_rig_changed(self) -> None:
        """Show another face."""
        self.face_view.set_rig(self._authoring.rig)
        self.style.button(Style.TEXTURED.value).setEnabled(self._authoring.rig is not None)

    def show_pick(self, pick: MapPick | None) -> None:
        """Show a place of the map; None leaves what is there."""
        database = self._authoring.document.database
        if pick is None or database is None:
            return
        self.pick = pick
        positions = database.pca.positions(pick.blend(database.frames))
        self.face_view.show_pose((positions - database.markers.rest).astype(np.float32))
        self.caption.setText(pick.caption(database))
        self.show_content()
        self._show_pinning()

    def _show_pinning(self) -> None:
        document, view = self._authoring.document, self._authoring.view
        slot = view.map_slot
        self.pin_button.setEnabled(self.pick is not None and slot is not None and document.database is not None
                                   and not document.has_no_path)  # fmt: skip
        pinned = (
            slot is not None
            and self.pick is not None
            and document.database is not None
            and document.pins.get(slot) == self.pick.node_name(document.database)
        )
        self.pin_button.setText(texts.UNPIN if pinned else texts.PIN)
        self.pin_button.setToolTip(texts.UNPIN_TIP if pinned else texts.PIN_TIP)
