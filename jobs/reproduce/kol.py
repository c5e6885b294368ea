"""Many views through two hierarchies. GPU times (GeForce GTX 1080 Ti) are information. Every
entry renders one iteration of many lights, each with a map. The paper's other scenes (Sibenik, San Miguel) are not ours:
Sponza and the hairball stand for them."""

import math

from harness import many_lights
from harness.entry import Entries
from harness.measured import Measured
from harness.run import Table
from harness.verdict import at_least, at_most, beside

ENTRIES = Entries()
NEEDS = "many_lights with visibility: view_maps"
VIEWS = {"Sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
         "Hairball": {"scene": "hairball.glb", "camera": "front"},
         "Door": {"scene": "door/scene.glb", "camera": "corner"}}


OURS = {"type": "view_maps"}  # its defaults
PUBLISHED = {"levels": 11, "node_texels": 1, "cover": 0}


def map_job(view, paths, how, resolution=(32, 16), edges=3, **more):
    """Lights of edges - 2 bounces. `how`: the visibility, or what differs from the published view_maps."""
    visibility = how if "type" in how else {"type": "view_maps", **PUBLISHED, **how}
    value = {**VIEWS[view], "resolution": list(resolution), "budget": {"iterations": 1}, "checkpoint_seconds": 86400,
             "integrator": {"type": "many_lights", "max_depth": edges, "light_paths": paths, "compensation": False,
                            "visibility": visibility}}
    value["integrator"].update(more.pop("integrator", {}))
    return {**value, **more}


def particles(view, count, how, **more):
    """Omnidirectional views at random places."""
    return map_job(view, count, how, edges=2, integrator={"direct": "lights", **more.pop("integrator", {})},
               particles={"count": count, "power": 300000, "color": [1, 0.8, 0.5], "low": [0.1, 0.02, 0.15],
                          "high": [0.9, 0.6, 0.85], "alone": True}, **more)


def map_statistics(run, name, value):
    return many_lights.render(run, name, value)["integrator"]


def map_seconds(told):
    return told["view_map_cpu_seconds"]


@ENTRIES.measured(
    "kol-fig-9", "Kol et al. 2018, section 3.2.4 (Fig. 9)", "few pairs of leaves need several pixels", NEEDS,
    (at_most("share of rendered pairs beyond a pixel", 0.05),))
def fig_9(run):
    """How many rendered pairs are leaves that need more than a texel."""
    rows = []
    for view in VIEWS:
        told = map_statistics(run, view, map_job(view, 65536, {}))
        share = told["view_splats_large"] / told["view_splats"]
        rows.append((view, round(told["virtual_lights"]), f"{told['view_splats']:.3g}", f"{share:.3g}"))
        if view == "Sponza":
            run.found("share of rendered pairs beyond a pixel", Measured(share))
    run.tables.append(Table(("scene", "lights", "rendered pairs", "beyond a texel"), rows))


PATHS = (2048, 8192, 32768, 131072, 524288, 1048576)  # lights of one bounce on sponza: nearly as many
MOST = {"megaviews": 1048576, "many_lods": 131072, "per_view": 1048576, "per_view_splats": 0}  # of the quick version
FEW = 512  # lights for which every leaf is drawn
WHOLE = 32768  # lights for which traversals are compared
PAIR_BYTES = 8  # of a pair in the paper's queue


def exponent(points):
    """The slope of a line through the logarithms."""
    xs, ys = ([math.log(p[i]) for p in points] for i in (0, 1))
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def traversals(run):
    """What culling saves, and what a breadth-first traversal holds."""

    def told(name, method, **how):
        return map_statistics(run, f"{name}-{method}", map_job("Sponza", WHOLE, {"method": method, **how}))

    rows = []
    for method in ("megaviews", "many_lods"):
        plain, all_seen = told("culled", method), told("not-culled", method, cull=False)
        queue = told("queue", method, traversal="breadth_first")
        rows.append((method, f"{map_seconds(plain):.3g}", f"{map_seconds(all_seen):.3g}",
                     f"{map_seconds(queue):.3g}", f"{queue['view_fusion_cpu_seconds']:.3g}",
                     f"{queue['view_queue_bytes'] / 2**20:.4g}", f"{queue['view_unfused_bytes'] / 2**20:.4g}"))
        if method == "megaviews":
            run.found("share of time that culling saves", Measured(1 - map_seconds(plain) / map_seconds(all_seen)))
    run.tables.append(Table((f"{WHOLE} light paths", "CPU s", "not culled", "breadth-first", "of it fusion",
                             "queue held, MiB", "maps of nodes, MiB"), rows))


