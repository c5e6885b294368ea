"""The integrators that the methods are compared with; and ours against renders of others."""

import json
import math
import statistics

from harness import child, layers, many_lights
from harness.entry import Entries
from harness.measured import error_at, gain_at, geometric_mean_of, mean_of, of_answer, speed_up_to, time_to
from harness.run import Table, cell_with
from harness.verdict import at_least, at_most, beside, up_to

ENTRIES = Entries()
# A picture counts as unbiased within a tenth of its mean radiance; here squared.
UNBIASED = 0.1**2

JOB = child.ROOT / "jobs/examples/corridor.json"
SWITCH = "/integrator/next_event_estimation"


def path_corridor_sweep(full):
    """CPU seconds are the clock: they hold on a busy machine, too."""
    job = json.loads(JOB.read_text())
    del job["label"]
    return {
        "label": "next event estimation in the corridor",
        "job": {**job, "budget": {"cpu_seconds": 240 if full else 8}},
        "axes": {SWITCH: [False, True]},
        "seeds": 10 if full else 3,
        "baseline": {SWITCH: False},
        "compare_at": {"clock": "cpu_seconds", "metric": "relmse"},
    }


def mean_radiance(run, cell):
    """Of the reference that the runs were compared with."""
    report = json.loads((run.runs / cell["runs"][0]["name"] / "report.json").read_text())
    reference = report["errors"]["reference"]["file"]
    lines = dict(line.split(maxsplit=1) for line in child.lacuna("compare", reference, reference)[0].splitlines())
    return float(lines["mean_b"])


@ENTRIES.measured(
    "path-corridor", "the thesis author's own render, 63,555 samples a pixel (corridor/reference.exr)",
    "path tracing without and with next event estimation: error at equal time, time to equal error, bias",
    "path",
    (beside("relMSE at equal time, without"), beside("relMSE at equal time, with"),
     at_least("error without / with, at equal time", 1), beside("CPU seconds to equal relMSE, without"),
     beside("CPU seconds to equal relMSE, with"), at_least("time without / with, to equal relMSE", 1),
     up_to("squared bias / squared mean radiance, without", 0, UNBIASED),
     up_to("squared bias / squared mean radiance, with", 0, UNBIASED)),
    sweep=path_corridor_sweep)
def path_corridor(run):
    """Path tracing in the thesis' corridor, without and with next event estimation, against its author's own render."""
    answers = run.answers(path_corridor_sweep(run.full))
    cells = {"without": cell_with(answers, next_event_estimation=False),
             "with": cell_with(answers, next_event_estimation=True)}
    mean = mean_radiance(run, cells["with"])
    for name, cell in cells.items():
        run.found(f"relMSE at equal time, {name}", error_at(cell["at"][-1]))
        run.found(f"CPU seconds to equal relMSE, {name}", time_to(cell["to"][-1]))
        bias = of_answer(cell["bias_between_runs"])
        run.found(f"squared bias / squared mean radiance, {name}", bias and bias.scaled(1 / mean**2))
        if bias and bias.low is not None and bias.low <= 0:
            within = math.sqrt(max(bias.high, 0)) / mean
            run.note(f"{name}: unbiased within {within:.0%} of the mean radiance {mean:.4g}")
    at, to = cells["with"]["at"][-1], cells["with"]["to"][-1]
    run.found("error without / with, at equal time", gain_at(at))
    run.found("time without / with, to equal relMSE", speed_up_to(to))
    run.note(f"equal time: {at['seconds']:.3g} CPU seconds; equal error: relMSE {to['error']:.3g}; "
             f"{answers['seeds']} runs each; the reference's own noise is not known and counts as bias")


# The scenes of chapter 4 are Mitsuba's and Veach's; these are of our own making.
BALL = {"scene": "cornell_ball.glb", "camera": "front"}
PATH, BPT = {"type": "path", "max_depth": 6}, {"type": "bdpt", "max_depth": 6}
CHAPTER_4 = "a scene of our own making: the thesis' are not among ours"


def fig_20_sweep(full):
    return {
        "label": "path tracing and bidirectional path tracing",
        "job": {**BALL, "resolution": [512, 512] if full else [128, 128], "budget": {"cpu_seconds": 90 if full else 3},
                "reference": "auto", "reference_iterations": 4000 if full else 400},
        "axes": {"/integrator": [PATH, BPT]},
        "seeds": 5 if full else 3,
        "baseline": {"/integrator": PATH},
        "compare_at": {"clock": "cpu_seconds", "metric": "mae"},
    }


