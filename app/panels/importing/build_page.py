"""Build: where to, how, and what was done."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtWidgets import (
    QComboBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPlainTextEdit,
    QPushButton,
    QSpinBox,
)

from app.authoring import Authoring
from app.export import check_outputs
from app.importing import write_takes
from app.panels.importing.draft import ImportDraft
from app.panels.importing.page import Page
from app.panels.importing.plain_table import PlainTable
from app.panels.pane import label
from app.pictures import DEFAULT_FACE
from app.settings import last_folder, remember_folder, window_settings
from app.texts import importing as texts
from app.theme import STEP
from core.errors import UserFacingError
from core.importing.plan import ImportPlan
from core.importing.report import ImportReport, SentenceReport
from core.importing.run import import_motion, run_import
from core.progress import Progress

_FOLDER = "database"
_SUFFIX = ".h5"
_DATABASES = (_SUFFIX, ".hdf5")
_WORDS_PX = 92


@dataclass(frozen=True)
class BuildRequest:
    """A plan and where its database goes."""

    plan: ImportPlan
    target: Path


@dataclass(frozen=True)
class _Built:
    """What came of it; nodes : of the database, None where none was asked for."""

    report: ImportReport
    nodes: int | None
    warnings: tuple[str, ...] = ()


class BuildPage(Page):
    """A form, then a report."""

    def __init__(self, draft: ImportDraft, authoring: Authoring) -> None:
        super().__init__(draft, texts.BUILD, texts.BUILD_HINT, texts.BUILD_EMPTY)
        self._authoring, self._settings = authoring, window_settings()
        self._built: tuple[ImportPlan, Path] | None = None
        form = QFormLayout()
        form.setHorizontalSpacing(2 * STEP)
        form.setVerticalSpacing(STEP)
        self.name, self.path = QLineEdit(), QLineEdit(toolTip=texts.TARGET_TIP)
        self.browse = QPushButton(texts.BROWSE)
        self.rate = QSpinBox(minimum=10, maximum=1000, suffix=" Hz")
        self.dims = QSpinBox(minimum=1, maximum=300, toolTip=texts.DIMS_TIP)
        self.hold_out = QComboBox(toolTip=texts.HOLD_OUT_TIP)
        for key, text in texts.HOLD_OUTS.items():
            self.hold_out.addItem(text, key)
        where, how = QHBoxLayout(), QHBoxLayout()
        where.addWidget(self.path, 1)
        where.addWidget(self.browse)
        for widget in (self.rate, label(texts.DIMS, "plain"), self.dims, label(texts.HOLD_OUT, "plain"), self.hold_out):
            how.addWidget(widget)
        for row in (where, how):
            row.setSpacing(STEP)
        how.addStretch(1)
        form.addRow(texts.NAME, self.name)
        form.addRow(texts.TARGET, where)
        form.addRow(texts.RATE_OF, how)
        self.body.addLayout(form)
        row = QHBoxLayout()
        row.setSpacing(STEP)
        self.build = QPushButton(texts.BUILD_NOW, toolTip=texts.BUILD_NOW_TIP)
        self.build.setProperty("role", "primary")
        self.cancel = QPushButton(texts.CANCEL_BUILD)
        self.open = QPushButton(texts.OPEN_BUILT, toolTip=texts.OPEN_BUILT_TIP)
        for widget in (self.build, self.cancel, self.open):
            row.addWidget(widget)
        row.addStretch(1)
        self.body.addLayout(row)
        self.words = QPlainTextEdit(readOnly=True)
        self.words.setFixedHeight(_WORDS_PX)
        self.table = PlainTable(texts.REPORT_COLUMNS, (), (120, 56, 56, 60, 60, 84, 76, 84, 92, 0))
        self.body.addWidget(self.words)
        self.body.addWidget(self.table, 1)
        self.body.addStretch(0)
        self._show_report(None)
        self.browse.clicked.connect(self.ask_path)
        self.build.clicked.connect(self.on_build)
        self.cancel.clicked.connect(lambda: draft.jobs.cancel("import"))
        self.open.clicked.connect(self.on_open)
        self.name.editingFinished.connect(self._keep)
        self.rate.editingFinished.connect(self._keep)
        self.dims.editingFinished.connect(self._keep)
        self.hold_out.activated.connect(lambda _: self._keep())
        draft.jobs.started.connect(lambda kind, _: kind == "import" and self._enable())
        draft.jobs.ended.connect(lambda kind: kind == "import" and self._enable())

    @property
    def state(self) -> str:
        """See `Page.state`."""
        if self.draft.jobs.is_running("import"):
            return texts.STATE_BUILDING
        return texts.STATE_BUILT if self._built is not None and self._built[0] == self.draft.plan else ""

    def refresh(self) -> None:
        """See `Page.refresh`."""
        plan = self.draft.plan
        self.name.setText(plan.name)
        for box, value in ((self.rate, round(plan.rate_hz)), (self.dims, plan.n_dims)):
            box.blockSignals(True)
            box.setValue(value)
            box.blockSignals(False)
        self.hold_out.setCurrentIndex(max(self.hold_out.findData(plan.hold_out), 0))
        if not self.path.text():
            self.path.setText(str(Path(last_folder(self._settings, _FOLDER)) / f"{plan.name}{_SUFFIX}"))
        self._enable()

    def _enable(self) -> None:
        building = self.draft.jobs.is_running("import")
        self.build.setEnabled(not building)
        self.cancel.setVisible(building)
        self.open.setVisible(self._built is not None and not building)
        self.draft.measured.emit()

    def _keep(self) -> None:
        if self.draft.plan is None:
            return
        fields = {"name": self.name.text().strip() or self.draft.plan.name, "rate_hz": float(self.rate.value()),
                  "n_dims": self.dims.value(), "hold_out": self.hold_out.currentData()}  # fmt: skip
        self.draft.change(texts.EDIT_BUILD, **fields)

    # Reactions

    def ask_path(self) -> None:
        """Choose where it goes."""
        name, _ = QFileDialog.getSaveFileName(self, texts.TARGET, self.path.text(), texts.FILTER_TARGET)
        if name:
            self.path.setText(name if Path(name).suffix else f"{name}{_SUFFIX}")

    def on_build(self) -> None:
        """Carry the plan out."""
        if self.draft.plan is None or self.draft.jobs.is_running("import"):
            return
        self._keep()
        path = Path(self.path.text().strip()).expanduser()
        request = BuildRequest(self.draft.plan, path if path.suffix else path.with_suffix(_SUFFIX))
        # work in the background would do the same sentences at the same time
        for kind in ("speech work", "listen", "mend"):
            self.draft.jobs.cancel(kind)
        title = texts.BUILDING.format(name=self.draft.plan.name)
        self._show_report(None)
        self.draft.jobs.start("import", title, request, _build, lambda built: self._on_built(request, built),
                              self._on_failed)  # fmt: skip

    def _on_built(self, request: BuildRequest, built: _Built) -> None:
        remember_folder(self._settings, _FOLDER, request.target)
        self._show_report(built.report)
        path, n = request.target, len(built.report.taken)
        if built.nodes is None:
            self._built = None
            self.draft.noted.emit(" ".join((texts.WRITTEN.format(path=path, takes=n), *built.warnings)))
        else:
            self._built = request.plan, path
            self.draft.noted.emit(texts.BUILT.format(path=path, nodes=built.nodes, sentences=n))
        self._enable()

    def _on_failed(self, error: UserFacingError) -> None:
        self.draft.failed.emit(error.message, error.remedy)

    def on_open(self) -> None:
        """Search the database that was built, in the main window."""
        if self._built is not None:
            self._authoring.open_database(self._built[1])

    def _show_report(self, report: ImportReport | None) -> None:
        for widget in (self.words, self.table):
            widget.setVisible(report is not None)
        if report is None:
            return
        self.words.setPlainText(report.in_words())
        rows = sorted(report.rows, key=lambda row: (not row.failure, -row.gaps_left, -row.gap_samples))
        self.table.show_rows([_row(row) for row in rows], [i for i, row in enumerate(rows) if row.failure])


def _row(row: SentenceReport) -> tuple[str, ...]:
    def count(n: int) -> str:
        return str(n) if n else "–"

    head = "" if row.rigid_residual_mm is None else texts.MM.format(mm=row.rigid_residual_mm)
    late = "" if row.offset_s is None else texts.MS.format(ms=1000 * row.offset_s)
    out = texts.MS.format(ms=1000 * row.offset_taken_out_s) if row.offset_taken_out_s else "–"
    return (row.sentence, count(row.gaps_filled), count(row.gaps_left), count(row.spikes_cut), count(row.swaps_undone),
            head, late, out, texts.ALIGNMENTS.get(row.alignment, ""), row.failure or " ".join(row.notes))  # fmt: skip


def _build(request: BuildRequest, progress: Progress) -> _Built:
    """Write the database, or film or markers of the takes as they are mended; a job."""
    if request.target.suffix.lower() in _DATABASES:
        result = run_import(request.plan, request.target, progress)
        return _Built(result.report, len(result.database.nodes))
    check_outputs([request.target])
    imported = import_motion(request.plan, progress.part(0.0, 0.5))
    takes = list(zip(imported.recordings, imported.motions))
    warnings = write_takes([request.target], takes, DEFAULT_FACE, progress.part(0.5, 1.0))
    return _Built(imported.report, None, tuple(warnings))
