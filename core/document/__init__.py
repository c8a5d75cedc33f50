"""What the animator works on: one observable document, and the edits that change it."""
