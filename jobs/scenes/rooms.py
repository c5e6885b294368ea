"""The demo scenes: rooms, in most of which the light arrives round a corner."""

from glb import Glb, cut_out, diffuse, emitter, glass, metal, plastic, texture_info
from images import checker, leaves, tiles
from shapes import arch_soffit, arch_wall, block, box, cylinder, disc, flipped, joined, moved
from shapes import quad, sphere, wall


def cornell():
    radiance = (22, 18, 13)
    s = Glb(
        "cornell",
        "The first picture: direct light, soft shadows, colour bleeding.",
        f"a ceiling panel, radiance {radiance}, facing down",
        "open towards the camera",
    )
    white, light = cornell_walls(s, radiance)
    s.add("tall box", block(0, 0, (0.58, 1.22, 0.58)), white, at=(-0.34, 0, -0.32), turn=17)
    s.add("short box", block(0, 0, (0.56, 0.56, 0.56)), white, at=(0.37, 0, 0.3), turn=-19)
    s.add("lamp", quad((-0.3, 1.98, -0.25), (0.6, 0, 0), (0, 0, 0.5)), light)
    s.camera("front", (0, 1, 3.9), (0, 1, 0), 39)
    return s


def cornell_walls(s, radiance):
    """Adds floor, ceiling and three walls; returns the materials of the boxes and of the lamp."""
    white = s.material(diffuse("white", (0.74, 0.73, 0.70)))
    red = s.material(diffuse("red", (0.61, 0.07, 0.06)))
    green = s.material(diffuse("green", (0.13, 0.44, 0.10)))
    light = s.material(emitter("light", radiance))
    side, height = (-1.0, 1.0), (0.0, 2.0)
    shell = [wall("+y", 0.0, side, side), wall("-y", 2.0, side, side)]
    shell += [wall("+z", -1.0, side, height)]
    s.add("floor, ceiling, back", joined(*shell), white)
    s.add("left", wall("+x", -1.0, side, height), red)
    s.add("right", wall("-x", 1.0, side, height), green)
    return white, light


def cornell_ball():
    radiance = (550, 450, 325)
    s = Glb(
        "cornell_ball",
        "Caustics of a small lamp: a ball of glass (IOR 1.5) and one of mirror in a Cornell box.",
        f"a ceiling panel of 12 x 10 cm, radiance {radiance}, facing down",
        "open towards the camera",
    )
    _, light = cornell_walls(s, radiance)
    ball = sphere(0.38, 96, 48)
    s.add("glass ball", ball, s.material(glass("glass")), at=(0.42, 0.39, 0.25))
    mirror = s.material(metal("mirror", (0.95, 0.95, 0.95), 0.0))
    s.add("mirror ball", ball, mirror, at=(-0.45, 0.39, -0.3))
    s.add("lamp", quad((-0.06, 1.98, -0.05), (0.12, 0, 0), (0, 0, 0.1)), light)
    s.camera("front", (0, 1, 3.9), (0, 1, 0), 39)
    return s


def bends():
    radiance = (1400, 1500, 1700)
    s = Glb(
        "bends",
        "An S-shaped corridor: light reaches the camera round two bends, in three edges at least "
        "and mostly in more.",
        f"a panel at the far end, radiance {radiance}",
        "closed",
    )
    white = s.material(diffuse("white", (0.76, 0.75, 0.72)))
    ochre = s.material(diffuse("ochre", (0.75, 0.52, 0.24)))
    blue = s.material(diffuse("blue", (0.28, 0.42, 0.66)))
    brick = s.material(diffuse("brick", (0.66, 0.36, 0.26)))
    wood = s.material(diffuse("wood", (0.45, 0.30, 0.18)))
    tile = texture_info(s.texture("tiles", tiles((205, 200, 190), (110, 105, 100))), scale=(2, 2))
    floor = s.material(diffuse("floor", texture=tile))
    light = s.material(emitter("light", radiance))
    # Seen from above: the first leg runs along -z, the second along +x, the third along -z again.
    legs = [((-1, 1), (-5, 0)), ((-1, 1), (-7, -5)), ((1, 4), (-7, -5))]
    legs += [((4, 6), (-7, -5)), ((4, 6), (-11, -7))]
    height = (0.0, 2.5)
    s.add("floor", joined(*(wall("+y", 0.0, x, z) for x, z in legs)), floor)
    s.add("ceiling", joined(*(wall("-y", 2.5, x, z) for x, z in legs)), white)
    s.add("first left", wall("+x", -1.0, (-7, -5, 0), height), ochre)
    s.add("first right", wall("-x", 1.0, (-5, 0), height), white)
    s.add("behind the camera", wall("-z", 0.0, (-1, 1), height), white)
    s.add("second left", wall("+z", -7.0, (-1, 1, 4), height), blue)
    s.add("second right", wall("-z", -5.0, (1, 4, 6), height), white)
    s.add("third left", wall("+x", 4.0, (-11, -7), height), white)
    s.add("third right", wall("-x", 6.0, (-11, -7, -5), height), brick)
    s.add("far end", wall("+z", -11.0, (4, 6), height), white)
    s.add("bench", block(0.78, -3.0, (0.4, 0.45, 1.6)), wood)
    s.add("crate", block(0, 0, (0.5, 0.5, 0.5)), brick, at=(-0.55, 0, -5.9), turn=24)
    s.add("lamp", quad((4.4, 0.7, -10.98), (1.2, 0, 0), (0, 1.2, 0)), light)
    s.camera("entrance", (0, 1.5, -0.25), (0.25, 1.15, -7), 55, 4 / 3)
    return s


