"""The window in which two engines say the same, side by side, with curves of what lies between them."""
