"""How neighbours may be searched; apart from the search, so that forms need no kernels."""

from __future__ import annotations

EXACT, INDEXED, AUTOMATIC = "exact", "indexed", "automatic"
SEARCHES = (AUTOMATIC, EXACT, INDEXED)
