"""Kol et al. 2018, Fig. 16: noise of 64 lights drawn for each pixel, with and without culling before, and filtered."""

from harness import many_lights, view_maps
from harness.measured import exact
from harness.run import Table


def measure(run):
    paths, at = 1048576, (256, 128) if run.full else (96, 48)

    def picture(name, **gather):
        value = view_maps.job("Sponza", paths, view_maps.OURS, at, integrator={"gather": gather})
        return view_maps.statistics(run, name, value)

    picture("all", type="all")
    rows, found = [], {}
    for name, gather in (("culled", {}), ("not culled", {"cull": False}), ("culled, filtered", {"filter_radius": 3}),
                         ("culled, filtered more", {"filter_radius": 8}),
                         # A sixth of the length of the atrium, and a twelfth.
                         ("culled, cutoff 600", {"cutoff": 600}), ("culled, cutoff 300", {"cutoff": 300})):
        key = name.replace(", ", "-").replace(" ", "-")
        t = picture(key, type="random", lights=64, **gather)
        e = found[name] = many_lights.errors(run, key, "all")
        rows.append((name, f"{t['lights_culled']:.3g}", f"{t['eye_pass_cpu_seconds']:.3g}", f"{e['rmse']:.3g}",
                     f"{e['relmse']:.3g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
        if name == "culled":
            run.found("share of leaf views culled", exact(t["lights_culled"]))
    run.found("error without culling / with", exact(found["not culled"]["rmse"] / found["culled"]["rmse"]))
    run.tables.append(Table(("64 lights a pixel", "culled", "eye pass, CPU s", "RMSE", "relMSE", "PSNR", "SSIM", "mean"),
                            rows))
    run.note(f"against all lights with the same maps; pictures: {run.folder / run.version}")
