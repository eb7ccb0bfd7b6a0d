"""Two performances side by side (papers 3 and 4)."""
