"""Open-end time warping, a frame at a time: the compiled kernels (paper 3)."""
