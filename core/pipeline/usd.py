"""A rig and its curves as USD: blend shapes of UsdSkel, or the moved points themselves.

Needs Pixar's ``usd-core`` (an optional extra, 30 MB).
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from core.errors import UserFacingError
from core.face.face import PARTS
from core.media.swap_in import swapped_in
from core.pipeline.gltf import M_PER_MM
from core.pipeline.vertex_colours import vertex_colours
from core.rig.control_track import ControlTrack
from core.rig.rig import Rig, poses

SUFFIXES = (".usd", ".usda", ".usdc")


class UsdMissing(UserFacingError):
    """The extra that writes USD is not installed."""

    def __init__(self) -> None:
        super().__init__("USD files are written by usd-core, which is not installed.",
                         "Install it with: pip install usd-core")  # fmt: skip


def check_usd() -> None:
    """Raise `UsdMissing`, before any work goes into it, where USD cannot be written."""
    try:
        import pxr.Usd  # noqa: F401
    except ImportError as error:
        raise UsdMissing from error


def write_usd(rig: Rig, track: ControlTrack, path: str | Path, as_points: bool = False) -> None:
    """Write ``rig`` with ``track`` (its own controls in its order, see `core.rig.rig.fitted`) to ``path``.

    Metres (``metersPerUnit`` 1), y up, the face looking along z. One time code a frame, counted from the track's start
    frame, at its rate. The sound is not in the file.

    path : .usda is text, .usdc and .usd are binary
    as_points : points at every frame (a point cache) instead of blend shapes; larger, and read by everything

    Raises `UsdMissing` without ``usd-core``, and `UserFacingError` when the file cannot be written.
    """
    if track.names != rig.names:
        raise ValueError("the track is not in the rig's own controls")
    check_usd()
    from pxr import Tf, Usd, UsdGeom

    with swapped_in(path) as beside:
        try:
            stage = Usd.Stage.CreateNew(str(beside))
        except Tf.ErrorException as error:
            raise UserFacingError(f"'{path}' cannot be written as USD.") from error
        UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
        UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        stage.SetTimeCodesPerSecond(track.rate_hz)
        stage.SetFramesPerSecond(track.rate_hz)
        stage.SetStartTimeCode(track.start_frame)
        stage.SetEndTimeCode(track.start_frame + len(track) - 1)
        if rig.face.credit:
            stage.SetMetadata("comment", rig.face.credit)
        name = Tf.MakeValidIdentifier(Path(rig.face.name).stem)
        if as_points:
            root = UsdGeom.Xform.Define(stage, f"/{name}").GetPrim()
            mesh = _mesh(stage, rig, f"/{name}/face")
            points = mesh.GetPointsAttr()
            for f, vertices in enumerate(poses(rig, track)):
                points.Set(_vec3(vertices * M_PER_MM), track.start_frame + f)
        else:
            root = _skel_root(stage, rig, track, name)
        stage.SetDefaultPrim(root)
        stage.GetRootLayer().Save()
        del stage, root  # the file is let go


def _skel_root(stage, rig: Rig, track: ControlTrack, name: str):
    from pxr import UsdSkel, Vt

    root = UsdSkel.Root.Define(stage, f"/{name}").GetPrim()
    mesh = _mesh(stage, rig, f"/{name}/face")
    # blend shapes are animated through a skeleton, even one whose only joint never moves
    skeleton = UsdSkel.Skeleton.Define(stage, f"/{name}/skeleton")
    skeleton.CreateJointsAttr(["root"])
    identity = _identity()
    skeleton.CreateBindTransformsAttr([identity])
    skeleton.CreateRestTransformsAttr([identity])
    animation = UsdSkel.Animation.Define(stage, f"/{name}/skeleton/speech")
    tokens = shape_tokens(rig.names)
    animation.CreateBlendShapesAttr(tokens)
    weights = animation.CreateBlendShapeWeightsAttr()
    for f, row in enumerate(track.values):
        weights.Set(Vt.FloatArray.FromNumpy(np.ascontiguousarray(row)), track.start_frame + f)
    UsdSkel.BindingAPI.Apply(skeleton.GetPrim()).CreateAnimationSourceRel().SetTargets([animation.GetPath()])
    binding = UsdSkel.BindingAPI.Apply(mesh.GetPrim())
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    binding.CreateJointIndicesPrimvar(True, 1).Set([0])
    binding.CreateJointWeightsPrimvar(True, 1).Set([1.0])
    targets = []
    for token, delta in zip(tokens, rig.deltas):
        shape = UsdSkel.BlendShape.Define(stage, mesh.GetPath().AppendChild(token))
        moved = np.flatnonzero(np.abs(delta).max(axis=1) > 0)
        shape.CreateOffsetsAttr(_vec3(delta[moved] * M_PER_MM))
        shape.CreatePointIndicesAttr(Vt.IntArray.FromNumpy(moved.astype(np.int32)))
        targets.append(shape.GetPath())
    binding.CreateBlendShapesAttr(tokens)
    binding.CreateBlendShapeTargetsRel().SetTargets(targets)
    return root


def _mesh(stage, rig: Rig, path: str):
    from pxr import Sdf, UsdGeom, Vt

    face = rig.face
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(_vec3(face.positions * M_PER_MM))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(face.triangles), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(np.ascontiguousarray(face.triangles.reshape(-1), np.int32)))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    extent = np.stack([face.positions.min(axis=0), face.positions.max(axis=0)]) * M_PER_MM
    mesh.CreateExtentAttr(_vec3(extent))
    mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex).Set(_vec3(vertex_colours(face)))
    if face.uv is not None:
        primvar = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray,
                                                          UsdGeom.Tokens.vertex)  # fmt: skip
        primvar.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(face.uv, np.float32)))
    part = face.part[face.triangles[:, 0]]
    for index in np.unique(part):
        rows = Vt.IntArray.FromNumpy(np.flatnonzero(part == index).astype(np.int32))
        UsdGeom.Subset.CreateGeomSubset(mesh, PARTS[index], UsdGeom.Tokens.face, rows)
    return mesh


def shape_tokens(names: tuple[str, ...]) -> list[str]:
    """Return names as USD allows them: letters, digits and underscores, all different."""
    tokens: list[str] = []
    for name in names:
        token = re.sub(r"\W", "_", name, flags=re.ASCII)
        token = f"_{token}" if token[0].isdigit() else token
        while token in tokens:
            token += "_"
        tokens.append(token)
    return tokens


def _vec3(rows: np.ndarray):
    from pxr import Vt

    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(rows, np.float32))


def _identity():
    from pxr import Gf

    return Gf.Matrix4d(1.0)
