"""Workspaces: each assembles views for one kind of work."""
