"""What an engine says that is told the phones."""

from __future__ import annotations

from core.iface.comparison import by_emotion
from core.iface.heard_takes import recorded_takes
from core.iface.measures import largest_displacements
from core.iface.told import told_estimates

MOUTH = [4, 5]


def test_told_the_phones_the_mouth_is_met_frame_by_frame(loud_database):
    takes = recorded_takes(loud_database, loud_database.held_out_recordings("test"))
    spoken = told_estimates(loud_database, takes)
    assert [moved.shape for moved in spoken] == [take.displacements.shape for take in takes]
    largest = largest_displacements(takes[0].displacements)
    found = by_emotion(takes, spoken, largest, MOUTH)
    assert all(row.r > 0.8 for row in found.values())
    late = [moved[[0, 0, 0, 0, *range(len(moved) - 4)]] for moved in spoken]
    assert all(row.r < found[emotion].r for emotion, row in by_emotion(takes, late, largest, MOUTH).items())
