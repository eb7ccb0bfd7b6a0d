"""Labelled markers solved to the joints of a skeleton."""

from mocapstudio.motion.solving.model import Solved
from mocapstudio.motion.solving.solver import solve, solving

__all__ = ["Solved", "solve", "solving"]
