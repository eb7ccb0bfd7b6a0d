"""How two motions are compared."""
