"""Nabata et al., Tables 1 and 2: time and tests of probabilistic visibility and of Veach's roulette against exact
visibility, which traces its rays in packets and evaluates eight lights at a time; all with the same lights."""

from harness import many_lights
from harness.many_lights import visibility
from harness.run import Table


def measure(run):
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
