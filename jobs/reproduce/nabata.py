"""Nabata et al.: probabilistic visibility of many lights. 512 x 512 pixels on a Xeon E5-2680v2 at 2.8 GHz."""

from harness import layers, many_lights
from harness.entry import Entries
from harness.many_lights import visibility
from harness.measured import exact
from harness.run import Table
from harness.verdict import at_least, beside

ENTRIES = Entries()
NEEDS = "many_lights with visibility: probabilistic, roulette, exact"
# Scene, and of probabilistic visibility and of Veach's roulette the speed-up over exact, and the share of tests saved.
SCENES = (("San Miguel", 2.60, 1.21, 0.88, 0.64), ("Hairball", 6.08, 2.45, 0.90, 0.63),
          ("Sponza", 2.12, 1.47, 0.90, 0.74), ("Museum", 2.56, 1.45, 0.90, 0.83))


def of_scene(scene, speed_up, speed_up_veach, saved, saved_veach):
    return (at_least(f"{scene}: speed-up", speed_up), beside(f"{scene}: speed-up, Veach", speed_up_veach),
            at_least(f"{scene}: tests saved", saved), beside(f"{scene}: tests saved, Veach", saved_veach))


@ENTRIES.measured(
    "nabata-table-1-2", "Nabata et al., Tables 1 and 2, section 5",
    "speed-up over all visibilities, and the share of visibility tests saved", NEEDS,
    tuple(claim for scene in SCENES for claim in of_scene(*scene)))
def table_1_2(run):
    """Time and tests of probabilistic visibility and of Veach's roulette against exact
    visibility, which traces its rays in packets and evaluates eight lights at a time; all with the same lights."""
    rows = []
    for scene in many_lights.SCENES:
        points = many_lights.cached(scene, run.full)
        how = {"probabilistic": visibility("probabilistic", points),
               "as published": visibility("probabilistic", points, term_cost=0, variance="point"),
               "Veach": visibility("roulette", points)}
        found = many_lights.speed_up(run, scene, how, run.full)
        for key in how:
            e = many_lights.errors(run, f"{scene}-{key}", f"{scene}-exact")
            rows.append((scene, round(found[key]["lights"]), key, str(found[key]["seconds"]), str(found[key]["speed_up"]),
                         f"{found[key]['saved'].value:.1%}", f"{e['rmse'] / e['mean_b']:.2g}", f"{e['relmse']:.2g}"))
        rows.append((scene, round(found["exact"]["lights"]), "exact", str(found["exact"]["seconds"]), "", "", "", ""))
        if scene == "Door":
            continue
        run.found(f"{scene}: speed-up", found["probabilistic"]["speed_up"])
        run.found(f"{scene}: speed-up, Veach", found["Veach"]["speed_up"])
        run.found(f"{scene}: tests saved", found["probabilistic"]["saved"])
        run.found(f"{scene}: tests saved, Veach", found["Veach"]["saved"])
    run.tables.append(Table(("scene", "lights", "visibility", "CPU seconds", "speed-up", "tests saved",
                             "RMSE / mean", "relMSE"), rows))
    run.note("errors are against exact visibility of the same lights; tests saved: of those of lights that face the point")


POINTS = [125, 250, 500, 1000, 2000, 4000, 8000]  # of the whole picture
LEVEL = 1.1  # the error has levelled off where twice the points make it less than this times smaller


@ENTRIES.measured(
    "nabata-fig-3", "Nabata et al., Fig. 3, section 5",
    "error and time against the number of cache points: time is linear, error levels off at about 2000", NEEDS,
    (beside("cache points from which on the error levels off", 2000),))
def fig_3(run):
    """Time and error of probabilistic visibility on the hairball against the number of cache points. The error is that
    against exact visibility with the same lights; the paper's, against path tracing, also has the lights'."""
    side = 64
    many_lights.render(run, "exact", many_lights.job("Hairball", visibility("exact"), run.full, 0.25, side))
    rows = []
    for points in POINTS:
        here = points if run.full else max(1, round(points * side * side / (512 * 512)))
        report = many_lights.render(
            run, f"{points}", many_lights.job("Hairball", visibility("probabilistic", here), run.full, 0.25, side))
        rows.append((points, many_lights.seconds(report), report["integrator"]["visibility_cpu_seconds"],
                     many_lights.errors(run, f"{points}", "exact")["rmse"]))
    level = [a[0] for a, b in zip(rows, rows[1:]) if a[3] < LEVEL * b[3]]
    run.found("cache points from which on the error levels off", exact(level[0]) if level else None)
    run.tables.append(Table(("cache points", "CPU seconds", "of these for cache points", "RMSE"),
                            [(n, f"{s:.3g}", f"{c:.3g}", f"{e:.3g}") for n, s, c, e in rows]))
    run.note("a quarter of the lights of Table 1" + ("" if run.full else "; a crop, with its share of the cache points"))


