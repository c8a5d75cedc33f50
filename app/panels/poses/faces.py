"""The two faces between list and sliders: the lips as captured, and the character in the pose."""

from __future__ import annotations

import numpy as np
from PySide6.QtWidgets import QComboBox

from app.panels.face_view import FaceView
from app.panels.pane import Choice, Pane
from app.panels.poses.posing import PosedFace
from app.pictures import FaceRig
from app.texts import poses as texts
from core.face.characters import CHARACTERS
from core.face.face import Face
from core.motion.marker_set import MarkerSet
from gpu.gl.camera import portrait_bounds
from gpu.gl.face import Style

_RIG_FILE = ""


def mouth_bounds(face: Face) -> np.ndarray:
    """Return the box, shape (2, 3), mm, from the bridge of the nose to the chin; the portrait's for unknown faces."""
    portrait = portrait_bounds(face)
    if any(name not in face.landmarks for name in ("nose_bridge", "chin", "outer_eye_left", "outer_eye_right")):
        return portrait
    bridge, chin = (face.positions[face.landmarks[name]] for name in ("nose_bridge", "chin"))
    margin, middle = 0.2 * face.outer_eye_distance, (portrait[0, 0] + portrait[1, 0]) / 2
    low, high = portrait.copy()
    low[:2] = middle - 3 * margin, chin[1] - margin
    high[:2] = middle + 3 * margin, bridge[1]
    return np.stack([low, high])


class CapturedPane(Pane):
    """A key lip shape as markers, or on the face that they move in the main window."""

    def __init__(self) -> None:
        self.view = FaceView(mouth_bounds)
        super().__init__(texts.CAPTURED, self.view, texts.NONE_YET)
        self.style = Choice([texts.FACE, texts.DOTS])
        self.style.group.idClicked.connect(lambda _: self._dress())
        self.header.addWidget(self.style)
        self._markers: MarkerSet | None = None
        self._rig: FaceRig | None = None

    def show_on(self, markers: MarkerSet | None, rig: FaceRig | None) -> None:
        """Show shapes of other markers, or on another face."""
        if markers is not self._markers:
            self._markers = markers
            self.view.set_markers(markers)
        if rig is not self._rig:
            if self._rig is None:
                self.style.button("face").setChecked(True)
            self._rig = rig
            self.view.set_rig(rig)
        self.style.button("face").setEnabled(rig is not None)
        self._dress()

    def show_shape(self, moved: np.ndarray | None, otherwise: str) -> None:
        """Show markers displaced from rest, shape (n_markers, 3), mm; without, a sentence."""
        if moved is None:
            self.show_empty(otherwise)
        else:
            self.show_content()
            self.view.show_pose(moved)

    def _dress(self) -> None:
        self.view.set_style(Style.TEXTURED if self.style.key == "face" else Style.MARKERS)


class PosedPane(Pane):
    """The character that is posed, and which one it is.

    ``characters`` lists ours, and the rig file on show
    """

    def __init__(self) -> None:
        self.view = FaceView(mouth_bounds)
        super().__init__(texts.POSED, self.view, texts.OPENING_RIG + "…")
        self.characters = QComboBox(toolTip=texts.CHARACTER_TIP)
        self.characters.setProperty("role", "small")
        for name, character in CHARACTERS.items():
            self.characters.addItem(character.description.split(",")[0], name)
        self.characters.addItem(texts.RIG_FILE, _RIG_FILE)
        self.header.addWidget(self.characters)
        self._face: PosedFace | None = None

    @property
    def asked(self) -> str:
        """The character that is chosen in the list; nothing for a rig file."""
        return self.characters.currentData()

    def show_face(self, face: PosedFace | None) -> None:
        """Show another character, and say in the list which."""
        if face is None:
            return
        if face is not self._face:
            self._face = face
            self.view.set_rig(face)
            self.show_content()
        place = self.characters.findData(face.face.name)
        if place < 0:
            place = self.characters.count() - 1
            self.characters.insertItem(place, face.face.name, face.face.name)
        self.characters.setCurrentIndex(place)

    def show_values(self, values: np.ndarray | None) -> None:
        """Pose it by controls, shape (U,); None is rest."""
        if self._face is not None:
            self.view.show_pose(np.zeros(len(self._face.rig.names)) if values is None else values)
