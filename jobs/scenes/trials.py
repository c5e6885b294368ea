"""The small scenes: each tests one part of the renderer, some against an exact answer."""

import math
import random

from glb import Glb, cut_out, diffuse, emitter, glass, metal, texture_info
from images import checker, png, tiles
from shapes import block, box, cylinder, joined, octahedron, quad, room, sphere, wall

CUBE = ((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))


def furnace():
    s = Glb(
        "furnace",
        "Energy: albedo 0.5 everywhere, and the meaning of `max_depth`.",
        "all walls, radiance 1",
        "closed",
        "every pixel has the expectation 2 - 2^(1 - max_depth), the sum of 0.5^k for k < max_depth",
    )
    glowing = s.material(emitter("walls", (1.0, 1.0, 1.0), albedo=(0.5, 0.5, 0.5)))
    s.add("walls", room(*CUBE), glowing)
    s.camera("inside", (0.11, 0.05, -0.07), (-0.5, -0.23, 0.4), 90)
    return s


def furnace_sphere():
    s = Glb(
        "furnace_sphere",
        "Energy with interpolated normals: a smooth sphere of albedo 0.8 in uniform light.",
        "the black walls of a cube round it, radiance 1",
        "closed",
        "walls: 1. Sphere, `max_depth` >= 2: 0.8 (1 + cos d) / 2, where d is the angle between the "
        "shading and the geometric normal, at most 0.1; so between 0.798 and 0.8",
    )
    s.add("walls", room(*CUBE), s.material(emitter("walls", (1.0, 1.0, 1.0))))
    s.add("sphere", sphere(0.2, 64, 32), s.material(diffuse("sphere", (0.8, 0.8, 0.8))))
    s.camera("front", (0, 0.1, 0.48), (0, 0, 0), 70)
    s.camera("close", (0.02, 0.03, 0.3), (0, 0, 0), 30)
    return s


def mirror():
    radiance = (4, 3, 2)
    s = Glb(
        "mirror",
        "Delta reflection: the emitter stands behind the camera and is seen in the mirror only; it "
        "also lights the floor by way of the mirror.",
        f"one quad, radiance {radiance}, single-sided, facing the mirror",
        "open",
        "where the mirror shows the emitter, |x| < 0.6 and 0.6 < y < 1.8 at z = 3, a pixel is "
        f"{radiance}",
    )
    s.add("floor", wall("+y", 0.0, (-3, 3), (-3, 4)), s.material(diffuse("floor", (0.5, 0.5, 0.5))))
    perfect = s.material(metal("mirror", (1, 1, 1), 0.0))
    s.add("mirror", wall("+z", -2.0, (-1, 1), (0.2, 2.2)), perfect)
    light = s.material(emitter("light", radiance))
    s.add("emitter", wall("-z", 3.0, (-0.6, 0.6), (0.6, 1.8)), light)
    s.camera("front", (0, 1.2, 1.0), (0, 1.0, -2), 60)
    return s


def glass_room():
    s = Glb(
        "glass",
        "Delta refraction: a ball and a tilted slab of glass (IOR 1.5, closed meshes) over a "
        "textured floor.",
        "most of the ceiling, radiance 1.6, facing down: large, so that chance finds the caustics",
        "closed",
    )
    white = s.material(diffuse("white", (0.74, 0.74, 0.74)))
    red = s.material(diffuse("red", (0.65, 0.18, 0.12)))
    blue = s.material(diffuse("blue", (0.14, 0.24, 0.60)))
    image = s.texture("checker", checker((60, 66, 80), (222, 220, 214)))
    floor = s.material(diffuse("floor", texture=texture_info(image, scale=(2, 2))))
    side, height = (-2.0, 2.0), (0.0, 3.0)
    s.add("floor", wall("+y", 0.0, side, side), floor)
    s.add("white walls", room((-2, 0, -2), (2, 3, 2), ("+y", "+x", "-x")), white)
    s.add("left", wall("+x", -2.0, side, height), red)
    s.add("right", wall("-x", 2.0, side, height), blue)
    light = s.material(emitter("light", (1.6, 1.6, 1.6)))
    s.add("lamp", wall("-y", 2.98, (-1.6, 1.6), (-1.6, 1.6)), light)
    clear = s.material(glass("glass"))
    s.add("ball", sphere(0.5, 64, 32), clear, at=(-0.7, 0.55, -0.2))
    s.add("slab", box((-0.55, -0.06, -0.55), (0.55, 0.06, 0.55)), clear, (0.75, 0.6, 0.1), tilt(20))
    s.camera("front", (0, 1.3, 1.95), (0, 0.75, -0.4), 60)
    return s


