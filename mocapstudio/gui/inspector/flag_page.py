"""The inspector's first page: why a flag was raised, and what to do about it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtWidgets import (
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QScrollArea,
    QStackedWidget,
    QVBoxLayout,
    QWidget,
)

from mocapstudio.cleaning.model import Neighbour
from mocapstudio.gui import icons, theme, wording
from mocapstudio.gui.actions import Actions
from mocapstudio.gui.document import DocumentBridge, UiState, only_frame_differs
from mocapstudio.gui.inspector.neighbours import NeighbourList
from mocapstudio.gui.queue.model import VERDICT_ICONS
from mocapstudio.gui.reasons import Reason, Reasons
from mocapstudio.gui.widgets.parts import ElidedLabel, Hint, label, panel
from mocapstudio.motion.facing import ROOT_ROWS
from mocapstudio.review.model import QueueItem, Verdict
from mocapstudio.review.state import DocumentState

_FACTS = ("peak", "score", "method", "moves")
_TITLES = {
    "peak": ("Peak", "Highest value of the digression map in the span, 0 to 1, and where"),
    "score": ("Score", "How surely it is an error, 0 to 1, comparable between takes"),
    "method": ("Proposal", "How the replacement motion was made, and from which neighbour"),
    "moves": ("Moves", "How far the proposal moves hands, feet and head at most, centimetres"),
}


class FlagPage(QWidget):
    """Shows the selected flag.

    Parameters
    ----------
    bridge
        The document's door.
    reasons
        Neighbours of the selected flag.
    actions
        The commands behind the buttons.
    """

    def __init__(self, bridge: DocumentBridge, reasons: Reasons, actions: Actions) -> None:
        super().__init__()
        self.setObjectName("inspector-flag")
        self._bridge, self._reasons = bridge, reasons
        self._joint = ElidedLabel()
        self._joint.setObjectName("inspector-joint")
        self._joint.setProperty("role", "heading")
        self._verdict_icon, self._verdict = QLabel(), label("", "", "inspector-verdict")
        self._span = label("", "muted", "inspector-span", wrap=True)
        self._span.setToolTip("Kind; start and end in the take; the file's frame numbers")
        self._why = label("", "", "inspector-why", wrap=True)
        self._why.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._facts = {name: label("", "", f"inspector-{name}", wrap=True) for name in _FACTS}
        self._neighbours = NeighbourList()
        self._neighbours.chosen.connect(reasons.choose)
        self._neighbours.alignment_wanted.connect(self.show_alignment)
        self._stack = QStackedWidget()
        self._empty = QWidget()
        self._hint = Hint(self._empty, "inspector-hint")
        self._stack.addWidget(self._empty)
        self._stack.addWidget(self._make_body(actions))
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.addWidget(self._stack)
        bridge.changed.connect(self._follow)
        bridge.ui_changed.connect(self._follow_ui)
        reasons.changed.connect(lambda: self._show(bridge.state))
        self._show(bridge.state)

    def _make_body(self, actions: Actions) -> QWidget:
        body = QWidget()
        column = QVBoxLayout(body)
        column.setContentsMargins(12, 10, 12, 10)
        column.setSpacing(7)
        top = QHBoxLayout()
        top.setSpacing(5)
        top.addWidget(self._joint, 1)
        top.addWidget(self._verdict_icon)
        top.addWidget(self._verdict)
        column.addLayout(top)
        column.addWidget(self._span)
        column.addWidget(self._why)
        column.addWidget(label("NEIGHBOURS", "section"))
        column.addWidget(self._neighbours)
        column.addWidget(label("FACTS", "section"))
        column.addLayout(self._make_facts())
        column.addStretch(1)
        scroll = QScrollArea()
        scroll.setObjectName("inspector-scroll")
        scroll.setWidgetResizable(True)
        scroll.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        scroll.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        scroll.setWidget(body)
        page = QWidget()
        whole = QVBoxLayout(page)
        whole.setContentsMargins(0, 0, 0, 0)
        whole.setSpacing(0)
        whole.addWidget(scroll, 1)
        whole.addWidget(_decisions(actions))
        return page

    def _make_facts(self) -> QGridLayout:
        grid = QGridLayout()
        grid.setHorizontalSpacing(12)
        grid.setVerticalSpacing(5)
        grid.setColumnStretch(1, 1)
        for row, name in enumerate(_FACTS):
            title, tip = _TITLES[name]
            caption = label(title, "muted")
            caption.setToolTip(tip)
            self._facts[name].setToolTip(tip)
            grid.addWidget(caption, row, 0, Qt.AlignmentFlag.AlignTop)
            grid.addWidget(self._facts[name], row, 1)
        return grid

    def _follow(self, old: DocumentState, new: DocumentState) -> None:
        if not only_frame_differs(old, new):
            self._show(new)

    def _follow_ui(self, old: UiState, new: UiState) -> None:
        if (old.preview, old.theme) != (new.preview, new.theme):
            self._show(self._bridge.state)

    def _show(self, state: DocumentState) -> None:
        item, take = state.selected, state.take
        self._stack.setCurrentIndex(0 if item is None else 1)
        if item is None or take is None:
            self._hint.say(_empty_words(state))
            return
        self._show_verdict(item)
        self._show_reason(state, item)
        self._show_facts(state, item)

    def _show_verdict(self, item: QueueItem) -> None:
        colour = theme.current().verdict(item.verdict)
        self._joint.show_text(item.flag.joint)
        self._verdict_icon.setPixmap(icons.pixmap(VERDICT_ICONS[item.verdict], 16, colour))
        self._verdict.setText(item.verdict.capitalize())
        self._verdict.setStyleSheet(f"color: {colour}; font-weight: 600;")

    def _show_reason(self, state: DocumentState, item: QueueItem) -> None:
        take, analysis = state.take, state.analysis
        assert take is not None
        span = wording.span(take, item.flag.start, item.flag.end)
        self._span.setText(f"{item.flag.kind.capitalize()}, {span}")
        reason = self._reasons.current
        if analysis is None:
            self._why.setText("Flagged in an earlier analysis. Press F5 to analyse again.")
        else:
            why = wording.explain(item.flag, take, analysis.map, reason.neighbours or ())
            if not item.current:
                why = f"No longer flagged; decided earlier. {why}"
            self._why.setText(why)
        near = reason.neighbours or ()
        note = _neighbours_note(reason, analysis is not None)
        times = [self._when(one) for one in near]
        choosable = item.flag.joint not in ROOT_ROWS
        self._neighbours.show_neighbours(near, times, note, choosable)
        self._neighbours.mark(self._previewed())

    def _previewed(self) -> int | None:
        """Which of the neighbours is the proposal, if it is one of them."""
        state, choice = self._bridge.state, self._bridge.ui.preview
        item, near = state.selected, self._reasons.current.neighbours or ()
        proposal = None if item is None else state.proposals.get(item.flag.id)
        if choice is None and proposal is not None and proposal.donor in near:
            return near.index(proposal.donor)
        return choice

    def show_alignment(self, which: int | None = None) -> bool:
        """Show how a neighbour, 0-based, answers to the flagged span; False where none is known.

        None is the one that is previewed, else the nearest.
        """
        state, reason = self._bridge.state, self._reasons.current
        item, analysis = state.selected, state.analysis
        near = reason.neighbours or ()
        if item is None or analysis is None or reason.profile is None or not near:
            return False
        # It brings compiled kernels along, which would hold up the first window.
        from mocapstudio.gui.dialogs.neighbour_alignment import NeighbourAlignmentDialog

        dialog = NeighbourAlignmentDialog(
            self._bridge, analysis, item.flag, reason.profile, near, self.window()
        )
        wanted = self._previewed() if which is None else which
        dialog.show_neighbour(min(wanted or 0, len(near) - 1))
        dialog.show()
        return True

    def _when(self, neighbour: Neighbour) -> str:
        analysis = self._bridge.state.analysis
        if analysis is None:
            return ""
        takes = (analysis.take, *analysis.context)
        take = takes[neighbour.index]
        return f"{take.seconds(neighbour.start):.2f} s"

    def _show_facts(self, state: DocumentState, item: QueueItem) -> None:
        take, flag = state.take, item.flag
        assert take is not None
        proposal = state.proposals.get(flag.id)
        peak = f"{flag.peak:.2f} at {wording.seconds(take, flag.peak_frame)}"
        peak += f", frame {wording.number(take, flag.peak_frame)}"
        method, moves = "—", "—"
        if proposal is not None:
            method = wording.method(proposal.method)
            if proposal.donor is not None:
                method += f" ({proposal.donor.take})"
            moves = wording.displacement(proposal.displacement)
        elif self._reasons.current.trouble is not None:
            method = self._reasons.current.trouble.cause
        texts = {
            "peak": peak,
            "score": f"{flag.score:.2f}",
            "method": method,
            "moves": moves,
        }
        for name, text in texts.items():
            self._facts[name].setText(text)


def _empty_words(state: DocumentState) -> str:
    if state.take is None:
        return "Why a span was flagged is told here."
    if state.queue:
        return "Select a flag in the queue or on the map,\nor press N for the worst one."
    return "No flag to inspect."


def _neighbours_note(reason: Reason, analysed: bool) -> str:
    if not analysed:
        return "Analyse again to find them (F5)."
    if reason.trouble is not None:
        return reason.trouble.cause
    if reason.neighbours is None:
        return "Looking for neighbours…"
    return "Nothing else in the take or its context resembles this span."


def _decisions(actions: Actions) -> QFrame:
    """Make the buttons at the foot of the inspector."""
    foot = panel("inspector-decisions")
    grid = QGridLayout(foot)
    grid.setContentsMargins(12, 8, 12, 10)
    grid.setSpacing(6)
    verdicts = {
        "accept": ("Accept", Verdict.ACCEPTED),
        "reject": ("Reject", Verdict.REJECTED),
        "defer": ("Defer", Verdict.DEFERRED),
    }
    for column, (name, (text, verdict)) in enumerate(verdicts.items()):
        button = actions.push_button(name, text)
        button.setProperty("verdict", str(verdict))
        button.setMinimumHeight(32)
        grid.addWidget(button, 1, 2 * column, 1, 2)
    grid.addWidget(actions.check_box("keep-ends", "Keep hands and feet"), 0, 0, 1, 6)
    below = QHBoxLayout()
    below.setSpacing(6)
    below.addWidget(actions.push_button("reject-like", "Reject like this"), 1)
    for name in ("protect", "reopen", "edit"):
        below.addWidget(actions.tool_button(name))
    grid.addLayout(below, 2, 0, 1, 6)
    return foot
