"""Kol et al. 2018, Fig. 9 and section 3.2.4: how many rendered pairs are leaves that need more than a texel."""

from harness import view_maps
from harness.measured import exact
from harness.run import Table


def measure(run):
    rows = []
    for view in view_maps.VIEWS:
        told = view_maps.statistics(run, view, view_maps.job(view, 65536, {}))
        share = told["view_splats_large"] / told["view_splats"]
        rows.append((view, round(told["virtual_lights"]), f"{told['view_splats']:.3g}", f"{share:.3g}"))
        if view == "Sponza":
            run.found("share of rendered pairs beyond a pixel", exact(share))
    run.tables.append(Table(("scene", "lights", "rendered pairs", "beyond a texel"), rows))
