"""Many takes at once."""
