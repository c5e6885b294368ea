"""Kol et al. 2018, Fig. 12: time against the resolution of the maps."""

from harness import view_maps
from harness.measured import Measured
from harness.run import Table


def measure(run):
    views, sizes = (1048576, (16, 32)) if run.full else (65536, (16, 32, 64, 128))
    rows, found = [], {}
    for method in ("megaviews", "many_lods"):
        for size in sizes:
            if method == "many_lods" and size > 64:
                continue
            t = view_maps.statistics(run, f"{method}-{size}",
                                     view_maps.job("Sponza", views, {"method": method, "map_size": size}))
            found[method, size] = view_maps.seconds(t)
            rows.append((method, size, round(t["view_leaves"]), f"{view_maps.seconds(t):.3g}",
                         f"{t['views_sharing_a_splat']:.3g}", f"{t['view_map_bytes'] / 2**20:.3g}"))
    run.found("time at twice the resolution / at one",
              Measured(found["megaviews", 32]).ratio(Measured(found["megaviews", 16])))
    run.tables.append(Table(("method", "texels a side", "maps", "CPU s", "views sharing a splat", "maps, MiB"), rows))
    if not run.full:
        run.note("64K views in place of 1M")
