"""The Markers workspace: gaps seen, filled and exchanged."""
