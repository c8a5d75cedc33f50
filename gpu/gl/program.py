"""GL programs from our shader files, with compile errors at our lines."""

from __future__ import annotations

from collections.abc import Mapping

import moderngl

from gpu.sources import shader_error, shader_source


def compile_program(
    ctx: moderngl.Context,
    vertex: str,
    fragment: str,
    geometry: str | None = None,
    defines: Mapping[str, int | float | str] | None = None,
) -> moderngl.Program:
    """Compile and link shader files named as in `gpu.sources.shader_source`; ``defines`` are the fragment shader's.

    Raises `gpu.sources.ShaderError` for the first stage that the driver refuses.
    """
    names = {"vertex_shader": vertex, "fragment_shader": fragment, "geometry_shader": geometry}
    texts = {
        stage: shader_source(name, defines if name is fragment else None)
        for stage, name in names.items()
        if name is not None
    }
    try:
        return ctx.program(**texts)
    except moderngl.Error as error:
        log = str(error)
        # a linker's log names no stage; the fragment shader is where its inputs and outputs meet
        blamed = next((name for stage, name in names.items() if name is not None and stage in log), fragment)
        raise shader_error(blamed, log) from error
