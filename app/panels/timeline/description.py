"""What there is to know of an utterance, in words."""

from __future__ import annotations

from app import texts
from core.document.document import Document
from core.speech.phoneme import PAU


def description(document: Document, slot: int, lane: str) -> str:
    """Return the tooltip of a slot in a lane: what is said for how long, what ties it, what it costs there."""
    utterance = document.speech.transcript.phonemes[slot]
    phone = texts.SILENCE if utterance.phone == PAU else f"/{utterance.phone}/"
    lines = [texts.UTTERANCE.format(phone=phone, milliseconds=1000 * (utterance.end_s - utterance.start_s))]
    if slot in document.pins:
        lines.append(texts.PINNED.format(node=document.pins[slot]))
    if slot in document.locks:
        lines.append(texts.LOCKED)
    unit = document.cost_unit
    if lane == "cost" and document.breakdown is not None:
        terms = document.breakdown[slot].items()
        lines += [texts.COST_TERM.format(term=texts.TERMS[name], cost=v / unit) for name, v in terms if v > 0]
        lines.append(texts.COST_OF_SLOT.format(cost=sum(document.breakdown[slot].values()) / unit))
    if lane == "price" and document.next_best_prices is not None:
        lines.append(texts.NEXT_BEST.format(price=document.next_best_prices[slot] / unit))
    if lane in ("cost", "price") and document.has_no_path:
        lines.append(texts.NO_PATH_TIP)
    return "\n".join(lines)
