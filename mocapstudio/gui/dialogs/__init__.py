"""Dialogs. All are opened, never executed: the desk's event loop is never nested."""
