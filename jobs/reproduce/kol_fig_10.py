"""Kol et al. 2018, Fig. 10: time of the maps of all lights against their number, for MegaViews, ManyLoDs and a ray for each
texel."""

import math

from harness import view_maps
from harness.measured import Measured, exact
from harness.run import Table

PATHS = (2048, 8192, 32768, 131072, 524288, 1048576)  # lights of one bounce on sponza: nearly as many
METHODS = ("megaviews", "many_lods", "per_view")
MOST = {"megaviews": 1048576, "many_lods": 131072, "per_view": 1048576}  # of the quick version
PAIR_BYTES = 8  # of a pair in the paper's queue


def exponent(points):
    """The slope of a line through the logarithms."""
    xs, ys = ([math.log(p[i]) for p in points] for i in (0, 1))
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def measure(run):
    found = {}
    rows = []
    for method in METHODS:
        for paths in PATHS:
            if not run.full and paths > MOST[method]:
                continue
            i = view_maps.statistics(run, f"{method}-{paths}", view_maps.job("Sponza", paths, {"method": method}))
            found[method, paths] = i
            rows.append((method, round(i["virtual_lights"]), round(i["view_leaves"]), f"{i['view_tree_cpu_seconds']:.2g}",
                         f"{i['view_map_cpu_seconds']:.3g}", f"{i['views_sharing_a_splat']:.3g}",
                         f"{i['view_map_bytes'] / 2**20:.3g}", f"{i['view_queue_peak_pairs'] * PAIR_BYTES / 2**20:.3g}"))

    def seconds(method, paths):
        return view_maps.seconds(found[method, paths])

    first, last = PATHS[0], PATHS[-1]
    lods = max(paths for m, paths in found if m == "many_lods")
    scale = found["megaviews", last]["virtual_lights"] / found["many_lods", lods]["virtual_lights"]
    points = [(found["megaviews", n]["virtual_lights"], seconds("megaviews", n)) for n in PATHS]
    run.found("exponent of time in views, 2k to 1M", Measured(exponent(points)))
    run.found("speed-up over ManyLoDs, 1M views", Measured(seconds("many_lods", lods) * scale / seconds("megaviews", last)))
    run.found("speed-up over ManyLoDs, 2048 views", Measured(seconds("many_lods", first) / seconds("megaviews", first)))
    run.found("memory of ManyLoDs / of ours, 1M views",
              exact(found["many_lods", lods]["view_queue_peak_pairs"] * scale /
                    found["megaviews", last]["view_queue_peak_pairs"]))
    run.tables.append(Table(("method", "lights", "maps", "view tree, CPU s", "maps, CPU s", "views sharing a splat",
                             "maps, MiB", "queue, MiB"), rows))
    run.note(f"exponent from 64k views on: {exponent(points[3:]):.2f}; sponza, one bounce, 11 levels, maps of 16 x 16")
    run.note("memory: of the queue that a breadth-first traversal would hold; ours goes depth-first and holds none")
    if lods < last:
        run.note(f"ManyLoDs at 1M views: {scale:.2g} times that at {lods}, as the paper extrapolates")