def slab():
    radiance = 20000
    s = Glb(
        "slab",
        "Caustics seen through glass: a small lamp and the camera above a slab of glass (IOR 1.5), a "
        "floor below it. Nothing joins the floor to the lamp or to the camera but by way of the slab.",
        f"a quad of 4 x 4 cm, radiance {radiance}, facing down",
        "open",
        "`max_depth` 6: a ray at the angle a to the vertical, b in the glass, sin a = 1.5 sin b, "
        "passes the slab with (1 - F(a))^2, and moves sideways by 0.2 tan b + 0.8 tan a from the "
        "camera or by 0.2 tan b + 1.8 tan a from the lamp, at height 1 and 2, down to the floor",
    )
    grey = s.material(diffuse("floor", (0.5, 0.5, 0.5)))
    s.add("floor", wall("+y", 0.0, (-4, 4), (-4, 4)), grey)
    s.add("slab", box((-5, 0.4, -5), (5, 0.6, 5)), s.material(glass("glass")))
    light = s.material(emitter("lamp", (radiance,) * 3))
    s.add("lamp", wall("-y", 2.0, (-0.02, 0.02), (-0.02, 0.02)), light)
    s.camera("above", (1.5, 1.0, 0.2), (1.5, 0, 0.2), 50, up=(0, 0, -1))  # sees no mirrored lamp
    return s


def tilt(degrees):
    """A quaternion: a turn about the z axis."""
    return (0, 0, math.sin(math.radians(degrees) / 2), math.cos(math.radians(degrees) / 2))


def many_lights():
    s = Glb(
        "many_lights",
        "Choosing among lights: 200 small emitters, of a thousandfold range of radiance, among "
        "pillars.",
        "200 quads and octahedra, radiance 4 to 4000; 3 point lights, 2 spots",
        "closed",
    )
    white = s.material(diffuse("white", (0.70, 0.70, 0.70)))
    warm = s.material(diffuse("warm", (0.62, 0.48, 0.36)))
    s.add("room", room((-5, 0, -4), (5, 3.5, 4)), white)
    pillars = [(x, z) for x in (-3.0, -1.0, 1.0, 3.0) for z in (-1.6, 1.6)]
    shaft = s.mesh("pillar", cylinder(0.3, 3.5, 24), warm)
    for i, (x, z) in enumerate(pillars):
        s.node(f"pillar {i}", shaft, (x, 0, z))
    many_emitters(s, pillars)
    s.point_light("point 0", (-4.2, 1.2, -3.2), 1.5, (1.0, 0.6, 0.3))
    s.point_light("point 1", (0.0, 3.1, 0.0), 2.5)
    s.point_light("point 2", (4.3, 0.6, 3.3), 1.0, (0.3, 0.6, 1.0))
    s.spot_light("spot 0", (-2.0, 3.3, 0.0), (0.3, -1, 0.1), (15, 35), 9.0, (0.7, 1.0, 0.7))
    s.spot_light("spot 1", (2.0, 3.3, -3.0), (-0.2, -1, 0.5), (5, 25), 12.0, (1.0, 0.8, 0.9))
    s.camera("corner", (-4.7, 2.3, 3.7), (1.5, 1.0, -1.0), 60, 4 / 3)
    return s


