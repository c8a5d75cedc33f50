"""What was done to a database since it was built, kept in its report: so that a project can say what changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime

from core.motion.database import MotionDatabase

KEY = "growth"
ADDED, REMOVED, REFITTED, NODES_DROPPED = "added", "removed", "refitted", "nodes_dropped"
_MOST_STEPS = 10_000


def with_step(
    report: Mapping[str, object],
    content_before: str,
    content_after: str,
    done: Mapping[str, Sequence[str]],
    about: Mapping[str, object] | None = None,
) -> dict[str, object]:
    """Return the report with one more step.

    done : sentence names by `ADDED` and `REMOVED`, node names by `NODES_DROPPED`, and an empty list for `REFITTED`
    about : what was done to the added sentences before they came, as their corpus reports
    """
    step = {
        "at": datetime.now(UTC).isoformat(timespec="seconds"), "before": content_before, "after": content_after,
        **{what: list(names) for what, names in done.items()}, **({"about": dict(about)} if about else {}),
    }  # fmt: skip
    return {**report, KEY: [*_steps(report), step][-_MOST_STEPS:]}


@dataclass(frozen=True)
class ContentChange:
    """What happened to a database's content between two hashes; a sentence that came and went is in neither list.

    refitted : the frames of all sentences are given in other components than before
    nodes_dropped : motion nodes that were taken out for good, by public name
    """

    added: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    nodes_dropped: tuple[str, ...] = ()
    refitted: bool = False


def changes_since(database: MotionDatabase, content_hash: str) -> ContentChange | None:
    """Return what changed since the database's content had ``content_hash``; None when it never had, as far as known.

    A sentence that was removed and added again is in both lists: its motion nodes may be others now.
    """
    if content_hash == database.content_hash:
        return ContentChange()
    steps = _steps(database.report)
    at = next((i for i in reversed(range(len(steps))) if steps[i].get("before") == content_hash), None)
    if at is None:
        return None
    there, added, removed, dropped, refitted = set(), [], [], [], False
    for step in steps[at:]:
        for name in _names(step, REMOVED):
            if name in there:
                there.discard(name)
                added.remove(name)
            else:
                removed.append(name)
        for name in _names(step, ADDED):
            there.add(name)
            added.append(name)
        dropped += _names(step, NODES_DROPPED)
        refitted |= REFITTED in step
    return ContentChange(tuple(added), tuple(removed), tuple(dropped), refitted)


def _steps(report: Mapping[str, object]) -> list[dict]:
    """The steps as far as they are steps: a report comes from a file."""
    steps = report.get(KEY, [])
    return [step for step in steps if isinstance(step, dict)] if isinstance(steps, list) else []


def _names(step: Mapping[str, object], what: str) -> list[str]:
    names = step.get(what, [])
    return [name for name in names if isinstance(name, str)] if isinstance(names, list) else []
