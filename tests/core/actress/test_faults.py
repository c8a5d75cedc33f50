import numpy as np
import pytest

from core.actress.corpus import actress_marker_set, database_sentences, planted_faults, record, transcript_of
from core.actress.faults import DRIFT_MM, FAULTY_SHARE, KINDS, SPIKE_MM, PlantedFault, contaminate
from core.speech.phoneme import PAU

NAMES = tuple("abcdef")
RATE_HZ = 100.0
STILL = np.zeros((40, 6, 3)) + np.arange(6)[:, None] * 10.0
MOVING = STILL + np.arange(40)[:, None, None] * 0.5


def _fault(kind, *markers):
    return PlantedFault("s:3", kind, markers, 0.1, 0.3)


def _changed(before, after):
    """Frames and markers that differ."""
    different = (before != after).any(axis=2)
    return np.flatnonzero(different.any(axis=1)), np.flatnonzero(different.any(axis=0))


@pytest.mark.parametrize("kind", KINDS)
def test_a_fault_stays_within_its_node_and_its_markers(kind):
    markers = ("b", "c") if kind == "swap" else ("b",)
    frames, rows = _changed(MOVING, contaminate(MOVING, NAMES, RATE_HZ, [_fault(kind, *markers)]))
    assert len(frames) >= 1 and frames.min() >= 10 and frames.max() < 30
    assert rows.tolist() == [NAMES.index(name) for name in markers]


def test_a_swap_exchanges_two_markers():
    spoilt = contaminate(MOVING, NAMES, RATE_HZ, [_fault("swap", "b", "e")])
    assert np.array_equal(spoilt[10:30, 1], MOVING[10:30, 4])
    assert np.array_equal(spoilt[10:30, 4], MOVING[10:30, 1])


def test_a_frozen_marker_stands_still():
    spoilt = contaminate(MOVING, NAMES, RATE_HZ, [_fault("freeze", "b", "e")])
    assert np.array_equal(spoilt[10:30, [1, 4]], np.repeat(MOVING[10:11, [1, 4]], 20, axis=0))


def test_a_drift_grows_and_a_spike_is_short():
    drift = np.linalg.norm((contaminate(STILL, NAMES, RATE_HZ, [_fault("drift", "b")]) - STILL)[10:30, 1], axis=1)
    assert drift[0] == 0 and np.all(np.diff(drift) > 0) and DRIFT_MM[0] <= drift[-1] <= DRIFT_MM[1]
    spike = np.linalg.norm((contaminate(STILL, NAMES, RATE_HZ, [_fault("spike", "b")]) - STILL)[10:30, 1], axis=1)
    assert 1 <= (spike > 0).sum() <= 3 and SPIKE_MM[0] <= spike.max() <= SPIKE_MM[1]


def test_two_percent_of_the_nodes_are_contaminated_in_all_ways():
    nodes = {}
    for spoken in database_sentences():
        phonemes = [u for u in transcript_of(spoken).phonemes if u.phone != PAU]
        nodes |= {f"{spoken.sentence}:{order}": u for order, u in enumerate(phonemes)}
    faults = planted_faults()
    assert len(faults) == len({fault.node for fault in faults}) == round(FAULTY_SHARE * len(nodes))
    for kind in KINDS:
        assert sum(fault.kind == kind for fault in faults) >= len(faults) // len(KINDS)
    for fault in faults:
        assert (fault.start_s, fault.end_s) == (nodes[fault.node].start_s, nodes[fault.node].end_s)
        assert fault.node.startswith(fault.sentence + ":")


def test_faulty_markers_are_kept_ones_that_nothing_else_stands_on():
    markers = actress_marker_set()
    solid = {*markers.groups["rigid"], *markers.groups["origin"]}
    for fault in planted_faults():
        assert set(fault.markers) <= set(markers.names) - solid
        assert len(set(fault.markers)) == len(fault.markers)


def test_recordings_hold_the_faults_and_nothing_that_tells_of_them(monkeypatch):
    fault = next(fault for fault in planted_faults() if fault.kind == "spike")
    (spoken,) = (s for s in database_sentences() if s.sentence == fault.sentence)
    faulty = record(spoken)
    monkeypatch.setattr("core.actress.corpus.planted_faults", tuple)
    clean = record(spoken)
    frames, _ = _changed(np.nan_to_num(clean.positions), np.nan_to_num(faulty.positions))
    start, stop = round(fault.start_s * 120), round(fault.end_s * 120)
    assert np.any((frames >= start) & (frames < stop))
    assert vars(faulty).keys() == vars(clean).keys()
