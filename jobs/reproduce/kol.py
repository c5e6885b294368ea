"""Many views through two hierarchies. The paper's times are those of a GeForce GTX 1080 Ti: ratios are compared. Every
entry renders one iteration of many lights, each with a map. Of the paper's scenes Sponza is ours;
others stand for the hairball, Sibenik and San Miguel.

`published`: the paper's rules, with as many leaves of the scene as the paper counts, and ManyLoDs and rays for each single
view. `ours`: this project's defaults, with competitors of the same settings."""

import math

from harness import many_lights
from harness.entry import Entries
from harness.measured import exact, geometric_mean_of, mean_of
from harness.run import Table
from harness.verdict import at_least, at_most, beside, near

ENTRIES = Entries()
NEEDS = "many_lights with visibility: view_maps"
VIEWS = {"Sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
         "Hairball": {"scene": "hairball_2800k.glb", "camera": "front"},
         "Sibenik": {"scene": "nave.glb", "camera": "door"},
         "San Miguel": {"scene": "atrium.glb", "camera": "court"},
         "Door": {"scene": "door/scene.glb", "camera": "corner"}}


OURS = {"type": "view_maps"}  # its defaults
RULES = {"node_texels": 1, "cover": 0, "bounds": "spheres", "split": "position"}
# 6.0, 6.9, 3.1 and 1.6 million leaves, as in the paper (section 4.1).
LEVELS = {"Sponza": 9.675, "Hairball": 9.097, "Sibenik": 10.097, "San Miguel": 9.583, "Door": 10}
STAND_INS = "stand-ins of our own making: hairball_2800k.glb, nave.glb for Sibenik, atrium.glb for San Miguel"
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
    for view in ("Sponza", "Hairball", "Door"):
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


# Besides sponza with lights of one bounce: the scene, the edges, the light paths over lights.
OTHERS = {"sponza, four bounces": ("Sponza", 6, 61 / 64), "hairball": ("Hairball", 3, 1), "sibenik": ("Sibenik", 3, 1),
          "san miguel": ("San Miguel", 3, 1)}


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
CULLING = ("pairs fall by 54 %: half of all directions are behind a light. More is saved because the wall that a light lies on is behind it, "
           "too: without culling sixteen times as many leaves cover several texels, which are filled one by one. The paper's times "
           "exclude that (section 4)")


@ENTRIES.measured(
    "kol-fig-10", "Kol et al. 2018, Fig. 10, section 4.1",
    "time grows less than linearly with views; against ManyLoDs at a million views ten times faster, in a tenth "
    "of the memory", f"{NEEDS} (megaviews, many_lods, per_view)",
    (at_most("exponent of time in views, 2k to 1M", 1), at_least("speed-up over ManyLoDs, 1M views", 10, why=PAIRS),
     at_least("queue of ManyLoDs / of ours, 1M views", 10, why=QUEUE),
     at_least("queue and maps of ManyLoDs / of ours, 1M views", 10, why=QUEUE),
     near("speed-up over ManyLoDs, 2048 views", 1), beside("time of a ray a texel / of ours, 128k views"),
     at_most("share of time that culling saves", 0.2, why=CULLING)))
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
    "kol-fig-10-scenes", "Kol et al. 2018, Fig. 10, section 4.1",
    "the same on other scenes: time grows less than linearly in all, an order of magnitude on average",
    f"{NEEDS} (megaviews, many_lods)",
    (*(at_most(f"exponent of time in views, {name}", 1) for name in OTHERS),
     *(beside(f"speed-up over ManyLoDs, 1M views, {name}") for name in OTHERS),
     at_least("speed-up over ManyLoDs, 1M views, mean of the scenes", 10, why=PAIRS)))
def fig_10_scenes(run):
    """MegaViews against ManyLoDs on the other scenes, each with as many leaves as the paper's."""
    rows = []
    for kind in ("published", "ours"):
        found = {}
        for name, (view, edges, share) in OTHERS.items():
            one = Growth(run, kind, view, edges, ("megaviews", "many_lods"), [round(n * share) for n in PATHS if n >= 32768])
            rows += [(f"{row[0]}, {name}", *row[1:]) for row in one.rows]
            found[name] = one.speed_up()
            run.found(f"exponent of time in views, {name}", **{kind: one.exponent()})
            run.found(f"speed-up over ManyLoDs, 1M views, {name}", **{kind: found[name]})
        run.found("speed-up over ManyLoDs, 1M views, mean of the scenes",
                  **{kind: geometric_mean_of([speed_up.value for speed_up in found.values()])})
    run.tables.append(Table(COLUMNS, rows))
    run.note(f"the interval of the mean is that between scenes; {STAND_INS}")


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
    f"{NEEDS} (megaviews, many_lods)", 
    (*(near(f"{method}: time at {2 * size} texels / at {size}", 4) for method in ("megaviews", "many_lods") for size in (16, 32)),
     at_most("speed-up over ManyLoDs at 64 texels / at 16", 1)))
def fig_12(run):
    """Time against the resolution of the maps."""
    views, sizes = 1048576 if run.full else 65536, (16, 32, 64)
    rows, found = [], {}
    for method in ("megaviews", "many_lods"):
        for size in sizes:
            told = found[method, size] = repeated(run, f"{method}-{size}",
                                                  map_job("Sponza", views, {"method": method, "map_size": size}))
            t = told[0]
            rows.append((method, size, round(t["view_leaves"]), str(mean_of(list(map(map_seconds, told)))),
                         f"{t['views_sharing_a_splat']:.3g}", f"{t['view_map_bytes'] / 2**20:.3g}"))
        for size in sizes[:-1]:
            run.found(f"{method}: time at {2 * size} texels / at {size}", published=ratio(found[method, 2 * size], found[method, size]))
    seconds = {key: list(map(map_seconds, told)) for key, told in found.items()}
    run.found("speed-up over ManyLoDs at 64 texels / at 16", published=geometric_mean_of(
        [b / a / (d / c) for a, b, c, d in zip(*(seconds[m, size] for size in (64, 16) for m in ("megaviews", "many_lods")))]))
    run.tables.append(Table(("method", "texels a side", "maps", "CPU s", "views sharing a splat", "maps, MiB"), rows))
    if not run.full:
        run.note("64K views in place of 1M")
