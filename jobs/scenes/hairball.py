"""A scene in which shadow rays are dear: a ball of hair, after the one that is common in papers on ray tracing (Laine's),
which Nabata et al. use."""

import math
import random

from glb import Glb, diffuse, emitter
from shapes import Shape, room, wall

STRANDS = 160  # of a bundle


def hairball():
    return ball("hairball", "Visibility that is dear to test and changes from pixel to pixel: 16,000 curled strands in a plain room.",
                segments=16, bundles=100)


def hairball_2800k():
    return ball("hairball_2800k", "Stand-in for the hairball of Nabata et al. and Kol et al., of as many triangles: 40,000 "
                "strands, in finer segments than those of `hairball.glb`.", segments=35, bundles=250)


def ball(name, purpose, segments, bundles):
    s = Glb(
        name,
        purpose,
        "a panel under the ceiling, radiance (30, 28, 25), facing down",
        "closed",
    )
    s.add("room", room((-2, -1.5, -2), (2, 2.5, 2)), s.material(diffuse("room", (0.75, 0.72, 0.68))))
    s.add("light", wall("-y", 2.49, (-0.5, 0.5), (-0.5, 0.5)), s.material(emitter("light", (30, 28, 25))))
    draw = random.Random(1)
    bundle = s.mesh("strands", strands(draw, segments), s.material(diffuse("hair", (0.6, 0.45, 0.3))))
    for i in range(bundles):
        s.node(f"strands {i}", bundle, turn=any_turn(draw))
    s.camera("front", (0.3, 0.4, 1.95), (0, -0.1, 0), 75)
    return s


def strands(draw, segments):
    """Ribbons from near the centre to about one metre from it, each curled its own way."""
    positions, triangles = [], []
    for _ in range(STRANDS):
        first = len(positions)
        along, side, third = any_frame(draw)
        length, curl, turns = draw.uniform(0.7, 1.0), draw.uniform(0.02, 0.12), draw.uniform(1, 4)
        start, width = draw.uniform(0.05, 0.3), 0.0035
        for k in range(segments + 1):
            t = k / segments
            angle = 2 * math.pi * turns * t
            a, b, c = start + (length - start) * t, curl * t * math.cos(angle), curl * t * math.sin(angle)
            at = [a * along[i] + b * side[i] + c * third[i] for i in range(3)]
            # The ribbon lies across the curl, thinner towards its end.
            half = [width * (1 - 0.7 * t) * (math.cos(angle) * third[i] - math.sin(angle) * side[i]) for i in range(3)]
            positions += [tuple(at[i] - half[i] for i in range(3)), tuple(at[i] + half[i] for i in range(3))]
        for k in range(segments):
            a = first + 2 * k
            triangles += [(a, a + 2, a + 1), (a + 1, a + 2, a + 3)]
    return Shape(positions, triangles)


def any_direction(draw):
    while True:
        v = [draw.uniform(-1, 1) for _ in range(3)]
        length = math.sqrt(sum(c * c for c in v))
        if 0.1 < length <= 1:
            return [c / length for c in v]


def any_frame(draw):
    """Three unit vectors at right angles."""
    u, v = any_direction(draw), any_direction(draw)
    w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(c * c for c in w))
    if length < 0.1:
        return any_frame(draw)
    w = [c / length for c in w]
    return u, w, [u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]]


def any_turn(draw):
    """A quaternion, uniform over all rotations (Shoemake 1992)."""
    u, v, w = (draw.random() for _ in range(3))
    a, b = math.sqrt(1 - u), math.sqrt(u)
    v, w = 2 * math.pi * v, 2 * math.pi * w
    return [a * math.sin(v), a * math.cos(v), b * math.sin(w), b * math.cos(w)]
