"""The phoneme-Isomap: all captured frames of one phoneme as a map that can be walked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import QComboBox, QLabel, QSizePolicy

from app import texts
from app.authoring import Authoring
from app.panels.map_items import MapBox, MapCanvas, MapMark, MotionFrameDots, NodeTrajectory, SplatImage
from app.panels.map_pick import MapPick, trajectory
from app.panels.pane import Pane
from app.theme import colour, theme
from core.document.change import Change
from core.manifold.splat import splat_image
from core.progress import Progress
from core.speech.emotion import EMOTIONS

_SETTLED_MS = 150
_SPLAT_PX = 384
_SIGMA_PX = 9.0
# ρ follows the map: where its frames lie densest, the sum of equation 3 comes to this before it is clamped
_DENSEST = 1.25
_HIGHEST_RHO = 0.6
_TRIAL_RHO = 1e-4
# the splats lie under the dots and must not outshine them
_SPLAT_OPACITY = 0.6
_SIGNS = {"neutral": "●", "happiness": "▲", "anger": "■", "sadness": "▼"}


@dataclass(frozen=True)
class _SplatRequest:
    points: np.ndarray
    colours: np.ndarray
    bounds: tuple[float, float, float, float]
    size: tuple[int, int]


class IsomapPane(Pane):
    """Bottom left: the map of the selected utterance's phone, or of any other.

    previewed(MapPick) : show this frame: the one under the pointer, else the kept one, else the one in use
    """

    previewed = Signal(object)

    def __init__(self, authoring: Authoring) -> None:
        self.box = MapBox()
        self.canvas = MapCanvas(self.box)
        super().__init__(texts.ISOMAP, self.canvas, texts.ISOMAP_EMPTY)
        self._authoring = authoring
        self.canvas.setStatusTip(texts.MAP_TIP)
        self._splats, self._dots = SplatImage(), MotionFrameDots()
        self._splats.setOpacity(_SPLAT_OPACITY)
        self._used_way = NodeTrajectory(theme().accent, 2.0)
        self._pointed_way = NodeTrajectory(theme().text, 1.0)
        self._used_mark = MapMark("d", theme().accent)
        self._kept_mark = MapMark("o", theme().text, 13)
        for item in (self._splats, self._dots, self._used_way, self._pointed_way, self._used_mark, self._kept_mark):
            self.box.addItem(item, ignoreBounds=item is not self._dots)
        self.kept: MapPick | None = None
        self._pointed: MapPick | None = None

        for key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            pin = QShortcut(QKeySequence(key), self.canvas)
            pin.setContext(Qt.ShortcutContext.WidgetShortcut)
            pin.activated.connect(self.pin_kept)

        self.phone = QComboBox(toolTip=texts.PHONE_TIP)
        self.phone.setProperty("role", "small")
        self.phone.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.phone.setMaxVisibleItems(24)
        self.phone.activated.connect(lambda i: authoring.view.show_map(self.phone.itemData(i)))
        self.header.addWidget(self.phone)
        legend = QLabel(_legend())
        legend.setProperty("role", "small")
        legend.setTextFormat(Qt.TextFormat.RichText)
        legend.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        self.footer.addWidget(legend, 1)

        self.box.pointed.connect(self.on_pointed)
        self.box.clicked.connect(self.on_clicked)
        self.canvas.double_clicked.connect(self.on_double_clicked)
        self._settle = QTimer(self, singleShot=True, interval=_SETTLED_MS)
        self._settle.timeout.connect(self._renew_splats)
        self.box.sigRangeChanged.connect(lambda *_: self._settle.start())
        authoring.document.changed.connect(self.on_document_changed)
        authoring.view.map_chosen.connect(self.on_map_chosen)
        authoring.view.slot_selected.connect(self.on_slot_selected)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)
        self._fill_phones()
        self.on_map_chosen()

    # Reactions to the document

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other maps, another path, another pin."""
        if change & Change.CLUSTERS:
            self._fill_phones()
            self.on_map_chosen()
        if change & (Change.PATH | Change.CONSTRAINTS):
            self._show_used()
            self._show_title()

    def on_map_chosen(self) -> None:
        """Show another map."""
        self._forget_picks()
        database, phone = self._authoring.document.database, self._authoring.view.map_phone
        if database is None or phone not in database.maps:
            self.show_empty(texts.ISOMAP_EMPTY)
            return
        self.phone.setCurrentIndex(self.phone.findData(phone))
        shown = database.maps[phone]
        node = np.searchsorted(database.nodes.start, shown.frames, side="right") - 1
        self._emotions = database.nodes.emotion[node]
        self._dots.show_frames(shown.embedding.astype(float), self._emotions)
        self._splats.clear()
        self.show_content()
        self.frame_view()
        self._show_title()
        self._show_used()

    def on_slot_selected(self) -> None:
        """Another utterance: what was kept was meant for the one before."""
        self._forget_picks()
        self._show_title()
        self._show_used()

    def on_playhead_moved(self, _time_s: float) -> None:
        """The frame in use moves along its node."""
        self._show_used()

    # Reactions to the animator

    def on_pointed(self, point: np.ndarray | None) -> None:
        """Preview what is under the pointer; away from the map, what was kept."""
        self._pointed = None if point is None else self._pick(point)
        self._pointed_way.show_points(self._way(self._pointed))
        self._preview()

    def on_clicked(self, point: np.ndarray) -> None:
        """Keep a place."""
        self.canvas.setFocus()
        self.kept = self._pick(point)
        self._kept_mark.show_at(None if self.kept is None else self.kept.at)
        self._preview()

    def on_double_clicked(self, point: np.ndarray) -> None:
        """Pin the node at a place, or free it."""
        self.on_clicked(point)
        self.pin_kept()

    def pin_kept(self) -> None:
        """Pin the node that is kept (or else the one in use) to the selected utterance, or free it."""
        picked = self.kept or self.used
        if picked is not None:
            self._authoring.toggle_pin(picked.node_name(self._authoring.document.database))

    def frame_view(self) -> None:
        """Show the whole map."""
        self.box.autoRange(padding=0.06)

    def zoom(self, factor: float) -> None:
        """Show everything ``factor`` times as large."""
        self.box.scaleBy((1 / factor, 1 / factor))

    # What is shown

    @property
    def used(self) -> MapPick | None:
        """The frame that the path uses in the selected slot at the playhead."""
        authoring = self._authoring
        document, slot, phone = authoring.document, authoring.view.slot, authoring.view.map_phone
        if document.answer is None or document.database is None or slot is None or phone is None:
            return None
        utterance = document.speech.transcript.phonemes[slot]
        share = (authoring.view.playhead_s - utterance.start_s) / (utterance.end_s - utterance.start_s)
        return MapPick.used(document.database, phone, int(document.answer.path.nodes[slot]), share)

    def _pick(self, point: np.ndarray) -> MapPick | None:
        database, phone = self._authoring.document.database, self._authoring.view.map_phone
        return None if database is None or phone is None else MapPick.under(database, database.maps[phone], point)

    def _way(self, picked: MapPick | None) -> np.ndarray:
        database, phone = self._authoring.document.database, self._authoring.view.map_phone
        if picked is None or database is None or phone is None:
            return np.zeros((0, 2))
        return trajectory(database, phone, picked.node)

    def _show_used(self) -> None:
        used = self.used
        self._used_way.show_points(self._way(used))
        self._used_mark.show_at(None if used is None else used.at)
        self._preview()

    def _preview(self) -> None:
        self.previewed.emit(self._pointed or self.kept or self.used)

    def _forget_picks(self) -> None:
        self.kept = self._pointed = None
        self._kept_mark.show_at(None)
        self._pointed_way.show_points(np.zeros((0, 2)))

    def _show_title(self) -> None:
        document, view = self._authoring.document, self._authoring.view
        slot = view.map_slot
        if slot is None:
            self.info.setText("" if view.map_phone is None else f"/{view.map_phone}/")
            return
        phones = ("pau", *document.speech.transcript.phones, "pau")
        title = texts.TRIPHONE.format(before=phones[slot], phone=phones[slot + 1], after=phones[slot + 2])
        if slot in document.pins:
            title += "   " + texts.PINNED.format(node=document.pins[slot])
        self.info.setText(title)

    def _fill_phones(self) -> None:
        self.phone.clear()
        database = self._authoring.document.database
        for phone, shown in sorted(database.maps.items()) if database is not None else ():
            self.phone.addItem(texts.PHONE_ITEM.format(phone=phone, frames=len(shown.frames)), phone)
        self.phone.setVisible(self.phone.count() > 0)

    def _renew_splats(self) -> None:
        database, phone = self._authoring.document.database, self._authoring.view.map_phone
        if database is None or phone not in database.maps or self.is_empty:
            return
        (left, right), (bottom, top) = self.box.viewRange()
        width, height = max(self.canvas.width(), 1), max(self.canvas.height(), 1)
        scale = min(1.0, _SPLAT_PX / max(width, height))
        size = max(1, round(width * scale)), max(1, round(height * scale))
        colours = np.array([colour(theme().emotion[e]).getRgbF()[:3] for e in EMOTIONS])[self._emotions]
        request = _SplatRequest(database.maps[phone].embedding, colours, (left, bottom, right, top), size)
        self._authoring.jobs.start("splats", "", request, _splats, lambda answer: self._splats.show_splats(*answer))


def _splats(request: _SplatRequest, _progress: Progress):
    image = splat_image(request.points, request.colours, _SIGMA_PX, _TRIAL_RHO, request.bounds, request.size)
    # equation 3 is linear in ρ until it is clamped, so one trial tells the picture of any ρ
    rho = min(_DENSEST * _TRIAL_RHO / max(float(image.max()), 1e-12), _HIGHEST_RHO)
    return np.minimum(image * (rho / _TRIAL_RHO), 1.0), request.bounds


def _legend() -> str:
    emotions = [f'<span style="color:{theme().emotion[e]}">{_SIGNS[e]}</span>&nbsp;{e}' for e in EMOTIONS]
    marks = [f'<span style="color:{theme().accent}">◇</span>&nbsp;{texts.LEGEND_USED}', f"○&nbsp;{texts.LEGEND_PICKED}"]
    return "&nbsp;&nbsp;&nbsp;".join([*emotions, *marks])
