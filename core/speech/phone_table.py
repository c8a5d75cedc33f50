"""A phone set of one's own: which of our phones each of its names stands for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.speech.phone_names import RESOURCES, phones_named
from core.speech.text_file import read_text
from core.speech.timed_label import TimedLabel

# name in a file -> our phones, one after the other in its time
PhoneTable = Mapping[str, tuple[str, ...]]
BUNDLED = {"pinyin": RESOURCES / "pinyin.tsv"}


def read_phone_table(name: str | Path) -> tuple[PhoneTable, tuple[str, ...]]:
    """Read lines ``name phone [phone ...]``; ``#`` begins a comment line, and capitals matter only where two differ.

    name : a file, or one of `BUNDLED`. Phones may be ours, ARPAbet or IPA; what IPA writes and we lack becomes the
        nearest, and the second answer says so, once a phone
    Raises `UserFacingError` naming the line that has no phones, or one that means nothing.
    """
    path = BUNDLED.get(str(name).lower(), Path(name))
    table: dict[str, tuple[str, ...]] = {}
    told: dict[str, str] = {}
    for number, line in enumerate(read_text(path, "phone table").split("\n"), start=1):
        columns = line.split("#")[0].split()
        if not columns:
            continue
        place = f"'{path}', line {number}"
        if len(columns) == 1:
            raise UserFacingError(f"{place}: '{columns[0][:20]}' has no phones.", "Write: name phone phone …")
        phones, warnings = phones_named(columns[1:], [place] * (len(columns) - 1))
        told |= {warning.partition("the phone ")[2]: warning for warning in warnings}
        if columns[0] in table:
            raise UserFacingError(f"{place}: '{columns[0][:20]}' comes twice.")
        table[columns[0]] = tuple(phones)
    if not table:
        raise UserFacingError(f"The phone table '{path}' holds no phone.")
    return table, tuple(told.values())


def by_table(labels: Sequence[TimedLabel], table: PhoneTable) -> list[TimedLabel]:
    """Return labels in which every name that the table has is parted into its phones, evenly over its time.

    Digits at the end (the tones of pinyin) are left out where the name with them is not in the table; a name that is
    two of the table's, the first as long as can be (``zhong`` is ``zh`` and ``ong``), is both. Names that the table
    lacks stay as they are.
    """
    found: list[TimedLabel] = []
    for label in labels:
        phones = _phones(label.name.strip(), table)
        if not phones:
            found.append(label)
            continue
        bounds_s = np.linspace(label.start_s, label.end_s, len(phones) + 1).tolist()
        found += [TimedLabel(p, a, b, label.place) for p, a, b in zip(phones, bounds_s, bounds_s[1:])]
    return found


def _phones(name: str, table: PhoneTable) -> tuple[str, ...]:
    toneless = name.rstrip("0123456789")
    spellings = dict.fromkeys((name, name.lower(), toneless, toneless.lower()))
    for spelling in spellings:
        if spelling in table:
            return table[spelling]
    for spelling in spellings:
        for cut in range(len(spelling) - 1, 0, -1):
            if spelling[:cut] in table and spelling[cut:] in table:
                return table[spelling[:cut]] + table[spelling[cut:]]
    return ()
