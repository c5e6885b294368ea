"""Many views through two hierarchies. GPU times (GeForce GTX 1080 Ti) are information. Every
entry renders one iteration of many lights, each with a map. The paper's other scenes (Sibenik, San Miguel) are not ours:
Sponza and the hairball stand for them.

`published`: the paper's rules, with as many leaves of the scene as the paper counts, and ManyLoDs and rays for each single
view. `ours`: this project's defaults, with competitors of the same settings."""

import math

from harness import many_lights
from harness.entry import Entries
from harness.measured import exact, geometric_mean_of, mean_of
from harness.run import Table
from harness.verdict import at_least, at_most, beside

ENTRIES = Entries()
NEEDS = "many_lights with visibility: view_maps"
VIEWS = {"Sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
         "Hairball": {"scene": "hairball.glb", "camera": "front"},
         "Door": {"scene": "door/scene.glb", "camera": "corner"}}


OURS = {"type": "view_maps"}  # its defaults
RULES = {"node_texels": 1, "cover": 0, "bounds": "spheres", "split": "position"}
LEVELS = {"Sponza": 9.675, "Hairball": 9.385, "Door": 10}  # 6.0 and 6.9 million leaves, as in the paper (section 4.1)
SINGLE = {"many_lods", "per_view", "per_view_splats"}  # methods that the paper has for each single view


def published(view, how):
    """The visibility as published with what differs."""
    share = {"share": "none"} if how.get("method") in SINGLE else {}
    return {"type": "view_maps", "levels": LEVELS[view], **RULES, **share, **how}


def map_job(view, paths, how, resolution=(32, 16), edges=3, **more):
    """Lights of edges - 2 bounces. `how`: the visibility, or what differs from the published view_maps."""
    visibility = how if "type" in how else published(view, how)
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


SEEDS = 3


def repeated(run, name, value):
    """map_statistics() of the seeds 0, 1, ...; they are called NAME-SEED."""
    return [report["integrator"] for report in run.repeated(name, value, SEEDS)]


def ratio(above, below, value=map_seconds):
    """Of a number of two lists of statistics, seed by seed."""
    return geometric_mean_of([value(a) / value(b) for a, b in zip(above, below)])


def mean_error(run, name, exact_name, metric):
    """Of the pictures of repeated() against those of the same lights."""
    return mean_of([many_lights.errors(run, f"{name}-{seed}", f"{exact_name}-{seed}")[metric] for seed in range(SEEDS)])


ERRORS = ("relmse", "psnr", "ssim", "mean_relative")
ERROR_HEADS = ("relMSE", "PSNR", "SSIM", "mean")


def error_cells(run, name, exact_name, metrics=ERRORS):
    return [str(mean_error(run, name, exact_name, metric)) for metric in metrics]


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
            run.found("share of rendered pairs beyond a pixel", published=exact(share))
    run.tables.append(Table(("scene", "lights", "rendered pairs", "beyond a texel"), rows))


PATHS = (2048, 8192, 32768, 131072, 524288, 1048576)  # lights of one bounce on sponza: nearly as many
FEW = 512  # lights for which every leaf is drawn
WHOLE = 32768  # lights for which traversals are compared
PAIR_BYTES = 8  # of a pair in the paper's queue
METHODS = ("megaviews", "many_lods", "per_view")
COLUMNS = ("settings", "method", "lights", "maps", "leaves of the scene", "view tree, CPU s", "maps, CPU s",
           "pairs a light", "views sharing a splat", "maps, MiB", "queue, MiB")


def exponent(points):
    """The slope of a line through the logarithms."""
    xs, ys = ([math.log(p[i]) for p in points] for i in (0, 1))
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def traversals(run):
    """What culling saves, and what a breadth-first traversal holds."""

    def told(name, method, **how):
        return repeated(run, f"{name}-{method}", map_job("Sponza", WHOLE, {"method": method, **how}))

    def saved(culled, all_seen):
        return mean_of([1 - map_seconds(a) / map_seconds(b) for a, b in zip(culled, all_seen)])

    rows = []
    for method in ("megaviews", "many_lods"):
        plain, all_seen = told("culled", method), told("not-culled", method, cull=False)
        boxes = told("boxes", method, bounds="boxes")
        queue = told("queue", method, traversal="breadth_first")
        rows.append((method, *(str(mean_of(list(map(map_seconds, t)))) for t in (plain, boxes, all_seen, queue)),
                     f"{queue[0]['view_fusion_cpu_seconds']:.3g}", f"{queue[0]['view_queue_bytes'] / 2**20:.4g}",
                     f"{queue[0]['view_unfused_bytes'] / 2**20:.4g}"))
        if method == "megaviews":
            run.found("share of time that culling saves", ours=saved(boxes, all_seen), published=saved(plain, all_seen))
    run.tables.append(Table((f"{WHOLE} light paths", "culled by spheres, CPU s", "by boxes", "not culled", "breadth-first",
                             "of it fusion", "queue held, MiB", "maps of nodes, MiB"), rows))


