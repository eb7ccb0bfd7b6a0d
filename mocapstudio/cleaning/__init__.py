"""From neighbours to digression map, flags and proposals (paper 1)."""
