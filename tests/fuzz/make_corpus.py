"""Makes the seeds of tests/fuzz/corpus that are not text: small pictures and a scene of every kind that is read. Its
glb/meshopt.glb is a scene of tests/renderer/gltf/meshopt_test.cpp, with a camera."""

import base64
import json
import pathlib
import struct
import subprocess
import zlib

CORPUS = pathlib.Path(__file__).resolve().parent / "corpus"
PATTERN = "fill:topleft=.1,.2,.3,1:topright=1,0,0,.5:bottomleft=0,1,0,1:bottomright=2,3,.5,0"


def make(file, *options, size="7x5", channels=4, save=()):
    file = CORPUS / file
    file.parent.mkdir(parents=True, exist_ok=True)
    subprocess.run(["oiiotool", "--nosoftwareattrib", "--pattern", PATTERN, size, str(channels), *options,
                    "--attrib", "DateTime", "2000:01:01 00:00:00", *save, "-o", str(file)], check=True)


def float_images():
    for compression in ("none", "rle", "zip", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"):
        make(f"float_image/{compression}.exr", channels=3, save=("-d", "half", "--compression", compression))
    rgb = {"channels": 3}
    make("float_image/float.exr", **rgb, save=("-d", "float"))
    make("float_image/uint.exr", **rgb, save=("-d", "uint32"))
    make("float_image/tiled.exr", **rgb, save=("-d", "half", "--tile", "4", "4"))
    make("float_image/grey.exr", "--ch", "R", "--chnames", "Y", **rgb, save=("-d", "half"))
    make("float_image/layers.exr", "--dup", "--chnames", "half_a.R,half_a.G,half_a.B", "--chappend", **rgb,
         save=("-d", "half"))
    make("float_image/parts.exr", "--dup", "--chnames", "half_a.R,half_a.G,half_a.B", "--siappend", **rgb,
         save=("-d", "half"))
    make("float_image/attributes.exr", "--attrib", "lacuna:est_rmse", "0.25", "--attrib:type=float", "x", "3",
         **rgb, save=("-d", "half"))
    make("float_image/crop.exr", "--crop", "3x2+1+1", **rgb, save=("-d", "half"))
    make("float_image/float.tif", **rgb, save=("-d", "float", "--compression", "none"))
    make("float_image/zip.tif", **rgb, save=("-d", "float", "--compression", "zip"))
    make("float_image/tiled.tif", size="17x16", channels=4, save=("-d", "float", "--compression", "lzw", "--tile", "16", "16"))
    make("float_image/planes.tif", **rgb, save=("-d", "float", "--compression", "packbits", "--planarconfig", "separate"))
    make("float_image/flat.hdr", size="4x3", **rgb)
    make("float_image/runs.hdr", size="16x3", **rgb)


def textures():
    for channels, name in ((1, "grey"), (2, "grey_alpha"), (3, "rgb"), (4, "rgba")):
        make(f"texture/{name}.png", "--ch", "R,G,B,A"[:2 * channels - 1], save=("-d", "uint8"))
        make(f"texture/{name}16.png", "--ch", "R,G,B,A"[:2 * channels - 1], save=("-d", "uint16"))
    make("texture/grey.jpg", "--ch", "R", save=("-d", "uint8"))
    make("texture/flat.jpg", "--mulc", "0", "--addc", ".4", size="16x16", channels=3, save=("-d", "uint8"))
    make("texture/rgb.jpg", channels=3, save=("-d", "uint8"))
    make("texture/rgb_large.jpg", size="40x24", channels=3, save=("-d", "uint8", "--quality", "30"))


# Two rows of two texels with alpha, by libwebp: lossless, and lossy in the extended format.
WEBP = {"lossless": (
    "524946463c000000574542505650384c300000002f014000101f20104892dd1f610d8100c1ff982b02018225ff6f0402c41a65d2"
    "85993b5205356d1bb0f84d3a22fa1f1c"), "lossy": (
    "524946467600000057454250565038580a00000010000000010000010000414c50480500000000ff8040ff00565038204a000000"
    "7002009d012a0200020000000025a00274ba01f801fa00033295df0000fefec1fffd67ffcc7f7643ff926fffd5275ae962b42b7f"
    "63fff70c0026376ffee187ffe644ef36d5dffe620000")}


def webps():
    for name, text in WEBP.items():
        (CORPUS / f"texture/{name}.webp").write_bytes(bytes.fromhex(text))


class Buffer:
    """Collects the binary of a scene; each call gives the index of an accessor or of a bufferView."""

    def __init__(self):
        self.bytes, self.views, self.accessors = bytearray(), [], []

    def view(self, data, **more):
        self.bytes += bytes(-len(self.bytes) % 4)
        self.views.append({"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data), **more})
        self.bytes += data
        return len(self.views) - 1

    def accessor(self, view, component, kind, count, offset=0, **more):
        self.accessors.append({"bufferView": view, "byteOffset": offset, "componentType": component, "count": count,
                               "type": kind, **more})
        return len(self.accessors) - 1


def primitives(buffer):
    """A strip and a list, interleaved and apart, with every type of index and of texture coordinate."""
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, .5)]
    both = buffer.view(b"".join(struct.pack("<6f", *c, 0, 0, 1) for c in corners), byteStride=24)
    position, normal = (buffer.accessor(both, 5126, "VEC3", 4, 12 * k) for k in range(2))
    shorts = buffer.accessor(buffer.view(struct.pack("<8H", 0, 0, 65535, 0, 0, 65535, 65535, 65535)), 5123, "VEC2", 4,
                             normalized=True)
    floats = buffer.accessor(buffer.view(struct.pack("<8f", 0, 0, 2, 0, 0, -2, 2, 2)), 5126, "VEC2", 4)
    indices = [buffer.accessor(buffer.view(struct.pack(f"<6{code}", 0, 1, 2, 2, 1, 3)), component, "SCALAR", 6)
               for code, component in (("B", 5121), ("H", 5123), ("I", 5125))]
    attributes = {"POSITION": position, "NORMAL": normal, "TEXCOORD_0": shorts, "TEXCOORD_1": floats}
    return [{"attributes": attributes, "indices": indices[0], "material": 0},
            {"attributes": attributes, "indices": indices[1], "material": 1},
            {"attributes": {"POSITION": position}, "indices": indices[2], "material": 2},
            {"attributes": attributes, "mode": 5, "material": 0},
            {"attributes": {"POSITION": position}, "mode": 6}]


def materials():
    def texture(**more):
        return {"index": 0, **more}
    turned = {"extensions": {"KHR_texture_transform": {"offset": [.1, .2], "rotation": 1, "scale": [2, 3]}}}
    return [
        {"alphaMode": "MASK", "alphaCutoff": .4, "doubleSided": True,
         "pbrMetallicRoughness": {"baseColorTexture": texture(texCoord=1, **turned), "metallicFactor": .5}},
        {"emissiveFactor": [1, .5, 0], "emissiveTexture": texture(),
         "pbrMetallicRoughness": {"metallicRoughnessTexture": texture(), "roughnessFactor": .3},
         "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}},
        {"pbrMetallicRoughness": {"baseColorFactor": [.2, .5, .8, 1], "roughnessFactor": 0},
         "extensions": {"KHR_materials_ior": {"ior": 1.4}, "KHR_materials_transmission": {"transmissionFactor": .9},
                        "KHR_materials_specular": {"specularFactor": .5, "specularColorFactor": [1, .9, .8]},
                        "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [1, .5, 0]},
                        "KHR_materials_clearcoat": {"clearcoatFactor": .5, "clearcoatTexture": texture(), "clearcoatRoughnessFactor": .2},
                        "KHR_materials_sheen": {"sheenColorFactor": [.5, .4, .3], "sheenRoughnessFactor": .6},
                        "KHR_materials_anisotropy": {"anisotropyStrength": .5, "anisotropyTexture": texture()},
                        "KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessTexture": texture()},
                        "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": .5, "diffuseTransmissionColorFactor": [1, .5, 0]}}}]


