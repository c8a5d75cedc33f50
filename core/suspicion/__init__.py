"""Which captured motion is likely to be contaminated, why, and how sure that is; nothing here removes anything."""
