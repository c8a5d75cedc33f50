"""The strip along the bottom: lanes over one time axis, and what can be done in them."""