def scene(buffer):
    mesh = {"primitives": primitives(buffer)}
    image = buffer.view((CORPUS / "texture/rgba.png").read_bytes())
    lights = [{"type": "point", "intensity": 3}, {"type": "directional", "color": [1, .5, 0]},
              {"type": "spot", "intensity": 9, "spot": {"innerConeAngle": .1, "outerConeAngle": .5}}]
    nodes = [{"mesh": 0, "rotation": [0, 0, .6, .8], "scale": [1, -2, 1], "children": [1]},
             {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .5, 0, -1, 1]},
             {"camera": 0, "translation": [.4, .4, 2]}]
    nodes += [{"translation": [0, 1, 1], "extensions": {"KHR_lights_punctual": {"light": i}}} for i in range(3)]
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3, 4, 5]}], "nodes": nodes,
            "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"],
            "meshes": [mesh], "materials": materials(), "accessors": buffer.accessors, "bufferViews": buffer.views,
            "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 33071, "wrapT": 33648}],
            "images": [{"bufferView": image, "mimeType": "image/png"}],
            "cameras": [{"type": "perspective", "perspective": {"yfov": .8, "znear": .01}}],
            "extensions": {"KHR_lights_punctual": {"lights": lights}}}


def posed_scene(buffer):
    """A triangle of shorts with a sparse morph target, on a joint that an animation moves."""
    positions = buffer.accessor(buffer.view(struct.pack("<12h", 0, 0, 0, 0, 9, 0, 0, 0, 0, 9, 0, 0), byteStride=8), 5122,
                                "VEC3", 3)
    where = buffer.view(struct.pack("<H", 2))
    moved = buffer.view(struct.pack("<3f", 0, 1, 1))
    target = buffer.accessor(where, 5126, "VEC3", 3)
    del buffer.accessors[target]["bufferView"]
    buffer.accessors[target]["sparse"] = {"count": 1, "indices": {"bufferView": where, "componentType": 5123},
                                          "values": {"bufferView": moved}}
    joints = buffer.accessor(buffer.view(bytes(12)), 5121, "VEC4", 3)
    weights = buffer.accessor(buffer.view(b"\xff\0\0\0" * 3), 5121, "VEC4", 3, normalized=True)
    identity = buffer.accessor(buffer.view(struct.pack("<16f", *[float(i % 5 == 0) for i in range(16)])), 5126, "MAT4", 1)
    times = buffer.accessor(buffer.view(struct.pack("<2f", 0, 1)), 5126, "SCALAR", 2)
    turns = buffer.accessor(buffer.view(struct.pack("<8f", 0, 0, 0, 1, 0, 0, .6, .8)), 5126, "VEC4", 2)
    curve = buffer.accessor(buffer.view(struct.pack("<18f", *range(18))), 5126, "VEC3", 6)
    steps = buffer.accessor(buffer.view(struct.pack("<2f", 0, 1)), 5126, "SCALAR", 2)
    channels = [{"sampler": i, "target": {"node": node, "path": path}}
                for i, (node, path) in enumerate(((1, "rotation"), (1, "translation"), (0, "weights")))]
    samplers = [{"input": times, "output": turns}, {"input": times, "output": curve, "interpolation": "CUBICSPLINE"},
                {"input": times, "output": steps, "interpolation": "STEP"}]
    attributes = {"POSITION": positions, "JOINTS_0": joints, "WEIGHTS_0": weights}
    return {"asset": {"version": "2.0"}, "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0, "skin": 0, "weights": [.5]}, {"scale": [.1, .1, .1]},
                      {"camera": 0, "translation": [.3, .3, 3]}],
            "meshes": [{"primitives": [{"attributes": attributes, "targets": [{"POSITION": target}]}]}],
            "skins": [{"joints": [1], "inverseBindMatrices": identity}],
            "animations": [{"channels": channels, "samplers": samplers}],
            "accessors": buffer.accessors, "bufferViews": buffer.views,
            "cameras": [{"type": "perspective", "perspective": {"yfov": .8, "znear": .01}}]}


