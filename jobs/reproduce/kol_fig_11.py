"""Kol et al. 2018, Fig. 11: 64K views at random places against lights of one bounce."""

from harness import view_maps
from harness.measured import Measured
from harness.run import Table


def measure(run):
    views = 65536
    jobs = {"one bounce": view_maps.job("Sponza", 68800, {}), "four bounces": view_maps.job("Sponza", 62500, {}, edges=6),
            "random": view_maps.particles("Sponza", views, {})}
    told = {key: view_maps.statistics(run, key, value) for key, value in jobs.items()}
    run.found("time of random views / of one bounce",
              Measured(view_maps.seconds(told["random"])).ratio(Measured(view_maps.seconds(told["one bounce"]))))
    run.tables.append(Table(("views", "number", "maps", "CPU s", "views sharing a splat"),
                            [(key, round(t["virtual_lights"]), round(t["view_leaves"]), f"{view_maps.seconds(t):.3g}",
                              f"{t['views_sharing_a_splat']:.3g}") for key, t in told.items()]))
    run.note("ours at random see in all directions, those of one bounce half of them")
