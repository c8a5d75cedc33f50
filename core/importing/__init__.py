"""From a studio's captures to a motion database: survey, marker matching, mending, offset, alignment, report."""
