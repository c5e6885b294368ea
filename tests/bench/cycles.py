"""Renders a glTF file by Cycles as a job of Lacuna would be: `blender -b --factory-startup --python cycles.py -- SPEC`.

SPEC is a JSON file: scene, camera (a name; empty: the first), resolution, max_depth (edges), threads, and runs, each
with seed, roulette, cpu_seconds (of all threads together) and file (EXR, linear, floats). Prints one line, `cycles: {...}`: Blender's version,
CPU seconds of loading and of preparing the rendering, and of each run its samples a pixel and their CPU seconds.

Blender's importer gives geometry, images and node transformations. Materials, lights and the camera are set here, from
the file, as Lacuna reads them: materials are Lambertian, smooth mirrors or smooth glass, single-sided emitters emit from
their front, and lights are in W/sr and W/m^2."""

import json
import math
import struct
import sys
import time

import bpy
import numpy

PROBE = 8  # samples a pixel from which the time of one is estimated


def gltf_of(file):
    """The JSON chunk of a GLB file."""
    data = open(file, "rb").read()
    size, = struct.unpack_from("<I", data, 12)
    return json.loads(data[20:20 + size])


def extension(owner, name):
    return owner.get("extensions", {}).get(f"KHR_{name}", {})


def link_or_value(tree, source, value, target):
    if source is not None:
        tree.links.new(source, target)
    else:
        target.default_value = value


def schlick(tree, f0):
    """Reflectance of a smooth metal: f0 + (1 - f0) (1 - cos)^5."""
    facing = tree.nodes.new("ShaderNodeLayerWeight")  # by 0.5 it is 1 - cos
    facing.inputs["Blend"].default_value = 0.5
    power = tree.nodes.new("ShaderNodeMath")
    power.operation = "POWER"
    tree.links.new(facing.outputs["Facing"], power.inputs[0])
    power.inputs[1].default_value = 5
    mix = tree.nodes.new("ShaderNodeMixRGB")
    tree.links.new(power.outputs[0], mix.inputs["Fac"])
    mix.inputs["Color1"].default_value = f0
    mix.inputs["Color2"].default_value = (1, 1, 1, 1)
    return mix.outputs["Color"]


def scattering(tree, material, base, base_value):
    """The shader of what a material scatters; none: it is black."""
    pbr = material.get("pbrMetallicRoughness", {})
    metallic, roughness = pbr.get("metallicFactor", 1.0), pbr.get("roughnessFactor", 1.0)
    transmission = extension(material, "materials_transmission").get("transmissionFactor", 0)
    solid = (extension(material, "materials_volume").get("thicknessFactor", 0) > 0
             or material.get("extras", {}).get("source", "").startswith("smooth dielectric"))
    if transmission == 1 and roughness == 0 and solid:
        node = tree.nodes.new("ShaderNodeBsdfGlass")
        node.inputs["IOR"].default_value = extension(material, "materials_ior").get("ior", 1.5)
        node.inputs["Roughness"].default_value = 0
    elif metallic == 1 and roughness == 0:
        node = tree.nodes.new("ShaderNodeBsdfGlossy")
        node.inputs["Roughness"].default_value = 0
        base, base_value = schlick(tree, base_value), None
    elif metallic == 0 and transmission == 0 and extension(material, "materials_specular").get("specularFactor", 1) == 0:
        if base is None and tuple(base_value)[:3] == (0, 0, 0):
            return None
        node = tree.nodes.new("ShaderNodeBsdfDiffuse")
        node.inputs["Roughness"].default_value = 0
    else:
        raise SystemExit(f"cycles: material {material.get('name')} is none that both renderers have")
    link_or_value(tree, base, base_value, node.inputs["Color"])
    return node.outputs[0]


def emission(tree, material, one_sided):
    """The shader of what a material emits, if it does."""
    factor = material.get("emissiveFactor", [0, 0, 0])
    if not any(factor):
        return None
    if "emissiveTexture" in material:
        raise SystemExit(f"cycles: material {material.get('name')} has a texture of emission")
    node = tree.nodes.new("ShaderNodeEmission")
    node.inputs["Color"].default_value = (*factor, 1)
    strength = extension(material, "materials_emissive_strength").get("emissiveStrength", 1)
    node.inputs["Strength"].default_value = strength
    if one_sided:
        front = tree.nodes.new("ShaderNodeMath")
        front.operation = "MULTIPLY_ADD"
        geometry = tree.nodes.new("ShaderNodeNewGeometry")
        tree.links.new(geometry.outputs["Backfacing"], front.inputs[0])
        front.inputs[1].default_value = -strength
        front.inputs[2].default_value = strength
        tree.links.new(front.outputs[0], node.inputs["Strength"])
    return node.outputs[0]


def source_of(socket):
    return socket.links[0].from_socket if socket.is_linked else None


def set_material(target, material):
    """Replaces what the importer made, but for textures and masks."""
    tree = target.node_tree
    principled = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    base, value = source_of(principled.inputs["Base Color"]), tuple(principled.inputs["Base Color"].default_value)
    alpha = source_of(principled.inputs["Alpha"]) if material.get("alphaMode") == "MASK" else None
    shaders = [s for s in (scattering(tree, material, base, value),
                           emission(tree, material, not material.get("doubleSided", False))) if s is not None]
    shader = shaders[0] if shaders else tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0]
    if not shaders:
        shader.node.inputs["Color"].default_value = (0, 0, 0, 1)
    if len(shaders) == 2:
        add = tree.nodes.new("ShaderNodeAddShader")
        for s, target_socket in zip(shaders, add.inputs):
            tree.links.new(s, target_socket)
        shader = add.outputs[0]
    if alpha is not None:
        mask = tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(alpha, mask.inputs[0])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mask.inputs[1])
        tree.links.new(shader, mask.inputs[2])
        shader = mask.outputs[0]
    tree.links.new(shader, output.inputs["Surface"])