def featured_scene(buffer):
    """A square with tangents and colours of bytes; a normal map, blending, old and unlit materials, variants, a WebP."""
    corners = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0))

    def floats(kind, *values):
        return buffer.accessor(buffer.view(struct.pack(f"<{len(values)}f", *values)), 5126, kind, 4)
    attributes = {"POSITION": floats("VEC3", *(x for c in corners for x in c)),
                  "NORMAL": floats("VEC3", *(0, 0, 1) * 4),
                  "TANGENT": floats("VEC4", *(1, 0, 0, -1) * 4),
                  "TEXCOORD_0": floats("VEC2", *(x for c in corners for x in c[:2])),
                  "COLOR_0": buffer.accessor(buffer.view(bytes(range(0, 240, 15))), 5121, "VEC4", 4, normalized=True)}
    indices = buffer.accessor(buffer.view(bytes((0, 1, 2, 0, 2, 3))), 5121, "SCALAR", 6)
    variants = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}
    image = buffer.view(bytes.fromhex(WEBP["lossy"]))
    texture = {"index": 0}
    materials = [{"alphaMode": "BLEND", "normalTexture": {"index": 0, "scale": 2},
                  "pbrMetallicRoughness": {"baseColorTexture": texture}},
                 {"extensions": {"KHR_materials_unlit": {}}},
                 {"extensions": {"KHR_materials_pbrSpecularGlossiness": {
                     "diffuseFactor": [.5, .4, .3, .8], "specularGlossinessTexture": texture}}}]
    primitives = [{"attributes": attributes, "indices": indices, "material": i, "extensions": variants}
                  for i in range(3)]
    return {"asset": {"version": "2.0", "generator": "Khronos glTF Blender I/O v4.5.32"},
            "scenes": [{"nodes": [0, 1, 2]}],
            "nodes": [{"mesh": 0, "scale": [-1, 1, 1]}, {"camera": 0, "translation": [-.5, .5, 2]},
                      {"translation": [0, 1, 1], "extensions": {"KHR_lights_punctual": {"light": 0}}}],
            "meshes": [{"primitives": primitives}], "materials": materials,
            "textures": [{"extensions": {"EXT_texture_webp": {"source": 0}}}],
            "images": [{"bufferView": image, "mimeType": "image/webp"}],
            "cameras": [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0, "zfar": 9}}],
            "extensionsUsed": ["EXT_texture_webp", "KHR_materials_variants", "KHR_materials_unlit"],
            "accessors": buffer.accessors, "bufferViews": buffer.views,
            "extensions": {"KHR_materials_variants": {"variants": [{"name": "lit"}]},
                           "KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 3}]}}}


def lacuna_scene(buffer):
    """The square with each type of LACUNA_materials."""
    content = featured_scene(buffer)
    texture = {"index": 0}
    both = [{"material": 0, "weight": .5}, {"material": 6, "weight": [.1, .5, .2]}]
    exact = [{"type": "diffuse", "sigma": .3, "oneSided": True, "bump": {"index": 0, "scale": .5}},
             {"type": "conductor", "eta": [.2, .9, 1.1], "k": [3.9, 2.5, 2.1], "distribution": "beckmann",
              "alpha": [.1, .4], "alphaTexture": texture, "reflectanceTexture": texture},
             {"type": "dielectric", "ior": 1.5, "alpha": .2, "transmittance": [.9, 1, 1]},
             {"type": "thinDielectric", "ior": 1.5, "reflectance": [1, .5, 1]},
             {"type": "plastic", "ior": 1.5, "nonlinear": True, "alpha": .1},
             {"type": "phong", "exponent": 30, "reflectance": [.2, .2, .2]},
             {"type": "ward", "variant": "duer", "alpha": [.1, .2], "reflectance": [.2, .2, .2]},
             {"type": "coating", "base": 1, "ior": 1.5, "thickness": .1, "absorption": [1, 2, 3]},
             {"type": "mixture", "parts": both},
             {"type": "mixture", "weightTexture": texture, "parts": [{"material": 7}, {"material": 8}]}]
    content["materials"] = [{"extensions": {"LACUNA_materials": e}} for e in exact]
    first = content["meshes"][0]["primitives"][0]
    content["meshes"] = [{"primitives": [{**first, "material": i, "extensions": {}} for i in range(len(exact))]}]
    content["extensionsUsed"] += ["LACUNA_materials"]
    return content


def write_glb(name, content, buffer):
    content["buffers"] = [{"byteLength": len(buffer.bytes)}]
    text = json.dumps(content, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    binary = bytes(buffer.bytes) + bytes(-len(buffer.bytes) % 4)
    folder = CORPUS / "glb"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(
        struct.pack("<5I", 0x46546C67, 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A) + text
        + struct.pack("<2I", len(binary), 0x004E4942) + binary)
    return binary


def posed():
    buffer = Buffer()
    write_glb("posed.glb", posed_scene(buffer), buffer)


def featured():
    buffer = Buffer()
    write_glb("features.glb", featured_scene(buffer), buffer)
    buffer = Buffer()
    write_glb("lacuna.glb", lacuna_scene(buffer), buffer)


def scenes():
    buffer = Buffer()
    content = scene(buffer)
    binary = write_glb("everything.glb", content, buffer)
    uri = "data:application/octet-stream;base64," + base64.b64encode(binary).decode()
    content["buffers"] = [{"byteLength": len(binary), "uri": uri}]
    content["images"] = [{"uri": "data:image/png;base64,"
                          + base64.b64encode((CORPUS / "texture/rgba.png").read_bytes()).decode()}]
    (CORPUS / "glb/everything.gltf").write_text(json.dumps(content, separators=(",", ":")))


def mesh_files():
    """A binary PLY of either byte order, and meshes of Mitsuba's own format with all that they can hold."""
    header = ("ply\nformat binary_{}_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\n"
              "property list uchar int vertex_indices\nend_header\n")
    folder = CORPUS / "mesh_file"
    for order, name in (("<", "little"), (">", "big")):
        vertices = b"".join(struct.pack(f"{order}3f3B", x, y, 0, 255, 128, 0) for x, y in ((0, 0), (1, 0), (0, 1)))
        (folder / f"{name}.ply").write_bytes(
            header.format(name).encode() + vertices + struct.pack(f"{order}B3i", 3, 0, 1, 2))
    for version, flags, real in ((3, 0x1001, "f"), (4, 0x200B, "d")):
        name = b"mesh\0" if version == 4 else b""
        values = 3 * (3 + 3 * (flags & 1) + (flags & 2) + 3 * ((flags & 8) > 0))
        body = struct.pack("<I", flags) + name + struct.pack("<QQ", 3, 1)
        body += struct.pack(f"<{values}{real}", *(i / 8 for i in range(values))) + struct.pack("<3I", 0, 1, 2)
        offsets = struct.pack("<QI" if version == 4 else "<II", 0, 1)
        (folder / f"v{version}.serialized").write_bytes(
            struct.pack("<HH", 0x041C, version) + zlib.compress(body) + offsets)


float_images()
textures()
webps()
scenes()
posed()
featured()
mesh_files()
