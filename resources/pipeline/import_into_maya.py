"""Key the weights of a blendShape node in Maya from curves of the eFASE workstation.

In Maya's Script Editor (Python) open this file, set CURVES and BLEND_SHAPE below, and run it. Works with Maya 2022 and
later. CURVES is a .livelink.csv (Live Link Face), a .curves.csv or a .json that efase wrote. Keys are set in seconds,
so that any frame rate of the scene is right.
"""

import csv
import json
import re

CURVES = "speech.json"
BLEND_SHAPE = "blendShape1"
START_S = 0.0  # where in the timeline the speech begins


def read_curves(path):
    """Return (names, rows, frames a second)."""
    if path.lower().endswith(".json"):
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        return data["controls"], data["frames"], data["rate_hz"]
    with open(path, encoding="utf-8", newline="") as file:
        heads, *lines = [line for line in csv.reader(file) if line]
    rows = [[float(cell) for cell in line[2:]] for line in lines if line[2]]
    if heads[0] == "Timecode":
        # a second has as many frames as the highest frame number and one more
        return heads[2:], rows, max(int(line[0].split(":")[3].split(".")[0]) for line in lines) + 1
    times = [float(line[1]) for line in lines]
    return heads[2:], rows, (len(times) - 1) / (times[-1] - times[0]) if len(times) > 1 else 30.0


def plain(name):
    """Spell a name so that jawOpen, JawOpen and blendShape1.jaw_open are the same."""
    name = re.sub(r"_l$", "left", re.sub(r"_r$", "right", re.split(r"[.:|]", name)[-1].lower()))
    return re.sub(r"[\W_]", "", name)


def key_weights(node, path, start_s=0.0):
    """Key every weight of the blendShape ``node`` that the curves name; return the names that found none."""
    from maya import cmds

    names, rows, rate = read_curves(path)
    weights = {plain(weight): weight for weight in cmds.listAttr(node + ".weight", multi=True) or []}
    lost = []
    for column, name in enumerate(names):
        weight = weights.get(plain(name))
        if weight is None:
            lost.append(name)
            continue
        for frame, row in enumerate(rows):
            time = "%fsec" % (start_s + frame / rate)
            cmds.setKeyframe(node, attribute=weight, time=(time,), value=row[column])
    return lost


if __name__ == "__main__":
    print("No weight for:", key_weights(BLEND_SHAPE, CURVES, START_S))
