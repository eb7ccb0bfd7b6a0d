"""Colours and type of the desk: two themes, one style sheet."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from string import Template

from PySide6.QtGui import QColor, QFont, QFontDatabase, QPalette
from PySide6.QtWidgets import QApplication

from mocapstudio.pictures import style
from mocapstudio.resource_files import resource
from mocapstudio.review.model import Verdict


@dataclass(frozen=True)
class Theme:
    """Colours as ``#rrggbb``; the verdicts are told apart by the colour-blind as well.

    The verdict colours follow Okabe and Ito's set (bluish green, vermilion, reddish purple,
    yellow), set lighter or darker for the background. `colormap` is a name of
    `pyqtgraph.colormap.get`.
    """

    name: str
    background: str
    panel: str
    raised: str
    field: str
    border: str
    text: str
    muted: str
    faint: str
    accent: str
    accent_text: str
    selection: str
    accepted: str
    rejected: str
    deferred: str
    open: str
    protected: str
    original: str
    proposal: str
    result: str
    playhead: str
    body: str
    partner: str
    neighbour: str
    viewport_top: str
    viewport_bottom: str
    floor: str
    colormap: str

    def verdict(self, verdict: Verdict) -> str:
        """Colour of a verdict."""
        colours = {
            Verdict.ACCEPTED: self.accepted,
            Verdict.REJECTED: self.rejected,
            Verdict.DEFERRED: self.deferred,
            Verdict.OPEN: self.open,
        }
        return colours[verdict]


DARK = Theme(
    name="dark",
    background=style.DARK.background,
    panel="#1b1e23",
    raised="#272b33",
    field=style.DARK.field,
    border=style.DARK.border,
    text=style.DARK.text,
    muted=style.DARK.muted,
    faint="#626a77",
    accent="#4da3ff",
    accent_text="#0b1017",
    selection="#24405f",
    accepted=style.DARK.truth,
    rejected=style.DARK.wrong,
    deferred="#cf8fc0",
    open=style.DARK.open,
    protected="#7f8896",
    original="#c3c8d1",
    proposal=style.DARK.proposal,
    result=style.DARK.truth,
    playhead="#ffffff",
    body=style.DARK.body,
    partner="#7a8494",
    neighbour="#a08fd6",
    viewport_top="#23272f",
    viewport_bottom="#121418",
    floor=style.DARK.floor,
    colormap=style.DARK.colormap,
)

LIGHT = Theme(
    name="light",
    background="#e9ebef",
    panel=style.LIGHT.background,
    raised="#ffffff",
    field=style.LIGHT.field,
    border=style.LIGHT.border,
    text=style.LIGHT.text,
    muted=style.LIGHT.muted,
    faint="#8d95a1",
    accent="#1a6fd4",
    accent_text="#ffffff",
    selection="#cfe2fa",
    accepted=style.LIGHT.truth,
    rejected=style.LIGHT.wrong,
    deferred="#9c4f86",
    open=style.LIGHT.open,
    protected="#7f8896",
    original="#4b535f",
    proposal=style.LIGHT.proposal,
    result=style.LIGHT.truth,
    playhead="#111418",
    body=style.LIGHT.body,
    partner="#a4acb8",
    neighbour="#7765bd",
    viewport_top="#f3f5f8",
    viewport_bottom="#d5dae2",
    floor=style.LIGHT.floor,
    colormap="CET-L18",
)

THEMES = {theme.name: theme for theme in (DARK, LIGHT)}

_STYLED = "mocapstudio-styled"

_current = DARK


def current() -> Theme:
    """Return the theme in force."""
    return _current


def apply(app: QApplication, theme: Theme) -> None:
    """Put a theme in force: palette, type and style sheet of the whole application."""
    global _current
    _current = theme
    if app.property(_STYLED) is None:
        # Once only: exchanging the style under living windows with a style sheet crashes Qt.
        app.setStyle("Fusion")
        app.setFont(_font())
        app.setProperty(_STYLED, True)
    app.setPalette(_palette(theme))
    icons = resource("icons").as_posix()
    sheet = Template(resource("styles", "desk.qss").read_text("utf-8"))
    app.setStyleSheet(sheet.substitute(asdict(theme), icons=icons))


def numbers_font() -> QFont:
    """Return the type for figures in tables and read-outs: the text's, with equal-width digits."""
    font = QFont(_font())
    font.setFeature(QFont.Tag("tnum"), 1)
    return font


def _font() -> QFont:
    families = set(QFontDatabase.families())
    wanted = ("Inter", "Segoe UI", "SF Pro Text", "Noto Sans", "Cantarell", "DejaVu Sans")
    family = next((name for name in wanted if name in families), QFont().family())
    font = QFont(family)
    # DejaVu runs a tenth wider than the others.
    font.setPixelSize(12 if family == "DejaVu Sans" else 13)
    return font


def _palette(theme: Theme) -> QPalette:
    roles = {
        QPalette.ColorRole.Window: theme.panel,
        QPalette.ColorRole.WindowText: theme.text,
        QPalette.ColorRole.Base: theme.field,
        QPalette.ColorRole.AlternateBase: theme.panel,
        QPalette.ColorRole.Text: theme.text,
        QPalette.ColorRole.PlaceholderText: theme.faint,
        QPalette.ColorRole.Button: theme.raised,
        QPalette.ColorRole.ButtonText: theme.text,
        QPalette.ColorRole.BrightText: theme.rejected,
        QPalette.ColorRole.Highlight: theme.selection,
        QPalette.ColorRole.HighlightedText: theme.text,
        QPalette.ColorRole.ToolTipBase: theme.raised,
        QPalette.ColorRole.ToolTipText: theme.text,
        QPalette.ColorRole.Link: theme.accent,
        QPalette.ColorRole.Accent: theme.accent,
        QPalette.ColorRole.Mid: theme.border,
        QPalette.ColorRole.Dark: theme.border,
        QPalette.ColorRole.Light: theme.raised,
    }
    palette = QPalette()
    for role, colour in roles.items():
        palette.setColor(role, QColor(colour))
    for role in (
        QPalette.ColorRole.Text,
        QPalette.ColorRole.WindowText,
        QPalette.ColorRole.ButtonText,
    ):
        palette.setColor(QPalette.ColorGroup.Disabled, role, QColor(theme.faint))
    return palette
