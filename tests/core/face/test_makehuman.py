import numpy as np
import pytest

from core.face.makehuman import BaseMesh

AROUND, LONG = 8, 6


@pytest.fixture(scope="module")
def tube():
    """A tube of LONG rings of AROUND vertices, in the group body, and a stray quad in a group nobody wants."""
    lines = []
    for ring in range(LONG):
        for k in range(AROUND):
            angle = 2 * np.pi * k / AROUND
            lines.append(f"v {np.cos(angle)} {np.sin(angle)} {ring}")
            lines.append(f"vt {k / AROUND} {ring / LONG}")
    lines.append("g body")
    for ring in range(LONG - 1):
        for k in range(AROUND):
            corners = [(ring, k), (ring, k + 1), (ring + 1, k + 1), (ring + 1, k)]
            numbers = [r * AROUND + c % AROUND + 1 for r, c in corners]
            lines.append("f " + " ".join(f"{n}/{n}" for n in numbers))
    lines += ["g joint-head", "f 1/1 2/2 3/3 4/4"]
    return BaseMesh("# a comment\n" + "\n".join(lines) + "\n")


def test_only_wanted_groups_are_read(tube):
    assert len(tube.positions) == AROUND * LONG
    assert len(tube.quads) == AROUND * (LONG - 1)
    np.testing.assert_allclose(tube.uv[AROUND + 3], [3 / AROUND, 1 / LONG])


@pytest.mark.parametrize("ring", [1, 2, 4])
def test_an_edge_loop_goes_once_round(tube, ring):
    loop = tube.edge_loop(ring * AROUND, ring * AROUND + 1)
    assert sorted(loop) == list(range(ring * AROUND, (ring + 1) * AROUND))


def test_behind_a_loop_lies_one_side_of_it(tube):
    behind = tube.behind(2 * AROUND, 2 * AROUND + 1, inside=5 * AROUND)
    assert behind.tolist() == list(range(3 * AROUND, LONG * AROUND))
