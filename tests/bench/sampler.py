"""What spreading samples evenly gains: squared errors at equal samples and the CPU time of a sample, `independent` over
`sobol`. The errors are those that the halves of each picture tell (tests hold that they are true), the mean of some
seeds."""

SEEDS = 4
SAMPLES = 256
SCENES = [("cornell", {"scene": "cornell.glb"}), ("area", {"scene": "area.glb"}),
          ("open, sky", {"scene": "open.glb", "environment": {"file": "sky.hdr"}}),
          ("atrium", {"scene": "atrium.glb", "camera": "arcade"}),
          ("ajar", {"scene": "ajar.glb", "camera": "room"}),
          ("many_lights", {"scene": "many_lights.glb", "camera": "corner"}),
          ("cornell-box", {"scene": "cornell-box/scene.glb"}),
          ("door", {"scene": "door/scene.glb", "camera": "corner"})]
METHODS = [("path, direct light", {"type": "path", "max_depth": 2}, SAMPLES), ("path", {"type": "path", "max_depth": 6}, SAMPLES),
           ("bdpt", {"type": "bdpt", "max_depth": 6}, SAMPLES // 2),
           ("bdpt, skeleton", {"type": "bdpt", "max_depth": 6, "connections": {"type": "skeleton"}}, SAMPLES // 2),
           ("light", {"type": "light", "max_depth": 6}, SAMPLES // 2)]
# Where most of the variance is that of edges and of rare paths nothing may be lost; elsewhere what is asked for.
LEAST = {("path, direct light", "cornell"): 4, ("path, direct light", "cornell-box"): 4,
         ("path, direct light", "open, sky"): 4, ("path, direct light", "atrium"): 4,
         ("path", "cornell"): 1.3, ("path", "cornell-box"): 1.3, ("path", "open, sky"): 1.3, ("path", "atrium"): 1.3}


def gain(bench, job):
    """Of one method on one scene: the ratios of MSE and of CPU time."""
    mse, seconds = {}, {}
    for sampler in ("independent", "sobol"):
        reports = [bench.render("spread", {**job, "sampler": sampler, "seed": seed})[1] for seed in range(1, SEEDS + 1)]
        mse[sampler] = sum(r["errors"]["est_rmse"] ** 2 for r in reports) / SEEDS
        seconds[sampler] = min(r["seconds"]["render_cpu"] for r in reports)
    return mse["independent"] / mse["sobol"], seconds["sobol"] / seconds["independent"]


def gains(bench):
    """Each method and scene with its two ratios."""
    for method, integrator, samples in METHODS:
        for scene, job in SCENES:
            yield method, scene, *gain(bench, {**job, "resolution": [96, 64], "integrator": integrator,
                                               "budget": {"iterations": samples}})


def run(bench):
    for method, scene, ratio, time in gains(bench):
        least = LEAST.get((method, scene), 0.98 if method.startswith("path") else 0)
        bench.figure(f"{scene}, {method}: MSE independent / sobol", f"{ratio:.2f}", f"at least {least}", ratio >= least)
        print(f"  CPU time of a sample, sobol / independent {time:.3f}", flush=True)
