"""Edits done, undone and redone at random, as an undo stack would."""

from __future__ import annotations

import random

from core.document.document import Document, Edit
from tests.core.document.random_edits import random_edit


class RandomWalk:
    """Steps through the edits of one document.

    done, undone : what undo and redo would take next is last
    """

    def __init__(self, document: Document, chance: random.Random) -> None:
        self.document, self.chance = document, chance
        self.done: list[Edit] = []
        self.undone: list[Edit] = []

    def undo_or_redo(self) -> bool:
        """Now and then, go a step back or forth; tells whether it did."""
        if self.done and self.chance.random() < 0.3:
            self.undone.append(self.done.pop())
            self.document.revert(self.undone[-1])
        elif self.undone and self.chance.random() < 0.4:
            self.done.append(self.undone.pop())
            self.document.apply(self.done[-1])
        else:
            return False
        return True

    def edit(self) -> Edit | None:
        """Do an edit of which there is nothing to redo; None where the one that was drawn cannot be."""
        edit = random_edit(self.document, self.chance)
        if edit is not None:
            self.document.apply(edit)
            self.done.append(edit)
            self.undone.clear()
        return edit
