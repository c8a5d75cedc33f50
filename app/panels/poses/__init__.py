"""The window in which an artist poses a character for each key lip shape."""
