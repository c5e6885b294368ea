"""Guided rays through the faces of regions (chapter 10): where they lead, and what they gain. `published` has the thesis'
settings, `ours` this project's, which it learns while it renders."""

import json
import math

from harness import child, layers
from harness.entry import Entries
from harness.measured import exact, geometric_mean_of, mean_of
from harness.run import AS, KINDS, Table, cell_with
from harness.verdict import at_least, at_most, beside
from noel_guides import frames, note_frames

ENTRIES = Entries()
BSDF = {"type": "bsdf"}
GUIDE = "/integrator/guide"
DOOR = "door/scene.glb"
GRID = 118  # voxels along door's longest side: (72, 118, 28), that of Figs 85 and 86
SLIT = [119.5, 60, -65]  # between the edge of the door and its frame
BEFORE = [128, 60, -50]  # in the room, in the region before the door

# The thesis: the next portal to the light's region, half of the rays, nothing between regions, its thresholds, and a path
# from each face. `one`: faces that all points share (SIS3 and 4, FIS3 and 4), which need no thresholds.
NO_THRESHOLDS = {"least_distance": 0, "least_cosine": 0}
FACES = {
    "portals": {"published": {"type": "portals", "as": "published"}, "ours": {"type": "portals"},
                "one": {"type": "portals", "as": "published", "through": SLIT}},
    "face_irradiance": {"published": {"type": "face_irradiance", "as": "published"}, "ours": {"type": "face_irradiance"},
                        "one": {"type": "face_irradiance", "as": "published", **NO_THRESHOLDS, "through": BEFORE}},
}


def alone(guide):
    return {**guide, "guide_only": True}


def mixing(guide):
    """As published but for the borders of regions: mixed over 4 voxels, the default, in place of thresholds."""
    return {**guide, "mixing": 4, **(NO_THRESHOLDS if guide["type"] == "face_irradiance" else {})}


def door_job(full):
    return {"scene": DOOR, "camera": "corner", "resolution": [1024, 512] if full else [256, 128],
            "integrator": {"type": "path", "max_depth": 6}, "analysis": {"resolution": GRID}}


QUICK = {"portals": 32, "face_irradiance": 16}  # iterations; with thresholds one takes eleven times that of BSDF sampling


def region_sweep(full, name, which="published"):
    faces = FACES[name]
    published = [faces["published"], faces["one"], alone(faces["published"]), alone(faces["one"])]
    return {
        "label": f"{name} at equal iterations",
        "job": {**AS[which], **door_job(full), "reference": "auto", "budget": {"iterations": 4096 if full else QUICK[name]},
                "reference_iterations": 4000 if full else 160},
        "axes": {GUIDE: [BSDF, *(published if which == "published" else [faces["ours"]])]},
        "seeds": 5 if full else 3,
    }


def light(folder):
    return sum(map(sum, layers.channels(folder, "")))


def measure_regions(run, name, title, claims):
    """Errors after as many iterations, with the thesis' settings and ours, and through faces that all points share; and what
    is lost where the guide draws alone. `claims`: the quantities of these four."""
    faces, rows, gains = FACES[name], [], {}

    def told(guide):
        return [run.report(cell_with(answers, guide=guide), seed) for seed in seeds]

    def pictures(guide):
        return [run.run_folder(cell_with(answers, guide=guide), seed) for seed in seeds]

    def gain(guide, value):
        return geometric_mean_of([value(a) / value(b) for a, b in zip(told(BSDF), told(guide))])

    def kept(guide):
        return geometric_mean_of([light(a) / light(b) for a, b in zip(pictures(alone(guide)), pictures(BSDF))])

    for which, guide in faces.items():
        answers = run.answers(region_sweep(run.full, name, "ours" if which == "ours" else "published"))
        seeds = range(answers["seeds"])
        found = [gain(guide, lambda r, m=metric: r["errors"][m]) for metric in ("mae", "rmse", "relmse")]
        gains[which] = found[0]
        rows.append((which, *map(str, found), f"{1 / gain(guide, lambda r: r['seconds']['render_cpu']).value:.3g}"))
    run.found(claims[0], **{which: gains[which] for which in KINDS})
    run.found(claims[1], published=kept(faces["published"]))  # the last of the faces is one of the published
    run.found(claims[2], published=gains["one"])
    run.found(claims[3], published=kept(faces["one"]))
    run.tables.append(Table((f"door, {title}", "gain in MAE", "in RMSE", "in relMSE", "time of an iteration"), rows))
    run.note(f"{region_sweep(run.full, name)['job']['budget']['iterations']} iterations, {answers['seeds']} runs; one: faces "
             f"that all points share, by `through` {faces['one']['through']}; rays of the guide alone: `guide_only`")


