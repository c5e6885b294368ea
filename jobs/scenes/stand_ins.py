"""Scenes of the kind of some that papers use and that are not to be had: stand-ins, not copies. What is measured on them is
not the papers' numbers."""

import math
import random

from glb import Glb, cross, diffuse, emitter, metal, plastic, subtract, unit
from hairball import any_frame
from shapes import Shape, arch_soffit, arch_wall, block, box, cylinder, disc, flipped, joined, moved, quad, room, sphere, wall


def nave():
    radiance = (260, 240, 205)
    s = Glb(
        "nave",
        "Stand-in for Sibenik: a church with a nave between columns, two aisles and a choir; the nave is dark, its light "
        "comes from behind the columns.",
        f"two panels high in the choir's side walls, radiance {radiance}, hidden from the door",
        "closed",
    )
    stone = s.material(diffuse("stone", (0.66, 0.62, 0.55)))
    vault = s.material(diffuse("vault", (0.72, 0.70, 0.66)))
    paving = s.material(diffuse("paving", (0.48, 0.42, 0.36)))
    nave_shell(s, stone, vault, paving)
    for side in (-1, 1):
        panel = quad((side * 5.49, 3.2, -11.2), (0, 0, side * 1.6), (0, 1.8, 0))
        s.add(f"lamp {'left' if side < 0 else 'right'}", flipped(panel), s.material(emitter("light", radiance)))
    s.add("altar", block(0, -10.2, (2.0, 1.0, 0.9)), vault)
    pew = s.mesh("pew", block(0, 0, (2.2, 0.85, 0.4)), s.material(diffuse("wood", (0.36, 0.22, 0.13))))
    for i in range(6):
        for x in (-1.5, 1.5):
            s.node(f"pew {i} {'left' if x < 0 else 'right'}", pew, (x, 0, 5.5 - 1.6 * i))
    s.camera("door", (0.4, 1.7, 8.6), (-0.3, 2.4, -6), 60, 4 / 3)
    s.camera("aisle", (4.3, 1.6, 8.4), (2.4, 2.0, -4), 60, 4 / 3)
    return s


# The nave |x| < NAVE, walls on arches up to AISLE, aisles beyond. Bays along z.
NAVE_BAYS = [-7.5 + 2.75 * i for i in range(7)]  # up to 9
NAVE, AISLE, SIDE = 2.9, 3.3, 5.5
NAVE_SPRING, NAVE_ARCH, NAVE_TOP, AISLE_TOP, CHOIR = 2.8, 1.05, 9.0, 5.2, -12.0


def nave_shell(s, stone, vault, paving):
    ends = (NAVE_BAYS[0], NAVE_BAYS[-1])
    across = (-SIDE, -AISLE, -NAVE, NAVE, AISLE, SIDE)
    levels = (0.0, AISLE_TOP, NAVE_TOP)
    s.add("floor", wall("+y", 0.0, across, (CHOIR, *NAVE_BAYS)), paving)
    sides = [wall(face, x, (CHOIR, *NAVE_BAYS), (0.0, AISLE_TOP)) for face, x in (("+x", -SIDE), ("-x", SIDE))]
    ends_of = [wall("-z", ends[1], across, levels, [(0, 1), (1, 1), (3, 1), (4, 1)])]
    ends_of.append(wall("+z", CHOIR, across, (0.0, AISLE_TOP)))
    # Over the arch between nave and choir, whose ceiling is as low as that of the aisles.
    ends_of.append(wall("+z", ends[0], across, levels, [(i, 0) for i in range(5)] + [(0, 1), (1, 1), (3, 1), (4, 1)]))
    s.add("outer walls", joined(*sides, *ends_of), stone)
    ceilings = [wall("-y", AISLE_TOP, x, NAVE_BAYS) for x in ((-SIDE, -AISLE, -NAVE), (NAVE, AISLE, SIDE))]
    ceilings += [wall("-y", AISLE_TOP, across, (CHOIR, ends[0])), wall("-y", NAVE_TOP, (-NAVE, NAVE), NAVE_BAYS)]
    s.add("ceilings", joined(*ceilings), vault)
    walls, soffits = [], []
    for z in zip(NAVE_BAYS, NAVE_BAYS[1:]):
        walls.append(arch_wall(-NAVE, z, NAVE_ARCH, NAVE_SPRING, NAVE_TOP))
        walls.append(flipped(arch_wall(-AISLE, z, NAVE_ARCH, NAVE_SPRING, AISLE_TOP)))
        walls.append(flipped(arch_wall(NAVE, z, NAVE_ARCH, NAVE_SPRING, NAVE_TOP)))
        walls.append(arch_wall(AISLE, z, NAVE_ARCH, NAVE_SPRING, AISLE_TOP))
        soffits += [arch_soffit(x, z, NAVE_ARCH, NAVE_SPRING) for x in ((-AISLE, -NAVE), (NAVE, AISLE))]
    s.add("arches", joined(*walls), stone)
    s.add("soffits", joined(*soffits), stone)
    shaft = s.mesh("shaft", cylinder(0.24, NAVE_SPRING - 0.15, 24), stone)
    capital = s.mesh("capital", box((-0.34, NAVE_SPRING - 0.15, -0.34), (0.34, NAVE_SPRING, 0.34)), stone)
    middle = (NAVE + AISLE) / 2
    for i, z in enumerate(NAVE_BAYS):
        for x in (-middle, middle):
            side = "left" if x < 0 else "right"
            s.node(f"{side} shaft {i}", shaft, (x, 0, z))
            s.node(f"{side} capital {i}", capital, (x, 0, z))