@ENTRIES.measured(
    "noel-fig-20", "Noel 2015, Fig. 20, p. 48",
    "less noise with bidirectional path tracing than with path tracing after 90 s", "path; bdpt",
    (at_least("error of path tracing / of bidirectional, at equal time", 1),), sweep=fig_20_sweep)
def fig_20(run):
    """Path tracing against bidirectional path tracing with caustics of a small lamp."""
    answers = run.answers(fig_20_sweep(run.full))
    at = cell_with(answers, integrator=BPT)["at"][-1]
    for name, integrator in (("path tracing", PATH), ("bidirectional path tracing", BPT)):
        run.show(name, run.run_folder(cell_with(answers, integrator=integrator)))
    for which in ("published", "ours"):  # the method has no settings that differ
        run.found("error of path tracing / of bidirectional, at equal time", **{which: gain_at(at)})
    run.note(f"MAE after {at['seconds']:.3g} CPU seconds; {CHAPTER_4}")


def variances(pictures):
    """Of each value, the variance between pictures; their sum."""
    n = len(pictures)
    total = 0.0
    for values in zip(*([value for channel in picture for value in channel] for picture in pictures)):
        mean = sum(values) / n
        total += sum((v - mean) ** 2 for v in values) / (n - 1)
    return total


@ENTRIES.measured(
    "noel-fig-22", "Noel 2015, Fig. 22, p. 51",
    "the noise of each strategy of bidirectional path tracing is less where it is weighted", "bdpt with layers of strategies",
    (at_least("variance of unweighted strategies / of weighted, mean over strategies", 1),
     at_least("variance of unweighted strategies / of weighted, least of all strategies", 1)))
def fig_22(run):
    """Every strategy (s, t) alone, before and after its weight."""
    seeds, parts = 9, 3
    side = 256 if run.full else 64
    job = {**BALL, "resolution": [side, side], "budget": {"iterations": 256 if run.full else 16},
           "layers": ["strategies", "strategies_unweighted"], "integrator": {**BPT, "max_depth": 4}}
    run.repeated("strategies", job, seeds)
    folders = [run.place(f"strategies-{seed}") for seed in range(seeds)]
    names = [n.split(".")[1] for n in layers.names(folders[0]) if n.startswith("strategies.")]
    means, leasts = [], []
    for part in range(parts):
        ratios = {}
        for name in names:
            plain, weighted = (variances([layers.channels(f, f"{kind}.{name}") for f in folders[part::parts]])
                               for kind in ("strategies_unweighted", "strategies"))
            if plain > 0 and weighted > 0:
                ratios[name] = plain / weighted
        means.append(math.exp(statistics.fmean(map(math.log, ratios.values()))))
        leasts.append(min(ratios.values()))
        run.tables.append(Table(("seeds of part", "strategy", "variance unweighted / weighted"), [
            (part, name, f"{ratio:.3g}") for name, ratio in ratios.items()]))
    for quantity, values in (("mean over", means), ("least of all", leasts)):
        for which in ("published", "ours"):
            run.found(f"variance of unweighted strategies / of weighted, {quantity} strategies",
                      **{which: geometric_mean_of(values)})
    run.note(f"variance between pictures of different seeds, over all pixels; {CHAPTER_4}")


# Veach's plates. The thesis' are Mitsuba's; which is the shiniest, its caption says: the farthest.
PLATES = {"scene": "plates.glb", "camera": "front"}
PLATE_BLUES = (0.4, 0.5, 0.6, 0.7)  # of the base colours, from the shiniest plate to the roughest
LIGHTS = 4  # from large to small, a quarter of a plate's width each
PLACES = {"shiniest plate, largest light": (0, 0), "roughest plate, smallest light": (3, 3)}
PLATES_SEEDS, PLATES_PARTS = 16, 4


def plates_job(full, integrator):
    """One sample of each strategy an iteration, independent of all others; lights are selected by their power, which is
    the same for all."""
    return {**PLATES, "resolution": [512, 384] if full else [160, 120], "budget": {"iterations": 512 if full else 24},
            "sampler": "independent", "layers": ["albedo"], "integrator": {"max_depth": 2, **integrator}}


def places_of(folder, width):
    """The pixels of each plate where it mirrors each light, by (plate, light)."""
    found = {}
    blues = layers.channels(folder, "albedo")[2]
    for plate, blue in enumerate(PLATE_BLUES):
        pixels = [i for i, b in enumerate(blues) if abs(b - blue) < 0.01]
        left, right = min(i % width for i in pixels), max(i % width for i in pixels) + 1
        for i in pixels:
            light = (i % width - left) * LIGHTS // (right - left)
            found.setdefault((plate, light), []).append(i)
    return found


