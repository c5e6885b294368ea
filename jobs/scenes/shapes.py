"""Shapes: lists of vertices and triangles, counter-clockwise seen from the side meant to be seen.

Coordinates are rounded to a tenth of a micrometre: where a C library's sine differs in its last
bit, the file does not.
"""

import math

DIGITS = 7


class Shape:
    """Positions and triangles; texture coordinates or None; normals, or None where it is flat."""

    def __init__(self, positions, triangles, uvs=None, normals=None):
        self.positions = [rounded(p) for p in positions]
        self.triangles = [tuple(t) for t in triangles]
        self.uvs = None if uvs is None else [rounded(p) for p in uvs]
        self.normals = None if normals is None else [rounded(n) for n in normals]


def rounded(values):
    """The same numbers, with DIGITS decimals and no negative zero."""
    return tuple(round(v, DIGITS) + 0.0 for v in values)


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def joined(*shapes):
    """Several shapes as one; they must agree in having texture coordinates and normals."""
    positions, triangles, uvs, normals = [], [], [], []
    for shape in shapes:
        first = len(positions)
        positions += shape.positions
        triangles += [tuple(i + first for i in t) for t in shape.triangles]
        uvs += shape.uvs or []
        normals += shape.normals or []
    if len(uvs) not in (0, len(positions)) or len(normals) not in (0, len(positions)):
        raise ValueError("joined shapes differ in their attributes")
    return Shape(positions, triangles, uvs or None, normals or None)


def flipped(shape):
    """The same surface, meant to be seen from its other side."""
    normals = shape.normals and [tuple(-c for c in n) for n in shape.normals]
    return Shape(shape.positions, [(a, c, b) for a, b, c in shape.triangles], shape.uvs, normals)


def moved(shape, offset):
    positions = [add(p, offset) for p in shape.positions]
    return Shape(positions, shape.triangles, shape.uvs, shape.normals)


