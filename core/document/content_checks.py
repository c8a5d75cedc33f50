"""What must hold in a project before anything is made of it: a file may come from anywhere."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from core.document.parts import DEFAULT_OUTPUT, OutputSettings, View
from core.document.pins_met import N_LOOKS, NodeContent
from core.media.audio import LONGEST_S
from core.media.video import FRAME_RATES
from core.motion.curation import Removal
from core.speech.emotion import EMOTION_INDEX, EmotionModifier
from core.speech.phoneme import PHONEME_INDEX
from core.speech.transcript import PhonemeUtterance, Transcript, WordUtterance
from core.synthesis.control_edits import (
    FARTHEST,
    LONGEST_REACH_S,
    SHORTEST_REACH_S,
    ControlEdits,
    ControlKey,
    CurveEdits,
)
from core.synthesis.polish import REGIONS, STRONGEST, Polish

_LONGEST_NAME, _LONGEST_TEXT = 1 << 15, 1 << 22
_MOST_UTTERANCES, MOST_SPANS, MOST_NODES = 100_000, 100_000, 1_000_000
_MOST_CONTROLS = 10_000
_HIGHEST_FRAME = 10**9
_FARTHEST_MM = 1e9
FARTHEST_S = 1e9
_ROUNDING_S = 1e-6


class Unbelievable(ValueError):
    """What cannot be in a project, as a clause."""


def require(holds: bool, otherwise: str) -> None:
    """Raise `Unbelievable` unless it holds."""
    if not holds:
        raise Unbelievable(otherwise)


def no_constant(name: str) -> None:
    """Refuse the NaN and infinity that JSON does not have."""
    raise Unbelievable(f"it holds {name}")


def of_type(value: Any, kind: type) -> Any:
    """Return a value of just this type."""
    require(type(value) is kind, "an entry is of another kind")
    return value


def optional(value: Any, read: Callable[[Any], Any]) -> Any:
    """Read a value that may be None."""
    return None if value is None else read(value)


def listed(value: Any, most: int) -> list:
    """Return a list that is not absurdly long."""
    require(len(of_type(value, list)) <= most, f"a list is longer than {most}")
    return value


def text(value: Any, longest: int = _LONGEST_TEXT) -> str:
    """Return a text that is not absurdly long."""
    require(len(of_type(value, str)) <= longest, "a text is too long")
    return value


def name_text(value: Any) -> str:
    """Return a name or path."""
    return text(value, _LONGEST_NAME)


def digest(value: Any) -> str:
    """Return the hexadecimal SHA-256 of something."""
    require(len(of_type(value, str)) == 64 and not set(value) - set("0123456789abcdef"), "a digest is none")
    return value


def number(value: Any, low: float, high: float) -> float:
    """Return a finite number within bounds."""
    require(type(value) in (int, float) and low <= value <= high, "a number is out of range")
    return float(value)


def whole(value: Any, low: int, high: int) -> int:
    """Return a whole number within bounds."""
    require(type(value) is int and low <= value <= high, "a number is out of range")
    return value


def transcript(entry: dict) -> Transcript:
    """Return phonemes that cover the speech, and words within it."""
    duration_s = number(entry["duration_s"], 0.0, 2 * LONGEST_S)
    phonemes, now_s = [], 0.0
    for phone, start_s, end_s in listed(entry["phonemes"], _MOST_UTTERANCES):
        start_s, end_s = number(start_s, 0.0, duration_s), number(end_s, 0.0, duration_s + _ROUNDING_S)
        require(phone in PHONEME_INDEX, "a phone is not of our set")
        require(abs(start_s - now_s) <= _ROUNDING_S and end_s > start_s, "phonemes do not follow each other")
        phonemes.append(PhonemeUtterance(phone, start_s, end_s))
        now_s = end_s
    require(bool(phonemes) and abs(now_s - duration_s) <= _ROUNDING_S, "phonemes do not cover the speech")
    words = [
        WordUtterance(name_text(word), number(start_s, 0.0, duration_s), number(end_s, 0.0, duration_s + _ROUNDING_S))
        for word, start_s, end_s in listed(entry["words"], _MOST_UTTERANCES)
    ]
    require(all(w.start_s <= w.end_s for w in words), "a word ends before it starts")
    warnings = [text(w) for w in listed(entry.get("warnings", []), _MOST_UTTERANCES)]
    return Transcript(tuple(phonemes), tuple(words), duration_s, tuple(warnings))


def modifier(entry: list) -> EmotionModifier:
    """Return an emotion span."""
    start_s, end_s, emotion, intensity = entry
    start_s = number(start_s, -FARTHEST_S, FARTHEST_S)
    end_s = math.inf if end_s is None else number(end_s, start_s, FARTHEST_S)
    require(emotion in EMOTION_INDEX, "an emotion is not of our set")
    return EmotionModifier(start_s, end_s, emotion, number(intensity, 0.0, 1.0))


def ties(entries: Any, n_slots: int) -> Mapping[int, str]:
    """Return pins or locks of slots that there are."""
    ties = {whole(slot, 0, n_slots - 1): name_text(node) for slot, node in listed(entries, _MOST_UTTERANCES)}
    return MappingProxyType(ties)


def tied(entries: Any) -> Mapping[str, NodeContent]:
    """Return what tied nodes held."""
    require(len(of_type(entries, dict)) <= 2 * _MOST_UTTERANCES, "too many nodes are tied")
    return MappingProxyType({
        name_text(name): NodeContent(
            name_text(e["phone"]), whole(e["n_frames"], 0, _HIGHEST_FRAME),
            tuple(number(look, -_FARTHEST_MM, _FARTHEST_MM) for look in listed(e["looks_mm"], 2 * N_LOOKS)))
        for name, e in entries.items()
    })  # fmt: skip


def removals(entries: Any) -> Mapping[str, Removal]:
    """Return removed nodes by name."""
    require(len(of_type(entries, dict)) <= MOST_NODES, "too many nodes are removed")
    return MappingProxyType({
        name_text(node): Removal(name_text(e["who"]), name_text(e["at"]), text(e["why"])) for node, e in entries.items()
    })  # fmt: skip


def output_settings(entry: dict) -> OutputSettings:
    """Return rate and first frame of films."""
    rate = entry.get("frame_rate", DEFAULT_OUTPUT.frame_rate)
    require(rate in FRAME_RATES, "its frame rate is not on offer")
    start_frame = whole(entry.get("start_frame", 0), 0, _HIGHEST_FRAME)
    return OutputSettings(rate, start_frame, of_type(entry.get("head_moves", True), bool))


def polish(entry: dict) -> Polish:
    """Return the layer over the motion."""
    curves = {}
    for region, keys in of_type(entry.get("curves", {}), dict).items():
        require(region in REGIONS, "a region of the face is not known")
        read = [
            (number(at_s, 0.0, FARTHEST_S), number(gain, 0.0, STRONGEST)) for at_s, gain in listed(keys, MOST_SPANS)
        ]
        curves[region] = tuple(sorted(read))
    gains = (number(entry.get(name, 1.0), 0.0, STRONGEST) for name in ("articulation", "expression"))
    return Polish(*gains, MappingProxyType(curves))


def control_edits(entries: dict) -> ControlEdits:
    """Return the layer over the control curves."""
    require(len(of_type(entries, dict)) <= _MOST_CONTROLS, "too many controls are edited")
    by_control = {}
    for name, entry in entries.items():
        keys = (
            ControlKey(number(at_s, 0.0, FARTHEST_S), number(amount, -FARTHEST, FARTHEST),
                       number(reach_s, SHORTEST_REACH_S, LONGEST_REACH_S))
            for at_s, amount, reach_s in listed(entry["keys"], MOST_SPANS)
        )  # fmt: skip
        stretches = tuple(
            (number(start_s, 0.0, FARTHEST_S), number(end_s, 0.0, FARTHEST_S))
            for start_s, end_s in listed(entry["smoothed"], MOST_SPANS)
        )
        by_control[name_text(name)] = CurveEdits(tuple(sorted(keys)), stretches, of_type(entry["is_muted"], bool))
    return ControlEdits(MappingProxyType(by_control))


def view_entry(entry: dict, n_slots: int) -> View:
    """Return what was looked at."""
    phone = entry.get("map_phone")
    require(phone is None or phone in PHONEME_INDEX, "a phone is not of our set")
    slot = optional(entry.get("slot"), lambda value: whole(value, 0, max(n_slots - 1, 0)))
    return View(slot, number(entry.get("playhead_s", 0.0), 0.0, 2 * LONGEST_S), phone)