def ajar():
    radiance, degrees = (4000, 3900, 3600), 12
    s = Glb(
        "ajar",
        f"Two rooms joined by a door {degrees} degrees ajar: almost all light in the near room "
        "came through the slit. Glass, rough metal, plastic, a turned and repeated texture (its "
        "extension is a required one).",
        f"a panel under the far room's ceiling, radiance {radiance}, facing down",
        "closed",
    )
    s.required = ["KHR_texture_transform"]
    ajar_walls(s)
    lamp = quad((-1.9, 2.6, -2.9), (1.0, 0, 0), (0, 0, 0.6))
    s.add("lamp", lamp, s.material(emitter("light", radiance)))
    ajar_door(s, degrees)
    ajar_furniture(s)
    s.camera("room", (1.9, 1.6, 4.6), (-0.35, 0.95, 0.6), 50, 4 / 3)
    s.camera("table", (0.75, 1.15, 3.1), (0.35, 0.8, 1.9), 45, 4 / 3)
    return s


# The door's opening, along x, and where walls are cut so that their edges meet.
DOOR_X, DOOR_HEIGHT = (-1.4, -0.5), 2.05
AJAR_X, AJAR_Y = (-2.5, *DOOR_X, 2.5), (0.0, DOOR_HEIGHT, 2.7)
NEAR_Z, FAR_Z = (0.0, 5.0), (-4.2, -0.2)


def ajar_walls(s):
    white = s.material(diffuse("white", (0.78, 0.77, 0.74)))
    rose = s.material(diffuse("rose", (0.72, 0.62, 0.55)))
    sage = s.material(diffuse("sage", (0.46, 0.58, 0.42)))
    image = s.texture("checker", checker((70, 62, 56), (214, 206, 192)))
    diamonds = texture_info(image, (1.1, 1.1), (0.05, 0.2), degrees=45)
    floor = s.material(diffuse("floor", texture=diamonds))
    frame = [
        wall("+x", DOOR_X[0], (-0.2, 0.0), (0.0, DOOR_HEIGHT)),
        wall("-x", DOOR_X[1], (-0.2, 0.0), (0.0, DOOR_HEIGHT)),
        wall("-y", DOOR_HEIGHT, DOOR_X, (-0.2, 0.0)),
    ]
    floors = [wall("+y", 0.0, AJAR_X, z) for z in (NEAR_Z, FAR_Z)]
    floors.append(wall("+y", 0.0, DOOR_X, (-0.2, 0.0)))
    s.add("floor", joined(*floors), floor)
    s.add("ceilings", joined(*(wall("-y", 2.7, AJAR_X, z) for z in (NEAR_Z, FAR_Z))), white)
    s.add("frame", joined(*frame), white)
    opening = [(1, 0)]
    s.add("near wall with the door", wall("+z", 0.0, AJAR_X, AJAR_Y, opening), white)
    s.add("near back", wall("-z", 5.0, AJAR_X, AJAR_Y), white)
    s.add("near left", wall("+x", -2.5, NEAR_Z, AJAR_Y), sage)
    s.add("near right", wall("-x", 2.5, NEAR_Z, AJAR_Y), white)
    far = [wall("-z", -0.2, AJAR_X, AJAR_Y, opening), wall("+z", -4.2, AJAR_X, AJAR_Y)]
    far += [wall("+x", -2.5, FAR_Z, AJAR_Y), wall("-x", 2.5, FAR_Z, AJAR_Y)]
    s.add("far walls", joined(*far), rose)


