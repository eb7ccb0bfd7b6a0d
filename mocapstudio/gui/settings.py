"""What the desk remembers between sittings: layout, recent files, folders, theme."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QByteArray, QSettings

_RECENT = 12


def _store() -> QSettings:
    return QSettings(
        QSettings.Format.IniFormat, QSettings.Scope.UserScope, "mocapstudio", "mocapstudio"
    )


def text(key: str, default: str = "") -> str:
    """Return a remembered word."""
    return str(_store().value(key, default))


def set_text(key: str, value: str) -> None:
    """Remember a word."""
    _store().setValue(key, value)


def flag(key: str, default: bool) -> bool:
    """Return a remembered switch."""
    return str(_store().value(key, default)).lower() in ("true", "1")


def set_flag(key: str, value: bool) -> None:
    """Remember a switch."""
    _store().setValue(key, value)


def layout(key: str) -> QByteArray | None:
    """Return the remembered state of a window, splitter or header."""
    value = _store().value(f"layout/{key}")
    return value if isinstance(value, QByteArray) else None


def set_layout(key: str, value: QByteArray) -> None:
    """Remember the state of a window, splitter or header."""
    _store().setValue(f"layout/{key}", value)


def recent(kind: str) -> tuple[Path, ...]:
    """Return recent paths of one kind (``"files"`` or ``"contexts"``), latest first."""
    value = _store().value(f"recent/{kind}", [])
    # Qt reads a list of one word back as that word.
    paths = value if isinstance(value, list) else [value] if value else []
    return tuple(Path(str(path)) for path in paths)


def add_recent(kind: str, path: Path) -> None:
    """Put a path on top of the recent ones."""
    path = path.resolve()
    paths = [path, *(one for one in recent(kind) if one != path)][:_RECENT]
    _store().setValue(f"recent/{kind}", [str(one) for one in paths])


def forget_recent(kind: str) -> None:
    """Empty the list of recent paths."""
    _store().remove(f"recent/{kind}")


def folder(purpose: str) -> str:
    """Return the folder last used for a purpose, or the user's home."""
    return text(f"folder/{purpose}", str(Path.home()))


def set_folder(purpose: str, path: Path) -> None:
    """Remember the folder of a path for a purpose."""
    set_text(f"folder/{purpose}", str(path if path.is_dir() else path.parent))