IN_PARTS = ("over the whole picture: 10.4.1 tells of less noise in parts, which Fig. 95 bears out. At this grid the door's portal "
            "covers 0.56 of its opening (Fig. 90), and for what comes past it half of the BSDF's rays are missing")


def gain_claims(title, one, first):
    """Of SIS1 to SIS4, or FIS1 to FIS4."""
    return (at_least(f"error of BSDF sampling / of {title}, at equal iterations", 1, why=IN_PARTS),
            at_most(f"light of the picture by rays of {first}1 alone / of the unbiased picture", 1),
            at_least(f"error of BSDF sampling / of {title} through {one} ({first}4)", 1, why=IN_PARTS),
            at_most(f"light of the picture by rays of {first}3 alone / of the unbiased picture", 1))


SIS = gain_claims("portals", "the door's portal", "SIS")
FIS = gain_claims("face irradiance", "the border before the door", "FIS")


@ENTRIES.measured(
    "noel-fig-91", "Noel 2015, Fig. 91, p. 155",
    "door, rays through portals: less noise than BSDF sampling after 4096 iterations (SIS2; through one portal SIS4); alone "
    "they are biased (SIS1, SIS3)",
    "path with guide: portals", SIS, sweep=lambda full: region_sweep(full, "portals"))
def fig_91(run):
    """Rays through portals against BSDF sampling on door, after as many iterations of each."""
    measure_regions(run, "portals", "portals", [claim.quantity for claim in SIS])


@ENTRIES.measured(
    "noel-fig-94", "Noel 2015, Fig. 94, p. 158 (too bright there: section 10.4.2)",
    "door, face irradiance: less noise than BSDF sampling after 4096 iterations (FIS2; through one border FIS4); alone it is "
    "biased (FIS1, FIS3)",
    "path with guide: face_irradiance", FIS, sweep=lambda full: region_sweep(full, "face_irradiance"))
def fig_94(run):
    """Rays towards bright faces against BSDF sampling on door, after as many iterations of each. The thesis' pictures are
    too bright; ours have the densities that it got wrong (10.4.2). d_t and o_t are read as its reason for them says, not as
    its inequalities do (renderer/guides/border_faces.cpp)."""
    measure_regions(run, "face_irradiance", "face irradiance", [claim.quantity for claim in FIS])


@ENTRIES.measured(
    "noel-fig-95", "Noel 2015, Fig. 95, p. 159, and 10.4.1",
    "door: both strategies have less noise than BSDF sampling where they are smooth (blue frame), and add some elsewhere (red "
    "frame)", "path with guide: portals, face_irradiance",
    tuple(claim for title in FACES for claim in (
        at_least(f"{title}, blue frame: variance of BSDF sampling / of the guide", 1),
        at_most(f"{title}, red frame: variance of BSDF sampling / of the guide", 1))))
