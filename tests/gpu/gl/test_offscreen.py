"""Pictures without a window."""

import threading

import moderngl
import numpy as np
import pytest

from core.errors import UserFacingError
from gpu.gl.offscreen import OffscreenRenderer


def two_bands(framebuffer):
    framebuffer.use()
    framebuffer.clear(0.0, 0.0, 1.0, 1.0)
    width, height = framebuffer.size
    framebuffer.clear(1.0, 0.0, 0.0, 1.0, viewport=(0, height - 5, width, 5))


@pytest.mark.parametrize("samples", [0, 4, None])
def test_the_top_row_comes_first(samples):
    with OffscreenRenderer(33, 21, samples) as offscreen:
        picture = offscreen.frame(two_bands)
    assert picture.shape == (21, 33, 3)
    assert picture.dtype == np.uint8
    assert (picture[:5] == [255, 0, 0]).all()
    assert (picture[5:] == [0, 0, 255]).all()


def test_a_picture_is_a_copy_that_outlives_the_next():
    with OffscreenRenderer(8, 8, 0) as offscreen:
        first = offscreen.frame(two_bands)
        offscreen.frame(lambda framebuffer: framebuffer.clear(0, 1, 0, 1))
    assert (first[0] == [255, 0, 0]).all()


def test_two_in_one_thread_take_turns():
    with OffscreenRenderer(8, 8, 0) as one, OffscreenRenderer(16, 16, 0) as two:
        for _ in range(2):
            assert (one.frame(lambda framebuffer: framebuffer.clear(1, 0, 0, 1)) == [255, 0, 0]).all()
            assert (two.frame(lambda framebuffer: framebuffer.clear(0, 0, 1, 1)) == [0, 0, 255]).all()
        two.release()
        assert (one.frame(lambda framebuffer: framebuffer.clear(0, 1, 0, 1)) == [0, 255, 0]).all()


def test_a_thread_of_its_own_draws_while_another_context_lives():
    pictures = []

    def work():
        with OffscreenRenderer(16, 16, 0) as mine:
            pictures.append(mine.frame(two_bands))

    with OffscreenRenderer(16, 16, 0) as here:
        before = here.frame(two_bands)
        thread = threading.Thread(target=work)
        thread.start()
        thread.join(30)
        after = here.frame(two_bands)
    assert len(pictures) == 1
    np.testing.assert_array_equal(pictures[0], before)
    np.testing.assert_array_equal(after, before)


def test_the_driver_is_named():
    with OffscreenRenderer(8, 8) as offscreen:
        assert offscreen.driver
        assert offscreen.is_software == ("llvmpipe" in offscreen.driver.lower())


def test_a_machine_without_opengl_gets_one_sentence_and_a_remedy(monkeypatch):
    def refuse(**_):
        raise Exception("eglGetDisplay failed")

    monkeypatch.setattr(moderngl, "create_context", refuse)
    with pytest.raises(UserFacingError, match="OpenGL") as caught:
        OffscreenRenderer(8, 8)
    assert caught.value.remedy


def test_a_picture_too_large_for_the_driver_gets_one_sentence():
    with pytest.raises(UserFacingError, match="1000000 by 1000000"):
        OffscreenRenderer(1_000_000, 1_000_000)
