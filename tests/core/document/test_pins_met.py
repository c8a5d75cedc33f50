"""A pin means one capture: another one under the same name is told, the same one under another basis is not."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from core.document.content import ProjectContent
from core.document.document import Document
from core.document.edits import PinMotionNode, SetSpeech
from core.document.pins_met import NodeContent, what_pins_met
from core.motion.node import NodeTableBuilder
from core.speech.phoneme import PHONEME_INDEX
from tests.core.document.random_edits import made_speech

N_MARKERS = 12


def database(seed=0, n_sentences=3):
    """Make the parts of a database that a pin looks at; coefficients are displacements under a random rotation."""
    rng = np.random.default_rng(1)
    builder, phones = NodeTableBuilder(), [PHONEME_INDEX[p] for p in ("m", "aa", "iy")]
    frames = np.cumsum(rng.normal(0, 1.0, (3 * 10 * n_sentences, 3 * N_MARKERS)), axis=0)
    for i in range(n_sentences):
        builder.add_sentence(f"s{i}", 0, phones, np.array([0, 10, 20]), np.array([10, 20, 30]), np.zeros(30), 30 * i)
    basis = np.linalg.qr(np.random.default_rng(seed).normal(size=(3 * N_MARKERS, 3 * N_MARKERS)))[0]
    rest = rng.normal(0, 50, (N_MARKERS, 3))
    pca = SimpleNamespace(positions=lambda c: (c @ basis).reshape(-1, N_MARKERS, 3) + rest)
    return SimpleNamespace(
        nodes=builder.table(), frames=frames @ basis.T, pca=pca, markers=SimpleNamespace(rest=rest), name="made",
        content_hash=str(seed), path=None,
    )  # fmt: skip


def pinned(to, *names):
    document = Document()
    document.apply(SetSpeech.on(document, made_speech(0)))
    document.database = to
    for slot, name in enumerate(names):
        document.apply(PinMotionNode.on(document, slot, name))
    return document


def test_the_same_capture_is_the_same_under_another_basis():
    content = ProjectContent.of(pinned(database(0), "s0:1", "s2:2"))
    assert set(content.tied) == {"s0:1", "s2:2"}
    assert what_pins_met(content, database(5)) == []


def test_a_node_that_is_not_there_and_one_that_is_another_are_told():
    content = ProjectContent.of(pinned(database(), "s0:1", "s1:0", "s2:2"))
    smaller = database(n_sentences=2)
    smaller.frames[10:20] = smaller.frames[10:20][::-1]
    lost, other = what_pins_met(content, smaller)
    assert "s2:2" in lost and "lacks" in lost
    assert "s0:1" in other and "s1:0" not in other


@pytest.mark.parametrize("moved_mm, is_like", [(0.05, True), (3.0, False)])
def test_a_small_rounding_is_no_other_capture(moved_mm, is_like):
    before, after = database(), database()
    after.frames = after.frames + np.random.default_rng(3).normal(0, moved_mm, after.frames.shape)
    assert NodeContent.of(before, "s1:1").is_like(NodeContent.of(after, "s1:1")) is is_like


def test_another_phone_or_length_is_another_node():
    node = NodeContent.of(database(), "s1:1")
    assert not node.is_like(replace(node, phone="m"))
    assert not node.is_like(replace(node, n_frames=9))


def test_it_is_kept_in_the_project_and_while_the_database_is_missing():
    document = pinned(database(), "s0:1", "s1:0")
    content = ProjectContent.of(document)
    assert ProjectContent.from_json(content.to_json()) == content
    document.database = None
    document.apply(PinMotionNode.on(document, 1, None))
    later = ProjectContent.of(document, tied=content.tied)
    assert dict(later.tied) == {"s0:1": content.tied["s0:1"]}
