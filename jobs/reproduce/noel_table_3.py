"""Noel 2015, Table 3: the squared error of pictures without indirect light, without its shadows, and with gates; with node
maps beside them."""

from harness import many_lights, shadows
from harness.measured import exact
from harness.run import Table

CONFIGURATIONS = {"1": "Sponza", "2": "Door"}
PATHS, EDGES = 1000, 5


def measure(run):
    rows = []
    for number, view in CONFIGURATIONS.items():
        shadows.report(run, view, "exact", PATHS, EDGES)
        shadows.report(run, view, "exact", PATHS, 2)
        pictures = {"direct light": f"{view}-exact-{PATHS}-2-0"}
        for how, name in (("none", "no shadows"), ("gates", "gates"), ("node_maps", "node maps")):
            shadows.report(run, view, how, PATHS, EDGES)
            pictures[name] = f"{view}-{how}-{PATHS}-{EDGES}-0"
        found = {name: many_lights.errors(run, p, f"{view}-exact-{PATHS}-{EDGES}-0") for name, p in pictures.items()}
        for name, e in found.items():
            if name != "node maps":
                run.found(f"{number}, {name}", exact(e["display_mse"]))
            rows.append((number, name, f"{e['display_mse']:.4g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}",
                         f"{e['mean_a'] / e['mean_b']:.3g}", f"{e['rmse'] / e['mean_b']:.3g}"))
        for other in ("no shadows", "direct light"):
            run.found(f"{number}, gates / {other}", exact(found["gates"]["display_mse"] / found[other]["display_mse"]))
    run.tables.append(Table(("configuration", "picture", "MSE of 0 to 255", "PSNR", "SSIM", "mean / exact", "RMSE / mean"),
                            rows))
    run.note("both configurations of the thesis are views of sponza; ours are sponza, atrium, and door, corner")
    run.note(f"pictures (Figs 47, 55, 56, 60, 64): {run.folder / run.version}")
