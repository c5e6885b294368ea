"""Parts of many-view rendering that this project does otherwise by default (Kol et al. 2018): queries without fusion, splats into
coarser levels of the maps, culling by a traversal of both hierarchies before lights are gathered."""

from harness.entry import Entries
from harness.measured import geometric_mean_of, mean_of
from harness.run import Table
from harness.verdict import at_least, beside
from kol import ERROR_HEADS, NEEDS, OURS, WHOLE, error_cells, map_job, map_seconds, mean_error, ratio, repeated

ENTRIES = Entries()
QUERIES, READ = "time of queries without fusion / with", "texels that a query reads without fusion"
CACHED = ("a query reads about nine texels where one is enough, but the maps near the root stay in the processor's cache; counted are the "
          "plane of the surface and all else of a query, too")


@ENTRIES.measured(
    "kol-queries", "Kol et al. 2018, sections 3.2.5 and 4.1.2",
    "\"querying without\" fusion \"is an order of magnitude slower, since each query visits a number of potentially sparse renderings\"",
    NEEDS, (at_least(QUERIES, 10, why=CACHED), beside(READ)))
def queries(run):
    """The time of the eye pass beyond that without visibility, where queries read the fused maps or descend the hierarchy."""
    def told(name, how):
        return repeated(run, name, map_job("Sponza", WHOLE, how, (128, 64)))

    none, fused = told("none", {"type": "none"}), told("fused", {"traversal": "breadth_first"})
    descending = told("descend", {"queries": "descend"})

    def seconds(of):
        return [t["eye_pass_cpu_seconds"] - n["eye_pass_cpu_seconds"] for t, n in zip(of, none)]

    run.found(QUERIES, published=geometric_mean_of([d / f for d, f in zip(seconds(descending), seconds(fused))]))
    run.found(READ, published=mean_of([t["view_texels_queried"] / t["view_queries"] for t in descending]))
    run.tables.append(Table(("maps", "queries", "CPU s of queries", "of fusion"), [
        (name, f"{descending[0]['view_queries']:.4g}", str(mean_of(seconds(of))), f"{of[0]['view_fusion_cpu_seconds']:.3g}")
        for name, of in (("fused", fused), ("not fused", descending))]))
    run.note(f"sponza, {WHOLE} light paths; the pictures are the same bit by bit")


SIZES = {256: 512, 1024: 16}  # texels along a side, as in Figs 12 and 14; light paths
PUSH = "the push reads every texel of the map and of its levels, as much as leaves of four or five texels each take"


def filled(size):
    return f"{size} x {size}: texels looked at to fill leaves beyond a pixel one by one / by levels of the map"


def filling_time(size):
    return f"{size} x {size}: time of the maps, leaves filled one by one / by levels"


@ENTRIES.measured(
    "kol-mip-splats", "Kol et al. 2018, section 3.2.4 (Fig. 9)",
    "\"We could fill the pixels one by one. However, mipmap splatting is more efficient\"", NEEDS,
    tuple(claim for size in SIZES for claim in (
        at_least(filling_time(size), 1), at_least(filled(size), 1, why=PUSH if size == 256 else ""))))
def mip_splats(run):
    """Work, time and error of large maps by both ways to draw leaves of the scene that cover several texels."""
    rows = []
    for size, paths in SIZES.items():
        told, exact_name = {}, f"{size}-exact"
        repeated(run, exact_name, map_job("Sponza", paths, {"type": "exact"}, (96, 48)))
        for filling in ("texels", "mips"):
            name = f"{size}-{filling}"
            told[filling] = repeated(run, name, map_job("Sponza", paths, {"map_size": size, "filling": filling}, (96, 48)))
            t = told[filling][0]
            rows.append((size, filling, f"{t['view_splats_large']:.3g}", f"{t['view_texels_filled']:.4g}",
                         str(mean_of(list(map(map_seconds, told[filling])))), *error_cells(run, name, exact_name)))
        run.found(filled(size), published=ratio(told["texels"], told["mips"], lambda t: t["view_texels_filled"]))
        run.found(filling_time(size), published=ratio(told["texels"], told["mips"]))
    run.tables.append(Table(("texels a side", "filled by", "leaves beyond a texel", "texels", "CPU s", *ERROR_HEADS), rows))
    run.note(f"sponza, {SIZES[256]} and {SIZES[1024]} light paths of one bounce")


CULLED, NOISE = "share of leaf views culled, cut-off 600", "error without culling / with"
CUT_OFF = "the paper tells neither the distance of its cut-off nor the scene's part that its views see"


@ENTRIES.measured(
    "kol-culling", "Kol et al. 2018, section 5.1 (Fig. 16)",
    "a traversal of both hierarchies to level 6 culls 94 % of the leaf views before lights are gathered, which lessens noise", NEEDS,
    (at_least(CULLED, 0.94, why=CUT_OFF), at_least(NOISE, 1), beside("tests of groups of lights, for points / for cubes")))
def culling(run):
    """Noise of 64 lights drawn for each pixel from what is left for the pixel, or for the cube of the scene that it lies in."""
    paths, at = 1048576 if run.full else 131072, (256, 128) if run.full else (96, 48)

    def picture(name, **gather):
        return repeated(run, name, map_job("Sponza", paths, OURS, at, integrator={"gather": gather}))

    picture("all", type="all")
    told, errors, rows = {}, {}, []
    for name, gather in (("not-culled", {"cull": False}), ("points", {}), ("cubes", {"cull_for": "cubes"}),
                         ("points-cutoff", {"cutoff": 600}), ("cubes-cutoff", {"cutoff": 600, "cull_for": "cubes"})):
        told[name] = picture(name, type="random", lights=64, **gather)
        errors[name] = mean_error(run, name, "all", "rmse")
        culled = "light_leaves_culled" if "cubes" in name else "lights_culled"
        rows.append((name, *(str(mean_of([t[key] for t in told[name]])) for key in (
            culled, "culling_tests", "eye_pass_cpu_seconds")), str(errors[name]), *error_cells(run, name, "all")))
        run.show(name, run.place(f"{name}-0"))
    run.found(CULLED, published=mean_of([t["light_leaves_culled"] for t in told["cubes-cutoff"]]))
    run.found(NOISE, published=errors["not-culled"].ratio(errors["cubes"]), ours=errors["not-culled"].ratio(errors["points"]))
    run.found("tests of groups of lights, for points / for cubes", published=ratio(
        told["points"], told["cubes"], lambda t: t["culling_tests"]))
    run.tables.append(Table(("64 lights a pixel", "culled", "tests", "eye pass, CPU s", "RMSE", *ERROR_HEADS), rows))
    run.note(f"{paths} light paths; against all lights with the same maps. Culled: of points their share of lights, of cubes that of "
             "leaves of the lights' octree; points also cull what lies behind their surface. Cut-off: a sixth of the atrium's length")
