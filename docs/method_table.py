"""The table "which method for which scene" as Markdown, from finished sweeps:

    python3 docs/method_table.py which-method.sweep which-method-real.sweep

Each cell: relMSE of the method at the end of the runs over the relMSE of `path` in the same scene.
"""

import json
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LACUNA = pathlib.Path(os.environ.get("LACUNA_BIN", HERE.parent / "build/release/bin")) / "lacuna"
SCENES = {
    "ajar": "a door 12 degrees ajar", "bends": "a corridor with two bends", "cornell": "direct light from a panel",
    "atrium": "sun into one side of a court", "many_lights": "200 emitters among pillars",
    "door": "Veach's door ajar", "corridor": "Noel's corridor", "sponza": "sun, camera in an arcade",
}
METHODS = ["path", "path skeleton", "path sd_tree", "bdpt paired", "bdpt skeleton", "many_lights probabilistic",
           "metropolis"]


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


def main():
    print("| scene | relMSE of `path` |", " | ".join(f"`{name.replace(' ', '`, `')}`" for name in METHODS[1:]), "|")
    print("| --- |" + " --- |" * len(METHODS))
    for sweep in sys.argv[1:]:
        for scene, errors in rows(sweep).items():
            base = errors["path"][0]
            shown = {name: ("" if supported else "< ") + f"{value / base:.2g}"
                     for name, (value, supported, _) in errors.items()}
            best = min(errors, key=lambda name: errors[name][0])
            shown[best] = f"**{shown[best]}**"
            print(f"| `{scene}`: {SCENES[scene]} | {base:.2g} |", " | ".join(shown.get(name, "") for name in METHODS[1:]), "|")


if __name__ == "__main__":
    main()
