"""Shader text: read, joined and, when a compiler complains, traced back to our file and line.

The text lives in the ``shaders`` folder beside this package, in an editable install as in a wheel. A name is a path
in that folder: ``"opencl/costs.cl"``, ``"glsl/face.frag"``.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Callable, Mapping
from functools import cache, reduce
from importlib.resources import files

from core.errors import WorkstationError

_INCLUDE = re.compile(r'^\s*#\s*include\s+(?:"([^"]*)"|(.*))')
_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)

# GLSL knows files by number only, and Mesa 22 forgets that number in most messages: so the line number carries
# the file as well, as file * _LINES_A_FILE + line.
_LINES_A_FILE = 10_000
# Where compilers put the line: Mesa ``0:12(3): error``, NVIDIA ``0(12) : error``, others ``ERROR: 0:12: ...``
_GLSL_PLACES = (
    re.compile(r"^\s*\d+:(\d+)\(\d+\)\s*:"),
    re.compile(r"^\s*\d+\((\d+)\)\s*:"),
    re.compile(r"^\s*ERROR:\s*\d+:(\d+)\s*:"),
)
# clang's ``opencl/costs.cl:12:3: error``, perhaps behind a folder or a prefix
_OPENCL_PLACE = re.compile(r"([\w./+-]+\.(?:cl|clh|h)):(\d+)(?::\d+)?:")


class ShaderError(WorkstationError):
    """Shader text that cannot be joined or compiled.

    file, line : where in ``shaders/`` (line counts from 1; None when the compiler named no place)
    offending : the text of that line, stripped; empty when unknown
    log : all that the compiler said; empty when it was not asked
    """

    def __init__(self, file: str, line: int | None, problem: str, offending: str = "", log: str = "") -> None:
        place = file if line is None else f"{file}:{line}"
        quoted = f" | {offending}" if offending else ""
        super().__init__(f"{place}: {problem}{quoted}")
        self.file, self.line, self.offending, self.log = file, line, offending, log


def shader_source(name: str, defines: Mapping[str, int | float | str] | None = None) -> str:
    """Return the text of a shader with its includes in place and ``defines`` at its head.

    ``#include "x"`` is looked up beside the including file; a file included twice is pasted once. ``#line``
    directives around each include keep compiler messages in terms of our files (`shader_error` reads them).
    Defines follow ``#version`` where there is one. A Python float becomes a single precision constant.

    Raises `ShaderError` for a missing file, a bad include, and a define that no code of the shader mentions.
    """
    lines, _ = _join(name)
    body = "\n".join(lines)
    code = _COMMENT.sub(" ", body)
    for define in defines or {}:
        if not re.search(rf"\b{re.escape(define)}\b", code):
            raise ShaderError(name, None, f"no code of this shader uses the define {define}")

    head = [f"#define {define} {_constant(value, name)}" for define, value in (defines or {}).items()]
    version = next((at for at, line in enumerate(lines) if re.match(r"\s*#\s*version\b", line)), None)
    start = 0 if version is None else version + 1
    if head:
        lines[start:start] = [*head, _line_directive(name, start + 1, 0)]
    return "\n".join(lines) + "\n"


def shader_error(name: str, log: str) -> ShaderError:
    """Return the error that a compiler's ``log`` for the shader ``name`` means, at our file and line."""
    _, names = _join(name)
    complaints = [line for line in log.splitlines() if "error" in line.lower()] or log.splitlines()
    for complaint in complaints:
        place = _place(complaint, names)
        if place is not None:
            file, line, problem = place
            text = _read(file, name).splitlines()
            offending = text[line - 1].strip() if 0 < line <= len(text) else ""
            return ShaderError(file, line, problem, offending, log)
    first = next((line.strip() for line in complaints if line.strip()), "the compiler failed without a message")
    return ShaderError(name, None, first, log=log)


def _place(complaint: str, names: list[str]) -> tuple[str, int, str] | None:
    for pattern in _GLSL_PLACES:
        match = pattern.match(complaint)
        if match:
            number, line = divmod(int(match[1]), _LINES_A_FILE)
            return (names[number], line, complaint[match.end() :].strip()) if number < len(names) else None
    match = _OPENCL_PLACE.search(complaint)
    if match:
        file = next((name for name in names if match[1] == name or match[1].endswith("/" + name)), None)
        if file is not None:
            return file, int(match[2]), complaint[match.end() :].strip()
    return None


def _join(root: str) -> tuple[list[str], list[str]]:
    """Return the joined lines and the files in them; a file's place in that list is its GLSL source number."""
    names: list[str] = []

    def paste(name: str, asked_by: str, asked_at: int | None) -> list[str]:
        number = len(names)
        names.append(name)
        lines: list[str] = []
        for at, line in enumerate(_read(name, asked_by, asked_at).splitlines(), start=1):
            match = _INCLUDE.match(line)
            if not match:
                lines.append(line)
                continue
            if not match[1]:
                raise ShaderError(name, at, 'an include is written #include "file"', line.strip())
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), match[1]))
            if target.startswith(("..", "/")):
                raise ShaderError(name, at, "the include leaves the shaders folder", line.strip())
            if target not in names:
                lines += [_line_directive(target, 1, len(names)), *paste(target, name, at)]
            lines.append(_line_directive(name, at + 1, number))
        return lines

    return paste(root, root, None), names


def _read(name: str, asked_by: str, asked_at: int | None = None) -> str:
    try:
        return _text(name, files)
    except (OSError, ModuleNotFoundError) as error:
        raise ShaderError(asked_by, asked_at, f"there is no shader file {name}") from error


@cache
def _text(name: str, folder_of: Callable) -> str:
    # looking into an installed package takes some milliseconds a file, and a face has ten shaders of the same two
    return reduce(lambda folder, part: folder.joinpath(part), name.split("/"), folder_of("shaders")).read_text("utf-8")


def _line_directive(name: str, line: int, number: int) -> str:
    return f'#line {line} "{name}"' if _is_opencl(name) else f"#line {number * _LINES_A_FILE + line} {number}"


def _constant(value: float | str, name: str) -> str:
    if isinstance(value, bool):
        return str(int(value))
    if isinstance(value, float):
        return repr(value) + ("f" if _is_opencl(name) else "")
    return str(value)


def _is_opencl(name: str) -> bool:
    return name.startswith("opencl/")