def fig_95(run):
    """The part of the picture that gains most from guided rays, and the part that loses most, after as many iterations."""
    job = {key: value for key, value in door_job(run.full).items() if key != "integrator"}
    job["budget"] = {"iterations": 4096 if run.full else 32}

    def path(guide, which):
        return {"type": "path", "max_depth": 6, **AS[which], "guide": guide}

    for title, guides in FACES.items():
        for which in KINDS:
            name = f"{title}-{which}"
            found = frames(run, job, (f"bsdf-{which}", path(BSDF, which)), (name, path(guides[which], which)))
            for frame, ratio in zip(("blue", "red"), found):
                run.found(f"{title}, {frame} frame: variance of BSDF sampling / of the guide", **{which: ratio})
            run.show(name, run.place(f"{name}-0"))
    run.show("BSDF sampling", run.place("bsdf-ours-0"))
    note_frames(run, job)


def guide_rays(run, guide, place, n, seed=0, resolution=GRID, scene=DOOR):
    """What guide_rays says of `n` directions of a guide at the surface that a camera in `place` looks down to."""
    job = {"scene": scene, "camera": {"position": place, "target": [place[0], place[1] - 1, place[2]], "up": [0, 0, 1]},
           "resolution": [2, 2], "analysis": {"resolution": resolution}, "seed": seed,
           "integrator": {"type": "inspect", "show": "guide_density", "guide": guide}}
    run.uses(job)
    run.folder.mkdir(parents=True, exist_ok=True)
    file = run.folder / "rays.json"
    file.write_text(json.dumps(job) + "\n")
    return json.loads(child.call(child.BIN / "guide_rays", file, n)[0])


BACK_ROOM, UNDER_TABLE = [-50, 60, -250], [-28, 12, -28]
DOOR_EDGE, LEAF, FRAME = 119.7, -54.6, -72.3  # x of the door's edge; z of the foremost of the door, and of its frame


def past_the_door(ray):
    """Its hit lies in the main room, not on the side of the door that the back room sees."""
    if ray["at"] is None:
        return False
    x, _, z = ray["at"]
    return z > LEAF or (x > DOOR_EDGE and z > FRAME)


def leaves_region(ray):
    return ray["entered"] is not None


THROUGH_DOOR = {"published": FACES["portals"]["one"], "ours": mixing(FACES["portals"]["one"])}
WAYS = {  # where from, which rays count, the guides
    "from the back room that reach the main room": (BACK_ROOM, leaves_region, THROUGH_DOOR),
    "from the back room that come past the edge of the door": (BACK_ROOM, past_the_door, THROUGH_DOOR),
    "from under the table that leave the region": (UNDER_TABLE, leaves_region, {
        "published": FACES["portals"]["published"], "ours": {"type": "portals", "probability": 0.5}}),
}
CLAIMED = {  # the thesis: all of them; and why not
    "from the back room that reach the main room": "",
    "from under the table that leave the region": "the others hit the legs of the table, which stand before the portal",
}


def way_claims(way):
    share = f"share of 128 rays {way}"
    first = at_least(share, 1, why=CLAIMED[way]) if way in CLAIMED else beside(share)
    return first, beside(f"share of 128 rays of the BSDF {way}")


@ENTRIES.measured(
    "noel-fig-86", "Noel 2015, Fig. 86, p. 151",
    "rays through a portal leave the region: from the back room of door, from under the table",
    "path with guide: portals", tuple(claim for way in WAYS for claim in way_claims(way)),
    targets=("lacuna", "guide_rays"))
def fig_86(run):
    """Rays from a point of the back room through the portal in the door's opening, and from the floor under the table
    through the portals of its region; beside them, rays of the BSDF from there (the thesis: uniform on the hemisphere).
    The back room is one region: a ray that leaves it has come to the main room."""
    seeds = 40 if run.full else 10
    rows = []
    for way, (place, counts, guides) in WAYS.items():
        for which, guide in {**guides, "BSDF": BSDF}.items():
            told = [guide_rays(run, guide, place, 128, seed) for seed in range(seeds)]
            share = mean_of([sum(map(counts, t["rays"])) / max(1, len(t["rays"])) for t in told])
            if which in KINDS:
                run.found(f"share of 128 rays {way}", **{which: share})
            else:
                run.found(f"share of 128 rays of the BSDF {way}", ours=share)
            rows.append((way, which, str(share), f"{mean_of([t['failed'] / 128 for t in told]).value:.3g}"))
    run.tables.append(Table(("rays", "guide", "share", "below the surface"), rows))
    run.note(f"grid (72, 118, 28); {seeds} times 128 rays each, of those that are not below the surface they start from; "
             f"points on the floor below {BACK_ROOM} and {UNDER_TABLE}: the thesis names none")