def plates_variances(run):
    """By place: of each part of the seeds, the variance of the strategies p_{0,3} and p_{1,2} alone, that of their weighted
    sum, and what the balance heuristic guarantees of the latter."""
    power = {"connections": {"type": "paired", "emitters": "power"}}
    alone = {**plates_job(run.full, {"type": "bdpt", **power}), "layers": ["albedo", "strategies_unweighted"]}
    run.repeated("alone", alone, PLATES_SEEDS)
    together = plates_job(run.full, {"type": "path", "emitters": "power"})
    run.repeated("weighted", together, PLATES_SEEDS)
    pictures = {name: [layers.channels(run.place(f"{kind}-{seed}"), layer) for seed in range(PLATES_SEEDS)]
                for name, kind, layer in (("p_{0,3}", "alone", "strategies_unweighted.s0t3"),
                                          ("p_{1,2}", "alone", "strategies_unweighted.s1t2"), ("weighted", "weighted", ""))}

    found = {}
    for place, pixels in places_of(run.place("alone-0"), together["resolution"][0]).items():
        at = {name: [[[channel[i] for i in pixels] for channel in picture] for picture in each]
              for name, each in pictures.items()}
        means = [statistics.fmean(values) for channels in zip(*at["weighted"]) for values in zip(*channels)]
        squares = sum(m * m for m in means) / together["budget"]["iterations"]
        found[place] = []
        for part in range(PLATES_PARTS):
            of = {name: variances(each[part::PLATES_PARTS]) for name, each in at.items()}
            # Veach 1997, theorem 9.2, of one sample each: 1 / min n - 1 / sum n = 1/2.
            of["bound"] = min(of["p_{0,3}"], of["p_{1,2}"]) + squares / 2
            found[place].append(of)
    return found


def ratio_of(parts, above, below):
    return geometric_mean_of([of[above] / of[below] for of in parts])


def strategies_of(parts):
    """The names of the better strategy at a place and of the worse one, by all seeds."""
    return sorted(("p_{0,3}", "p_{1,2}"), key=lambda name: sum(of[name] for of in parts))


def plates_table(run, found):
    columns = ("plate, light", "p_{1,2} / p_{0,3}", "weighted / better", "bound / better", "weighted / worse")
    run.tables.append(Table(columns, [
        (f"{plate + 1}, {light + 1}", str(ratio_of(parts, "p_{1,2}", "p_{0,3}")),
         *(str(ratio_of(parts, of, strategies_of(parts)[worse])) for of, worse in
           (("weighted", 0), ("bound", 0), ("weighted", 1)))) for (plate, light), parts in sorted(found.items())]))
    run.note(f"variance between pictures of different seeds, summed over the pixels of a place: a quarter of a plate; "
             f"{PLATES_SEEDS} seeds in {PLATES_PARTS} parts; plates from shiny to rough, lights from large to small")
    run.note("plates.glb is a stand-in of ours: the thesis' scene is Mitsuba's")
    run.show("both strategies, weighted", run.place("weighted-0"))


@ENTRIES.measured(
    "noel-fig-18", "Noel 2015, Fig. 18, p. 47",
    "hitting lights (p_{0,3}) has less noise on shiny plates and large lights, sampling them (p_{1,2}) on rough plates and "
    "small lights", "bdpt with layers of strategies",
    (at_least("shiniest plate, largest light: variance of p_{1,2} / of p_{0,3}", 1),
     at_most("roughest plate, smallest light: variance of p_{1,2} / of p_{0,3}", 1)))
def fig_18(run):
    """The two strategies of direct light alone, where plates mirror lights."""
    found = plates_variances(run)
    for name, place in PLACES.items():
        for which in ("published", "ours"):  # strategies have no settings that differ
            run.found(f"{name}: variance of p_{{1,2}} / of p_{{0,3}}",
                      **{which: ratio_of(found[place], "p_{1,2}", "p_{0,3}")})
    plates_table(run, found)


@ENTRIES.measured(
    "noel-fig-19", "Noel 2015, Fig. 19, p. 47",
    "multiple importance sampling has low variance at every point: never that of the worse strategy", "path; bdpt",
    tuple(claim(f"{place}: variance weighted / of the {strategy} strategy", *figure) for place in PLACES
          for claim, strategy, figure in ((at_most, "worse", (1,)), (beside, "better", ()))))
