"""The shape of empty space."""

import gzip
import json
import math
import pathlib
import statistics
import tempfile

from harness import child
from harness.entry import Entries
from harness.measured import exact, median_of
from harness.run import Table
from harness.verdict import at_most

ENTRIES = Entries()

# The thesis' scene and grid; ours, its camera, voxels along the longest side.
ROWS = (
    ("Door (72, 118, 28)", "door/scene.glb", "corner", 118),
    ("Door (144, 234, 54)", "door/scene.glb", "corner", 234),
    ("Sponza (118, 50, 72)", "sponza/scene.glb", "", 118),
    ("Sponza (234, 98, 144)", "sponza/scene.glb", "", 234),
    ("Plants (118, 16, 68), stand-in: plants.glb", "plants.glb", "chair", 118),
    ("Plants (234, 32, 134), stand-in: plants.glb", "plants.glb", "chair", 234),
    ("Apartment (234, 128, 152), stand-in: flat.glb", "flat.glb", "first room", 234),
    ("Apartment (364, 200, 238), stand-in: flat.glb", "flat.glb", "first room", 364),
)
SECONDS = (0.17, 1.28, 0.92, 6.81, 1.17, 4.57, 11, 45)


GROWTH = (("Door", *ROWS[:2]), ("Sponza", *ROWS[2:4]))
COUNTED = ("voxels", "domain", "skeleton")  # what the thesis' seconds hold


def analyse(scene, camera, resolution, *options):
    return child.lacuna_json("analyze", scene, "--resolution", resolution, "--no-cache",
                             *(("--camera", camera) if camera else ()), *options)


def counted_seconds(told):
    return sum(step["seconds"] for step in told["steps"] if step["name"] in COUNTED)


def growth(small, large):
    """The exponents with which seconds grow in faces, from the runs at two resolutions in pairs."""
    faces = math.log(large[0]["complex_faces"] / small[0]["complex_faces"])
    return [math.log(counted_seconds(b) / counted_seconds(a)) / faces for a, b in zip(small, large)]


@ENTRIES.measured(
    "noel-table-1", "Noel 2015, Table 1, p. 86, and section 6.2.5",
    "seconds to voxelise and thin (Intel Core i7-3770K of 2012, 8 threads), linear in the faces", "analysis",
    (*(at_most(row[0], seconds, "s") for row, seconds in zip(ROWS, SECONDS)),
     *(at_most(f"{scene}: exponent of seconds in faces", 1) for scene, *_ in GROWTH)))
def table_1(run):
    """Seconds to voxelise a scene and to thin its empty space, and whether they are linear in the faces
    of its cubical complex (section 6.2.5). Others stand for scenes that are not to be had."""
    told = {row: [] for row in ROWS}
    run.uses([row[1] for row in ROWS])
    for _ in range(20 if run.full else 6):
        for row in ROWS:  # in turn: what the machine does meanwhile meets all alike
            told[row].append(analyse(*row[1:]))
    for row in ROWS:
        run.found(row[0], median_of([counted_seconds(t) for t in told[row]]))
    for scene, small, large in GROWTH:
        run.found(f"{scene}: exponent of seconds in faces", median_of(growth(told[small], told[large])))
    run.tables.append(Table(("thesis", "our grid", "faces", "nodes", "filtered"), [
        (row[0], "x".join(map(str, t["grid"])), t["complex_faces"], t["nodes"], t["filtered_nodes"])
        for row, (t, *_) in told.items()]))
    run.note(f"ours: medians of {len(told[ROWS[0]])} processes, nothing cached; wall clock: a busy machine only "
             "makes it longer")


BASELINES = child.ROOT.parent / "shared/baselines"
GRIDS = ("door_128", "door_256", "door_512", "corridor_128", "corridor_256")
CELL = 8  # voxels


class Nearest:
    """The distance to the nearest of some points."""

    def __init__(self, points):
        self.cells = {}
        for p in points:
            self.cells.setdefault(tuple(c // CELL for c in p), []).append(p)

    def __call__(self, p):
        a, b, c = (x // CELL for x in p)
        best, ring = math.inf, 0
        while best > (ring - 1) * CELL:  # nothing in this ring is nearer
            shell = range(-ring, ring + 1)
            for i in shell:
                for j in shell:
                    for k in shell if ring in (abs(i), abs(j)) else {-ring, ring}:
                        for q in self.cells.get((a + i, b + j, c + k), ()):
                            best = min(best, math.dist(p, q))
            ring += 1
        return best


def summary(distances):
    return statistics.median(distances), statistics.quantiles(distances, n=10)[-1]


def skeleton(grid, what):
    """Nodes, number of edges, median distance of the surface."""
    out = child.call(child.BIN / "grid_skeleton", grid, what)[0].splitlines()
    numbers = out[0].split()
    return [tuple(map(int, line.split())) for line in out[1:]], int(numbers[1]), float(numbers[3])


def compare(run, name, folder):
    """The rows of a grid: his, and ours with either distance."""
    grid, nodes = folder / "grid", folder / "nodes"
    grid.write_bytes(gzip.decompress((BASELINES / f"{name}.vox.gz").read_bytes()))
    found = json.loads(gzip.decompress((BASELINES / f"{name}.skel.json.gz").read_bytes()))["nodes"]
    his = [tuple(n["p"]) for n in found]
    nodes.write_text("".join(f"{x} {y} {z}\n" for x, y, z in his))
    _, _, his_surface = skeleton(grid, nodes)
    yield (name, "his", len(his), sum(len(n["n"]) for n in found) // 2, his_surface, *[""] * 5)
    for distance in ("l1", "chebyshev"):
        ours, edges, surface = skeleton(grid, distance)
        there = list(map(Nearest(ours), his))
        back = list(map(Nearest(his), ours))
        inside = sum(d <= n["r"] + math.sqrt(3) for d, n in zip(there, found)) / len(found)
        yield ("", distance, len(ours), edges, surface, *summary(there), *summary(back), inside)
        run.stands_beside(f"{name}, {distance}: surface to node", his_surface, exact(surface), "voxels")


@ENTRIES.measured(
    "noel-skeletons", "the thesis author's published code, run on its own grids (shared/baselines)",
    "how far his skeletons and ours lie from each other, and from the scene", "analysis",
    targets=("grid_skeleton",))
def skeletons(run):
    """The skeletons that the thesis author's published code found, beside ours on the same grids (../shared/baselines).

    `surface`: the median of how far voxels beside the scene lie from their node. `his to ours`, `ours to his`: how far the
    nearest node of the other is, the median and the 90th percentile; `in ball`: which share of his nodes has one of ours
    within his node's own radius and a voxel's diagonal. All in voxels. His code keeps curves by the Chebyshev distance and
    does not pierce closed surfaces, so that the space around floating objects has no node."""
    if not BASELINES.is_dir():
        raise child.Failed(f"the author's grids are not there ({BASELINES})")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in GRIDS:
            rows += compare(run, name, pathlib.Path(folder))
    run.tables.append(Table(("grid", "", "nodes", "edges", "surface", "his to ours", "90 %", "ours to his", "90 %",
                             "in ball"), rows))
