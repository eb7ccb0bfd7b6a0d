"""mocapstudio: review and clean motion capture."""

__version__ = "0.1.0"
