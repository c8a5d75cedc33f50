"""Edits on Qt's undo stack, which gives the menu its labels and makes one entry of a drag."""

from __future__ import annotations

from PySide6.QtGui import QUndoCommand

from core.document.document import Document, Edit

_MERGING = 1


class EditCommand(QUndoCommand):
    """Wraps one edit, or several of one drag."""

    def __init__(self, document: Document, edit: Edit, origin: object) -> None:
        super().__init__(edit.label)
        self.edit = edit
        self._document, self._origin = document, origin

    def redo(self) -> None:
        """Do it; whoever asked shows it already the first time, later it is news to all."""
        self._document.apply(self.edit, self._origin)
        self._origin = None

    def undo(self) -> None:
        """Take it back."""
        self._document.revert(self.edit)

    def id(self) -> int:
        """Let Qt try to merge."""
        return _MERGING

    def mergeWith(self, other: QUndoCommand) -> bool:
        """Take in the next edit of the same drag."""
        merged = self.edit.followed_by(other.edit) if isinstance(other, EditCommand) else None
        if merged is None:
            return False
        self.edit = merged
        self.setText(merged.label)
        return True
