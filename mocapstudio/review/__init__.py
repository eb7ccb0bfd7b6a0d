"""The document of a sitting, without Qt."""
