"""Kol et al. 2018, Fig. 15: error of the maps against their resolution, with both hierarchies and with one."""

from harness import many_lights, view_maps
from harness.measured import exact
from harness.run import Table


def measure(run):
    paths, at = 8192, (512, 256) if run.full else (192, 96)
    view_maps.statistics(run, "exact", view_maps.job("Sponza", paths, {"type": "exact"}, at))
    rows, found = [], {}
    for key, how in (*((m, {"method": m}) for m in ("megaviews", "many_lods", "per_view")), ("ours", view_maps.OURS)):
        for size in (16, 32, 64):
            name = f"{key}-{size}"
            t = view_maps.statistics(run, name, view_maps.job("Sponza", paths, {**how, "map_size": size, "levels": 9}, at))
            e = many_lights.errors(run, name, "exact")
            found[key, size] = e["rmse"]
            rows.append((key, size, f"{view_maps.seconds(t):.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}",
                         f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.found("error of 16 x 16 / of 64 x 64", exact(found["megaviews", 16] / found["megaviews", 64]))
    run.tables.append(Table(("method", "texels a side", "CPU s", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"sponza, {paths} light paths of one bounce, 9 levels; per_view: a ray for each texel; ours: the defaults; "
             f"pictures: {run.folder / run.version}")
