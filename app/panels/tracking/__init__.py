"""The window in which a face is tracked in a video."""