# Along z: the rooms of `flat`, wall to wall; the doors stand now left, now right.
FLAT_ROOMS = [(0.0, 4.6), (-4.8, -0.2), (-9.6, -5.0), (-14.4, -9.8)]
FLAT_DOORS = [(-1.7, -0.8), (0.8, 1.7), (-1.7, -0.8)]
FLAT_X, FLAT_HEIGHT, FLAT_DOOR = 2.2, 2.6, 2.05


def flat():
    radiance = (900, 870, 800)
    s = Glb(
        "flat",
        "Stand-in for the apartment: four rooms in a row whose doors do not face each other, on a glossy floor; the light "
        "is in the last, the camera in the first.",
        f"a panel of 1.6 x 1.2 m under the last room's ceiling, radiance {radiance}, facing down",
        "closed",
    )
    white = s.material(diffuse("white", (0.76, 0.75, 0.72)))
    cuts = (-FLAT_X, *FLAT_DOORS[0], *FLAT_DOORS[1], FLAT_X)
    levels = (0.0, FLAT_DOOR, FLAT_HEIGHT)
    floors, ceilings, walls = [], [], []
    for i, z in enumerate(FLAT_ROOMS):
        floors.append(wall("+y", 0.0, cuts, z))
        ceilings.append(wall("-y", FLAT_HEIGHT, cuts, z))
        walls += [wall("+x", -FLAT_X, z, levels), wall("-x", FLAT_X, z, levels)]
        walls.append(wall("+z", z[0], cuts, levels, flat_opening(i)))
        walls.append(wall("-z", z[1], cuts, levels, flat_opening(i - 1)))
    for i, (low, high) in enumerate(FLAT_DOORS):
        gap = (FLAT_ROOMS[i + 1][1], FLAT_ROOMS[i][0])
        floors.append(wall("+y", 0.0, (low, high), gap))
        walls += [wall("+x", low, gap, (0.0, FLAT_DOOR)), wall("-x", high, gap, (0.0, FLAT_DOOR))]
        walls.append(wall("-y", FLAT_DOOR, (low, high), gap))
    s.add("floor", joined(*floors), s.material(metal("floor", (0.42, 0.30, 0.20), 0.25)))
    s.add("ceilings", joined(*ceilings), white)
    s.add("walls", joined(*walls), white)
    lamp = quad((-0.6, FLAT_HEIGHT - 0.02, -12.6), (1.6, 0, 0), (0, 0, 1.2))
    s.add("lamp", lamp, s.material(emitter("light", radiance)))
    wood = s.material(diffuse("wood", (0.50, 0.33, 0.19)))
    s.add("table", block(0.9, 1.6, (1.0, 0.74, 0.7)), wood)
    s.add("chair", block(0.2, 2.4, (0.42, 0.46, 0.42)), s.material(plastic("red", (0.58, 0.10, 0.08), 0.3)))
    for i, (x, z) in enumerate([(1.4, -2.6), (-1.2, -7.2), (1.5, -8.6), (-1.5, -11.4)]):
        s.add(f"crate {i}", block(0, 0, (0.7, 0.9, 0.7)), wood, at=(x, 0, z), turn=17 * i)
    s.camera("first room", (1.7, 1.6, 4.3), (-0.9, 1.0, 0), 58, 4 / 3)
    s.camera("second room", (-1.8, 1.5, -0.6), (0.9, 1.0, -4.8), 60, 4 / 3)
    return s


def flat_opening(i):
    """The hole of door `i` in the cuts of a wall; none beyond the doors."""
    return [({0: 1, 1: 3}[i % 2], 0)] if 0 <= i < len(FLAT_DOORS) else []


