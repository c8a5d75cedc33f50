"""The page of `efase evaluate`: figures and tables in the order in which a reader asks for them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from app.report import page as html
from app.report.charts import ACCENT, INK, PALE, Line, Spot, line_chart, spot_chart
from app.report.page import Figure, Row, number, share
from core.evaluation import measures
from core.evaluation.comparison import Comparison, Scores
from core.evaluation.emotion_check import Recognition
from core.evaluation.evaluate import Evaluation
from core.evaluation.phrase_times import PAPER_TIMES_S
from core.motion.database import MotionDatabase

ALIVE = (0.8, 1.25)  # variance ratios to aim for
_STANDARDS = ("static", "phone-means", "random")  # what engines are measured against
_NAMES = {
    "static": "static face", "phone-means": "phone means", "random": "random nodes",
    "search": "search", "search-paper": "search as printed", "search-single": "search, best path alone",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Measured:
    """All that a report says.

    times : engine to seconds by number of phonemes; recognised : engine, or ``capture``, to how often its emotion is
    """

    corpus: str
    split: str
    database: MotionDatabase
    found: Evaluation
    times: Mapping[str, Mapping[int, float]]
    recognised: Mapping[str, Recognition]

    @property
    def subject(self) -> str:
        """The engine that figures are drawn of: the search if it was measured, else the last that is no standard."""
        names = list(self.found.engines)
        return "search" if "search" in names else next((n for n in names[::-1] if n not in _STANDARDS), names[-1])


def engine_name(name: str) -> str:
    """What the page calls an engine."""
    return _NAMES.get(name, name)


def evaluation_page(measured: Measured) -> str:
    """Return the whole page as HTML."""
    figures = {figure.name: html.figure(figure) for figure in evaluation_figures(measured)}
    found, database = measured.found, measured.database
    made = "synthetic, made by a program" if database.synthetic else "captured"
    parts = [
        html.paragraph(
            f"Split “{measured.split}”: {len(found.sentences)} sentences that no engine has seen, beside a database of "
            f"{len(database.nodes):,} motion nodes in {len(database.sentences)} sentences ({made}; "
            f"content {database.content_hash[:12]}).",
            "lead",
        ),
        html.heading("Error and liveliness"),
        _scores_table(measured),
        html.paragraph(
            "A captured sample that has the right distribution differs from the truth by about √2 of what the mean of "
            "that distribution does, so error alone favours dull averages. Read both together: good motion lies left "
            "and in the band, a dull average lies left and below it, a jittery one above it."
        ),
        figures.get("error-and-liveliness", ""),
        html.heading("One lip marker over time (figures 15 and 16)"),
        figures["lip-trajectory"],
        figures["lip-velocity"],
        html.heading("Error per frame (figure 10)"),
        figures["error-per-frame"],
        *_emotions(measured),
        html.heading("Joins"),
        _joins_table(measured),
        html.paragraph(
            "What all markers do, on average, where one spoken phone meets the next, at the rate of the database. The "
            "capture at the same boundaries, seen through the database's principal components, is the standard; far "
            "below it is blur, far above it is a seam.", "note",
        ),
        html.heading("Phoneme by phoneme"),
        _phoneme_table(measured),
        html.heading("Time (table 5)"),
        _time_table(measured),
        html.paragraph(
            "Sentences of the split laid end to end and cut to the paper's lengths; medians of three, preparation not "
            "counted. The paper's machine had two cores, graphics hardware of 2006 and 5,556 motion nodes.", "note",
        ),
        html.heading("What the words mean"),
        _definitions(measured),
    ]  # fmt: skip
    return html.page(f"Evaluation on {measured.corpus}", parts)


def evaluation_figures(measured: Measured) -> list[Figure]:
    """Return the plots of the page."""
    figures = [_lip_figure(measured, 0), _lip_figure(measured, 1), _error_figure(measured)]
    spots = [
        Spot(engine_name(name), scores.lip_error_mm, scores.velocity_variance_ratio,
             ACCENT if name == measured.subject else INK, name in _STANDARDS)
        for name, scores in ((name, result.scores) for name, result in measured.found.engines.items())
        if scores.lip_error_mm is not None and scores.velocity_variance_ratio is not None
    ]  # fmt: skip
    floor = measured.found.floor
    if spots and floor.velocity_variance_ratio is not None:
        spots.append(Spot("the capture itself", floor.lip_error_mm, floor.velocity_variance_ratio, PALE, True))
        svg = spot_chart(
            "Lip error and liveliness of each engine", spots,
            ("lip error, mm", "variance of lip velocity, engine / capture"), (*ALIVE, "as alive as the capture"),
        )  # fmt: skip
        caption = (
            "Left is near, the band is as alive as the lightly smoothed capture. “The capture itself” is what its own "
            "noise makes of it. Hollow points are standards to measure against."
        )
        figures.insert(0, Figure("error-and-liveliness", svg, caption))
    return figures


def _scores_table(measured: Measured) -> str:
    header = ("", "error mm²", "lip error mm", "lip-gap r", "closure", "gap var.", "velocity var.", "accel. var.",
              "s / sentence")  # fmt: skip

    def cells(name: str, scores: Scores, seconds: float | None) -> tuple[str, ...]:
        ratios = (scores.gap_variance_ratio, scores.velocity_variance_ratio, scores.acceleration_variance_ratio)
        return (
            name, number(scores.error_mm2), number(scores.lip_error_mm), number(scores.lip_gap_r),
            share(scores.closure_rate), *(number(ratio) for ratio in ratios), number(seconds, 3),
        )  # fmt: skip

    rows = [
        Row(cells(engine_name(name), result.scores, result.seconds_per_sentence), _kind(name, measured))
        for name, result in measured.found.engines.items()
    ]
    rows.append(Row(cells("noise of the capture", measured.found.floor, None), "standard"))
    return html.table(header, rows)


def _emotions(measured: Measured) -> list[str]:
    subject = measured.found.engines[measured.subject]
    if len(subject.per_emotion) < 2:
        return []
    emotions = list(subject.per_emotion)
    rows = [
        Row(
            (engine_name(name), *(number(result.per_emotion[emotion].error_mm2) for emotion in emotions),
             *(number(result.per_emotion[emotion].lip_error_mm) for emotion in emotions)),
            _kind(name, measured),
        )
        for name, result in measured.found.engines.items()
    ]  # fmt: skip
    header = ("", *(f"{emotion}, {unit}" for unit in ("error mm²", "lip error mm") for emotion in emotions))
    parts = [html.heading("Emotion by emotion"), html.table(header, rows)]
    if measured.recognised:
        rows = [
            Row(
                ("the capture" if name == "capture" else engine_name(name), share(found.share),
                 f"{share(found.low)} to {share(found.high)}", str(found.windows)),
                "standard" if name == "capture" else _kind(name, measured),
            )
            for name, found in measured.recognised.items()
        ]  # fmt: skip
        parts += [
            html.table(("", "emotion recognised", "95 % interval", "windows of 1 s"), rows),
            html.paragraph(
                "Linear discriminants on mean and spread of the principal components over one second, trained on the "
                "captures of the database. Windows of one sentence are alike, so the true interval is wider.", "note",
            ),
        ]  # fmt: skip
    return parts


def _joins_table(measured: Measured) -> str:
    rows = []
    for name, result in measured.found.engines.items():
        if result.joins is not None:
            rows.append(Row((engine_name(name), *_roughness(result.joins)), _kind(name, measured)))
    captured = measured.found.captured_joins
    if captured is not None:
        rows.append(Row(("the capture", *_roughness(captured)), "standard"))
    return html.table(("", "velocity jump mm/s", "acceleration mm/s²"), rows)


def _roughness(found: measures.Roughness) -> tuple[str, str]:
    return number(found.velocity_jump_mm_s, 1), number(found.acceleration_mm_s2, 0)


def _phoneme_table(measured: Measured) -> str:
    engines = measured.found.engines
    per_phoneme = engines[measured.subject].per_phoneme
    unit = "lip_error_mm" if all("lip_error_mm" in row for row in per_phoneme.values()) else "error_mm2"
    order = sorted(per_phoneme, key=lambda phone: -per_phoneme[phone][unit])
    rows = [
        Row((phone, str(int(per_phoneme[phone]["said"])),
             *(number(result.per_phoneme[phone][unit]) for result in engines.values())))
        for phone in order
    ]  # fmt: skip
    words = "lip error, mm" if unit == "lip_error_mm" else "error, mm²"
    return html.table(("phone", "said", *(f"{engine_name(name)}: {words}" for name in engines)), rows)


def _time_table(measured: Measured) -> str:
    rows = [
        Row((str(n), *(number(seconds, 1) for seconds in paper), *(number(t[n], 3) for t in measured.times.values())))
        for n, paper in PAPER_TIMES_S.items()
    ]
    header = ("phonemes", "paper, s", "paper with GPU, s", *(f"{engine_name(name)}, s" for name in measured.times))
    return html.table(header, rows)


def _kind(name: str, measured: Measured) -> str:
    return "subject" if name == measured.subject else "result"


def _median(comparisons: Sequence[Comparison], place: float = 0.5) -> Comparison:
    """Return the sentence in the middle by its error (or at another place in that order), so that none is chosen."""
    error = [measures.error_mm2(c.synthesised, c.truth.positions) for c in comparisons]
    return comparisons[np.argsort(error, kind="stable")[round(place * (len(error) - 1))]]


def _lip_figure(measured: Measured, order: int) -> Figure:
    """Height of the lower-lip marker over one sentence, or its velocity, engine and capture."""
    chosen = _median(measured.found.engines[measured.subject].comparisons)
    truth, rate_hz = chosen.truth, chosen.truth.rate_hz
    row = truth.markers.landmark("lower_lip")
    row = 0 if row is None else row
    rest = truth.markers.rest[row, 1]
    lines = []
    for name, positions, colour, style in (
        ("captured", truth.positions, PALE, "dashed"),
        (f"synthesised, {engine_name(measured.subject)}", chosen.synthesised, ACCENT, "solid"),
    ):
        track = measures.derivative(positions[:, row, 1] - rest, rate_hz, order)
        lines.append(Line(name, (np.arange(len(track)) + order / 2) / rate_hz, track, colour, style))
    phones = [(u.start_s, u.end_s, u.phone) for u in truth.recording.transcript.phonemes]
    what = "velocity, mm/s" if order else "height above rest, mm"
    svg = line_chart(f"Lower lip, {what}", lines, ("time, s", what), phones)
    said = f" (“{truth.recording.text}”)" if truth.recording.text else ""
    caption = (
        f"Vertical {'velocity' if order else 'position'} of the marker {truth.markers.names[row]}, which plays the "
        f"part of the paper's #79, in sentence {truth.recording.sentence}{said}, {truth.recording.emotion}: the one "
        "whose error is the median. No pins."
    )
    return Figure("lip-velocity" if order else "lip-trajectory", svg, caption)


def _error_figure(measured: Measured) -> Figure:
    comparisons = measured.found.engines[measured.subject].comparisons
    spoken = {c.truth.recording.emotion for c in comparisons}
    styles = ((ACCENT, "solid"), (INK, "dashed"), (PALE, "dotted"))
    wanted = [e for e in ("neutral", "anger", "sadness") if e in spoken]
    if len(wanted) > 1:
        chosen = [(e, _median([c for c in comparisons if c.truth.recording.emotion == e])) for e in wanted]
        how = "for each emotion the sentence whose error is the median"
    else:
        places = (("least", 0.0), ("median", 0.5), ("greatest", 1.0))
        chosen = [(f"{name} error", _median(comparisons, place)) for name, place in places]
        how = "the sentences with the least, the median and the greatest error"
    lines = []
    for (name, c), (colour, style) in zip(chosen, styles):
        errors = measures.errors_per_frame_mm2(c.synthesised, c.truth.positions)
        times_s = np.arange(len(errors)) / c.truth.rate_hz
        lines.append(Line(f"{c.truth.recording.sentence}, {name}", times_s, errors, colour, style))
    svg = line_chart("Error per frame", lines, ("time, s", "error, mm²"))
    caption = (
        "Squared distance, mean over markers (equation 12 before its mean over frames), "
        f"{engine_name(measured.subject)}: {how}."
    )
    return Figure("error-per-frame", svg, caption)


def _definitions(measured: Measured) -> str:
    rate_hz = measured.found.engines[measured.subject].comparisons[0].truth.rate_hz
    slower = rate_hz > 1.01 * measures.LIVELINESS_HZ
    rate = f"both brought from {rate_hz:g} to {measures.LIVELINESS_HZ:g} Hz" if slower else f"at {rate_hz:g} Hz"
    scaled = " and size" if measured.database.with_scale else ""
    return html.definitions(
        [
            ("error", "Squared distance of synthesised and captured markers, mean over frames and markers of a "
                      "sentence, then over sentences (equations 12 and 13, divided by the number of sentences)."),
            ("capture", f"The raw track at the corpus rate ({rate_hz:g} Hz), head motion{scaled} taken out as in the "
                        "database; short gaps filled, long ones left out."),
            ("lip error", "Mean distance over the markers of the lips, per frame."),
            ("lip gap", "Vertical distance of the midpoints of the inner lips; r is its correlation with the raw "
                        "capture, mean over sentences."),
            ("closure", "Of the p, b and m in which the capture's gap comes within 2 mm of the sentence's least "
                        "captured gap, the share in which the engine's gap does."),
            ("var.", "Variance of the lip gap, of its velocity and of its acceleration, over that of the capture "
                     f"smoothed by Savitzky and Golay's filter (5 frames, order 2), {rate}. Aim for 0.8 to 1.25."),
            ("noise of the capture", "Errors and r of the lightly smoothed capture beside the raw one, and variance "
                                     "ratios of the raw one: nothing can be expected to come nearer, and an engine "
                                     "that copies captures copies their noise."),
            ("phone means", "Mean frames at phone middles, linearly joined, emotion by emotion: near, and dull."),
            ("random nodes", "Captured nodes of the right phone and emotion, otherwise drawn by lot."),
            ("search as printed", "Deng and Neumann's cost terms alone, one path, silence interpolated. The best path "
                                  "alone and the blend of near-optimal paths (search) use what goes beyond the paper."),
        ]
    )  # fmt: skip
