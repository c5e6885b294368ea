"""The table of docs/methods/README.md, from two sweeps: relMSE of each method at the end of the runs over that of `path` in the
same scene."""

import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
LACUNA = ROOT / "build/release/bin/lacuna"
SWEEPS = ("which-method", "which-method-real")
SCENES = {
    "ajar": "a door 12 degrees ajar", "bends": "a corridor with two bends", "cornell": "direct light from a panel",
    "atrium": "sun into one side of a court", "many_lights": "200 emitters among pillars",
    "door": "Veach's door ajar", "corridor": "Noel's corridor", "sponza": "sun, camera in an arcade",
}
METHODS = ["path", "path skeleton", "path sd_tree", "bdpt paired", "bdpt skeleton", "many_lights probabilistic",
           "metropolis"]
INTEGRATORS = {method.split()[0] for method in METHODS}


def method(integrator):
    strategies = [integrator[key]["type"] for key in ("guide", "connections", "visibility") if key in integrator]
    return " ".join([integrator["type"], *strategies])


def rows(sweep):
    """{scene: {method: (relMSE, supported, seeds)}}, at the last of the times that are compared."""
    answers = json.loads(subprocess.run([LACUNA, "report", sweep, "--json"], capture_output=True, text=True,
                                        check=True).stdout)
    found = {}
    for cell in answers["cells"]:
        at = cell["at"][-1] if cell.get("at") else {}
        if at.get("error"):
            scene = cell["settings"]["/scene"].removesuffix(".glb").removesuffix("/scene")
            found.setdefault(scene, {})[method(cell["settings"]["/integrator"])] = (
                at["error"]["value"], at.get("supported", True), at["error"]["n"])
    return found


def lines(folder):
    out = ["| scene | relMSE of `path` | " + " | ".join(f"`{name.replace(' ', '`, `')}`" for name in METHODS[1:]) + " |",
           "| --- |" + " --- |" * len(METHODS)]
    for name in SWEEPS:
        sweep = folder / f"{name}.sweep"
        subprocess.run([LACUNA, "sweep", ROOT / f"jobs/examples/sweeps/{name}.json", "--out", sweep], check=True)
        for scene, errors in rows(sweep).items():
            base = errors["path"][0]
            shown = {name: ("" if supported else "< ") + f"{value / base:.2g}"
                     for name, (value, supported, _) in errors.items()}
            best = min(errors, key=lambda name: errors[name][0])
            shown[best] = f"**{shown[best]}**"
            cells = " | ".join(shown.get(name, "") for name in METHODS[1:])
            out.append(f"| `{scene}`: {SCENES[scene]} | {base:.2g} | {cells} |")
    return out
