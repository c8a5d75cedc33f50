"""An import carried out: read, match, mend, align, build."""
