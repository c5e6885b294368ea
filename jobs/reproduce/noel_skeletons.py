"""The skeletons that the thesis author's published code found, beside ours on the same grids (../shared/baselines).

`surface`: the median of how far voxels beside the scene lie from their node. `his to ours`, `ours to his`: how far the
nearest node of the other is, the median and the 90th percentile; `in ball`: which share of his nodes has one of ours
within his node's own radius and a voxel's diagonal. All in voxels. His code keeps curves by the Chebyshev distance and
does not pierce closed surfaces, so that the space around floating objects has no node.
"""

import gzip
import json
import math
import pathlib
import statistics
import tempfile

from harness import child
from harness.measured import exact
from harness.run import Table

TARGETS = ("grid_skeleton",)
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


def measure(run):
    if not BASELINES.is_dir():
        raise child.Failed(f"the author's grids are not there ({BASELINES})")
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name in GRIDS:
            rows += compare(run, name, pathlib.Path(folder))
    run.tables.append(Table(("grid", "", "nodes", "edges", "surface", "his to ours", "90 %", "ours to his", "90 %",
                             "in ball"), rows))
