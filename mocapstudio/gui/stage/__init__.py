"""A viewport for any performers, of joints or of markers: actors, their scene, the widget."""