class Growth:
    """Time and memory of each method against the number of views, with the settings of one kind; numbers are those of each
    seed, with an interval."""

    def __init__(self, run, kind, view="Sponza", edges=3, methods=METHODS, paths=PATHS):
        self.found, self.rows = {}, []
        some = paths if run.full else [n for n in paths if n <= 131072]  # of what grows in proportion
        for method in methods:
            own = {"method": method, **({"share": "none"} if method in SINGLE else {})}
            how = published(view, own) if kind == "published" else {**OURS, **own}
            for n in (paths if method == "megaviews" else some):
                told = repeated(run, f"{kind}-{view}-{edges}-{method}-{n}", map_job(view, n, how, edges=edges))
                self.found[method, n] = told
                t = told[0]
                self.rows.append((kind, method, round(t["virtual_lights"]), round(t["view_leaves"]),
                                  f"{t['scene_leaves']:.3g}", f"{t['view_tree_cpu_seconds']:.2g}",
                                  str(mean_of(list(map(map_seconds, told)))),
                                  f"{t['view_pairs'] / t['virtual_lights']:.4g}", f"{t['views_sharing_a_splat']:.3g}",
                                  f"{t['view_map_bytes'] / 2**20:.3g}",
                                  f"{t['view_queue_peak_pairs'] * PAIR_BYTES / 2**20:.3g}"))
        self.first, self.last, self.lods = paths[0], paths[-1], some[-1]

    def scaled(self, value):
        """Of each seed `value` of ManyLoDs at most views, and of ours. ManyLoDs grow in proportion to the views, as the
        paper extrapolates."""
        for all_views, lods in zip(self.found["megaviews", self.last], self.found["many_lods", self.lods]):
            yield value(lods) * all_views["virtual_lights"] / lods["virtual_lights"], value(all_views)

    def exponent(self, least=0):
        kept = [told for (m, n), told in self.found.items() if m == "megaviews" and n >= least]
        return mean_of([exponent([(t["virtual_lights"], map_seconds(t)) for t in one]) for one in zip(*kept)])

    def speed_up(self):
        """Over ManyLoDs, at most views."""
        return geometric_mean_of([lods / ours for lods, ours in self.scaled(map_seconds)])

    def queue(self):
        """Of ManyLoDs over ours, at most views."""
        return geometric_mean_of([lods / ours for lods, ours in self.scaled(lambda t: t["view_queue_peak_pairs"])])

    def memory(self):
        """The same with the maps of single views in 32 bits, and with the maps of all nodes of the view tree; the
        scene's octree is in both."""
        maps = 2 * 16 * 16 * 4

        def held(t, views):
            return t["view_queue_peak_pairs"] * PAIR_BYTES + maps * t[views]

        return geometric_mean_of([
            lods / held(ours, "view_leaves") for (lods, _), ours in
            zip(self.scaled(lambda t: held(t, "virtual_lights")), self.found["megaviews", self.last])])

    def over(self, method, n):
        """Time of another method over ours."""
        return ratio(self.found[method, n], self.found["megaviews", n])


# Why less is reached as published.
PAIRS = ("times are in proportion to pairs of nodes, and ManyLoDs have five times as many for each light; by this project's rules, "
         "whose boxes cull what spheres keep, ten times is reached")
QUEUE = "the queue shrinks where views share what they see, as pairs do, and falls short of the paper's tenth as they do"


@ENTRIES.measured(
    "kol-fig-10", "Kol et al. 2018, Fig. 10, section 4.1",
    "time grows less than linearly with views; against ManyLoDs at a million views ten times faster, in a tenth "
    "of the memory", f"{NEEDS} (megaviews, many_lods, per_view)",
    (at_most("exponent of time in views, 2k to 1M", 1), at_least("speed-up over ManyLoDs, 1M views", 10, why=PAIRS),
     at_least("queue of ManyLoDs / of ours, 1M views", 10, why=QUEUE),
     at_least("queue and maps of ManyLoDs / of ours, 1M views", 10, why=QUEUE),
     beside("speed-up over ManyLoDs, 2048 views", 1), beside("time of a ray a texel / of ours, 128k views"),
     beside("share of time that culling saves", 0.2), beside("speed-up over ManyLoDs, 1M views, four bounces", 10),
     beside("speed-up over ManyLoDs, 1M views, hairball", 10)))
