"""The figures of `efase bench iface` as Markdown, in the layout of the paper's tables I and II: a column an emotion."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

_ROWS = {"r": ("R", 3), "spread_estimated": ("ν", 3), "mse": ("MSE", 4)}
_HALVES = ("train", "test")
TOLD = "told the phones"


def as_table(answer: dict) -> str:
    """Write the object of `app.iface_bench`."""
    lines = [f"{answer['corpus']}{' (synthetic)' if answer['synthetic'] else ''}"]
    for split, measured in answer["splits"].items():
        lines += ["", f"{split}; {'; '.join(_amount(half, measured['speech_s'][half]) for half in _HALVES)}"]
        faces = measured["faces"]
        for scope in next(iter(faces.values()))["test"]:
            lines += ["", *_nearness(scope, faces, measured.get("told"), measured["speech_s"])]
        ceilings = {name: face["ceiling"] for name, face in {**faces, TOLD: measured.get("told", {})}.items()
                    if "ceiling" in face}  # fmt: skip
        if ceilings:
            lines += ["", *_ceiling(ceilings)]
        lines.append("")
        for name, face in faces.items():
            lines.append(f"{name}: trained and measured in {face['seconds_to_train_and_measure']:.0f} s{_lips(face)}")
    return "\n".join(lines)


def _amount(half: str, seconds: Mapping[str, float]) -> str:
    return f"{half} {', '.join(f'{emotion} {said_s:.0f} s' for emotion, said_s in seconds.items())}"


def _nearness(
    scope: str, faces: Mapping[str, dict], told: dict | None, speech_s: Mapping[str, Mapping[str, float]]
) -> list[str]:
    columns = [(half, emotion) for half in _HALVES for emotion in speech_s[half]]
    first = next(iter(faces.values()))
    rows = [("captured", "ν", *(f"{first[half][scope][emotion]['spread']:.3f}" for half, emotion in columns))]
    for name, face in (*faces.items(), *([] if told is None else [(TOLD, told)])):
        for key, (title, digits) in _ROWS.items():
            found = (face.get(half, {}).get(scope, {}).get(emotion) for half, emotion in columns)
            rows.append((name, title, *("–" if row is None else f"{row[key]:.{digits}f}" for row in found)))
    return _table((scope, "", *(f"{half}, {emotion}" for half, emotion in columns)), rows)


def _ceiling(ceilings: Mapping[str, dict]) -> list[str]:
    first = next(iter(ceilings.values()))
    emotions = list(next(iter(first.values())))
    rows = []
    for scope, by in first.items():
        rows.append((scope, "√R of two takes", *(f"{by[emotion]['ceiling']:.3f}" for emotion in emotions)))
        for name, scopes in ceilings.items():
            for key, title in (("r", "R"), ("share", "share")):
                found = (f"{scopes[scope][emotion][key]:.3f}" for emotion in emotions)
                rows.append((scope, f"{name}, {title}", *found))
    return _table(("ceiling", "", *emotions), rows)


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    rule = "|---|---|" + "---:|" * (len(head) - 2)
    return [f"| {' | '.join(head)} |", rule, *(f"| {' | '.join(row)} |" for row in rows)]


def _lips(face: dict) -> str:
    if "lips" not in face:
        return ""
    found = {"lip gap r": "lip_gap_r", "closures": "closure_rate", "lip error, mm": "lip_error_mm"}
    return "".join(
        f"; {title} {face['lips'][key]:.2f}" for title, key in found.items() if face["lips"][key] is not None
    )