GRIDS = {"(72, 118, 28)": GRID, "(144, 234, 54)": 234, "(286, 466, 108)": 466}
SLIT_AREA = math.dist((118, -56), (121.5, -73)) * 121  # from the door's free edge to the frame, times the door's height


def portal_area(grid):
    return f"area of the door's portal / of its opening, grid {grid}"


FIT = "misfit of the area, grid (144, 234, 54) / (72, 118, 28)"


@ENTRIES.measured(
    "noel-fig-90", "Noel 2015, Fig. 90, p. 153 (there of sponza)",
    "portals stay where they are as the grid gets finer, and fit the scene better", "path with guide: portals",
    (at_most(FIT, 1), *(beside(portal_area(grid)) for grid in GRIDS)), targets=("lacuna", "guide_rays"))
def fig_90(run):
    """The area of the portal in the opening of door, over that of the opening, at three resolutions. Misfit: |log| of it."""
    areas = {}
    for grid, resolution in GRIDS.items():
        told = guide_rays(run, THROUGH_DOOR["published"], UNDER_TABLE, 0, resolution=resolution)
        areas[grid] = told["guide"]["through_area"] / SLIT_AREA
        run.found(portal_area(grid), ours=exact(areas[grid]))
    coarse, fine = (abs(math.log(areas[grid])) for grid in list(GRIDS)[:2])
    run.found(FIT, ours=exact(fine / coarse))
    run.note(f"the opening: {SLIT_AREA:.0f} square units, from the door's free edge to the frame; at half of the first "
             "resolution no voxel of it is empty")


NORMAL, DEPTH = 0.99, 0.05  # neighbours on one surface: the cosine of their normals, the relative change of their depths


class Borders:
    """Pixels on both sides of the borders of regions in a picture. A border is all neighbours, along rows and columns, whose
    labels are the same two; of each side there are two strips of `wide` pixels, the near one along the border. Only where
    all of them lie on one surface."""

    def __init__(self, labels, surface, width, height, wide):
        self.strips = {}  # by border: near and far of the first region, near and far of the second
        for step in (1, width):
            for p in range(width * height):
                line = [p + k * step for k in range(1 - 2 * wide, 2 * wide + 1)]
                if line[0] < 0 or line[-1] >= width * height:
                    continue
                if step == 1 and line[0] // width != line[-1] // width:
                    continue
                self._add(line, labels, surface, wide)

    def _add(self, line, labels, surface, wide):
        first, second = line[:2 * wide][::-1], line[2 * wide:]
        a, b = labels[first[0]], labels[second[0]]
        if a == b or not any(a) or not any(b):
            return
        if any(labels[p] != a for p in first) or any(labels[p] != b for p in second):
            return
        if not all(surface(p, q) for p, q in zip(line, line[1:])):
            return
        if a > b:
            a, b, first, second = b, a, second, first
        strips = self.strips.setdefault((a, b), ([], [], [], []))
        for strip, pixels in zip(strips, (first[:wide], first[wide:], second[:wide], second[wide:])):
            strip += pixels

    def step(self, variance, least=32, darkest=0.02):
        """The mean over borders, each by its length, of |log| of the ratio of variances of their two near strips, over
        that of the near strip of a side and the far one; and how many borders there are that have strips of `least` pixels
        or more, none with less than the share `darkest` of the picture's variance. ValueError: none."""
        floor = darkest * sum(variance) / len(variance)
        across = within = count = 0
        for strips in self.strips.values():
            means = [sum(variance[p] for p in strip) / len(strip) for strip in strips]
            if len(strips[0]) < least or min(means) < floor or min(means) <= 0:
                continue
            near_a, far_a, near_b, far_b = map(math.log, means)
            across += len(strips[0]) * abs(near_a - near_b)
            within += len(strips[0]) * (abs(near_a - far_a) + abs(near_b - far_b)) / 2
            count += 1
        if count == 0:
            raise ValueError("no border of regions is seen")
        return across / within, count


