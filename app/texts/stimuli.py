"""All words of a perception study's folder. ``{names}`` are filled in."""

from __future__ import annotations

UNBALANCED = (
    "Combinations are met equally often, in each group, by multiples of {multiple} participants; these are not one."
)
NO_CAPTURES = "The words of '{track}' were not captured in {expression}, so only synthetic faces are shown."
SYNTHETIC_DATABASE = " (synthetic: nobody was captured)"
SPOKEN_CAPTURED = "in the database's own recording"
SPOKEN_OWN = "in a recording of your own; speak calmly, so that the voice tells no emotion"
APART = " No capture of the\n                       same words was used."
LEARNED_FROM = " The engine learned\n                       from captures of the same words among others."
CAPTURED_FACES = """  captured             the same face moved by markers that were captured while the actor said these
                       words in that expression, phone by phone at the times of the audio. It is the
                       paper's "real" face (R) as far as motion goes; it is drawn, not filmed."""
FILMED_FACES = """  captured             films of a real speaker, given with --films, under the same audio: the paper's
                       "real" face (R)."""
ALIKE = """Head, gaze and tongue move alike in all films of an audio: they are made from the sound, so that
the faces differ by what is studied alone."""
ALIKE_FILMED = """Head, gaze and tongue of the synthetic face move alike in all films of an audio: they are made
from the sound."""
NO_CAPTURED_FACES = "  There are no captured faces in this study."
PARTS = {
    "paper": {
        True: """  1. silent faces, synthetic and captured, one in each expression
  2. the audio alone, each once
  3. all audios with one kind of face, in each expression
  4. all audios with the other kind of face, in each expression""",
        False: """  1. silent faces, one in each expression
  2. the audio alone, each once
  3. all audios with the face, in each expression""",
    },
    "once": {
        True: """  1. silent faces, synthetic and captured, one in each expression
  2. to 4. every audio once: alone, or with one kind of face in one expression; which one goes round
     from participant to participant, the audio alone first, then one kind of face, then the other""",
        False: """  1. silent faces, one in each expression
  2. to 3. every audio once: alone, or with the face in one expression; which one goes round""",
    },
}
GROUPS = (
    ":\ngroup A meets synthetic faces with sound before captured ones, group B the other way round,\n"
    "so that being used to one kind does not favour the other"
)
MIRRORED = ":\neach of group B meets what the one before them met, every part backwards"
