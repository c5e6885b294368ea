"""Kol et al. 2018, Fig. 14: many small maps against a few large ones in the same time."""

from harness import many_lights, view_maps
from harness.measured import Measured
from harness.run import Table

LARGEST = 256  # texels along a side of ours; the paper's are 1024


def measure(run):
    at = (128, 128) if run.full else (64, 64)
    paths = 32768 if run.full else 8192
    view_maps.statistics(run, "exact", view_maps.job("Hairball", paths, {"type": "exact"}, at))
    small = view_maps.statistics(run, "small", view_maps.job("Hairball", paths, {}, at))
    large = view_maps.statistics(run, "large", view_maps.job("Hairball", 64, {"map_size": LARGEST}, at))
    each = view_maps.seconds(large) / large["virtual_lights"] * (1024 / LARGEST) ** 2
    run.found("lights of 1024 x 1024 at equal time", Measured(view_maps.seconds(small) / each))
    rows = []
    for size in (16, 32, 64):
        t = view_maps.statistics(run, f"size-{size}", view_maps.job("Hairball", paths, {"map_size": size}, at))
        e = many_lights.errors(run, f"size-{size}", "exact")
        rows.append((size, f"{view_maps.seconds(t):.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}",
                     f"{e['mean_relative']:+.3g}"))
    run.tables.append(Table(("texels a side", "CPU s", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"{small['virtual_lights']:.0f} lights; the time of a map of 1024 x 1024 is sixteen times that of "
             f"{LARGEST} x {LARGEST}; pictures: {run.folder / run.version}")