def fig_19(run):
    """The weighted sum of the two strategies, against each alone with as many samples."""
    found = plates_variances(run)
    for name, place in PLACES.items():
        better, worse = strategies_of(found[place])
        for which in ("published", "ours"):  # as in Fig. 18
            run.found(f"{name}: variance weighted / of the worse strategy",
                      **{which: ratio_of(found[place], "weighted", worse)})
            run.found(f"{name}: variance weighted / of the better strategy",
                      **{which: ratio_of(found[place], "weighted", better)})
        run.note(f"{name}: {better} is the better; the balance heuristic guarantees at most "
                 f"{ratio_of(found[place], 'bound', better).value:.3g} times its variance (Veach 1997, theorem 9.2)")
    run.show("weighted", run.place("weighted-0"))
    plates_table(run, found)


def neighbours_correlation(a, b, width):
    """Of the signs of the difference of two pictures about its median: that of pixels side by side. Signs, because few
    bright pixels hold a large part of all squares."""
    found = []
    for one, other in zip(a, b):
        error = [x - y for x, y in zip(one, other)]
        middle = statistics.median(error)
        signs = [1 if e > middle else -1 for e in error]
        found.append(statistics.fmean(x * y for i, (x, y) in enumerate(zip(signs, signs[1:])) if (i + 1) % width != 0))
    return statistics.fmean(found)


@ENTRIES.measured(
    "noel-fig-23", "Noel 2015, Fig. 23, p. 52",
    "instant global illumination has structured errors where bidirectional path tracing has noise, after 90 s",
    "bdpt; many_lights with visibility: exact",
    (at_least("correlation of neighbouring pixels' errors, virtual lights less bidirectional", 0),
     beside("correlation of neighbouring pixels' errors, virtual lights"),
     beside("correlation of neighbouring pixels' errors, bidirectional")))
def fig_23(run):
    """Whether errors of pixels side by side are alike: by differences of pictures with different seeds."""
    side, pairs = (512 if run.full else 128), 3
    job = {"scene": "cornell.glb", "resolution": [side, side], "budget": {"cpu_seconds": 90 if run.full else 2}}
    lights = {"type": "many_lights", "max_depth": 6, "light_paths": 64, "direct": "lights", "compensation": False,
              "visibility": {"type": "exact"}}
    found = {}
    for name, integrator in (("bidirectional", BPT), ("virtual lights", lights)):
        more = {"budget": {"iterations": 1}} if name == "virtual lights" else {}  # the same lights for every pixel
        run.repeated(name, {**job, **more, "integrator": integrator}, 2 * pairs)
        folders = [run.place(f"{name}-{seed}") for seed in range(2 * pairs)]
        run.show(name, folders[0])
        found[name] = [neighbours_correlation(layers.channels(a, ""), layers.channels(b, ""), side)
                       for a, b in zip(folders[::2], folders[1::2])]
    for which in ("published", "ours"):
        for name, values in found.items():
            run.found(f"correlation of neighbouring pixels' errors, {name}", **{which: mean_of(values)})
        run.found("correlation of neighbouring pixels' errors, virtual lights less bidirectional",
                  **{which: mean_of([a - b for a, b in zip(found["virtual lights"], found["bidirectional"])])})
    run.note("correlation of signs; virtual lights: 64 light paths, one iteration, as instant global illumination has them; "
             "bidirectional: equal in nothing but the scene: what is compared is the kind of error, not its size; "
             f"{CHAPTER_4}")

# The thesis' scene and radii are not known. In ours the lamp is so large that path tracing, too, finds its
# caustics, and the radius so large that its blur shows.
FIG_25 = {
    "path tracing": {"type": "path"}, "bidirectional": {"type": "bdpt"},
    "instant global illumination": {"type": "many_lights", "light_paths": 1000},
    "photon mapping": {"type": "photon_map", "radius": 0.08, "radius_unit": "scene"},
    "progressive": {"type": "sppm", "radius": 0.08, "radius_unit": "scene"},
    "connection and merging": {"type": "vcm", "radius": 0.005, "radius_unit": "scene"}}


@ENTRIES.measured(
    "noel-fig-25", "Noel 2015, Fig. 25, p. 58",
    "photon mapping stays blurred, progressive photon mapping converges to the picture", "photon_map; sppm; vcm; path; bdpt; many_lights",
    (at_most("error of progressive / of photon mapping, at equal time", 1),))
