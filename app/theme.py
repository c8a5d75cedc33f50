"""How the workstation looks: one ground, one accent, two sizes of one typeface, a rhythm of eight pixels."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtGui import QColor, QFont, QPalette
from PySide6.QtWidgets import QApplication

_CHEVRON = (Path(__file__).resolve().parents[1] / "resources" / "icons" / "chevron.svg").as_posix()

STEP = 8
TEXT_PX = 13
SMALL_PX = 11


@dataclass(frozen=True)
class Theme:
    """Colours by what they are for; each is a CSS colour.

    other : the second of two that are compared, beside the accent
    emotion : colour of each emotion, the same everywhere (the paper's, with a light neutral on dark)
    """

    ground: str
    raised: str
    canvas: str
    line: str
    text: str
    dim: str
    faint: str
    accent: str
    on_accent: str
    warning: str
    other: str
    emotion: dict[str, str]


DARK = Theme(
    ground="#1a1c1f", raised="#24272b", canvas="#131417", line="#2e3136", text="#d9dbdf", dim="#8d929b",
    faint="#5d626b",
    accent="#e3ad55", on_accent="#1a1408", warning="#3a2f1d", other="#4cc2b4",
    emotion={"neutral": "#c8cbd0", "happiness": "#5b9df5", "anger": "#e8574f", "sadness": "#5cb463"},
)  # fmt: skip
LIGHT = Theme(
    ground="#f3f3f1", raised="#ffffff", canvas="#e9e9e6", line="#d2d2cd", text="#26282b", dim="#6d717a",
    faint="#a3a6ac",
    accent="#a8690a", on_accent="#ffffff", warning="#f6e7c8", other="#0b7a70",
    emotion={"neutral": "#4a4d52", "happiness": "#2566c4", "anger": "#c4302a", "sadness": "#2c8236"},
)  # fmt: skip
THEMES = {"dark": DARK, "light": LIGHT}

_chosen = DARK

# pyqtgraph's symbols, so that colour is never the only sign
EMOTION_SYMBOLS = {"neutral": "o", "happiness": "t1", "anger": "s", "sadness": "t"}


def set_emotion_colours(colours: dict[str, str]) -> None:
    """Paint the emotions otherwise from now on; see `app.emotion_colours`, which tells the panels."""
    global _chosen
    _chosen = replace(_chosen, emotion=colours)


def theme() -> Theme:
    """Return the theme in use."""
    return _chosen


def colour(css: str, alpha: float = 1.0) -> QColor:
    """Return a colour of the theme, more or less see-through."""
    made = QColor(css)
    made.setAlphaF(alpha)
    return made


def small_font() -> QFont:
    """Return the smaller of the two sizes."""
    font = QFont(QApplication.font())
    font.setPixelSize(SMALL_PX)
    return font


def apply_theme(app: QApplication, name: str = "dark") -> None:
    """Dress ``app``; widgets that paint themselves ask `theme` when they next paint."""
    global _chosen
    _chosen = THEMES[name]
    app.setStyle("Fusion")
    font = QFont(app.font())
    font.setPixelSize(TEXT_PX)
    app.setFont(font)
    app.setPalette(_palette(_chosen))
    app.setStyleSheet(_style_sheet(_chosen))


def _palette(t: Theme) -> QPalette:
    palette, role = QPalette(), QPalette.ColorRole
    for which, css in (
        (role.Window, t.ground), (role.WindowText, t.text), (role.Base, t.canvas), (role.AlternateBase, t.raised),
        (role.Text, t.text), (role.Button, t.raised), (role.ButtonText, t.text), (role.PlaceholderText, t.dim),
        (role.Highlight, t.accent), (role.HighlightedText, t.on_accent), (role.ToolTipBase, t.raised),
        (role.ToolTipText, t.text), (role.Link, t.accent), (role.Mid, t.line), (role.Dark, t.line),
    ):  # fmt: skip
        palette.setColor(which, QColor(css))
    for which in (role.WindowText, role.Text, role.ButtonText):
        palette.setColor(QPalette.ColorGroup.Disabled, which, colour(t.dim, 0.6))
    return palette


def _style_sheet(t: Theme) -> str:
    return f"""
    QToolTip {{ color: {t.text}; background: {t.raised}; border: 1px solid {t.line}; padding: 4px 8px; }}
    QMenuBar {{ background: {t.ground}; padding: 2px 4px; }}
    QMenuBar::item {{ padding: 4px 8px; background: transparent; }}
    QMenuBar::item:selected {{ background: {t.raised}; }}
    QMenu {{ background: {t.raised}; border: 1px solid {t.line}; padding: 4px 0; }}
    QMenu::item {{ padding: 5px 24px; }}
    QMenu::item:selected {{ background: {t.line}; }}
    QMenu::item:disabled {{ color: {t.dim}; }}
    QMenu::separator {{ height: 1px; background: {t.line}; margin: 4px 0; }}
    QSplitter::handle {{ background: {t.line}; }}
    QSplitter::handle:hover {{ background: {t.accent}; }}
    QScrollArea, QScrollArea > QWidget > QWidget#scrolled {{ background: transparent; border: none; }}
    QScrollBar:vertical {{ background: transparent; width: 8px; margin: 0; }}
    QScrollBar::handle:vertical {{ background: {t.line}; border-radius: 4px; min-height: 24px; }}
    QScrollBar::add-line, QScrollBar::sub-line {{ height: 0; width: 0; }}
    QLabel[role="title"] {{ color: {t.dim}; font-size: {SMALL_PX}px; letter-spacing: 1px; }}
    QLabel[role="small"] {{ color: {t.dim}; font-size: {SMALL_PX}px; }}
    QLabel[role="warning"] {{ color: {t.accent}; font-size: {SMALL_PX}px; }}
    QLabel[role="empty"] {{ color: {t.dim}; }}
    QLabel[role="badge"] {{ color: {t.accent}; font-size: {SMALL_PX}px; border: 1px solid {t.accent};
        border-radius: 3px; padding: 0 4px; }}
    QPushButton, QComboBox {{ background: {t.raised}; color: {t.text};
        border: 1px solid {t.line}; border-radius: 4px; padding: 4px 8px; min-height: 16px; text-align: left; }}
    QPushButton:hover, QComboBox:hover {{ border-color: {t.dim}; }}
    QPushButton:focus, QComboBox:focus {{ border-color: {t.accent}; }}
    QPushButton:disabled {{ color: {t.faint}; }}
    QPushButton[role="primary"] {{ background: {t.accent}; color: {t.on_accent}; border-color: {t.accent};
        font-weight: 600; padding: 8px; text-align: center; }}
    QPushButton[role="primary"]:hover {{ border-color: {t.text}; }}
    QPushButton[role="primary"]:focus {{ border-color: {t.text}; }}
    QPushButton[role="primary"]:disabled {{ background: {t.raised}; color: {t.dim}; border-color: {t.line}; }}
    QPushButton[role="quiet"], QToolButton {{ background: transparent; border: 1px solid transparent;
        border-radius: 3px; padding: 2px 2px; color: {t.dim}; font-size: {SMALL_PX}px; }}
    QPushButton[role="quiet"]:hover, QToolButton:hover {{ color: {t.text}; }}
    QPushButton[role="quiet"]:focus, QToolButton:focus {{ border-color: {t.accent}; }}
    QPushButton[role="quiet"]:disabled, QToolButton:disabled {{ color: {t.faint}; }}
    QToolButton::menu-indicator {{ image: none; }}
    QToolButton:checked {{ color: {t.accent}; }}
    QPushButton::menu-indicator {{ image: url({_CHEVRON}); width: 12px; height: 12px;
        subcontrol-position: right center; right: 6px; }}
    QComboBox::drop-down {{ border: none; width: 20px; }}
    QComboBox::down-arrow {{ image: url({_CHEVRON}); width: 12px; height: 12px; }}
    QComboBox QAbstractItemView {{ background: {t.raised}; border: 1px solid {t.line};
        selection-background-color: {t.line}; selection-color: {t.text}; outline: none; }}
    QComboBox[role="small"] {{ font-size: {SMALL_PX}px; padding: 1px 6px; }}
    QPlainTextEdit {{ background: {t.canvas}; border: 1px solid {t.line}; border-radius: 4px; padding: 4px;
        selection-background-color: {t.accent}; selection-color: {t.on_accent}; }}
    QPlainTextEdit:focus {{ border-color: {t.accent}; }}
    QLineEdit, QDoubleSpinBox, QSpinBox {{ background: {t.canvas}; color: {t.text}; border: 1px solid {t.line};
        border-radius: 4px; padding: 3px 6px; selection-background-color: {t.accent};
        selection-color: {t.on_accent}; }}
    QLineEdit:focus, QDoubleSpinBox:focus, QSpinBox:focus {{ border-color: {t.accent}; }}
    QLineEdit:disabled, QDoubleSpinBox:disabled, QSpinBox:disabled {{ color: {t.dim}; }}
    QListWidget {{ background: {t.canvas}; border: 1px solid {t.line}; border-radius: 4px; outline: none; }}
    QListView {{ border: 1px solid transparent; }}
    QListView:focus {{ border-color: {t.accent}; }}
    QListWidget::item {{ padding: 4px 8px; }}
    QListWidget::item:selected {{ background: {t.line}; color: {t.text}; }}
    QFrame[role="chooser"] {{ background: {t.raised}; border: 1px solid {t.line}; border-radius: 6px; }}
    QSlider::groove:horizontal {{ height: 2px; background: {t.line}; }}
    QSlider::sub-page:horizontal {{ background: {t.accent}; }}
    QSlider::handle:horizontal {{ background: {t.text}; width: 8px; height: 8px; margin: -3px 0; border-radius: 4px; }}
    QSlider::handle:horizontal:focus {{ background: {t.accent}; }}
    QSlider::groove:horizontal:disabled, QSlider::sub-page:horizontal:disabled {{ background: {t.line}; }}
    QSlider::handle:horizontal:disabled {{ background: {t.line}; }}
    QProgressBar {{ background: {t.line}; border: none; border-radius: 2px; max-height: 4px; }}
    QProgressBar::chunk {{ background: {t.accent}; border-radius: 2px; }}
    QFrame[role="rule"] {{ background: {t.line}; border: none; max-height: 1px; min-height: 1px; }}
    QFrame[role="message"] {{ background: {t.warning}; border: none; border-bottom: 1px solid {t.line}; }}
    """
