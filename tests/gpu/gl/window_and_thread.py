"""Run under a screen by test_window.py: one face in a QOpenGLWidget, the same in a thread of its own; both compared."""

import threading

import moderngl
import numpy as np
from conftest import make_head
from PySide6.QtCore import QTimer
from PySide6.QtGui import QImage, QSurfaceFormat
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QApplication

from gpu.gl.camera import Camera
from gpu.gl.face import FaceRenderer
from gpu.gl.offscreen import OffscreenRenderer

HEAD = make_head()
CAMERA = Camera.front(np.array([[-90.0] * 3, [90.0] * 3])).orbited(20, 5)
SIZE = (200, 150)


class Panel(QOpenGLWidget):
    def initializeGL(self):
        self.ctx = moderngl.create_context()
        self.renderer = FaceRenderer(self.ctx)
        self.renderer.set_face(HEAD)

    def paintGL(self):
        self.renderer.draw(self.ctx.detect_framebuffer(self.defaultFramebufferObject()), CAMERA)


def film(pictures: list) -> None:
    with OffscreenRenderer(*SIZE, samples=0) as offscreen:
        renderer = FaceRenderer(offscreen.ctx)
        renderer.set_face(HEAD)
        pictures += [offscreen.frame(lambda framebuffer: renderer.draw(framebuffer, CAMERA)) for _ in range(20)]
        renderer.release()


def main() -> None:
    settings = QSurfaceFormat()
    settings.setVersion(3, 3)
    settings.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    settings.setDepthBufferSize(24)
    QSurfaceFormat.setDefaultFormat(settings)
    app = QApplication([])
    panel = Panel()
    panel.resize(*SIZE)
    panel.show()
    repaint = QTimer()
    repaint.timeout.connect(panel.update)
    repaint.start(5)
    pictures: list = []
    thread = threading.Thread(target=film, args=(pictures,))
    QTimer.singleShot(50, thread.start)

    def finish_once_filmed():
        if thread.is_alive() or not pictures:
            QTimer.singleShot(50, finish_once_filmed)
            return
        image = panel.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
        rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
        shown = rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)
        difference = np.abs(shown.astype(int) - pictures[-1])
        print(len(pictures), shown.max(), round(float(difference.mean()), 4))
        app.quit()

    QTimer.singleShot(200, finish_once_filmed)
    app.exec()


main()