@ENTRIES.measured(
    "kol-fig-10", "Kol et al. 2018, Fig. 10, section 4.1",
    "time grows less than linearly with views; against ManyLoDs at a million views ten times faster, in a tenth "
    "of the memory", f"{NEEDS} (megaviews, many_lods, per_view)",
    (at_most("exponent of time in views, 2k to 1M", 1), at_least("speed-up over ManyLoDs, 1M views", 10),
     at_least("memory of ManyLoDs / of ours, 1M views", 10), beside("speed-up over ManyLoDs, 2048 views", 1),
     at_most("share of time that culling saves", 0.2)))
def fig_10(run):
    """Time of the maps of all lights against their number, for MegaViews, ManyLoDs and a ray for each
    texel, and every leaf drawn for each light; what culling saves, and what a queue holds."""
    found = {}
    rows = []
    for method, most in MOST.items():
        for paths in (FEW, *PATHS):
            if paths > (PATHS[-1] if run.full and most > 0 else max(most, FEW)):
                continue
            i = map_statistics(run, f"{method}-{paths}", map_job("Sponza", paths, {"method": method}))
            found[method, paths] = i
            rows.append((method, round(i["virtual_lights"]), round(i["view_leaves"]), f"{i['view_tree_cpu_seconds']:.2g}",
                         f"{i['view_map_cpu_seconds']:.3g}", f"{i['views_sharing_a_splat']:.3g}",
                         f"{i['view_map_bytes'] / 2**20:.3g}", f"{i['view_queue_peak_pairs'] * PAIR_BYTES / 2**20:.3g}"))

    def seconds(method, paths):
        return map_seconds(found[method, paths])

    traversals(run)
    first, last = PATHS[0], PATHS[-1]
    lods = max(paths for m, paths in found if m == "many_lods")
    scale = found["megaviews", last]["virtual_lights"] / found["many_lods", lods]["virtual_lights"]
    points = [(found["megaviews", n]["virtual_lights"], seconds("megaviews", n)) for n in PATHS]
    run.found("exponent of time in views, 2k to 1M", Measured(exponent(points)))
    run.found("speed-up over ManyLoDs, 1M views", Measured(seconds("many_lods", lods) * scale / seconds("megaviews", last)))
    run.found("speed-up over ManyLoDs, 2048 views", Measured(seconds("many_lods", first) / seconds("megaviews", first)))
    run.found("memory of ManyLoDs / of ours, 1M views",
              Measured(found["many_lods", lods]["view_queue_peak_pairs"] * scale /
                       found["megaviews", last]["view_queue_peak_pairs"]))
    run.tables.append(Table(("method", "lights", "maps", "view tree, CPU s", "maps, CPU s", "views sharing a splat",
                             "maps, MiB", "queue, MiB"), rows))
    run.note(f"exponent from 64k views on: {exponent(points[3:]):.2f}; sponza, one bounce, 11 levels, maps of 16 x 16")
    run.note("queue, MiB: that a breadth-first traversal would hold at 8 bytes a pair; ours goes depth-first and holds none")
    if lods < last:
        run.note(f"ManyLoDs at 1M views: {scale:.2g} times that at {lods}, as the paper extrapolates")


@ENTRIES.measured(
    "kol-fig-11", "Kol et al. 2018, Fig. 11, section 4.1.1",
    "sponza, 64K views: random views against lights of one bounce", NEEDS,
    (at_most("time of random views / of one bounce", 4),))
def fig_11(run):
    """64K views at random places against lights of one bounce."""
    views = 65536
    jobs = {"one bounce": map_job("Sponza", 68800, {}), "four bounces": map_job("Sponza", 62500, {}, edges=6),
            "random": particles("Sponza", views, {})}
    told = {key: map_statistics(run, key, value) for key, value in jobs.items()}
    run.found("time of random views / of one bounce",
              Measured(map_seconds(told["random"])).ratio(Measured(map_seconds(told["one bounce"]))))
    run.tables.append(Table(("views", "number", "maps", "CPU s", "views sharing a splat"),
                            [(key, round(t["virtual_lights"]), round(t["view_leaves"]), f"{map_seconds(t):.3g}",
                              f"{t['views_sharing_a_splat']:.3g}") for key, t in told.items()]))
    run.note("ours at random see in all directions, those of one bounce half of them")


