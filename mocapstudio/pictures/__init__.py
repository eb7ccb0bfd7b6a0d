"""Maps, poses and curves as image files, without a window."""