def ajar_door(s, degrees):
    """The leaf turns about the left jamb, into the near room, sealed along its hinge."""
    paint = s.material(plastic("door paint", (0.36, 0.22, 0.13), 0.5))
    brass = s.material(metal("brass", (0.88, 0.72, 0.42), 0.25))
    hinge = (DOOR_X[0] - 0.002, 0.0, 0.0)
    width = DOOR_X[1] - DOOR_X[0]
    s.add("door", box((0, 0.004, -0.04), (width, DOOR_HEIGHT - 0.01, 0)), paint, hinge, -degrees)
    knob = moved(sphere(0.03, 24, 12), (width - 0.07, 1.02, 0.045))
    s.add("knob", knob, brass, hinge, -degrees)


def ajar_furniture(s):
    wood = s.material(diffuse("wood", (0.50, 0.33, 0.19)))
    red = s.material(diffuse("red", (0.62, 0.12, 0.10)))
    blue = s.material(diffuse("blue", (0.12, 0.20, 0.46)))
    cream = s.material(diffuse("cream", (0.85, 0.80, 0.66)))
    lacquer = s.material(plastic("lacquer", (0.10, 0.24, 0.26), 0.3))
    leg = box((-0.03, 0, -0.03), (0.03, 0.72, 0.03), ("-y", "+y"))
    legs = [moved(leg, (x, 0, z)) for x in (-0.5, 0.5) for z in (-0.3, 0.3)]
    table = joined(box((-0.6, 0.72, -0.4), (0.6, 0.76, 0.4)), *legs)
    s.add("table", table, wood, at=(0.35, 0, 1.9), turn=8)
    s.add("glass ball", sphere(0.13, 48, 24), s.material(glass("glass")), at=(0.62, 0.895, 2.0))
    steel = s.material(metal("steel", (0.75, 0.76, 0.78), 0.2))
    s.add("metal ball", sphere(0.13, 48, 24), steel, at=(0.24, 0.89, 1.75))
    s.add("lower book", block(0, 0, (0.26, 0.04, 0.19)), red, at=(0.02, 0.76, 2.06), turn=20)
    s.add("upper book", block(0, 0, (0.22, 0.03, 0.16)), blue, at=(0.02, 0.8, 2.06), turn=-6)
    s.add("cabinet", block(-2.2, 2.6, (0.58, 1.1, 1.4)), lacquer)
    s.add("stool", block(0, 0, (0.38, 0.46, 0.38)), red, at=(1.35, 0, 1.1), turn=32)
    s.add("picture", box((0.6, 1.2, 0.0), (1.5, 1.85, 0.03), ("-z",)), cream)
    s.add("picture's inside", wall("+z", 0.032, (0.68, 1.42), (1.28, 1.77)), blue)
    s.add("far crate", block(0, 0, (0.7, 0.8, 0.7)), wood, at=(1.2, 0, -2.6), turn=15)


def atrium():
    irradiance = 11.0
    s = Glb(
        "atrium",
        "A court with an open roof: the sun falls into one side and lights the other arcade by "
        "reflection only. Round pillars (shared geometry), masked leaves with dappled shadows.",
        f"one directional light, {irradiance:g} W/m^2, oblique",
        "open above the court",
    )
    stone = s.material(diffuse("stone", (0.70, 0.64, 0.54)))
    plaster = s.material(diffuse("plaster", (0.74, 0.56, 0.40)))
    image = s.texture("tiles", tiles((186, 160, 132), (96, 84, 74)))
    paving = s.material(diffuse("paving", texture=texture_info(image, scale=(1.25, 1.25))))
    atrium_walls(s, stone, plaster, paving)
    atrium_pillars(s, stone)
    atrium_leaves(s)
    s.directional_light("sun", (0.5, -0.8, -0.33), irradiance, (1.0, 0.94, 0.82))
    s.camera("arcade", (-4.6, 1.65, 5.0), (0.6, 1.6, -4.0), 52, 4 / 3)
    s.camera("court", (-1.4, 1.7, 7.9), (1.0, 2.1, -3.0), 60, 4 / 3)
    return s


# Court |x| < 3, its walls as thick as 3 to 3.4, arcades up to 5.5. Bays along z lie between these.
BAYS = [-8.4 + 2.4 * i for i in range(8)]
COURT, WALL, OUTSIDE = 3.0, 3.4, 5.5
SPRING, ARCH, CEILING, ROOF = 2.6, 0.9, 4.0, 6.5