def plants():
    radiance = (1500, 1350, 1000)
    s = Glb(
        "plants",
        "Stand-in for the plants: leaves before a window and in pots, with small bulbs among them; what the camera sees is "
        "lit through leaves.",
        f"three bulbs of 3 cm, radiance {radiance}, and a window, radiance (3, 4, 5)",
        "closed",
    )
    low, high = (-2.6, 0, -3), (2.6, 2.7, 3)
    s.add("room", room(low, high), s.material(diffuse("walls", (0.70, 0.68, 0.62))))
    window = wall("+z", -2.98, (-1.3, 1.3), (0.9, 2.2))
    s.add("window", window, s.material(emitter("sky", (3, 4, 5))))
    leaf = [s.material(diffuse(f"leaf {i}", c)) for i, c in enumerate([(0.20, 0.42, 0.10), (0.30, 0.46, 0.14)])]
    draw = random.Random(7)
    for i in range(6):  # a curtain of leaves before the window
        x = -1.25 + 0.5 * i
        s.add(f"hanging {i}", foliage(draw, 130, (0.32, 0.75, 0.16)), leaf[i % 2], at=(x, 1.55, -2.5))
    pot = s.mesh("pot", cylinder(0.2, 0.36, 20), s.material(diffuse("clay", (0.52, 0.25, 0.15))))
    earth = s.mesh("earth", moved(block(0, 0, (0.26, 0.01, 0.26)), (0, 0.33, 0)),
                   s.material(diffuse("earth", (0.1, 0.07, 0.05))))
    for i, (x, z) in enumerate([(-1.7, -1.2), (-0.2, -0.9), (1.5, -1.3), (-1.5, 0.9), (1.6, 0.7)]):
        s.node(f"pot {i}", pot, (x, 0, z))
        s.node(f"earth {i}", earth, (x, 0, z))
        s.add(f"plant {i}", foliage(draw, 170, (0.55, 0.6, 0.55)), leaf[i % 2], at=(x, 1.0, z))
    bulb = s.mesh("bulb", sphere(0.03, 10, 6), s.material(emitter("bulb", radiance)))
    for i, at in enumerate([(-1.7, 1.05, -1.2), (1.5, 1.1, -1.3), (-0.2, 0.95, -0.9)]):
        s.node(f"bulb {i}", bulb, at)
    s.camera("chair", (0.3, 1.3, 2.8), (-0.1, 1.0, -1), 60, 4 / 3)
    return s


def foliage(draw, count, radii):
    """`count` leaves of 5 to 9 cm, turned any way, in an ellipsoid."""
    positions, triangles = [], []
    while len(triangles) < 2 * count:
        at = [draw.uniform(-1, 1) for _ in range(3)]
        if math.sqrt(sum(c * c for c in at)) > 1:
            continue
        along, side, _ = any_frame(draw)
        half = draw.uniform(0.05, 0.09)
        first = len(positions)
        for a, b in ((-1, 0), (0, -0.5), (1, 0), (0, 0.5)):
            positions.append(tuple(at[k] * radii[k] + half * (a * along[k] + b * side[k]) for k in range(3)))
        triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return Shape(positions, triangles)


# `plates`: the lights' row and the camera, and (y, z) of the plates' middles with their roughness, the farthest first.
PLATES_LIGHTS, PLATES_EYE, PLATES_POWER = (1.7, 0.0), (0, 2.4, 6.2), 10.0
PLATES = [((0.72, 0.0), 0.08), ((0.46, 0.45), 0.15), ((0.27, 1.0), 0.25), ((0.14, 1.6), 0.4)]
PLATES_RADII = (0.36, 0.12, 0.04, 0.0133)


def plates():
    s = Glb(
        "plates",
        "Stand-in for Veach's scene of multiple importance sampling: four metal plates, the farthest the shiniest (roughness "
        "0.08, 0.15, 0.25, 0.4), mirror four lights of equal power. Each quarter of a plate's width has the image of one "
        "light. The blue of a plate's base colour, 0.4, 0.5, 0.6 or 0.7, tells which it is.",
        "discs of radius 0.36, 0.12, 0.04 and 0.0133 m from left to right, of radiance 10 / (pi radius)^2 each",
        "open",
    )
    grey = s.material(diffuse("grey", (0.4, 0.4, 0.4)))
    s.add("floor", wall("+y", 0.0, (-5, 5), (-1.2, 7)), grey)
    s.add("wall", wall("+z", -1.2, (-5, 5), (0.0, 5)), grey)
    for i, ((y, z), roughness) in enumerate(PLATES):
        to_eye, to_light = (subtract(end, (0, y, z)) for end in (PLATES_EYE, (0, *PLATES_LIGHTS)))
        far, near = (math.sqrt(sum(c * c for c in d)) for d in (to_eye, to_light))
        facing = unit(tuple(a + b for a, b in zip(unit(to_eye), unit(to_light))))
        half = 2 * far / (far + near)  # the images of lights that are 1 apart
        up = tuple(0.42 * c for c in cross(facing, (1, 0, 0)))
        corner = subtract((-half, y, z), tuple(c / 2 for c in up))
        s.add(f"plate {i}", quad(corner, (2 * half, 0, 0), up),
              s.material(metal(f"plate {i}", (0.7, 0.7, 0.4 + 0.1 * i), roughness)))
    shape, turn = disc(1.0, 24), math.radians(148.5)  # down to the plates
    for i, radius in enumerate(PLATES_RADII):
        light = s.material(emitter(f"light {i}", (PLATES_POWER / (math.pi * radius) ** 2,) * 3))
        s.node(f"light {i}", s.mesh(f"light {i}", shape, light), (i - 1.5, *PLATES_LIGHTS),
               (math.sin(turn / 2), 0, 0, math.cos(turn / 2)), radius)
    s.camera("front", PLATES_EYE, (0, 0.8, 0.6), 32, 4 / 3)
    return s
