"""Reading and writing takes, one module a file format."""