def set_light(light, spec):
    """Cycles takes W for points and spots and W/m^2 for suns."""
    color, intensity = spec.get("color", [1, 1, 1]), spec.get("intensity", 1)
    light.color = color
    if spec["type"] == "directional":
        light.energy = intensity
        light.angle = 0
    elif spec["type"] == "point":
        light.energy = 4 * math.pi * intensity
        light.shadow_soft_size = 0
    else:
        raise SystemExit("cycles: a spot light falls off in another way")
    light.cycles.use_multiple_importance_sampling = False  # a delta light: nothing hits it


def set_camera(name, gltf):
    """The camera of that name, with the vertical field of view."""
    cameras = [n for n in gltf["nodes"] if "camera" in n]
    cameras.sort(key=lambda n: n["camera"])
    node = next((n for n in cameras if name in (n.get("name"), gltf["cameras"][n["camera"]].get("name"))),
                cameras[0] if not name else None)
    if node is None:
        raise SystemExit(f"cycles: no camera {name}")
    camera = next(o for o in bpy.data.objects if o.type == "CAMERA" and o.name == node.get("name", o.name))
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle_y = gltf["cameras"][node["camera"]]["perspective"]["yfov"]
    camera.data.clip_start, camera.data.clip_end = 1e-4, 1e6
    bpy.context.scene.camera = camera


def load(spec):
    numpy.bool = bool  # which Blender 3.4's importer uses and NumPy 1.24 no longer has
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.import_scene.gltf(filepath=spec["scene"], import_shading="NORMALS", merge_vertices=False)
    gltf = gltf_of(spec["scene"])
    by_name = {m["name"]: m for m in gltf.get("materials", [])}
    for material in bpy.data.materials:
        if material.users and material.node_tree:
            set_material(material, by_name[material.name])
    lights = {light["name"]: light for light in extension(gltf, "lights_punctual").get("lights", [])}
    for light in bpy.data.lights:
        set_light(light, lights[light.name])
    for o in bpy.data.objects:
        if o.type == "MESH":
            o.cycles.shadow_terminator_geometry_offset = 0
            o.cycles.shadow_terminator_offset = 0
    set_camera(spec["camera"], gltf)


def set_renderer(spec):
    """Everything that would make the estimate biased, or smooth it, is off."""
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    r, c = scene.render, scene.cycles
    r.engine = "CYCLES"
    r.resolution_x, r.resolution_y = spec["resolution"]
    r.resolution_percentage = 100
    r.pixel_aspect_x = r.pixel_aspect_y = 1
    r.threads_mode, r.threads = "FIXED", spec["threads"]
    r.use_persistent_data = True  # one build of the BVH for all runs
    r.use_compositing = r.use_sequencer = False
    r.image_settings.file_format = "OPEN_EXR"
    r.image_settings.color_depth = "32"
    r.image_settings.color_mode = "RGB"
    c.device = "CPU"
    c.use_adaptive_sampling = c.use_denoising = False
    c.sample_clamp_direct = c.sample_clamp_indirect = c.blur_glossy = 0
    c.caustics_reflective = c.caustics_refractive = True
    c.pixel_filter_type = "BOX"
    c.film_exposure = 1
    if spec["max_depth"] < 2:
        raise SystemExit("cycles: has direct light, two edges, at least")
    bounces = spec["max_depth"] - 2  # direct light is what Cycles calls no bounce
    c.max_bounces = c.diffuse_bounces = c.glossy_bounces = c.transmission_bounces = bounces
    c.transparent_max_bounces = 1024
    return scene


def render(scene, samples, run):
    """CPU seconds of the process."""
    c = scene.cycles
    c.samples, c.seed = samples, run["seed"]
    c.min_light_bounces = 0 if run["roulette"] else c.max_bounces
    c.light_sampling_threshold = 0.01 if run["roulette"] else 0
    scene.render.filepath = run["file"]
    begin = time.process_time()
    bpy.ops.render.render(write_still=True)
    return time.process_time() - begin


def measure(scene, run):
    """A run's samples a pixel and their CPU seconds: those of one sample fewer are taken off, with all that is not rendering."""
    first = render(scene, 1, run)
    each = max(1e-5, (render(scene, 1 + PROBE, run) - first) / PROBE)
    samples = 1 + max(1, round(run["cpu_seconds"] / each))
    seconds = render(scene, samples, run) - first
    return {"samples": samples, "cpu_seconds": seconds * samples / (samples - 1)}


def main():
    spec = json.load(open(sys.argv[sys.argv.index("--") + 1]))
    begin = time.process_time()
    load(spec)
    loading = time.process_time() - begin
    scene = set_renderer(spec)
    preparing = render(scene, 1, spec["runs"][0])
    runs = [measure(scene, run) for run in spec["runs"]]
    print("cycles:", json.dumps({"version": bpy.app.version_string, "loading": loading, "preparing": preparing,
                                 "runs": runs}))


main()
