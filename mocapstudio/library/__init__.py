"""Takes on disk, their index, search and energies (papers 2 and 5)."""
