"""What the entries of Kol et al. 2018 have in common: one iteration of many lights, each with a map. The paper's other
scenes (Sibenik, San Miguel) are not ours: Sponza and the hairball stand for them."""

from harness import many_lights

VIEWS = {"Sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
         "Hairball": {"scene": "hairball.glb", "camera": "front"},
         "Door": {"scene": "door/scene.glb", "camera": "corner"}}
OURS = {"type": "view_maps"}  # its defaults
PUBLISHED = {"levels": 11, "node_texels": 1, "cover": 0}


def job(view, paths, how, resolution=(32, 16), edges=3, **more):
    """Lights of edges - 2 bounces. `how`: the visibility, or what differs from the published view_maps."""
    visibility = how if "type" in how else {"type": "view_maps", **PUBLISHED, **how}
    value = {**VIEWS[view], "resolution": list(resolution), "budget": {"iterations": 1}, "checkpoint_seconds": 86400,
             "integrator": {"type": "many_lights", "max_depth": edges, "light_paths": paths, "compensation": False,
                            "visibility": visibility}}
    value["integrator"].update(more.pop("integrator", {}))
    return {**value, **more}


def particles(view, count, how, **more):
    """Omnidirectional views at random places."""
    return job(view, count, how, edges=2, integrator={"direct": "lights", **more.pop("integrator", {})},
               particles={"count": count, "power": 300000, "color": [1, 0.8, 0.5], "low": [0.1, 0.02, 0.15],
                          "high": [0.9, 0.6, 0.85], "alone": True}, **more)


def statistics(run, name, value):
    return many_lights.render(run, name, value)["integrator"]


def seconds(told):
    return told["view_map_cpu_seconds"]