def fig_10(run):
    """Time of the maps of all lights against their number, for MegaViews, ManyLoDs and a ray for each
    texel; what culling saves, and what a queue holds."""
    rows = []
    for kind in ("published", "ours"):
        one = Growth(run, kind)
        rows += one.rows
        found = {"exponent of time in views, 2k to 1M": one.exponent(), "speed-up over ManyLoDs, 1M views": one.speed_up(),
                 "queue of ManyLoDs / of ours, 1M views": one.queue(),
                 "queue and maps of ManyLoDs / of ours, 1M views": one.memory(),
                 "speed-up over ManyLoDs, 2048 views": one.over("many_lods", one.first),
                 "time of a ray a texel / of ours, 128k views": one.over("per_view", 131072)}
        run.note(f"{kind}: exponent from 32k views on {one.exponent(32768)}; time of rays / of ours: " +
                 ", ".join(f"{one.over('per_view', n)} at {n}" for m, n in one.found if m == "per_view"))
        some, two = [n for n in PATHS if n >= 32768], ("megaviews", "many_lods")
        for name, view, edges, paths in (("four bounces", "Sponza", 6, [n * 61 // 64 for n in some]),
                                         ("hairball", "Hairball", 3, some)):
            other = Growth(run, kind, view, edges, two, paths)
            rows += [(f"{row[0]}, {name}", *row[1:]) for row in other.rows]
            found[f"speed-up over ManyLoDs, 1M views, {name}"] = other.speed_up()
        for quantity, value in found.items():
            run.found(quantity, **{kind: value})
    traversals(run)
    run.tables.append(Table(COLUMNS, rows))
    if run.full:
        leaves = map_statistics(run, "every-leaf", map_job("Sponza", FEW, {"method": "per_view_splats"}))
        run.note(f"every leaf drawn for each of {leaves['virtual_lights']:.0f} lights: {map_seconds(leaves):.3g} s")
    run.note("queue, MiB: that a breadth-first traversal would hold at 8 bytes a pair; ours goes depth-first and holds none")
    if not run.full:
        run.note("ManyLoDs at 1M views: in proportion to those at 128k, as the paper extrapolates")


@ENTRIES.measured(
    "kol-fig-11", "Kol et al. 2018, Fig. 11, section 4.1.1",
    "sponza, 64K views: random views against lights of one bounce", NEEDS,
    (at_most("time of random views / of one bounce", 4),
     *(at_most(f"exponent of time in views, {kind}", 1) for kind in ("one bounce", "four bounces", "random"))))
def fig_11(run):
    """Views at random places against lights of one bounce, and how their time grows with their number."""
    numbers = (8192, 65536, 524288) if run.full else (8192, 65536)
    kinds = {"one bounce": lambda n: map_job("Sponza", round(n * 1.05), {}),
             "four bounces": lambda n: map_job("Sponza", round(n * 0.954), {}, edges=6),
             "random": lambda n: particles("Sponza", n, {})}
    told, rows = {}, []
    for kind, job in kinds.items():
        for n in numbers:
            t = told[kind, n] = repeated(run, f"{kind}-{n}", job(n))
            rows.append((kind, round(t[0]["virtual_lights"]), round(t[0]["view_leaves"]),
                         str(mean_of(list(map(map_seconds, t)))), f"{t[0]['views_sharing_a_splat']:.3g}"))
    run.found("time of random views / of one bounce", published=ratio(told["random", 65536], told["one bounce", 65536]))
    for kind in kinds:
        few, many = told[kind, numbers[0]], told[kind, numbers[-1]]
        run.found(f"exponent of time in views, {kind}", published=mean_of(
            [exponent([(t["virtual_lights"], map_seconds(t)) for t in pair]) for pair in zip(few, many)]))
    run.tables.append(Table(("views", "number", "maps", "CPU s", "views sharing a splat"), rows))
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
            told = found[method, size] = repeated(run, f"{method}-{size}",
                                                  map_job("Sponza", views, {"method": method, "map_size": size}))
            t = told[0]
            rows.append((method, size, round(t["view_leaves"]), str(mean_of(list(map(map_seconds, told)))),
                         f"{t['views_sharing_a_splat']:.3g}", f"{t['view_map_bytes'] / 2**20:.3g}"))
    run.found("time at twice the resolution / at one", published=ratio(found["megaviews", 32], found["megaviews", 16]))
    run.tables.append(Table(("method", "texels a side", "maps", "CPU s", "views sharing a splat", "maps, MiB"), rows))
    if not run.full:
        run.note("64K views in place of 1M")


@ENTRIES.measured(
    "kol-fig-13", "Kol et al. 2018, Fig. 13, section 5.1",
    "sibenik, 64K lights: error and time of maps against the depth of both hierarchies", NEEDS,
    (beside("11 levels", 31, "ms"), beside("8 levels", 7, "ms"), beside("time at 11 levels / at 8", 31 / 7),
     beside("leaves beyond a pixel, 8 levels / 11", 15)))
def fig_13(run):
    """Error and time of the maps against the depth of both octrees."""
    paths, at = 62500, (256, 128) if run.full else (96, 48)
    repeated(run, "exact", map_job("Sponza", paths, {"type": "exact"}, at, edges=6))
    rows = []
    for which, rules in (("published", {}), ("ours", OURS)):
        found = {}
        for levels in (7, 8, 9, 10, 11):
            name = f"{which}-levels-{levels}"
            told = found[levels] = repeated(run, name, map_job("Sponza", paths, {**rules, "levels": levels}, at, edges=6))
            t = told[0]
            rows.append((which, levels, round(t["view_leaves"]), str(mean_of(list(map(map_seconds, told)))),
                         f"{t['view_splats_large'] / t['view_splats']:.3g}", *error_cells(run, name, "exact")))
            if levels in (7, 9, 11):
                run.show(f"{which}, {levels} levels", run.place(f"{name}-0"))
        run.found("time at 11 levels / at 8", **{which: ratio(found[11], found[8])})
        run.found("leaves beyond a pixel, 8 levels / 11",
                  **{which: ratio(found[8], found[11], lambda t: t["view_splats_large"])})
        for levels in (8, 11):
            run.found(f"{levels} levels", **{which: mean_of([1000 * map_seconds(t) for t in found[levels]])})
    run.show("exact", run.place("exact-0"))
    run.tables.append(Table(("rules", "levels", "maps", "CPU s", "leaves beyond a texel", *ERROR_HEADS), rows))
    run.note(f"sponza, {told[0]['virtual_lights']:.0f} lights of up to four bounces; errors against exact visibility of "
             "the same lights. Published: a leaf fills the texel that contains its centre, so that shadows grow with the levels")


LARGEST = 1024  # texels along a side


@ENTRIES.measured(
    "kol-fig-14", "Kol et al. 2018, Fig. 14, section 5.1",
    "hairball: 64K maps of 16 x 16 against 1024 x 1024; at equal time that leaves 18 lights", NEEDS,
    (beside("lights of 1024 x 1024 at equal time", 18),))
def fig_14(run):
    """Many small maps against a few large ones in the same time."""
    at = (128, 128) if run.full else (64, 64)
    paths = 32768 if run.full else 8192
    repeated(run, "exact", map_job("Hairball", paths, {"type": "exact"}, at))
    large = repeated(run, "large", map_job("Hairball", 16, {"map_size": LARGEST}, at))
    rows = []
    for size in (16, 32, 64):
        name = f"size-{size}"
        told = repeated(run, name, map_job("Hairball", paths, {"map_size": size}, at))
        if size == 16:
            run.found("lights of 1024 x 1024 at equal time", published=geometric_mean_of(
                [map_seconds(a) / map_seconds(b) * b["virtual_lights"] for a, b in zip(told, large)]))
        rows.append((size, str(mean_of(list(map(map_seconds, told)))), *error_cells(run, name, "exact")))
        run.show(f"{size} x {size}", run.place(f"{name}-0"))
    run.show("exact", run.place("exact-0"))
    run.tables.append(Table(("texels a side", "CPU s", *ERROR_HEADS), rows))
    run.note(f"{told[0]['virtual_lights']:.0f} lights, in full 64K as in the paper")


@ENTRIES.measured(
    "kol-fig-15", "Kol et al. 2018, Fig. 15, section 5.1",
    "sibenik, 8K lights: maps of 64 x 64 against 16 x 16, and against ManyLoDs",
    f"{NEEDS} (megaviews, many_lods)", (at_least("error of 16 x 16 / of 64 x 64", 1),))
def fig_15(run):
    """Error of the maps against their resolution, with both hierarchies and with one."""
    paths, at = 8192, (512, 256) if run.full else (192, 96)
    repeated(run, "exact", map_job("Sponza", paths, {"type": "exact"}, at))
    rows = []
    for key, how in (*((m, {"method": m}) for m in ("megaviews", "many_lods", "per_view")), ("ours", OURS)):
        for size in (16, 32, 64):
            name = f"{key}-{size}"
            told = repeated(run, name, map_job("Sponza", paths, {**how, "map_size": size, "levels": 9}, at))
            rows.append((key, size, str(mean_of(list(map(map_seconds, told)))), *error_cells(run, name, "exact")))
            if key != "per_view" and size != 32:
                run.show(f"{key}, {size} x {size}", run.place(f"{name}-0"))
    run.show("exact", run.place("exact-0"))
    for which, key in (("published", "megaviews"), ("ours", "ours")):
        small, large = (mean_error(run, f"{key}-{size}", "exact", "rmse") for size in (16, 64))
        run.found("error of 16 x 16 / of 64 x 64", **{which: small.ratio(large)})
    run.tables.append(Table(("method", "texels a side", "CPU s", *ERROR_HEADS), rows))
    run.note(f"sponza, {paths} light paths of one bounce, 9 levels; per_view: a ray for each texel; ours: the defaults")


@ENTRIES.measured(
    "kol-fig-16", "Kol et al. 2018, Fig. 16, section 5.1",
    "sponza, 64 of 1M lights a pixel: culling and a cut-off before lights are drawn lessen noise", NEEDS,
    (at_least("share of leaf views culled", 0.94, why="the paper's 94 % include its cut-off; without it 90 % are culled, and "
              "the picture stays unbiased"), at_least("error without culling / with", 1)))
def fig_16(run):
    """Noise of 64 lights drawn for each pixel, with and without culling before, and filtered."""
    paths, at = 1048576, (256, 128) if run.full else (96, 48)

    def picture(name, **gather):
        return repeated(run, name, map_job("Sponza", paths, OURS, at, integrator={"gather": gather}))

    picture("all", type="all")
    rows, found = [], {}
    for name, gather in (("culled", {}), ("not culled", {"cull": False}), ("culled, filtered", {"filter_radius": 3}),
                         ("culled, filtered more", {"filter_radius": 8}),
                         # A sixth of the length of the atrium, and a twelfth.
                         ("culled, cutoff 600", {"cutoff": 600}), ("culled, cutoff 300", {"cutoff": 300})):
        key = name.replace(", ", "-").replace(" ", "-")
        told = picture(key, type="random", lights=64, **gather)
        found[name] = mean_error(run, key, "all", "rmse")
        rows.append((name, *(str(mean_of([t[value] for t in told])) for value in ("lights_culled", "eye_pass_cpu_seconds")),
                     str(found[name]), *error_cells(run, key, "all")))
        run.show(name, run.place(f"{key}-0"))
        which = {"culled": "ours", "culled, cutoff 600": "published"}.get(name)
        if which:
            run.found("share of leaf views culled", **{which: mean_of([t["lights_culled"] for t in told])})
    run.show("all lights", run.place("all-0"))
    run.found("error without culling / with", found["not culled"].ratio(found["culled"]))
    run.tables.append(Table(("64 lights a pixel", "culled", "eye pass, CPU s", "RMSE", *ERROR_HEADS), rows))
    run.note("against all lights with the same maps; published: with a cut-off, whose distance the paper does not tell; ours: "
             "without, because it is biased")


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
            told = found[method, count] = repeated(run, f"{method}-{count}",
                                                   particles("Sponza", count, {"method": method}))
            seconds = mean_of(list(map(map_seconds, told)))
            rows.append((method, count, round(told[0]["view_leaves"]), str(seconds),
                         f"{told[0]['views_sharing_a_splat']:.3g}"))
            if method == "megaviews":
                run.found(f"{count // 1024}K particles", published=seconds.scaled(1000))
    run.found("speed-up over ManyLoDs, 64K particles",
              published=ratio(found["many_lods", 65536], found["megaviews", 65536]))
    run.tables.append(Table(("method", "particles", "maps", "CPU s", "views sharing a splat"), rows))
    at = (640, 360) if run.full else (320, 180)
    for name, how in (("exact", {"type": "exact"}), ("none", {"type": "none"}), ("maps", {"map_size": 32, "levels": 9})):
        repeated(run, name, particles("Sponza", 1024, how, resolution=at))
        run.show(f"1024 particles, visibility {name}", run.place(f"{name}-0"))
    run.tables.append(Table(("1024 particles", *ERROR_HEADS), [
        (name, *error_cells(run, name, "exact")) for name in ("none", "maps")]))
    run.note("the paper's times are of San Miguel on a GPU")
