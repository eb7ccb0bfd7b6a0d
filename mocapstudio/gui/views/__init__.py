"""The parts of the desk, each fed by the document and none by another."""
