"""Controls of rigs from the command line: what is written agrees, in every form, and bad requests are refused first."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from app.control_export import write_motion_controls
from app.export import VideoSettings, check_outputs, frame_rate, write_outputs
from app.pictures import n_columns
from core.document.parts import FaceChoice
from core.errors import UserFacingError
from core.face.default_face import FaceUnavailable, character_face
from core.face.marker_placement import ACTRESS_FILE, load_marker_file, marker_set_on
from core.media.audio import Audio
from core.media.video import probe
from core.motion.build import BuildSettings, build_database
from core.motion.live_link_face import read_live_link_face
from core.pipeline.curves import read_curves_json, write_curves_csv, write_curves_json
from core.pipeline.gltf import write_glb
from core.rig.control_track import ControlTrack
from core.rig.key_poses import default_poses, load_key_poses
from core.rig.rig import Rig, posed
from core.rig.rig_files import load_rig
from core.search.engine import SearchEngine
from core.speech.transcript import PhonemeUtterance, Transcript
from core.synthesis.marker_motion import MarkerMotion
from tests.core.rig.small_rigs import small_rig

SPEECH = Transcript.covering([PhonemeUtterance("aa", 0.0, 1.0)], [], 1.0)
LANDMARKS = {"outer_eye_left": "ring1", "outer_eye_right": "ring5", "brow_left": "ring2", "brow_right": "ring4",
             "chin": "ring9", "upper_lip": "lip_up", "lower_lip": "lip_low"}  # fmt: skip
AUDIO = Audio(np.sin(np.arange(16_000) / 9).astype(np.float32), 16_000)


@pytest.fixture(scope="module")
def face():
    try:
        return character_face("default", download=False)
    except FaceUnavailable as error:
        pytest.skip(f"needs the faces: {error}")


@pytest.fixture(scope="module")
def opening(face):
    """The actress's markers under a jaw that opens over a second."""
    placement = load_marker_file(ACTRESS_FILE)
    vertices = placement.vertices[placement.kept]
    track = ControlTrack(("jawOpen",), np.linspace(0, 0.6, 61)[:, None], 60.0)
    moved = posed(Rig.of(face), track)[:, vertices] - face.positions[vertices]
    markers = marker_set_on(face, placement)
    return MarkerMotion((markers.rest + moved).astype(np.float32), 60.0, markers)


def settings(**more):
    return VideoSettings(frame_rate("25"), 160, 96, **more)


def test_every_form_holds_the_same_curves_of_the_same_span(opening, tmp_path):
    names = ("a.livelink.csv", "a.json", "a.curves.csv", "a.glb", "a.csv")
    outputs = [tmp_path / name for name in names]
    video = settings(span_s=(0.2, 0.8), start_frame=250)
    assert write_outputs(outputs, opening, AUDIO, SPEECH, video, FaceChoice("default")) == []
    curves = read_curves_json(tmp_path / "a.json")
    assert len(curves) == 15 and curves.rate_hz == 25.0 and curves.start_frame == 255
    jaw = curves.column("jawOpen")
    np.testing.assert_allclose(jaw, 0.6 * (0.2 + np.arange(15) / 25), atol=0.05)
    live = read_live_link_face(tmp_path / "a.livelink.csv", 25.0)
    assert live.start_timecode.startswith("00:00:10:05")
    np.testing.assert_allclose(live.weights[:, live.names.index("jawOpen")], jaw, atol=1e-5)
    assert len(load_rig(str(tmp_path / "a.glb")).names) == 52
    assert (tmp_path / "a.csv").read_text().count("\n") >= 15  # a plain .csv holds markers


def test_a_plain_csv_is_live_link_face_for_lip_sync(opening, tmp_path):
    write_outputs([tmp_path / "a.csv"], opening, AUDIO, SPEECH, settings(), FaceChoice("default"),
                  csv_is_live_link=True)  # fmt: skip
    assert (tmp_path / "a.csv").read_text().startswith("Timecode,BlendShapeCount,EyeBlinkLeft")


def test_a_rig_of_ones_own_is_driven_by_names_and_by_poses(opening, face, tmp_path):
    rig = small_rig(names=("JawOpen", "ctrl"))
    write_glb(rig, ControlTrack(rig.names, np.zeros((1, 2)), 25.0), tmp_path / "own.glb")
    own = FaceChoice(str(tmp_path / "own.glb"))
    write_motion_controls([tmp_path / "named.glb"], opening, own)
    assert load_rig(str(tmp_path / "named.glb")).names == rig.names
    lips = opening.markers.group("lips")
    keys = default_poses(face, opening.markers, lips, opening.displacements[[30, 60]][:, lips])
    poses = type(keys)("own.glb", keys.keys, keys.markers, keys.lips_mm, rig.names, np.array([[0, 0.4], [0, 0.8]]))
    poses.save(tmp_path / "poses.json")
    write_motion_controls([tmp_path / "posed.json"], opening, own, tmp_path / "poses.json")
    ctrl = read_curves_json(tmp_path / "posed.json").column("ctrl")
    assert ctrl[0] == pytest.approx(0, abs=0.02) and ctrl[30] == pytest.approx(0.4, abs=0.02)
    assert ctrl[60] == pytest.approx(0.8, abs=0.02)