def atrium_walls(s, stone, plaster, paving):
    across, ends = (-OUTSIDE, -WALL, -COURT, COURT, WALL, OUTSIDE), (BAYS[0], BAYS[-1])
    s.add("floor", wall("+y", 0.0, across, BAYS), paving)
    sides = [wall("+x", -OUTSIDE, BAYS, (0.0, CEILING)), wall("-x", OUTSIDE, BAYS, (0.0, CEILING))]
    s.add("outer walls", joined(*sides), plaster)
    above_arcades = [(0, 1), (4, 1)]
    levels = (0.0, CEILING, ROOF)
    walls = [wall(f, z, across, levels, above_arcades) for f, z in zip(("+z", "-z"), ends)]
    s.add("end walls", joined(*walls), plaster)
    ceilings = [wall("-y", CEILING, x, BAYS) for x in ((-OUTSIDE, -WALL), (WALL, OUTSIDE))]
    tops = [wall("+y", ROOF, x, BAYS) for x in ((-WALL, -COURT), (COURT, WALL))]
    s.add("arcade ceilings, wall tops", joined(*ceilings, *tops), plaster)
    left, right, soffits = [], [], []
    for z in zip(BAYS, BAYS[1:]):
        left.append(arch_wall(-COURT, z, ARCH, SPRING, ROOF))
        left.append(flipped(arch_wall(-WALL, z, ARCH, SPRING, CEILING)))
        right.append(flipped(arch_wall(COURT, z, ARCH, SPRING, ROOF)))
        right.append(arch_wall(WALL, z, ARCH, SPRING, CEILING))
        soffits.append(arch_soffit((-WALL, -COURT), z, ARCH, SPRING))
        soffits.append(arch_soffit((COURT, WALL), z, ARCH, SPRING))
    s.add("left arches", joined(*left), stone)
    s.add("right arches", joined(*right), stone)
    s.add("soffits", joined(*soffits), stone)


def atrium_pillars(s, stone):
    shaft = s.mesh("shaft", moved(cylinder(0.22, SPRING - 0.4, 24), (0, 0.2, 0)), stone)
    capital = s.mesh("capital", box((-0.3, SPRING - 0.2, -0.3), (0.3, SPRING, 0.3)), stone)
    base = s.mesh("base", block(0, 0, (0.6, 0.2, 0.6)), stone)
    middle = (COURT + WALL) / 2
    for x in (-middle, middle):
        for i, z in enumerate(BAYS):
            side = "left" if x < 0 else "right"
            s.node(f"{side} capital {i}", capital, (x, 0, z))
            if 0 < i < len(BAYS) - 1:
                s.node(f"{side} shaft {i}", shaft, (x, 0, z))
                s.node(f"{side} base {i}", base, (x, 0, z))


def atrium_leaves(s):
    image = s.texture("leaves", leaves())
    clay = s.material(diffuse("clay", (0.52, 0.25, 0.15)))
    earth = s.material(diffuse("earth", (0.11, 0.08, 0.06)))
    side = s.mesh("pot", cylinder(0.26, 0.5, 24), clay)
    soil = s.mesh("soil", disc(0.26, 24, 0.45), earth)
    upright = quad((-0.5, 0.42, 0), (1.0, 0, 0), (0, 1.0, 0))
    bush = s.mesh("bush", upright, s.material(cut_out("bush leaves", texture_info(image))))
    for i, (x, z) in enumerate([(-2.4, 4.8), (-2.4, 0.0), (-2.4, -4.8), (2.4, 2.4), (2.4, -2.4)]):
        s.node(f"pot {i}", side, (x, 0, z))
        s.node(f"soil {i}", soil, (x, 0, z))
        for j in range(3):
            s.node(f"bush {i} {j}", bush, (x, 0, z), turn=60 * j + 13 * i)
    vines = [quad((-COURT, 5.6, z), (2 * COURT, 0, 0), (0, 0, -1.4)) for z in (5.4, 1.4, -3.6)]
    vine = s.material(cut_out("vine leaves", texture_info(image, scale=(6, 1.5))))
    s.add("vines across the court", joined(*vines), vine)
    climbers = [quad((COURT - 0.03, 3.7, z), (0, 0, 1.6), (0, 2.4, 0)) for z in (1.6, -3.2)]
    ivy = s.material(cut_out("ivy leaves", texture_info(image, scale=(2, 3))))
    s.add("ivy", joined(*climbers), ivy)
