"""Kol et al. 2018, Fig. 17: time of the maps of glowing particles, and what they add to the picture."""

from harness import many_lights, view_maps
from harness.measured import Measured
from harness.run import Table


def measure(run):
    rows, found = [], {}
    for method in ("megaviews", "many_lods"):
        for count in (4096, 65536):
            t = view_maps.statistics(run, f"{method}-{count}", view_maps.particles("Sponza", count, {"method": method}))
            found[method, count] = Measured(view_maps.seconds(t))
            rows.append((method, count, round(t["view_leaves"]), f"{view_maps.seconds(t):.3g}",
                         f"{t['views_sharing_a_splat']:.3g}"))
    run.found("speed-up over ManyLoDs, 64K particles", found["many_lods", 65536].ratio(found["megaviews", 65536]))
    run.tables.append(Table(("method", "particles", "maps", "CPU s", "views sharing a splat"), rows))
    at = (640, 360) if run.full else (320, 180)
    for name, how in (("exact", {"type": "exact"}), ("none", {"type": "none"}), ("maps", {"map_size": 32, "levels": 9})):
        view_maps.statistics(run, name, view_maps.particles("Sponza", 1024, how, resolution=at))
    rows = []
    for name in ("none", "maps"):
        e = many_lights.errors(run, name, "exact")
        rows.append((name, f"{e['relmse']:.3g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.tables.append(Table(("1024 particles", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"the paper's times are of San Miguel on a GPU; pictures: {run.folder / run.version}")