def test_five_characters_share_a_film(opening, tmp_path):
    write_outputs([tmp_path / "cast.avi"], opening, AUDIO, SPEECH, settings(span_s=(0.0, 0.08)), FaceChoice("cast"))
    facts = probe(tmp_path / "cast.avi")
    assert (facts.n_frames, facts.width, facts.height) == (2, 160, 96)


def test_faces_stand_as_large_as_the_picture_allows():
    assert n_columns(5, 1280, 320) == 5 and n_columns(5, 640, 480) == 3 and n_columns(5, 100, 900) == 1
    assert n_columns(1, 640, 480) == 1


@pytest.mark.parametrize(
    ("name", "chosen", "said"),
    [("a.glb", "cast", "is 5"), ("a.glb", "head.obj", "no shapes"), ("a.usd", "default", "usd-core")],
)
def test_what_cannot_be_written_is_refused(opening, tmp_path, monkeypatch, name, chosen, said):
    monkeypatch.setitem(__import__("sys").modules, "pxr", None)
    with pytest.raises(UserFacingError, match=said):
        check_outputs([tmp_path / name])
        write_motion_controls([tmp_path / name], opening, FaceChoice(chosen))
    assert not list(tmp_path.iterdir())


def test_curves_go_from_one_form_to_another_and_onto_a_face(efase, tmp_path):
    track = ControlTrack(("jawOpen", "mouthSmileLeft"), np.random.default_rng(1).uniform(size=(40, 2)), 25.0, 50)
    write_curves_json(tmp_path / "in.json", track)
    code, out, err = efase("curves", tmp_path / "in.json", "-o", tmp_path / "a.csv", "-o", tmp_path / "b.curves.csv",
                           "--fps", "25", "--json")  # fmt: skip
    assert (code, err) == (0, "") and json.loads(out)["frames"] == 40
    code, out, _ = efase("curves", tmp_path / "a.csv", "--rate", "25", "-o", tmp_path / "c.json", "--fps", "25")
    assert code == 0
    again = read_curves_json(tmp_path / "c.json")
    np.testing.assert_allclose(again.column("jawOpen"), track.column("jawOpen"), atol=1e-5)
    assert again.start_frame == 50


