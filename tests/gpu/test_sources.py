"""Shader text is joined, guarded and traced back to our lines, without any device."""

import re

import pytest

import gpu.sources
from gpu.sources import ShaderError, shader_error, shader_source


@pytest.fixture
def shaders(tmp_path, monkeypatch):
    """A ``shaders`` folder of the test's own; returns a function that writes a file into it."""
    monkeypatch.setattr(gpu.sources, "files", lambda package: tmp_path)

    def write(name: str, text: str) -> None:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    return write


def numbered(text: str) -> dict[str, tuple[str, int]]:
    """What a preprocessor makes of ``#line``: each code line with the file and line it is said to be at."""
    at, file, seen = 1, "0", {}
    for line in text.splitlines():
        directive = re.match(r'#line (\d+) "?([^"]*)"?', line)
        if directive:
            at, file = int(directive[1]), directive[2]
            continue
        seen[line] = (file, at)
        at += 1
    return seen


def test_each_line_keeps_its_own_file_and_number_across_includes_and_defines(shaders):
    shaders("glsl/a.frag", '#version 330 core\nfloat one;\n#include "b.glsl"\nfloat four = SIZE;\n')
    shaders("glsl/b.glsl", 'float b_one;\n#include "parts/c.glsl"\nfloat b_three;')
    shaders("glsl/parts/c.glsl", "float c_one;\nfloat c_two;\n")
    text = shader_source("glsl/a.frag", {"SIZE": 3.0})
    assert text.startswith("#version 330 core\n#define SIZE 3.0\n")
    assert "#include" not in text
    places = numbered(text)
    assert places["float one;"] == ("0", 2)
    assert places["float b_one;"] == ("1", 10001)
    assert places["float c_two;"] == ("2", 20002)
    assert places["float b_three;"] == ("1", 10003)
    assert places["float four = SIZE;"] == ("0", 4)


def test_opencl_lines_carry_names_and_single_precision_defines(shaders):
    shaders("opencl/k.cl", '// kernel\n#include "types.clh"\nfloat x = SCALE;\n')
    shaders("opencl/types.clh", "typedef int node;\n")
    text = shader_source("opencl/k.cl", {"SCALE": 0.5})
    assert "#define SCALE 0.5f" in text
    places = numbered(text)
    assert places["typedef int node;"] == ("opencl/types.clh", 1)
    assert places["float x = SCALE;"] == ("opencl/k.cl", 3)


def test_a_file_included_twice_is_pasted_once_and_a_ring_ends(shaders):
    shaders("glsl/a.vert", '#include "b.glsl"\n#include "b.glsl"\nint a;\n')
    shaders("glsl/b.glsl", '#include "a.vert"\nint b;\n')
    text = shader_source("glsl/a.vert")
    assert text.count("int b;") == 1
    assert text.count("int a;") == 1


def test_a_define_that_only_a_comment_mentions_is_refused(shaders):
    shaders("opencl/k.cl", "// SPEED matters\n/* SPEED\n too */\nint WARP_SPEED;\n")
    with pytest.raises(ShaderError, match="SPEED"):
        shader_source("opencl/k.cl", {"SPEED": 1})
    assert "#define WARP_SPEED 1" in shader_source("opencl/k.cl", {"WARP_SPEED": True})


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ('#include "missing.glsl"', "missing.glsl"),
        ("#include <math.h>", "written"),
        ('#include "../../secret.txt"', "leaves"),
        ('#include "/etc/hostname"', "leaves"),
    ],
)
def test_a_bad_include_is_reported_where_it_stands(shaders, line, problem):
    shaders("glsl/a.frag", f"int a;\n{line}\n")
    with pytest.raises(ShaderError, match=problem) as caught:
        shader_source("glsl/a.frag")
    assert (caught.value.file, caught.value.line) == ("glsl/a.frag", 2)


def test_a_missing_shader_is_named():
    with pytest.raises(ShaderError, match=r"glsl/nothing\.frag"):
        shader_source("glsl/nothing.frag")


@pytest.mark.parametrize(
    "log",
    [
        "0:1(1): warning: unused\n0:10002(7): error: `wrong' undeclared",
        "1(10002) : error C1503: undefined variable wrong",
        "ERROR: 1:10002: 'wrong' : undeclared identifier",
    ],
    ids=["mesa", "nvidia", "apple"],
)
def test_a_glsl_log_leads_to_our_file_line_and_text(shaders, log):
    shaders("glsl/a.frag", 'int a;\n#include "b.glsl"\n')
    shaders("glsl/b.glsl", "int b;\n  int c = wrong;\n")
    error = shader_error("glsl/a.frag", log)
    assert (error.file, error.line, error.offending) == ("glsl/b.glsl", 2, "int c = wrong;")
    assert "wrong" in str(error)
    assert "glsl/b.glsl:2" in str(error)
    assert error.log == log


def test_an_opencl_log_leads_to_our_file_line_and_text(shaders):
    shaders("opencl/k.cl", "int a;\nint c = wrong;\n")
    error = shader_error("opencl/k.cl", "1 error\nopencl/k.cl:2:9: error: use of undeclared identifier 'wrong'")
    assert (error.file, error.line, error.offending) == ("opencl/k.cl", 2, "int c = wrong;")


def test_a_log_without_a_place_still_tells_its_first_line(shaders):
    shaders("glsl/a.frag", "int a;\n")
    error = shader_error("glsl/a.frag", "error: out of registers\nmore")
    assert error.line is None
    assert str(error) == "glsl/a.frag: error: out of registers"
