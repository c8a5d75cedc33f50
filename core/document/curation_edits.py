"""Edits of what the search may use: motion nodes are removed and restored."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Self

from core.document.change import NOTHING, Change
from core.document.document import Document
from core.motion.curation import Removal


@dataclass(frozen=True, eq=False)
class _CurationEdit:
    """Removes or restores motion nodes, each by itself: the curation list is shared, others may change it meanwhile.

    shared, here : node to its removal before and after, None for a node that was or is not removed
    kept : node to whether the project used it all the same, before and after
    """

    label: str
    shared: Mapping[str, tuple[Removal | None, Removal | None]]
    here: Mapping[str, tuple[Removal | None, Removal | None]]
    kept: Mapping[str, tuple[bool, bool]]

    @classmethod
    def setting(cls, document: Document, label: str, nodes: Iterable[str], **after: Removal | bool | None) -> Self:
        """Return the edit that gives ``nodes`` what ``after`` says of shared, here and kept."""
        nodes = tuple(dict.fromkeys(nodes))
        now = {"shared": document.shared_removals.get, "here": document.removed_here.get,
               "kept": document.kept.__contains__}  # fmt: skip
        changes = {
            part: {node: (get(node), after[part]) for node in nodes} if part in after else {}
            for part, get in now.items()
        }
        what = f"node {nodes[0]}" if len(nodes) == 1 else f"{len(nodes)} nodes"
        return cls(f"{label} {what}", **changes)

    def do(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, 1)

    def undo(self, document: Document) -> Change:
        """See `core.document.document.Edit`."""
        return self._set(document, 0)

    def followed_by(self, later: object) -> None:
        """See `core.document.document.Edit`."""

    def _set(self, document: Document, which: int) -> Change:
        before = document.shared_removals, document.removed_here, document.kept
        document.shared_removals = _with(document.shared_removals, {n: v[which] for n, v in self.shared.items()})
        document.removed_here = _with(document.removed_here, {n: v[which] for n, v in self.here.items()})
        used = {node for node, values in self.kept.items() if values[which]}
        document.kept = frozenset(document.kept - self.kept.keys() | used)
        after = document.shared_removals, document.removed_here, document.kept
        return NOTHING if before == after else Change.CURATION


def _with(removals: Mapping[str, Removal], changes: Mapping[str, Removal | None]) -> Mapping[str, Removal]:
    changed = {**removals, **changes}
    return MappingProxyType({node: removal for node, removal in changed.items() if removal is not None})


class RemoveMotionNodes(_CurationEdit):
    """Let no search use these motion nodes any more: in any project, or in this one only."""

    @classmethod
    def on(cls, document: Document, nodes: Iterable[str], removal: Removal, only_here: bool = False) -> Self:
        """Return the edit for ``document`` as it is now; ``removal`` says who does it and why."""
        where = "here" if only_here else "shared"
        return cls.setting(document, "Remove", nodes, kept=False, **{where: removal})


class RestoreMotionNodes(_CurationEdit):
    """Let the search use removed motion nodes again: in any project, or in this one only."""

    @classmethod
    def on(cls, document: Document, nodes: Iterable[str], only_here: bool = False) -> Self:
        """Return the edit for ``document`` as it is now."""
        if only_here:
            edit = cls.setting(document, "Restore", nodes, here=None, kept=True)
            return replace(edit, kept={n: v for n, v in edit.kept.items() if n in document.shared_removals})
        return cls.setting(document, "Restore", nodes, here=None, kept=False, shared=None)
