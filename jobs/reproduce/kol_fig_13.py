"""Kol et al. 2018, Fig. 13: error and time of the maps against the depth of both octrees."""

from harness import many_lights, view_maps
from harness.measured import Measured
from harness.run import Table


def measure(run):
    paths, at = 62500, (256, 128) if run.full else (96, 48)
    view_maps.statistics(run, "exact", view_maps.job("Sponza", paths, {"type": "exact"}, at, edges=6))
    rows, found = [], {}
    for levels in (7, 8, 9, 10, 11):
        name = f"levels-{levels}"
        t = found[levels] = view_maps.statistics(run, name, view_maps.job("Sponza", paths, {"levels": levels}, at, edges=6))
        e = many_lights.errors(run, name, "exact")
        rows.append((levels, round(t["view_leaves"]), f"{view_maps.seconds(t):.3g}",
                     f"{t['view_splats_large'] / t['view_splats']:.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}",
                     f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.found("time at 11 levels / at 8",
              Measured(view_maps.seconds(found[11])).ratio(Measured(view_maps.seconds(found[8]))))
    run.tables.append(Table(("levels", "maps", "CPU s", "leaves beyond a texel", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"sponza, {found[11]['virtual_lights']:.0f} lights of up to four bounces; errors against exact visibility of "
             f"the same lights; pictures: {run.folder / run.version}")
