"""The phoneme-Isomap pane: the map, what can be seen on it, and the lists beside it."""

from app.panels.isomap.pane import IsomapPane

__all__ = ["IsomapPane"]
