"""How many neighbours each of two maps keeps, compared in the background and said in their corners."""

from __future__ import annotations

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QToolButton

from app import texts
from app.jobs import JobRunner
from app.panels.isomap.shown_map import ShownMap
from app.panels.isomap.view import MapView
from core.manifold.preservation import NeighbourPreservation, map_preservation
from core.progress import Progress


class PreservationFigures(QObject):
    """Captions of the Isomap and of the PCA map beside it."""

    def __init__(
        self, jobs: JobRunner, isomap: MapView, pca: MapView, pca_button: QToolButton, parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self._jobs, self._isomap, self._pca, self._button = jobs, isomap, pca, pca_button
        self._known: dict[tuple[str, str], tuple[NeighbourPreservation, NeighbourPreservation]] = {}

    def show(self) -> None:
        """Say in the corner of each map which it is and how many neighbours it keeps, when there are two."""
        shown = self._isomap.shown
        if shown is None or not self._button.isChecked():
            self._isomap.show_caption("")
            return
        key = shown.database.content_hash, shown.phone
        if key not in self._known:
            self._isomap.show_caption(texts.ISOMAP_MAP)
            self._pca.show_caption(texts.PCA_MAP)

            def compared(figures: tuple[NeighbourPreservation, NeighbourPreservation]) -> None:
                self._known[key] = figures
                self.show()

            self._jobs.start("preservation", texts.COMPARING_MAPS, shown, _compare, compared)
            return
        isomap, pca = self._known[key]
        for view, name, figures in ((self._isomap, texts.ISOMAP_MAP, isomap), (self._pca, texts.PCA_MAP, pca)):
            view.show_caption(texts.PRESERVATION.format(map=name, figures=figures))
        self._button.setToolTip(texts.PCA_TIP + texts.PRESERVATION_TIP.format(isomap=isomap, pca=pca))


def _compare(shown: ShownMap, progress: Progress) -> tuple[NeighbourPreservation, NeighbourPreservation]:
    return map_preservation(shown.map, shown.database.frames, progress)