@ENTRIES.measured(
    "kol-fig-12", "Kol et al. 2018, Fig. 12, section 4.2", "time against the maps' resolution, 1M views",
    f"{NEEDS} (megaviews, many_lods)", (beside("time at twice the resolution / at one", 4),))
def fig_12(run):
    """Time against the resolution of the maps."""
    views, sizes = (1048576, (16, 32)) if run.full else (65536, (16, 32, 64, 128))
    rows, found = [], {}
    for method in ("megaviews", "many_lods"):
        for size in sizes:
            if method == "many_lods" and size > 64:
                continue
            t = map_statistics(run, f"{method}-{size}",
                                     map_job("Sponza", views, {"method": method, "map_size": size}))
            found[method, size] = map_seconds(t)
            rows.append((method, size, round(t["view_leaves"]), f"{map_seconds(t):.3g}",
                         f"{t['views_sharing_a_splat']:.3g}", f"{t['view_map_bytes'] / 2**20:.3g}"))
    run.found("time at twice the resolution / at one",
              Measured(found["megaviews", 32]).ratio(Measured(found["megaviews", 16])))
    run.tables.append(Table(("method", "texels a side", "maps", "CPU s", "views sharing a splat", "maps, MiB"), rows))
    if not run.full:
        run.note("64K views in place of 1M")


@ENTRIES.measured(
    "kol-fig-13", "Kol et al. 2018, Fig. 13, section 5.1",
    "sibenik, 64K lights: error and time of maps against the depth of both hierarchies", NEEDS,
    (beside("11 levels", 31, "ms"), beside("8 levels", 7, "ms"), at_least("time at 11 levels / at 8", 31 / 7),
     beside("leaves beyond a pixel, 8 levels / 11", 15)))
