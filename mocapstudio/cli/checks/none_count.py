"""Whether this PySide6 loses references to None.

PySide6 6.12.0 on Python 3.11 drops one at every call that returns None, until the interpreter
dies of it within minutes of work. From Python 3.12 on None is immortal.
"""

from __future__ import annotations

from mocapstudio.cli.checks.finding import Finding, State
from mocapstudio.cli.checks.trial import attempt

CALLS = 1000
TOLERANCE = 100

_SCRIPT = f"""
import sys
from PySide6.QtWidgets import QApplication, QLabel
application = QApplication([])
label = QLabel()
before = sys.getrefcount(None)
for _ in range({CALLS}):
    label.update()
print(before - sys.getrefcount(None))
"""


def lost_references() -> int:
    """Count the references to None that are lost in `CALLS` calls of a Qt method.

    Raises
    ------
    OSError
        If Qt does not start.
    """
    trial = attempt(_SCRIPT, {"QT_QPA_PLATFORM": "offscreen"})
    if not trial.passed:
        raise OSError(trial.said)
    return int(trial.said)


def check_none_count() -> list[Finding]:
    """Find out whether PySide6 is one that kills the process."""
    what = "PySide6 and None"
    try:
        lost = lost_references()
    except OSError as error:
        return [Finding(what, State.FAILED, str(error), "see the lines on Qt's libraries")]
    if lost > TOLERANCE:
        remedy = "pip install 'PySide6-Essentials<6.12', or Python 3.12"
        found = f"{lost} references lost in {CALLS} calls: the program will die"
        return [Finding(what, State.FAILED, found, remedy)]
    return [Finding(what, State.OK, f"no references lost in {CALLS} calls")]
