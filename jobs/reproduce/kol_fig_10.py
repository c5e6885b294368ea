"""Kol et al. 2018, Fig. 10: time of the maps of all lights against their number, for MegaViews, ManyLoDs and a ray for each
texel, and every leaf drawn for each light; what culling saves, and what a queue holds."""

import math

from harness import view_maps
from harness.measured import Measured, exact
from harness.run import Table

PATHS = (2048, 8192, 32768, 131072, 524288, 1048576)  # lights of one bounce on sponza: nearly as many
MOST = {"megaviews": 1048576, "many_lods": 131072, "per_view": 1048576, "per_view_splats": 0}  # of the quick version
FEW = 512  # lights for which every leaf is drawn
WHOLE = 32768  # lights for which traversals are compared
PAIR_BYTES = 8  # of a pair in the paper's queue


def exponent(points):
    """The slope of a line through the logarithms."""
    xs, ys = ([math.log(p[i]) for p in points] for i in (0, 1))
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def traversals(run):
    """What culling saves, and what a breadth-first traversal holds."""

    def told(name, method, **how):
        return view_maps.statistics(run, f"{name}-{method}", view_maps.job("Sponza", WHOLE, {"method": method, **how}))

    rows = []
    for method in ("megaviews", "many_lods"):
        plain, all_seen = told("culled", method), told("not-culled", method, cull=False)
        queue = told("queue", method, traversal="breadth_first")
        rows.append((method, f"{view_maps.seconds(plain):.3g}", f"{view_maps.seconds(all_seen):.3g}",
                     f"{view_maps.seconds(queue):.3g}", f"{queue['view_fusion_cpu_seconds']:.3g}",
                     f"{queue['view_queue_bytes'] / 2**20:.4g}", f"{queue['view_unfused_bytes'] / 2**20:.4g}"))
        if method == "megaviews":
            run.found("share of time that culling saves", Measured(1 - view_maps.seconds(plain) / view_maps.seconds(all_seen)))
    run.tables.append(Table((f"{WHOLE} light paths", "CPU s", "not culled", "breadth-first", "of it fusion",
                             "queue held, MiB", "maps of nodes, MiB"), rows))


def measure(run):
    found = {}
    rows = []
    for method, most in MOST.items():
        for paths in (FEW, *PATHS):
            if paths > (PATHS[-1] if run.full and most > 0 else max(most, FEW)):
                continue
            i = view_maps.statistics(run, f"{method}-{paths}", view_maps.job("Sponza", paths, {"method": method}))
            found[method, paths] = i
            rows.append((method, round(i["virtual_lights"]), round(i["view_leaves"]), f"{i['view_tree_cpu_seconds']:.2g}",
                         f"{i['view_map_cpu_seconds']:.3g}", f"{i['views_sharing_a_splat']:.3g}",
                         f"{i['view_map_bytes'] / 2**20:.3g}", f"{i['view_queue_peak_pairs'] * PAIR_BYTES / 2**20:.3g}"))

    def seconds(method, paths):
        return view_maps.seconds(found[method, paths])

    traversals(run)
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
    run.note("queue, MiB: that a breadth-first traversal would hold at 8 bytes a pair; ours goes depth-first and holds none")
    if lods < last:
        run.note(f"ManyLoDs at 1M views: {scale:.2g} times that at {lods}, as the paper extrapolates")
