"""The stimuli of a perception study, from a database to a folder."""
