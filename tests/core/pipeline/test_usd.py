import numpy as np
import pytest

from core.errors import UserFacingError
from core.pipeline import usd
from core.rig.rig import posed
from tests.core.rig.small_rigs import random_track, small_rig

NAMES = ("jawOpen", "mouth.smile", "2nd shape")


def test_without_usd_core_it_says_so_and_writes_nothing(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "pxr", None)
    rig = small_rig()
    with pytest.raises(UserFacingError, match="usd-core"):
        usd.write_usd(rig, random_track(rig.names), tmp_path / "a.usd")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", [".usda", ".usdc", ".usd"])
def test_usd_skel_moves_the_points_as_the_rig_does(tmp_path, suffix):
    """Pixar's own skinning of what was written, at every frame."""
    pytest.importorskip("pxr", reason="usd-core, which writes USD, is not installed")
    from pxr import Usd, UsdGeom, UsdSkel

    rig = small_rig(names=NAMES)
    track = random_track(rig.names, n_frames=5, rate_hz=24.0, start_frame=48)
    usd.write_usd(rig, track, tmp_path / f"a{suffix}")
    stage = Usd.Stage.Open(str(tmp_path / f"a{suffix}"))
    assert UsdGeom.GetStageUpAxis(stage) == "Y" and UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    assert (stage.GetTimeCodesPerSecond(), stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (24.0, 48.0, 52.0)
    root = UsdSkel.Root(stage.GetDefaultPrim())
    assert root
    assert UsdSkel.BakeSkinning(root, __import__("pxr").Gf.Interval(48, 52))
    (mesh,) = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    points = UsdGeom.Mesh(mesh).GetPointsAttr()
    baked = np.array([points.Get(48 + f) for f in range(5)])
    np.testing.assert_allclose(baked * 1000, posed(rig, track), atol=1e-2)


def test_a_point_cache_holds_every_frame(tmp_path):
    pytest.importorskip("pxr", reason="usd-core, which writes USD, is not installed")
    from pxr import Usd, UsdGeom

    rig = small_rig()
    track = random_track(rig.names, n_frames=4)
    usd.write_usd(rig, track, tmp_path / "a.usdc", as_points=True)
    stage = Usd.Stage.Open(str(tmp_path / "a.usdc"))
    points = UsdGeom.Mesh(stage.GetPrimAtPath("/sheet/face")).GetPointsAttr()
    assert points.GetTimeSamples() == [0, 1, 2, 3]
    np.testing.assert_allclose(np.array([points.Get(f) for f in range(4)]) * 1000, posed(rig, track), atol=1e-2)


def test_names_are_made_lawful_and_stay_different():
    assert usd.shape_tokens(("a.b", "a-b", "2", "a_b_")) == ["a_b", "a_b_", "_2", "a_b__"]