AT = (0.1, 0.25, 0.5, 0.75, 0.9)


@ENTRIES.measured(
    "nabata-fig-4", "Nabata et al., Fig. 4, section 5",
    "Hairball: where lights are tested; seldom on plain walls, other than with Veach", NEEDS)
def fig_4(run):
    """The share of the lights that each pixel of the hairball tests."""
    side = 128
    rows = []
    for key, how in (("probabilistic", visibility("probabilistic", many_lights.cached("Hairball", run.full, side))),
                     ("as published", visibility("probabilistic", many_lights.cached("Hairball", run.full, side),
                                                 term_cost=0, variance="point")),
                     ("Veach", visibility("roulette", many_lights.cached("Hairball", run.full, side)))):
        many_lights.render(run, key, many_lights.job("Hairball", how, run.full, 0.25, side, layers=["visibility_tests"]))
        shares = sorted(layers.channels(run.folder / run.version / key, "visibility_tests")[0])
        rows.append((key, *(f"{shares[int(q * (len(shares) - 1))]:.1%}" for q in AT)))
    run.tables.append(Table(("visibility", *(f"{q:.0%} of the pixels below" for q in AT)), rows))
    run.note(f"of all lights, those that turn away included; pictures: {run.folder / run.version}")


LIGHTS = 100_000  # of many_lights.job() with a share of 1
EXACT = 2000
TRIED = [2000, 4000, 8000, 16000, 32000]


@ENTRIES.measured(
    "nabata-fig-5", "Nabata et al., Fig. 5, section 5", "Hairball: lights within equal time (99 s, 101 s)", NEEDS,
    (beside("lights, probabilistic", 13000), beside("lights, exact", 2000),
     at_least("lights, probabilistic / exact", 13000 / 2000)))
def fig_5(run):
    """How many lights probabilistic visibility affords on the hairball in the time that exact visibility
    takes for 2000."""
    side = 128
    points = many_lights.cached("Hairball", run.full, side)

    def timed(how, lights):
        name = f"{how['type']}-{lights}"
        job = many_lights.job("Hairball", how, run.full, lights / LIGHTS, side)
        report = many_lights.render(run, name, job)
        return report["integrator"]["virtual_lights"], many_lights.seconds(report)

    lights, limit = timed(visibility("exact"), EXACT)
    rows = [timed(visibility("probabilistic", points), n) for n in TRIED]
    affords = None
    for (n0, t0), (n1, t1) in zip(rows, rows[1:]):
        if t0 <= limit < t1:
            affords = n0 + (n1 - n0) * (limit - t0) / (t1 - t0)
    run.found("lights, exact", exact(lights))
    if affords is not None:
        run.found("lights, probabilistic", exact(affords))
        run.found("lights, probabilistic / exact", exact(affords / lights))
    run.tables.append(Table(("visibility", "lights", "CPU seconds"),
                            [("exact", round(lights), f"{limit:.3g}")] +
                            [("probabilistic", round(n), f"{t:.3g}") for n, t in rows]))


@ENTRIES.measured(
    "nabata-fig-6", "Nabata et al., Fig. 6, section 5",
    "interpolated visibility alone has steps in brightness, probabilistic visibility has none",
    "many_lights with visibility: probabilistic, interpolated")
def fig_6(run):
    """Steps in brightness of interpolated visibility, against none of probabilistic visibility. Both are
    compared with exact visibility of the same lights in blocks of 16 x 16 pixels, over which noise averages out and steps do
    not."""
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


ENTRIES.planned(
    "nabata-fig-7", "Nabata et al., Fig. 7, section 5", "Museum, glossy, 300k lights: time at like quality",
    NEEDS, (beside("probabilistic", 1468, "s"), beside("exact", 3822, "s"), at_least("speed-up", 3822 / 1468)))