def fig_25(run):
    """Each method at two times, against bidirectional path tracing: the error of photon mapping levels off."""
    side, seconds, iterations, seeds = (512, 90, 20000, 5) if run.full else (128, 4, 1000, 3)
    job = {"scene": "glass.glb", "resolution": [side, side]}
    run.render("reference", {**job, "seed": 1000, "integrator": {"type": "bdpt", "max_depth": 8},
                             "budget": {"iterations": iterations}})
    error, rows = {}, []
    for method, integrator in FIG_25.items():
        found = []
        for share in (1 / 4, 1):
            name = f"{method.replace(' ', '-')}-{share:g}"
            run.repeated(name, {**job, "integrator": {**integrator, "max_depth": 8},
                                "budget": {"cpu_seconds": seconds * share}}, seeds)
            found.append([many_lights.errors(run, f"{name}-{seed}", "reference")["mse"] for seed in range(seeds)])
        run.show(method, run.place(f"{name}-0"))
        error[method] = found[1]
        rows.append((method, *(str(geometric_mean_of(e)) for e in found),
                     str(geometric_mean_of([b / a for a, b in zip(*found)]))))
    for which in ("published", "ours"):
        run.found("error of progressive / of photon mapping, at equal time", **{which: geometric_mean_of(
            [a / b for a, b in zip(error["progressive"], error["photon mapping"])])})
    run.tables.append(Table(("method", f"MSE, {seconds / 4:g} CPU seconds", f"{seconds}", "ratio"), rows))
    run.note("glass.glb; noise alone falls to a quarter from one column to the next, and sppm's error to 0.4; "
             "instant global illumination is that of Fig. 23; the reference's noise is in all errors")


METROPOLIS = {"path_space": {"type": "metropolis", "mutation": "path_space"},
              "path_space, direct light apart": {"type": "metropolis", "mutation": "path_space",
                                                 "direct_samples": 2},
              "multiplexed": {"type": "metropolis", "mutation": "multiplexed"},
              "primary_sample": {"type": "metropolis", "mutation": "primary_sample"},
              "bdpt skeleton": {"type": "bdpt", "connections": "skeleton"}, "bdpt": {"type": "bdpt"},
              "path": {"type": "path"}}
METROPOLIS_SCENES = {"door": {"scene": "door/scene.glb", "camera": "corner"},
                     "corridor": {"scene": "corridor/scene.glb", "camera": "far-from-light"}}


@ENTRIES.measured(
    "noel-metropolis", "Noel 2015, 4.6, which measures nothing; Veach and Guibas 1997",
    "Metropolis light transport has less error behind doors and round corners than independent samples",
    "metropolis; bdpt; path",
    tuple(at_least(f"MSE of {other} / of path_space, {scene}", 1)
          for scene in METROPOLIS_SCENES for other in ("bdpt skeleton", "multiplexed", "path")))
def metropolis(run):
    """Each mutation, and methods of independent samples, at equal CPU time."""
    size, seconds, seeds = ([640, 360], 30, 5) if run.full else ([192, 108], 3, 3)
    for scene, where in METROPOLIS_SCENES.items():
        def job(integrator, budget, where=where):
            return {**where, "resolution": size, "budget": {"cpu_seconds": budget}, "integrator": {**integrator, "max_depth": 6}}

        exact_one = f"{scene}-reference"
        run.render(exact_one, {**job(METROPOLIS["path_space"], 20 * seconds), "seed": 1000})
        found = {}
        for name, integrator in METROPOLIS.items():
            key = f"{scene}-{name.replace(' ', '-').replace(',', '')}"
            run.repeated(key, job(integrator, seconds), seeds)
            found[name] = [many_lights.errors(run, f"{key}-{seed}", exact_one) for seed in range(seeds)]
            if scene == "door":
                run.show(name, run.place(f"{key}-0"))
        for other in ("bdpt skeleton", "multiplexed", "path"):
            run.found(f"MSE of {other} / of path_space, {scene}", geometric_mean_of(
                [a["mse"] / b["mse"] for a, b in zip(found[other], found["path_space"])]))
        run.tables.append(Table((f"{scene}, {seconds} CPU seconds", "MSE", "relMSE"), [
            (name, *(str(geometric_mean_of([e[metric] for e in errors])) for metric in ("mse", "relmse")))
            for name, errors in found.items()]))
    run.note(f"{seeds} seeds; the reference is another picture of the same method after twenty times as long, and its noise is "
             "in all errors")