def grid(columns, rows, point, hole=()):
    """Two triangles a cell over points point(column, row), facing (d/dcolumn) x (d/drow).

    `columns` and `rows` count points; cells (column, row) in `hole` are left out.
    """
    triangles = []
    for j in range(rows - 1):
        for i in range(columns - 1):
            if (i, j) not in hole:
                a, b = j * columns + i, j * columns + i + 1
                c, d = b + columns, a + columns
                triangles += [(a, b, c), (a, c, d)]
    used = sorted({i for t in triangles for i in t})
    position = {old: new for new, old in enumerate(used)}
    points = [point(i % columns, i // columns) for i in used]
    return Shape(points, [tuple(position[i] for i in t) for t in triangles])


def quad(corner, u, v):
    """A parallelogram that faces u x v. Its image stands upright with u to the right and v up."""
    positions = [corner, add(corner, u), add(add(corner, u), v), add(corner, v)]
    uvs = [(0, 1), (1, 1), (1, 0), (0, 0)]
    return Shape(positions, [(0, 1, 2), (0, 2, 3)], uvs)


# The two axes along an axis-aligned wall, and the side that the first x the second faces.
WALL_AXES = {"x": (2, 1, "-"), "y": (0, 2, "-"), "z": (0, 1, "+")}


def wall(face, at, across, up, hole=()):
    """A rectangle that faces an axis, such as "-x", at that coordinate.

    `across` and `up` are ascending cuts along its axes (z, y for x; x, z for y; x, y for z): walls
    that share their cuts meet without T-junctions. Cells (i, j) in `hole` stay open. Texture
    coordinates are in metres.
    """
    first, second, natural = WALL_AXES[face[1]]
    normal = 3 - first - second

    def point(i, j):
        p = [0.0, 0.0, 0.0]
        p[normal], p[first], p[second] = at, across[i], up[j]
        return p

    shape = grid(len(across), len(up), point, hole)
    shape.uvs = [rounded((p[first], -p[second])) for p in shape.positions]
    return shape if face[0] == natural else flipped(shape)


def box(lo, hi, open_faces=()):
    """The outside of a box, without the faces named in `open_faces` ("-y": no bottom)."""
    x, y, z = ((lo[k], hi[k]) for k in range(3))
    cuts = {"x": (z, y), "y": (x, z), "z": (x, y)}
    faces = [(s + a, c[k], *cuts[a]) for a, c in zip("xyz", (x, y, z)) for k, s in enumerate("-+")]
    return joined(*(wall(*f) for f in faces if f[0] not in open_faces))


def block(centre_x, centre_z, size, bottom=0.0):
    """A box that stands on something: no bottom face, so that none lies in the plane below it."""
    sx, sy, sz = size
    lo = (centre_x - sx / 2, bottom, centre_z - sz / 2)
    return box(lo, (lo[0] + sx, bottom + sy, lo[2] + sz), ("-y",))


def room(lo, hi, open_faces=()):
    """A box seen from inside; `open_faces` name the way they face: "-y" is the ceiling."""
    turned = {"-": "+", "+": "-"}
    return flipped(box(lo, hi, [turned[f[0]] + f[1] for f in open_faces]))


def sphere(radius, segments, rings):
    """A smooth sphere round the origin: closed, poles on y, one vertex at each pole."""
    directions = [(0.0, 1.0, 0.0)]
    for j in range(1, rings):
        polar = math.pi * j / rings
        for i in range(segments):
            a = 2 * math.pi * i / segments
            ring = math.sin(polar)
            directions.append((ring * math.sin(a), math.cos(polar), ring * math.cos(a)))
    directions.append((0.0, -1.0, 0.0))
    last = len(directions) - 1
    triangles = []
    for i in range(segments):
        k = (i + 1) % segments
        triangles.append((0, 1 + i, 1 + k))
        for j in range(rings - 2):
            upper, lower = 1 + j * segments, 1 + (j + 1) * segments
            triangles += [(upper + i, lower + i, lower + k), (upper + i, lower + k, upper + k)]
        triangles.append((last, last - segments + k, last - segments + i))
    positions = [tuple(radius * c for c in d) for d in directions]
    return Shape(positions, triangles, normals=directions)


def cylinder(radius, height, segments):
    """The smooth side of an upright cylinder that stands on the origin, without caps."""
    angles = [2 * math.pi * i / segments for i in range(segments)]
    normals = [(math.sin(a), 0.0, math.cos(a)) for a in angles]
    positions = [(radius * n[0], y, radius * n[2]) for y in (0.0, height) for n in normals]
    triangles = []
    for i in range(segments):
        k = (i + 1) % segments
        triangles += [(i, k, k + segments), (i, k + segments, i + segments)]
    return Shape(positions, triangles, normals=normals * 2)


def disc(radius, segments, height=0.0):
    """A flat disc round the y axis that faces up."""
    angles = [2 * math.pi * i / segments for i in range(segments)]
    positions = [(radius * math.sin(a), height, radius * math.cos(a)) for a in angles]
    return Shape(positions, [(0, i, i + 1) for i in range(1, segments - 1)])


def octahedron(radius):
    r = radius
    positions = [(r, 0, 0), (-r, 0, 0), (0, r, 0), (0, -r, 0), (0, 0, r), (0, 0, -r)]
    upper = [(2, 4, 0), (2, 0, 5), (2, 5, 1), (2, 1, 4)]
    return Shape(positions, upper + [(3, c, b) for _, b, c in upper])


def arch_wall(x, z_range, radius, spring, top, segments=12):
    """A wall at `x` that faces +x, from height `spring` up, over a round arch amid `z_range`."""
    z0, z1 = z_range
    centre = (z0 + z1) / 2
    arc = arch_points(centre, radius, spring, segments)
    lower = [(spring, z1)] + arc + [(spring, z0)]
    levels = [lower, [(top, z) for _, z in lower]]
    return grid(len(lower), 2, lambda i, j: (x, levels[j][i][0], levels[j][i][1]))


def arch_soffit(x_range, z_range, radius, spring, segments=12):
    """The smooth underside of the arch of `arch_wall`, `x_range` wide."""
    centre = (z_range[0] + z_range[1]) / 2
    arc = arch_points(centre, radius, spring, segments)
    shape = flipped(grid(2, len(arc), lambda i, j: (x_range[i], arc[j][0], arc[j][1])))
    normals = [((spring - p[1]) / radius, (centre - p[2]) / radius) for p in shape.positions]
    return Shape(shape.positions, shape.triangles, normals=[(0.0, a, b) for a, b in normals])


def arch_points(centre, radius, spring, segments):
    """(y, z) along a half circle, from large z to small z."""
    angles = [math.pi * i / segments for i in range(segments + 1)]
    return [(spring + radius * math.sin(a), centre + radius * math.cos(a)) for a in angles]