def one_surface(folder):
    """Whether two pixels show one surface, by the layers of a picture."""
    normals, depth = list(zip(*layers.channels(folder, "normal"))), layers.channels(folder, "depth")[0]

    def same(p, q):
        return (sum(a * b for a, b in zip(normals[p], normals[q])) > NORMAL and
                abs(depth[p] - depth[q]) <= DEPTH * min(depth[p], depth[q]))
    return same


def step_quantity(title):
    return f"{title}: step of variance across borders of regions / within them"


GUIDES_92 = {"portals": "portals", "face irradiance": "face_irradiance"}


@ENTRIES.measured(
    "noel-fig-92", "Noel 2015, Fig. 92, p. 156, and section 10.4",
    "door: where regions meet, the noise changes at once; where regions are mixed, it does not",
    "path with guide: portals, face_irradiance; inspect",
    (*(claim for title in GUIDES_92 for claim in (
        at_least(step_quantity(title), 1), at_least(f"{title}: step as published / with mixing", 1))),
     beside(step_quantity("BSDF sampling"))))
def fig_92(run):
    """Variances of pixels on both sides of the borders of regions, as the picture shows them, against variances of pixels as
    far from each other in one region. Edges of surfaces do not count. BSDF sampling knows no regions: its steps are those
    of the light itself. Paths of three edges, so that one choice of a direction makes the noise; the left half of the
    picture, where all large borders are. The strips were chosen with other seeds."""
    scale = 4 if run.full else 1
    width, height, wide = 128 * scale, 128 * scale, 4 * scale
    job = {**door_job(run.full), "resolution": [width, height], "crop": {"of": [2 * width, height], "from": [0, 0]},
           "sampler": "independent"}
    seeds, iterations = range(10, 22 if run.full else 16), 512 if run.full else 64
    run.render("regions", {**job, "integrator": {"type": "inspect", "show": "region_labels"},
                           "budget": {"iterations": 1}, "layers": ["normal", "depth"]})
    place, rows = run.place("regions"), []
    borders = Borders(list(zip(*layers.channels(place, ""))), one_surface(place), width, height, wide)

    def step(title, guide):
        found = []
        for seed in seeds:
            name = f"{title}-{seed}".replace(" ", "-").replace(",", "")
            run.render(name, {**job, "seed": seed, "layers": ["variance"], "budget": {"iterations": iterations},
                              "integrator": {"type": "path", "max_depth": 3, "guide": guide}})
            variances = layers.channels(run.place(name), "variance")
            found.append(borders.step([sum(channels) for channels in zip(*variances)]))
        ratio = geometric_mean_of([ratio for ratio, _ in found])
        rows.append((title, str(ratio), f"{mean_of([count for _, count in found]).value:.3g}"))
        return ratio

    run.found(step_quantity("BSDF sampling"), ours=step("BSDF sampling", BSDF))
    for title, name in GUIDES_92.items():
        guide = FACES[name]["published"]
        published, mixed = step(f"{title}, published", guide), step(f"{title}, mixed", mixing(guide))
        run.found(step_quantity(title), published=published)
        run.found(f"{title}: step as published / with mixing", ours=published.ratio(mixed))
    run.tables.append(Table(("door", "step across borders / within regions", "borders"), rows))
    run.note(f"strips of {wide} pixels along each border; variance between {iterations} iterations; {len(seeds)} runs; with "
             "mixing: as published, but `mixing` 4 and no thresholds")