def fig_13(run):
    """Error and time of the maps against the depth of both octrees."""
    paths, at = 62500, (256, 128) if run.full else (96, 48)
    map_statistics(run, "exact", map_job("Sponza", paths, {"type": "exact"}, at, edges=6))
    rows, found = [], {}
    for levels in (7, 8, 9, 10, 11):
        name = f"levels-{levels}"
        t = found[levels] = map_statistics(run, name, map_job("Sponza", paths, {"levels": levels}, at, edges=6))
        e = many_lights.errors(run, name, "exact")
        rows.append((levels, round(t["view_leaves"]), f"{map_seconds(t):.3g}",
                     f"{t['view_splats_large'] / t['view_splats']:.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}",
                     f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.found("time at 11 levels / at 8",
              Measured(map_seconds(found[11])).ratio(Measured(map_seconds(found[8]))))
    run.tables.append(Table(("levels", "maps", "CPU s", "leaves beyond a texel", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"sponza, {found[11]['virtual_lights']:.0f} lights of up to four bounces; errors against exact visibility of "
             f"the same lights; pictures: {run.pictures}")


LARGEST = 256  # texels along a side of ours; the paper's are 1024


@ENTRIES.measured(
    "kol-fig-14", "Kol et al. 2018, Fig. 14, section 5.1",
    "hairball: 64K maps of 16 x 16 against 1024 x 1024; at equal time that leaves 18 lights", NEEDS,
    (beside("lights of 1024 x 1024 at equal time", 18),))
def fig_14(run):
    """Many small maps against a few large ones in the same time."""
    at = (128, 128) if run.full else (64, 64)
    paths = 32768 if run.full else 8192
    map_statistics(run, "exact", map_job("Hairball", paths, {"type": "exact"}, at))
    small = map_statistics(run, "small", map_job("Hairball", paths, {}, at))
    large = map_statistics(run, "large", map_job("Hairball", 64, {"map_size": LARGEST}, at))
    each = map_seconds(large) / large["virtual_lights"] * (1024 / LARGEST) ** 2
    run.found("lights of 1024 x 1024 at equal time", Measured(map_seconds(small) / each))
    rows = []
    for size in (16, 32, 64):
        t = map_statistics(run, f"size-{size}", map_job("Hairball", paths, {"map_size": size}, at))
        e = many_lights.errors(run, f"size-{size}", "exact")
        rows.append((size, f"{map_seconds(t):.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}",
                     f"{e['mean_relative']:+.3g}"))
    run.tables.append(Table(("texels a side", "CPU s", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"{small['virtual_lights']:.0f} lights; the time of a map of 1024 x 1024 is sixteen times that of "
             f"{LARGEST} x {LARGEST}; pictures: {run.pictures}")


@ENTRIES.measured(
    "kol-fig-15", "Kol et al. 2018, Fig. 15, section 5.1",
    "sibenik, 8K lights: maps of 64 x 64 against 16 x 16, and against ManyLoDs",
    f"{NEEDS} (megaviews, many_lods)", (at_least("error of 16 x 16 / of 64 x 64", 1),))
def fig_15(run):
    """Error of the maps against their resolution, with both hierarchies and with one."""
    paths, at = 8192, (512, 256) if run.full else (192, 96)
    map_statistics(run, "exact", map_job("Sponza", paths, {"type": "exact"}, at))
    rows, found = [], {}
    for key, how in (*((m, {"method": m}) for m in ("megaviews", "many_lods", "per_view")), ("ours", OURS)):
        for size in (16, 32, 64):
            name = f"{key}-{size}"
            t = map_statistics(run, name, map_job("Sponza", paths, {**how, "map_size": size, "levels": 9}, at))
            e = many_lights.errors(run, name, "exact")
            found[key, size] = e["rmse"]
            rows.append((key, size, f"{map_seconds(t):.3g}", f"{e['relmse']:.3g}", f"{e['psnr']:.3g}",
                         f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.found("error of 16 x 16 / of 64 x 64", Measured(found["megaviews", 16] / found["megaviews", 64]))
    run.tables.append(Table(("method", "texels a side", "CPU s", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"sponza, {paths} light paths of one bounce, 9 levels; per_view: a ray for each texel; ours: the defaults; "
             f"pictures: {run.pictures}")


@ENTRIES.measured(
    "kol-fig-16", "Kol et al. 2018, Fig. 16, section 5.1",
    "sponza, 64 of 1M lights a pixel: culling before lights are drawn lessens noise", NEEDS,
    (at_least("share of leaf views culled", 0.94), at_least("error without culling / with", 1)))
def fig_16(run):
    """Noise of 64 lights drawn for each pixel, with and without culling before, and filtered."""
    paths, at = 1048576, (256, 128) if run.full else (96, 48)

    def picture(name, **gather):
        value = map_job("Sponza", paths, OURS, at, integrator={"gather": gather})
        return map_statistics(run, name, value)

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
            run.found("share of leaf views culled", Measured(t["lights_culled"]))
    run.found("error without culling / with", Measured(found["not culled"]["rmse"] / found["culled"]["rmse"]))
    run.tables.append(Table(("64 lights a pixel", "culled", "eye pass, CPU s", "RMSE", "relMSE", "PSNR", "SSIM", "mean"),
                            rows))
    run.note(f"against all lights with the same maps; pictures: {run.pictures}")


@ENTRIES.measured(
    "kol-fig-17", "Kol et al. 2018, Fig. 17, section 5.2", "san miguel, glowing particles: time of their maps",
    f"{NEEDS} (megaviews, many_lods), omnidirectional",
    (beside("4K particles", 21, "ms"), beside("64K particles", 184, "ms"),
     beside("speed-up over ManyLoDs, 64K particles", 2)))
def fig_17(run):
    """Time of the maps of glowing particles, and what they add to the picture."""
    rows, found = [], {}
    for method in ("megaviews", "many_lods"):
        for count in (4096, 65536):
            t = map_statistics(run, f"{method}-{count}", particles("Sponza", count, {"method": method}))
            found[method, count] = Measured(map_seconds(t))
            rows.append((method, count, round(t["view_leaves"]), f"{map_seconds(t):.3g}",
                         f"{t['views_sharing_a_splat']:.3g}"))
    run.found("speed-up over ManyLoDs, 64K particles", found["many_lods", 65536].ratio(found["megaviews", 65536]))
    run.tables.append(Table(("method", "particles", "maps", "CPU s", "views sharing a splat"), rows))
    at = (640, 360) if run.full else (320, 180)
    for name, how in (("exact", {"type": "exact"}), ("none", {"type": "none"}), ("maps", {"map_size": 32, "levels": 9})):
        map_statistics(run, name, particles("Sponza", 1024, how, resolution=at))
    rows = []
    for name in ("none", "maps"):
        e = many_lights.errors(run, name, "exact")
        rows.append((name, f"{e['relmse']:.3g}", f"{e['psnr']:.3g}", f"{e['ssim']:.3g}", f"{e['mean_relative']:+.3g}"))
    run.tables.append(Table(("1024 particles", "relMSE", "PSNR", "SSIM", "mean"), rows))
    run.note(f"the paper's times are of San Miguel on a GPU; pictures: {run.pictures}")
