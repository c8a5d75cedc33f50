"""A cell of a table whose value is chosen from a list."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QModelIndex, QObject, Qt
from PySide6.QtGui import QIcon
from PySide6.QtWidgets import QComboBox, QStyledItemDelegate

Options = Callable[[QModelIndex], Sequence[tuple[QIcon, str]]]


class ChoiceDelegate(QStyledItemDelegate):
    """``options(index)`` gives the icons and texts that a cell may hold; the list opens at once."""

    def __init__(self, options: Options, parent: QObject) -> None:
        super().__init__(parent)
        self._options = options

    def createEditor(self, parent, _option, index):
        """See Qt."""
        editor = QComboBox(parent)
        for icon, text in self._options(index):
            editor.addItem(icon, text)
        editor.activated.connect(lambda _: (self.commitData.emit(editor), self.closeEditor.emit(editor)))
        return editor

    def setEditorData(self, editor, index) -> None:
        """See Qt."""
        editor.setCurrentText(index.data(Qt.ItemDataRole.EditRole))
        editor.showPopup()

    def setModelData(self, editor, model, index) -> None:
        """See Qt."""
        model.setData(index, editor.currentText())