def many_emitters(s, pillars):
    """40 materials, two shapes, 200 places that touch no pillar and no wall."""
    draw = random.Random(20150427).random
    shapes = [quad((-0.5, -0.5, 0), (1, 0, 0), (0, 1, 0)), octahedron(0.5)]
    meshes = []
    for i in range(40):
        radiance = 4.0 * 1000.0 ** (i / 39)
        colour = [0.25 + 0.75 * draw() for _ in range(3)]
        light = s.material(emitter(f"light {i}", tuple(radiance * c for c in colour)))
        meshes.append(s.mesh(f"quad {i}", shapes[0], light))
        meshes.append(s.mesh(f"octahedron {i}", shapes[1], light))
    for i in range(200):
        while True:
            at = (9.4 * draw() - 4.7, 3.2 * draw() + 0.15, 7.4 * draw() - 3.7)
            if all((at[0] - x) ** 2 + (at[2] - z) ** 2 > 0.5**2 for x, z in pillars):
                break
        # Dimmer ones are larger, so that no few of them own all the power.
        scale = (0.10 + 0.06 * draw()) * 1000.0 ** (-(i // 2 % 40) / 39 / 3)
        turn = [draw() - 0.5 for _ in range(4)]
        length = math.sqrt(turn[0] ** 2 + turn[1] ** 2 + turn[2] ** 2 + turn[3] ** 2)
        s.node(f"emitter {i}", meshes[i % 80], at, [c / length for c in turn], scale)


def sides():
    s = Glb(
        "sides",
        "Which side shines: from left to right a quad facing `front`, one facing `back`, a "
        "double-sided one, a textured one, and one behind a masked grille.",
        "quads, radiance 2 (the textured one 2 times its image)",
        "open",
        "with `max_depth` 1, from `front`: 2, 0, 2, twice the image (red upper left, green upper "
        "right, blue lower left, white lower right), 2 between the bars and 0 on them; from "
        "`back`, in the same order: 0, 2, 2, 0, 0; all else 0",
    )
    s.add("floor", wall("+y", 0.0, (-5, 5), (-3, 3)), s.material(diffuse("floor", (0.6, 0.6, 0.6))))
    one_side = s.material(emitter("single-sided", (2.0, 2.0, 2.0)))
    both = s.material(emitter("double-sided", (2.0, 2.0, 2.0), double_sided=True))
    colours = [[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (255, 255, 255)]]
    image = s.texture("four colours", png(16, 16, lambda x, y: colours[y // 8][x // 8]))
    textured = s.material(emitter("textured", (2.0, 2.0, 2.0), texture=texture_info(image)))
    x, up = [-4.0, -2.2, -0.4, 1.4, 3.2], (0.6, 1.6)
    s.add("facing front", wall("+z", 0.0, (x[0], x[0] + 1), up), one_side)
    s.add("facing back", wall("-z", 0.0, (x[1], x[1] + 1), up), one_side)
    s.add("facing both", wall("+z", 0.0, (x[2], x[2] + 1), up), both)
    s.add("textured", quad((x[3], up[0], 0), (1, 0, 0), (0, 1, 0)), textured)
    s.add("behind the grille", wall("+z", 0.0, (x[4], x[4] + 1), up), one_side)
    stripes = png(32, 32, lambda i, j: (128, 128, 128, 255 if i // 8 % 2 else 0))
    bars = texture_info(s.texture("stripes", stripes), scale=(2, 1))
    grille = s.material(cut_out("grille", bars))
    s.add("grille", quad((x[4] - 0.2, up[0] - 0.2, 0.3), (1.4, 0, 0), (0, 1.4, 0)), grille)
    s.camera("front", (0, 1.6, 6.5), (0, 0.9, 0), 40, 2.0)
    s.camera("back", (0, 1.6, -6.5), (0, 0.9, 0), 40, 2.0)
    return s


ABOVE = (
    "On a square film pixel (i, j) of `above` shows x = 1.5 (2 (i + 0.5) / width - 1), "
    "z = 1.5 (2 (j + 0.5) / height - 1)"
)


def floor_from_above(name, light, answer):
    """A floor of albedo 0.5 at y = 0 under one light; the camera hangs below the height of 2."""
    s = Glb(name, f"One light over a floor of albedo 0.5. {ABOVE}.", light, "open", answer)
    s.add("floor", wall("+y", 0.0, (-5, 5), (-5, 5)), s.material(diffuse("floor", (0.5, 0.5, 0.5))))
    s.camera("above", (0, 1.5, 0), (0, 0, 0), 90)
    return s


def point():
    s = floor_from_above(
        "point",
        "a point light, 10 W/sr, at (0, 2, 0)",
        "0.5 / pi x 10 x cos t / r^2 with r^2 = x^2 + z^2 + 4, cos t = 2 / r",
    )
    s.point_light("point", (0, 2, 0), 10.0)
    return s


def spot():
    s = floor_from_above(
        "spot",
        "a spot light, 10 W/sr, at (0, 2, 0), aimed straight down, half angles 20 and 30 degrees",
        "as `point`, times f^2 with f = (cos t - cos 30) / (cos 20 - cos 30) kept within [0, 1]",
    )
    s.spot_light("spot", (0, 2, 0), (0, -1, 0), (20, 30), 10.0)
    return s


def directional():
    s = floor_from_above(
        "directional",
        "a directional light, 3 W/m^2 across its direction, 30 degrees off the vertical",
        "0.5 / pi x 3 x cos 30 = 0.413497 everywhere",
    )
    s.directional_light("sun", (0.5, -math.sqrt(0.75), 0.0), 3.0)
    return s


def area():
    s = floor_from_above(
        "area",
        "a black quad, 1 by 1, radiance 5, at height 2 round the y axis, single-sided, facing down",
        "0.5 x 5 x F, F the form factor of a parallel square: the sum over its four quarters, "
        "signed, of (A / sqrt(1 + A^2) atan(B / sqrt(1 + A^2)) + B / sqrt(1 + B^2) "
        "atan(A / sqrt(1 + B^2))) / 2 pi, where A and B are the quarter's sides over the height; "
        "below the centre A = B = 1/4 and the radiance is 0.183694",
    )
    light = s.material(emitter("light", (5.0, 5.0, 5.0)))
    s.add("emitter", wall("-y", 2.0, (-0.5, 0.5), (-0.5, 0.5)), light)
    return s


def open_air():
    s = Glb(
        "open",
        "For environment maps such as `sky.hdr`: a diffuse and a metal ball and a post on a floor.",
        "none: black without an environment",
        "open",
    )
    image = s.texture("tiles", tiles((170, 165, 158), (90, 88, 86)))
    paving = s.material(diffuse("paving", texture=texture_info(image)))
    s.add("floor", wall("+y", 0.0, (-4, 4), (-4, 4)), paving)
    clay = s.material(diffuse("clay", (0.60, 0.35, 0.25)))
    steel = s.material(metal("steel", (0.9, 0.88, 0.85), 0.15))
    white = s.material(diffuse("white", (0.75, 0.75, 0.75)))
    ball = sphere(0.6, 48, 24)
    s.add("diffuse ball", ball, clay, at=(-0.8, 0.6, 0))
    s.add("metal ball", ball, steel, at=(0.8, 0.6, 0))
    s.add("post", block(0, -1.5, (0.25, 2.0, 0.25)), white)
    s.camera("front", (0, 1.4, 4.0), (0, 0.75, 0), 45, 4 / 3)
    return s
