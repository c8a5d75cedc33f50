"""The window of the live face."""
