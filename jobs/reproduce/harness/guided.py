"""What the figures of Noel 2015, chapter 10, have in common: path tracing on door with a guide and without."""

from harness.measured import median_of
from harness.run import Table, cell_with

BSDF = {"type": "bsdf"}
GUIDE = "/integrator/guide"


def measure_iterations(run, guides, quantity):
    """Errors after as many iterations of each guide. `quantity`: the first one's gain over BSDF sampling."""
    iterations = 4096 if run.full else 32
    answers = run.answers({
        "label": "guides at equal iterations",
        "job": {"scene": "door/scene.glb", "camera": "corner", "resolution": [1024, 512] if run.full else [256, 128],
                "integrator": {"type": "path", "max_depth": 6}, "analysis": {"resolution": 128},
                "budget": {"iterations": iterations}, "reference": "auto",
                "reference_iterations": 4000 if run.full else 1000},
        "axes": {GUIDE: [BSDF, *guides.values()]},
        "seeds": 5 if run.full else 3,
    })

    def told(guide):
        return [run.report(cell_with(answers, guide=guide), seed) for seed in range(answers["seeds"])]

    plain = told(BSDF)
    rows = []
    for name, guide in guides.items():
        own = told(guide)

        def gain(value, own=own):
            return median_of([value(a) / value(b) for a, b in zip(plain, own)])

        gains = [gain(lambda r, m=metric: r["errors"][m]) for metric in ("mae", "rmse", "relmse")]
        cost = gain(lambda r: r["seconds"]["render_cpu"])
        if not rows:
            run.found(quantity, gains[0])
        rows.append((name, *map(str, gains), f"{1 / cost.value:.3g}"))
    run.tables.append(Table(("door", "gain in MAE", "in RMSE", "in relMSE", "time of an iteration"), rows))
    run.note(f"{iterations} iterations; medians of {answers['seeds']} runs")
