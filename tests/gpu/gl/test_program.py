"""What a driver refuses is told at our file and line."""

import re

import pytest

import gpu.sources
from gpu.gl.program import compile_program
from gpu.sources import ShaderError

VERTEX = "#version 330 core\nvoid main() { gl_Position = vec4(0.0); }\n"


def write(folder, **texts):
    (folder / "glsl").mkdir()
    for name, text in texts.items():
        (folder / "glsl" / name.replace("_", ".")).write_text(text)


def test_a_mistake_in_an_included_file_is_told_there(offscreen, tmp_path, monkeypatch):
    broken = "// soft\nfloat soft() {\n    return missing;\n}\n"
    fragment = '#version 330 core\nout vec4 c;\n#include "part.glsl"\nvoid main() { c = vec4(soft()); }\n'
    write(tmp_path, a_vert=VERTEX, a_frag=fragment, part_glsl=broken)
    monkeypatch.setattr(gpu.sources, "files", lambda package: tmp_path)
    with pytest.raises(ShaderError, match="missing") as caught:
        compile_program(offscreen.ctx, "glsl/a.vert", "glsl/a.frag")
    assert (caught.value.file, caught.value.line) == ("glsl/part.glsl", 3)
    assert caught.value.offending == "return missing;"


def test_a_mistake_after_an_include_keeps_its_own_line(offscreen, tmp_path, monkeypatch):
    vertex = '#version 330 core\n#include "part.glsl"\nvoid main() {\n    gl_Position = nowhere;\n}\n'
    fragment = "#version 330 core\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"
    write(tmp_path, a_vert=vertex, a_frag=fragment, part_glsl="float a() { return 1.0; }\n")
    monkeypatch.setattr(gpu.sources, "files", lambda package: tmp_path)
    with pytest.raises(ShaderError) as caught:
        compile_program(offscreen.ctx, "glsl/a.vert", "glsl/a.frag")
    assert (caught.value.file, caught.value.line) == ("glsl/a.vert", 4)


def test_stages_that_do_not_fit_are_a_shader_error(offscreen, tmp_path, monkeypatch):
    vertex = "#version 330 core\nout vec3 x;\nvoid main() { x = vec3(0.0); gl_Position = vec4(0.0); }\n"
    fragment = "#version 330 core\nin vec4 x;\nout vec4 c;\nvoid main() { c = x; }\n"
    write(tmp_path, a_vert=vertex, a_frag=fragment)
    monkeypatch.setattr(gpu.sources, "files", lambda package: tmp_path)
    with pytest.raises(ShaderError, match=re.escape("glsl/a.frag")):
        compile_program(offscreen.ctx, "glsl/a.vert", "glsl/a.frag")
