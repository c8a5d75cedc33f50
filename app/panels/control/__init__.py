"""The control panel: what is said, how it feels, on which face, from which motion, by which engine."""

from app.panels.control.panel import WIDTH_PX, ControlPanel

__all__ = ["WIDTH_PX", "ControlPanel"]