def test_curves_are_drawn_on_every_character(efase, face, tmp_path):
    write_curves_json(tmp_path / "in.json", ControlTrack(("jawOpen",), np.array([[0.0], [0.9]]), 25.0))
    code, _, err = efase("curves", tmp_path / "in.json", "--face", "cast", "--size", "160x96", "--fps", "25",
                         "-o", tmp_path / "a.png")  # fmt: skip
    assert (code, err) == (0, "") and len(list(tmp_path.glob("a.*.png"))) == 2


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["missing.json", "-o", "a.glb"], "missing.json"),
        (["in.json", "-o", "in.json"], "same time"),
        (["in.json", "-o", "a.txt"], "suffix"),
        (["in.json", "-o", "a.glb", "--face", "nobody"], "nobody"),
    ],
)
def test_bad_requests_are_one_sentence(efase, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    write_curves_json("in.json", ControlTrack(("jawOpen",), np.zeros((2, 1)), 25.0))
    code, _, err = efase("curves", *words)
    assert code == 2 and said in err and "Traceback" not in err
    assert [p.name for p in tmp_path.iterdir()] == ["in.json"]


def test_lipsync_writes_the_weights_of_arkit(efase, face, tiny_corpus, speech_path, tmp_path):
    build_database(replace(tiny_corpus(), landmarks=LANDMARKS), tmp_path / "a.h5", BuildSettings(rate_hz=60.0))
    code, out, err = efase("lipsync", speech_path, "--phones", speech_path.with_suffix(".lab"), "--db",
                           tmp_path / "a.h5", "-o", tmp_path / "a.csv", "-o", tmp_path / "a.glb", "--json")  # fmt: skip
    assert code == 0, err
    assert json.loads(out)["engine"] == "animeme"
    weights = read_live_link_face(tmp_path / "a.csv", 30.0)
    assert weights.rate_hz == 30.0 and len(weights.names) == 52 and weights.weights.max() <= 1
    assert np.ptp(weights.weights[:, weights.names.index("jawOpen")]) > 0.01


def test_markers_that_fit_no_face_are_refused(efase, face, database_path, speech_path, tmp_path):
    code, _, err = efase("lipsync", speech_path, "--phones", speech_path.with_suffix(".lab"), "--db", database_path,
                         "-o", tmp_path / "a.csv")  # fmt: skip
    assert code == 2 and "known points" in err and not (tmp_path / "a.csv").exists()


@pytest.fixture
def artists_model(efase, tmp_path):
    """Animemes of two controls, trained on an artist's curves: the jaw opens in aa and closes in m."""
    rng = np.random.default_rng(2)
    folder = tmp_path / "curves"
    folder.mkdir()
    for n in range(6):
        spoken = rng.permutation(["aa", "m", "iy", "aa", "m", "iy"]).tolist()
        lines = [f"{0.2 * k:.1f} {0.2 * (k + 1):.1f} {phone}" for k, phone in enumerate(["pau", *spoken, "pau"])]
        (folder / f"{n}.lab").write_text("\n".join(lines) + "\n")
        height = {"aa": 0.8, "iy": 0.3, "m": 0.0, "pau": 0.0}
        steps = np.repeat([height[phone] for phone in ["pau", *spoken, "pau"]], 6)
        jaw = np.convolve(np.pad(steps, 2, mode="edge"), np.ones(5) / 5, mode="valid")
        write_curves_csv(folder / f"{n}.csv", ControlTrack(("jawOpen", "ctrl"), np.stack([jaw, jaw / 2], 1), 30.0))
    code, _, err = efase("train", "animeme", "--controls", folder, "-o", tmp_path / "m.npz")
    assert code == 0, err
    return tmp_path / "m.npz"


def test_a_model_of_an_artists_curves_speaks_by_her_controls(efase, artists_model, speech_path, tmp_path):
    said = speech_path.with_suffix(".lab")
    code, out, err = efase("lipsync", speech_path, "--phones", said, "--model", artists_model, "--range", "0.2-0.6",
                           "-o", tmp_path / "a.json", "-o", tmp_path / "a.csv", "--fps", "25", "--json")  # fmt: skip
    assert code == 0 and "ctrl" in err  # Live Link Face has no such unit
    curves = read_curves_json(tmp_path / "a.json")
    assert curves.names == ("jawOpen", "ctrl") and len(curves) == 10 and curves.start_frame == 5
    np.testing.assert_allclose(curves.column("ctrl"), curves.column("jawOpen") / 2, atol=0.05)
    assert json.loads(out)["outputs"] == [str(tmp_path / "a.json"), str(tmp_path / "a.csv")]


@pytest.mark.parametrize(
    ("words", "said"),
    [(["--db", "x.h5"], "needs no database"), (["-o", "a.c3d"], "suffix"), (["--face", "cast", "-o", "a.glb"], "is 5")],
)
def test_what_a_model_cannot_do_is_one_sentence(efase, artists_model, speech_path, tmp_path, monkeypatch, words, said):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    code, _, err = efase("lipsync", speech_path, "--model", artists_model, "-o", "a.json", *words)
    assert code == 2 and said in err and "Traceback" not in err
    assert sorted(tmp_path.iterdir()) == before


def test_long_sounds_are_held_when_asked(efase, artists_model, speech_path, tmp_path):
    """The artist's sounds last 0.2 s; one of 1 s keeps its shape in the middle."""
    (tmp_path / "long.lab").write_text("0 0.1 pau\n0.1 0.2 m\n0.2 0.8 aa\n0.8 0.9 pau\n")
    wander = {}
    for words in ((), ("--hold",)):
        code, _, err = efase("lipsync", speech_path, "--phones", tmp_path / "long.lab", "--model", artists_model,
                             "-o", tmp_path / "a.json", "--fps", "60", *words)  # fmt: skip
        assert code == 0, err
        wander[words] = np.ptp(read_curves_json(tmp_path / "a.json").column("jawOpen")[24:36])
    assert wander["--hold",] < 1e-6 < wander[()]


def test_a_face_without_shapes_is_refused_before_any_synthesis(efase, speech_path, tmp_path, monkeypatch):
    monkeypatch.setattr(SearchEngine, "synthesise", lambda *_: pytest.fail("it was not looked at first"))
    (tmp_path / "bare.obj").write_text("v 0 0 0\nv 100 0 0\nv 0 100 0\nf 1 2 3\n")
    code, _, err = efase("synth", speech_path, "--face", tmp_path / "bare.obj", "-o", tmp_path / "a.glb")
    assert code == 2 and "has no shapes" in err and not (tmp_path / "a.glb").exists()


def test_a_rig_is_posed_by_names_for_an_artist_to_go_on_from(efase, face, tiny_corpus, tmp_path):
    build_database(replace(tiny_corpus(), landmarks=LANDMARKS), tmp_path / "a.h5", BuildSettings(rate_hz=60.0))
    for name, controls in (("arkit", ("JawOpen", "other")), ("strange", ("a", "b"))):
        rig = small_rig(names=controls)
        write_glb(rig, ControlTrack(controls, np.zeros((1, 2)), 25.0), tmp_path / f"{name}.glb")
        code, _, err = efase("poses", "--db", tmp_path / "a.h5", "--face", tmp_path / f"{name}.glb", "--keys", "3",
                             "-o", tmp_path / f"{name}.json")  # fmt: skip
        assert code == 0, err
        poses = load_key_poses(tmp_path / f"{name}.json")
        assert poses.controls == controls and poses.markers == ("lip_up", "lip_low")
        assert poses.values[:, 0].any() == (name == "arkit") and ("at rest" in err) == (name == "strange")
