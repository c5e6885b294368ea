"""Nabata et al., Fig. 6: steps in brightness of interpolated visibility, against none of probabilistic visibility. Both are
compared with exact visibility of the same lights in blocks of 16 x 16 pixels, over which noise averages out and steps do
not."""

from harness import many_lights
from harness.many_lights import visibility
from harness.run import Table


def measure(run):
    side = 256
    rows = []
    points = many_lights.cached("Hairball", run.full, side)
    for key, how in (("exact", visibility("exact")), ("probabilistic", visibility("probabilistic", points)),
                     ("interpolated", visibility("interpolated", points))):
        many_lights.render(run, key, many_lights.job("Hairball", how, run.full, 0.1, side, crop={"of": [512, 512],
                                                                                               "from": [60, 200]}))
        if key != "exact":
            e = many_lights.errors(run, key, "exact", "--block", 16)
            rows.append((key, f"{e['rmse'] / e['mean_b']:.3g}", f"{e['mean_a'] / e['mean_b']:.4g}",
                         f"{e['block_relative']:.3g}", f"{e['ssim']:.3g}"))
    run.tables.append(Table(("visibility", "RMSE / mean", "mean / exact", "worst block, of its mean", "SSIM"), rows))
    run.note(f"pictures: {run.folder / run.version}")
