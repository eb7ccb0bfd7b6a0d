"""Dynamic time warping of whole performances."""
