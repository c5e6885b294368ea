"""What the entries of Noel 2015, chapters 7 and 8, have in common: one iteration of many lights, with the same lights for
every visibility. The thesis' own views are not known; ours are named in the notes."""

from harness import many_lights
from harness.many_lights import visibility

RESOLUTION = [1024, 512]
VIEWS = {"Sponza": {"scene": "sponza/scene.glb", "camera": "atrium"},
         "Door": {"scene": "door/scene.glb", "camera": "corner"}}


def job(view, how, paths, edges, seed=0, **more):
    """Light after at most `edges` edges, of which the first and the last are no light path's."""
    return {**VIEWS[view], "resolution": RESOLUTION, "seed": seed, "budget": {"iterations": 1}, "checkpoint_seconds": 86400,
            "integrator": {"type": "many_lights", "max_depth": edges, "light_paths": paths, "compensation": False,
                           "visibility": visibility(how)}, **more}


def report(run, view, how, paths, edges, seed=0):
    return many_lights.render(run, f"{view}-{how}-{paths}-{edges}-{seed}", job(view, how, paths, edges, seed))


def sum_seconds(run, view, how, paths, seed):
    """CPU seconds of what the lights of one bounce give, and how many they are: what the picture takes without lights is
    not counted."""
    lit = report(run, view, how, paths, 3, seed)["integrator"]
    dark = report(run, view, "none", 1, 3, seed)["integrator"]
    return lit["eye_pass_cpu_seconds"] - dark["eye_pass_cpu_seconds"], lit["virtual_lights"]
