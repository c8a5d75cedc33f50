"""The scripts for Blender and Maya, run against stand-ins that note down what they are told."""

import importlib.util
import sys
import types
from pathlib import Path

import numpy as np
import pytest

from core.motion.live_link_face import write_live_link_face
from core.pipeline.blendshapes import arkit_weights
from core.pipeline.curves import write_curves_csv, write_curves_json
from tests.core.rig.small_rigs import random_track

SCRIPTS = Path(__file__).resolve().parents[3] / "resources" / "pipeline"
NAMES = ("jawOpen", "mouthSmileLeft", "tongueOut")


def script(name):
    found = importlib.util.spec_from_file_location(name, SCRIPTS / f"{name}.py")
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


@pytest.fixture(params=[".json", ".curves.csv", ".livelink.csv"])
def curves(request, tmp_path):
    """A file of each kind, and the track in it."""
    track = random_track(NAMES, n_frames=40, rate_hz=25.0, start_frame=50)
    path = tmp_path / f"speech{request.param}"
    if request.param == ".json":
        write_curves_json(path, track)
    elif request.param == ".curves.csv":
        write_curves_csv(path, track)
    else:
        write_live_link_face(path, arkit_weights(track)[0])
    return path, track


class Block:
    def __init__(self, name):
        self.name, self.value, self.keys = name, 0.0, {}

    def keyframe_insert(self, what, frame):
        assert what == "value"
        self.keys[frame] = self.value


def test_blenders_shape_keys_get_every_frame_in_the_time_of_the_scene(curves, monkeypatch):
    path, track = curves
    render = types.SimpleNamespace(fps=50, fps_base=1.0)
    scene = types.SimpleNamespace(render=render, frame_end=10)
    bpy = types.SimpleNamespace(context=types.SimpleNamespace(scene=scene))
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    blocks = [Block("Basis"), Block("JawOpen"), Block("mouthSmile_L")]
    mesh = types.SimpleNamespace(data=types.SimpleNamespace(shape_keys=types.SimpleNamespace(key_blocks=blocks)))
    lost = script("import_into_blender").key_shapes(mesh, str(path), first_frame=1)
    assert "tongueOut" in [name[0].lower() + name[1:] for name in lost] and scene.frame_end == 81
    assert not blocks[0].keys and list(blocks[1].keys) == [1.0 + 2 * f for f in range(40)]
    for block, name in zip(blocks[1:], NAMES):
        np.testing.assert_allclose(list(block.keys.values()), track.column(name), atol=1e-6)


def test_mayas_weights_get_every_frame_in_seconds(curves, monkeypatch):
    path, track = curves
    keyed = {}

    def set_keyframe(node, attribute, time, value):
        keyed.setdefault((node, attribute), []).append((time, value))

    cmds = types.SimpleNamespace(listAttr=lambda plug, multi: ["jawOpen", "mouthSmileLeft"], setKeyframe=set_keyframe)
    monkeypatch.setitem(sys.modules, "maya", types.SimpleNamespace(cmds=cmds))
    lost = script("import_into_maya").key_weights("faceShapes", str(path), start_s=2.0)
    assert "tongueout" in [name.lower() for name in lost] and len(keyed) == 2
    times, values = zip(*keyed["faceShapes", "jawOpen"])
    assert times[0] == ("2.000000sec",) and times[25] == ("3.000000sec",)
    np.testing.assert_allclose(values, track.column("jawOpen"), atol=1e-6)
