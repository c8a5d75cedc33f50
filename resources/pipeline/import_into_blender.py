"""Key the shape keys of the selected mesh in Blender from curves of the eFASE workstation.

In Blender's Scripting workspace open this file, select the mesh, set CURVES below, and press Run. Works with Blender
3.0 and later. CURVES is a .livelink.csv (Live Link Face), a .curves.csv or a .json that efase wrote.
"""

import csv
import json
import re

CURVES = "speech.json"
FIRST_FRAME = 1  # where in the timeline the speech begins


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


def key_shapes(mesh, path, first_frame=1):
    """Key every shape key of ``mesh`` that the curves name; return the names of the curves that found none."""
    import bpy

    names, rows, rate = read_curves(path)
    blocks = {plain(block.name): block for block in mesh.data.shape_keys.key_blocks}
    scene_rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    lost = []
    for column, name in enumerate(names):
        block = blocks.get(plain(name))
        if block is None:
            lost.append(name)
            continue
        for frame, row in enumerate(rows):
            block.value = row[column]
            block.keyframe_insert("value", frame=first_frame + frame * scene_rate / rate)
    bpy.context.scene.frame_end = max(bpy.context.scene.frame_end, int(first_frame + len(rows) * scene_rate / rate))
    return lost


if __name__ == "__main__":
    import bpy

    print("No shape key for:", key_shapes(bpy.context.object, CURVES, FIRST_FRAME))
