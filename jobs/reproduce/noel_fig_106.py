"""Noel 2015, Fig. 106: what each distribution of resampled connections gives to the picture of door."""

from harness import layers, many_lights, resampling
from harness.run import Table


def measure(run):
    job = {"scene": "door/scene.glb", "camera": "corner", "resolution": [1024, 512] if run.full else [256, 128],
           "budget": {"cpu_seconds": 7200 if run.full else 30}, "layers": ["distributions"]}
    rows = []
    for name in ("SkelBPT", "ICBPT"):
        many_lights.render(run, name, {**job, "integrator": resampling.OURS[name]})
        folder = run.folder / run.version / name

        def mean(layer, folder=folder):
            return sum(map(sum, layers.channels(folder, layer)))

        whole = mean("")
        rows += [(name, layer.split(".")[1], f"{mean(layer) / whole:.1%}") for layer in layers.names(folder)
                 if layer.startswith("distributions.")]
    run.tables.append(Table(("method", "distribution", "of the picture's light"), rows))
    run.note(f"layers of each: {run.folder / run.version}")
