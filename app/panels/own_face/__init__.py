"""The window in which a face is fitted to a scan."""
