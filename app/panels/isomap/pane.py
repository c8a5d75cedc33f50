"""The phoneme-Isomap: all captured frames of one phoneme as a map that can be walked, pinned from and pruned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QSplitter, QVBoxLayout, QWidget

from app import texts
from app.authoring import Authoring
from app.emotion_colours import emotion_colours
from app.panels.isomap.clip import NodeClip
from app.panels.isomap.colouring import ColourBy, colouring
from app.panels.isomap.controls import MapControls
from app.panels.isomap.legend import MapLegend
from app.panels.isomap.preservation import PreservationFigures
from app.panels.isomap.pruning import Pruning
from app.panels.isomap.removal import RemovalStrip
from app.panels.isomap.shown_map import ShownMap
from app.panels.isomap.side_lists import SideLists
from app.panels.isomap.view import MapView
from app.panels.map_pick import MapPick
from app.panels.pane import Pane, toggle
from core.document.change import Change
from core.motion.database import MotionDatabase
from core.speech.phoneme import PAU

_SIDE_PX = 210


class IsomapPane(Pane):
    """Bottom left: the map of the selected utterance's phone, or of any other.

    previewed(MapPick) : show this frame: of the clip that plays, else under the pointer, else the kept one, else the
        one in use
    """

    previewed = Signal(object)

    def __init__(self, authoring: Authoring) -> None:
        self._authoring = authoring
        self.view, self.pca = MapView("isomap", authoring.jobs), MapView("pca", authoring.jobs)
        self.controls, self.strip = MapControls(), RemovalStrip()
        self.side = SideLists(authoring)
        self.suspects, self.removed = self.side.suspects, self.side.removed
        super().__init__(texts.ISOMAP, self._arranged(), texts.ISOMAP_EMPTY)
        self.canvas, self.box = self.view.canvas, self.view.box
        self.kept: MapPick | None = None
        self.selection: frozenset[int] = frozenset()
        self._pointed: MapPick | None = None
        self.clip = NodeClip(authoring.jobs, self)
        self.pruning = Pruning(authoring, self.strip, self)
        self._make_header()
        self.legend = MapLegend()
        self.footer.addWidget(self.legend, 1)
        self._join()
        self._fill_phones()
        self.on_map_chosen()

    # Making

    def _arranged(self) -> QWidget:
        across = QSplitter(Qt.Orientation.Horizontal, childrenCollapsible=False, handleWidth=1)
        for widget in (self.view, self.pca, self.side):
            across.addWidget(widget)
        across.setStretchFactor(0, 1)
        across.setStretchFactor(1, 1)
        across.setSizes([400, 400, _SIDE_PX])
        self.pca.hide()
        content = QWidget()
        column = QVBoxLayout(content)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(self.controls)
        column.addWidget(across, 1)
        column.addWidget(self.strip)
        return content

    def _make_header(self) -> None:
        self.pca_button = toggle(texts.PCA_MAP, texts.PCA_TIP, self.show_pca)
        self.suspects_button, self.removed_button = self.side.suspects_button, self.side.removed_button
        self._figures = PreservationFigures(self._authoring.jobs, self.view, self.pca, self.pca_button, self)
        for button in (self.pca_button, self.suspects_button, self.removed_button):
            self.header.addWidget(button)
        self.phone = QComboBox(toolTip=texts.PHONE_TIP)
        self.phone.setProperty("role", "small")
        self.phone.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.phone.setMaxVisibleItems(24)
        self.phone.activated.connect(lambda i: self._authoring.view.show_map(self.phone.itemData(i)))
        self.header.addWidget(self.phone)

    def _join(self) -> None:
        authoring, controls = self._authoring, self.controls
        for view in self._views:
            view.canvas.setStatusTip(texts.MAP_TIP)
            view.pointed.connect(self.on_pointed)
            view.clicked.connect(self.on_clicked)
            view.double_clicked.connect(self.on_double_clicked)
            view.enclosed.connect(self.on_enclosed)
            view.keyed.connect(self.on_keyed)
        controls.tool_chosen.connect(self.on_tool_chosen)
        controls.colours_chosen.connect(lambda _: self._show_colours())
        controls.filter_changed.connect(self._show_colours)
        controls.splats_changed.connect(self.on_splats_changed)
        self.suspects.chosen.connect(self.on_suspect_chosen)
        self.suspects.activated.connect(lambda row: self.play_node(row))
        self.removed.chosen.connect(self.show_node)
        self.removed.activated.connect(lambda row: self.pruning.restore(frozenset([row])))
        for nodes in (self.suspects, self.removed):
            nodes.removal_asked.connect(self.remove_selected)
            nodes.play_asked.connect(self.play_selected)
        self.side.found.connect(self._show_colours)
        self.clip.frame_shown.connect(self.previewed)
        self.clip.ended.connect(self._preview)
        self.strip.cancelled.connect(self.canvas.setFocus)
        emotion_colours.changed.connect(self.on_emotion_colours)
        authoring.document.changed.connect(self.on_document_changed)
        authoring.view.map_chosen.connect(self.on_map_chosen)
        authoring.view.slot_selected.connect(self.on_slot_selected)
        authoring.view.playhead_moved.connect(self.on_playhead_moved)

    # Reactions to the document

    def on_document_changed(self, change: Change, _origin: object) -> None:
        """Show other maps, another path, another pin, other prices, what is removed."""
        if change & Change.NODES:
            self.clip.stop()
        if change & Change.CLUSTERS:
            self._fill_phones()
            self.on_map_chosen()
        recoloured = Change.CURATION | Change.NODES
        if self.controls.colour_by is ColourBy.PRICE:
            recoloured |= Change.PRICES
        if change & recoloured:
            self._show_colours()
        if change & (Change.PATH | Change.CONSTRAINTS | Change.ALIGNMENT | Change.ENGINE):
            self._show_used()
            self._show_title()
        if change & Change.PRICES:
            self._preview()

    def on_map_chosen(self) -> None:
        """Show another map."""
        self._forget_picks()
        database, phone = self._database, self._authoring.view.map_phone
        if database is None or phone not in database.maps:
            self.show_empty(texts.ISOMAP_EMPTY)
            return
        self.phone.setCurrentIndex(self.phone.findData(phone))
        self.view.show_map(ShownMap.isomap(database, phone))
        self.pca.show_map(ShownMap.pca(database, phone) if self.pca_button.isChecked() else None)
        self.show_content()
        self._show_colours()
        self._figures.show()
        self._show_title()
        self._show_used()

    def on_slot_selected(self) -> None:
        """Another utterance: what was kept was meant for the one before."""
        self._forget_picks()
        if self.controls.colour_by is ColourBy.PRICE:
            self._show_colours()
        self._show_title()
        self._show_used()

    def on_playhead_moved(self, _time_s: float) -> None:
        """The frame in use moves along its node, and time-correct frames along theirs."""
        self._show_used()

    def on_emotion_colours(self) -> None:
        """Paint emotions otherwise."""
        self.controls.show_palette()
        self._show_colours()

    # Reactions to the animator

    def on_pointed(self, picked: MapPick | None) -> None:
        """Preview what is under the pointer; away from the map, what was kept."""
        self._pointed = picked
        for view in self._views:
            view.show_pointed(picked)
        if not self.clip.is_playing:
            self._preview()

    def on_clicked(self, picked: MapPick, adds: bool) -> None:
        """Keep a place; a captured frame selects its node too, with Ctrl beside those that are selected."""
        self.clip.stop()
        self._keep(picked)
        start, stop = self._database.nodes.start[picked.node], self._database.nodes.stop[picked.node]
        of_node = picked.inside and bool(((picked.frames >= start) & (picked.frames < stop)).all())
        captured = frozenset([picked.node]) if of_node else frozenset()
        self._select(self.selection ^ captured if adds else captured)

    def on_double_clicked(self, picked: MapPick) -> None:
        """Pin the node at a place, or free it."""
        self.on_clicked(picked, False)
        self.pin_kept()

    def on_enclosed(self, rows: frozenset[int], adds: bool) -> None:
        """Select the nodes within an outline."""
        self._keep(None)
        self._select(self.selection | rows if adds else rows)

    def on_keyed(self, key: int, shift: bool) -> None:
        """Do what a key on the map asks for."""
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.pin_kept()
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.remove_selected()
        elif key == Qt.Key.Key_U:
            self._authoring.unpin()
        elif key == Qt.Key.Key_Space:
            self.play_selected(shift)
        elif key == Qt.Key.Key_N:
            self.step_suspects(-1 if shift else 1)
        elif key == Qt.Key.Key_Escape:
            self.clip.stop()
            self._forget_picks()
            self._preview()

    def on_tool_chosen(self, tool: str) -> None:
        """Let a drag do something else."""
        for view in self._views:
            view.box.tool = tool

    def on_splats_changed(self, sigma_px: float, rho_gain: float) -> None:
        """Draw other splats."""
        for view in self._views:
            view.show_splats(sigma_px, rho_gain)

    def on_suspect_chosen(self, row: int) -> None:
        """Show a suspect on its map and play it."""
        self.show_node(row)
        self.play_node(row)

    # What can be asked for

    def pin_kept(self) -> None:
        """Pin the node that is kept (or else the one in use) to the selected utterance, or free it."""
        picked = self.kept or self.used
        if picked is not None:
            self._authoring.toggle_pin(picked.node_name(self._database))

    def remove_selected(self) -> None:
        """Ask why the selected nodes are to be removed; nothing is removed before that is answered."""
        self.pruning.ask(self.selection, self.side.fault_of(self.selection))

    def restore_selected(self) -> None:
        """Let the search use the selected nodes again."""
        self.pruning.restore(self.selection)

    def play_selected(self, slowly: bool = False) -> None:
        """Play the node that is selected (or else the one in use) as a clip, or stop it."""
        if self.clip.is_playing:
            self.clip.stop()
            return
        picked = self.kept or self.used
        row = next(iter(self.selection)) if len(self.selection) == 1 else None if picked is None else picked.node
        if row is not None:
            self.play_node(row, slowly)

    def play_node(self, row: int, slowly: bool = False) -> None:
        """Play a node as a clip, with its sound."""
        self._authoring.player.pause()
        self.clip.play(self._database, row, slowly)

    def show_node(self, row: int) -> None:
        """Show a node on the map of its phone and select it."""
        self._authoring.view.show_map(self._database.nodes[row].phone)
        self._keep(MapPick.of_node(self._database, row, 0.5, self.view.shown))
        self._select(frozenset([row]))

    def step_suspects(self, by: int = 1) -> None:
        """Show the next suspect that is not removed yet, or the previous one."""
        if not self.suspects_button.isChecked():
            self.suspects_button.setChecked(True)
        self.suspects.step(by, self.side.removed_rows)

    def show_pca(self, shows: bool) -> None:
        """Show the PCA map beside the Isomap, or the Isomap alone."""
        self.pca.setVisible(shows)
        if shows and self.view.shown is not None:
            self.pca.show_map(ShownMap.pca(self.view.shown.database, self.view.shown.phone))
            self.pca.show_kept(self.kept)
            self.pca.show_selected(self.selection)
            self._show_colours()
            self._show_used()
        self._figures.show()

    def frame_view(self) -> None:
        """Show the whole map."""
        for view in self._views:
            view.frame_view()

    def zoom(self, factor: float) -> None:
        """Show everything ``factor`` times as large."""
        for view in self._views:
            view.zoom(factor)

    # What is shown

    @property
    def used(self) -> MapPick | None:
        """The frame that the path uses in the selected slot at the playhead."""
        document, slot, share = self._authoring.document, self._authoring.view.slot, self._share
        if document.path is None or share is None or self.view.shown is None:
            return None
        node = int(document.path.nodes[slot])
        return replace(MapPick.of_node(document.database, node, share, self.view.shown), in_use=True)

    @property
    def prices(self) -> np.ndarray | None:
        """Price of each node of the database in the selected slot, in units of PNT; None where none are known."""
        document, slot = self._authoring.document, self._authoring.view.map_slot
        if document.prices is None or slot is None or slot >= len(document.prices):
            return None
        return document.prices[slot] / document.cost_unit

    @property
    def _views(self) -> tuple[MapView, MapView]:
        return self.view, self.pca

    @property
    def _database(self) -> MotionDatabase | None:
        return self._authoring.document.database

    @property
    def _share(self) -> float | None:
        """Relative time of the playhead in the selected slot, 0 to 1."""
        document, slot = self._authoring.document, self._authoring.view.slot
        if document.speech is None or slot is None or slot >= len(document.speech.transcript.phonemes):
            return None
        utterance = document.speech.transcript.phonemes[slot]
        share = (self._authoring.view.playhead_s - utterance.start_s) / (utterance.end_s - utterance.start_s)
        return min(max(share, 0.0), 1.0)

    def _keep(self, picked: MapPick | None) -> None:
        self.kept = picked
        for view in self._views:
            view.show_kept(picked)

    def _select(self, rows: frozenset[int]) -> None:
        self.selection = rows
        for view in self._views:
            view.show_selected(rows)
        self._show_title()
        self._preview()

    def _forget_picks(self) -> None:
        self._pointed = None
        self._keep(None)
        self.selection = frozenset()
        for view in self._views:
            view.show_pointed(None)
            view.show_selected(frozenset())

    def _show_used(self) -> None:
        used, share, context = self.used, None, None
        slot = self._authoring.view.map_slot
        if slot is not None:
            share = self._share
            phones = (PAU, *self._authoring.document.speech.transcript.phones, PAU)
            context = phones[slot], phones[slot + 2]
        for view in self._views:
            view.show_used(used)
            view.show_correct(share, context)
        if not self.clip.is_playing:
            self._preview()

    def _preview(self) -> None:
        picked = self._pointed or self.kept or self.used
        if picked is not None and self.prices is not None:
            picked = replace(picked, price=float(self.prices[picked.node]))
        self.previewed.emit(picked)

    def _show_colours(self) -> None:
        shown = self.view.shown
        if shown is None:
            return
        by = self.controls.colour_by
        if by is ColourBy.SUSPICION and self.side.suspicion is None:
            self.side.look_for_suspects()
        if by is ColourBy.PRICE and self.prices is None:
            waits = texts.PRICE_NEEDS_SEARCH if self._authoring.document.has_no_path else texts.PRICE_WAITS
            self._authoring.noted.emit(waits.format(phone=shown.phone))
        score = None if self.side.suspicion is None else self.side.suspicion.score
        painted = colouring(shown, by, score, self.prices)
        removed = np.isin(shown.node, list(self.side.removed_rows))
        hidden = ~np.array(self.controls.emotions)[shown.emotion]
        for view in self._views:
            view.show_colours(painted, removed, hidden)
        self.legend.show_legend(by, painted)

    def _show_title(self) -> None:
        document, view = self._authoring.document, self._authoring.view
        slot = view.map_slot
        if slot is None:
            title = "" if view.map_phone is None else f"/{view.map_phone}/"
        else:
            phones = (PAU, *document.speech.transcript.phones, PAU)
            title = texts.TRIPHONE.format(before=phones[slot], phone=phones[slot + 1], after=phones[slot + 2])
            if slot in document.pins:
                title += "   " + texts.PINNED.format(node=document.pins[slot])
            if document.has_no_path:
                title += "   " + texts.NO_NODE_IN_USE
        if len(self.selection) > 1:
            title += "   " + texts.SELECTED_NODES.format(count=len(self.selection))
        self.info.setText(title)

    def _fill_phones(self) -> None:
        self.phone.clear()
        database = self._database
        for phone, shown in sorted(database.maps.items()) if database is not None else ():
            self.phone.addItem(texts.PHONE_ITEM.format(phone=phone, frames=len(shown.frames)), phone)
        self.phone.setVisible(self.phone.count() > 0)
