"""A small writer of binary glTF 2.0, and the materials that the scenes use."""

import json
import math
import struct

from shapes import add, rounded

FLOAT, UINT16 = 5126, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
REPEAT, LINEAR, LINEAR_MIPMAP_LINEAR = 10497, 9729, 9987


class Glb:
    """One scene. `purpose`, `light`, `closed` and `answer` (the exact one) go into README.md."""

    def __init__(self, name, purpose, light, closed, answer=""):
        self.name, self.purpose, self.light, self.closed = name, purpose, light, closed
        self.answer = answer
        self.required = []
        self.triangles = 0
        self._binary = bytearray()
        self._lists = {}
        self._extensions = set()
        self._geometry = {}

    def texture(self, name, png_bytes):
        """Adds a texture that repeats; returns its index, for `texture_info`."""
        self._lists.setdefault("samplers", [REPEAT_SAMPLER])
        view = self._view(png_bytes)
        image = self._append("images", {"name": name, "mimeType": "image/png", "bufferView": view})
        return self._append("textures", {"name": name, "sampler": 0, "source": image})

    def material(self, material):
        self._extensions.update(names_inside(material, "KHR_"))
        return self._append("materials", material)

    def mesh(self, name, shape, material):
        """Adds a mesh without a node. Meshes of the same Shape object share its data."""
        textured = names_inside(self._lists["materials"][material], "Texture")
        key = (id(shape), bool(textured))
        if key not in self._geometry:
            self._geometry[key] = (shape, self._primitive(shape, with_uvs=textured))
        primitive = dict(self._geometry[key][1], material=material)
        return self._append("meshes", {"name": name, "primitives": [primitive]})

    def node(self, name, mesh, at=(0, 0, 0), turn=None, scale=1.0):
        """Places a mesh: scaled, turned by a quaternion or by degrees about y, moved."""
        node = {"name": name, "mesh": mesh}
        if scale != 1.0:
            node["scale"] = [scale] * 3
        self._place(node, at, turn)
        index = self._lists["meshes"][mesh]["primitives"][0]["indices"]
        self.triangles += self._lists["accessors"][index]["count"] // 3

    def add(self, name, shape, material, at=(0, 0, 0), turn=None):
        self.node(name, self.mesh(name, shape, material), at, turn)

    def camera(self, name, eye, target, yfov_degrees, aspect=1.0, up=(0, 1, 0)):
        perspective = {"yfov": math.radians(yfov_degrees), "aspectRatio": aspect, "znear": 0.01}
        camera = {"name": name, "type": "perspective", "perspective": perspective}
        node = {"name": name, "camera": self._append("cameras", camera)}
        self._place(node, eye, looking(subtract(target, eye), up))

    def point_light(self, name, at, intensity, colour=(1, 1, 1)):
        self._light({"type": "point"}, name, at, None, intensity, colour)

    def spot_light(self, name, at, direction, degrees, intensity, colour=(1, 1, 1)):
        """`degrees` are the half angles (inner, outer)."""
        inner, outer = (math.radians(d) for d in degrees)
        cone = {"innerConeAngle": inner, "outerConeAngle": outer}
        self._light({"type": "spot", "spot": cone}, name, at, looking(direction), intensity, colour)

    def directional_light(self, name, direction, intensity, colour=(1, 1, 1)):
        """`direction` is the way the light travels."""
        self._light({"type": "directional"}, name, (0, 0, 0), looking(direction), intensity, colour)

    def cameras(self):
        return [c["name"] for c in self._lists["cameras"]]

    def bytes(self):
        """The file. `required` names extensions that a reader must know to show the scene."""
        document = {
            "asset": {"version": "2.0", "generator": "lacuna make_scenes.py", "copyright": "CC0"},
            "extensionsUsed": sorted(self._extensions),
            "extensionsRequired": sorted(self.required),
            "scene": 0,
            "scenes": [{"name": self.name, "nodes": list(range(len(self._lists["nodes"])))}],
            "buffers": [{"byteLength": len(self._binary)}],
        } | self._lists
        if "lights" in document:
            document["extensions"] = {"KHR_lights_punctual": {"lights": document.pop("lights")}}
        document = {k: v for k, v in document.items() if v not in ([], {})}
        text = json.dumps(short_numbers(document), separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        length = 12 + 8 + len(text) + 8 + len(self._binary)
        head = struct.pack("<4sII", b"glTF", 2, length)
        chunks = struct.pack("<I4s", len(text), b"JSON") + text
        chunks += struct.pack("<I4s", len(self._binary), b"BIN\0") + bytes(self._binary)
        return head + chunks

    def _append(self, kind, item):
        self._lists.setdefault(kind, []).append(item)
        return len(self._lists[kind]) - 1

    def _place(self, node, at, turn):
        if isinstance(turn, (int, float)):
            turn = (0, math.sin(math.radians(turn) / 2), 0, math.cos(math.radians(turn) / 2))
        if turn is not None:
            node["rotation"] = list(turn)
        if tuple(at) != (0, 0, 0):
            node["translation"] = list(at)
        self._append("nodes", node)

    def _light(self, light, name, at, turn, intensity, colour):
        self._extensions.add("KHR_lights_punctual")
        light = {"name": name, "color": list(colour), "intensity": intensity} | light
        extension = {"KHR_lights_punctual": {"light": self._append("lights", light)}}
        self._place({"name": name, "extensions": extension}, at, turn)

    def _view(self, data, target=None):
        view = {"buffer": 0, "byteOffset": len(self._binary), "byteLength": len(data)}
        if target is not None:
            view["target"] = target
        self._binary += data + b"\0" * (-len(data) % 4)
        return self._append("bufferViews", view)

    def _primitive(self, shape, with_uvs):
        attributes = {"POSITION": self._floats(shape.positions, with_bounds=True)}
        if shape.normals:
            attributes["NORMAL"] = self._floats([unit(n) for n in shape.normals])
        if with_uvs:
            attributes["TEXCOORD_0"] = self._floats(shape.uvs)
        indices = [i for t in shape.triangles for i in t]
        view = self._view(struct.pack(f"<{len(indices)}H", *indices), ELEMENT_ARRAY_BUFFER)
        accessor = {"bufferView": view, "componentType": UINT16, "type": "SCALAR"}
        accessor["count"] = len(indices)
        return {"attributes": attributes, "indices": self._append("accessors", accessor)}

    def _floats(self, vectors, with_bounds=False):
        size = len(vectors[0])
        data = struct.pack(f"<{size * len(vectors)}f", *(c for v in vectors for c in v))
        accessor = {"bufferView": self._view(data, ARRAY_BUFFER), "componentType": FLOAT}
        accessor |= {"count": len(vectors), "type": f"VEC{size}"}
        if with_bounds:
            stored = struct.unpack(f"<{size * len(vectors)}f", data)
            accessor["min"] = [min(stored[k::size]) for k in range(size)]
            accessor["max"] = [max(stored[k::size]) for k in range(size)]
        return self._append("accessors", accessor)


REPEAT_SAMPLER = {
    "magFilter": LINEAR,
    "minFilter": LINEAR_MIPMAP_LINEAR,
    "wrapS": REPEAT,
    "wrapT": REPEAT,
}


def texture_info(index, scale=None, offset=None, degrees=None):
    """A texture in a material; scale, offset and counter-clockwise turn: KHR_texture_transform."""
    transform = {}
    if offset is not None:
        transform["offset"] = list(offset)
    if degrees is not None:
        transform["rotation"] = math.radians(degrees)
    if scale is not None:
        transform["scale"] = list(scale)
    info = {"index": index}
    if transform:
        info["extensions"] = {"KHR_texture_transform": transform}
    return info


def surface(name, colour, metallic, roughness, texture=None, **more):
    pbr = {"metallicFactor": metallic, "roughnessFactor": roughness}
    pbr["baseColorFactor"] = [*colour, 1.0]
    if texture is not None:
        pbr["baseColorTexture"] = texture
    return {"name": name, "pbrMetallicRoughness": pbr} | more


NO_SPECULAR = {"KHR_materials_specular": {"specularFactor": 0.0}}


def diffuse(name, colour=(1, 1, 1), texture=None):
    """Lambert's surface: no specular reflection at all."""
    return surface(name, colour, 0.0, 1.0, texture, extensions=dict(NO_SPECULAR))


def cut_out(name, texture, colour=(1, 1, 1)):
    """Diffuse where the texture's alpha is at least one half, absent elsewhere."""
    mask = {"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": True}
    return diffuse(name, colour, texture) | mask


def plastic(name, colour, roughness):
    return surface(name, colour, 0.0, roughness)


def metal(name, colour, roughness):
    return surface(name, colour, 1.0, roughness)


def glass(name, ior=1.5):
    extensions = {"KHR_materials_transmission": {"transmissionFactor": 1.0}}
    extensions["KHR_materials_ior"] = {"ior": ior}
    extensions["KHR_materials_volume"] = {"thicknessFactor": 1.0}  # a solid, not a thin wall
    return surface(name, (1, 1, 1), 0.0, 0.0, extensions=extensions)


def emitter(name, radiance, albedo=(0, 0, 0), double_sided=False, texture=None):
    """A diffuse emitter, black unless it has an albedo."""
    strength = max(radiance)
    material = diffuse(name, albedo)
    material["emissiveFactor"] = [c / strength for c in radiance]
    material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
    if texture is not None:
        material["emissiveTexture"] = texture
    if double_sided:
        material["doubleSided"] = True
    return material


def names_inside(value, part):
    """All keys somewhere inside a material that contain `part`."""
    if not isinstance(value, dict):
        return set()
    return {k for k in value if part in k}.union(*(names_inside(v, part) for v in value.values()))


def short_numbers(value):
    """Nine significant digits: all that a float holds, and the same on every machine."""
    if isinstance(value, float):
        return float(f"{value:.9g}") + 0.0
    if isinstance(value, dict):
        return {k: short_numbers(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [short_numbers(v) for v in value]
    return value


def subtract(a, b):
    return add(a, tuple(-c for c in b))


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(v):
    length = math.sqrt(dot(v, v))
    return tuple(c / length for c in v)


def looking(direction, up=(0, 1, 0)):
    """The quaternion (x, y, z, w) that turns -z to `direction`, `up` as upright as it goes."""
    back = unit(tuple(-c for c in direction))
    if abs(dot(back, unit(up))) > 0.999999:
        up = (0, 0, -1)
    right = unit(cross(up, back))
    above = cross(back, right)
    w = math.sqrt(max(0.0, 1 + right[0] + above[1] + back[2])) / 2
    if w > 1e-6:
        x, y, z = above[2] - back[1], back[0] - right[2], right[1] - above[0]
        return rounded_unit((x / (4 * w), y / (4 * w), z / (4 * w), w))
    # Half a turn: any column of rotation + identity that is not zero is the axis.
    columns = [add(c, e) for c, e in zip((right, above, back), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))]
    return rounded_unit((*max(columns, key=lambda c: dot(c, c)), 0.0))


def rounded_unit(q):
    length = math.sqrt(dot(q, q) + q[3] * q[3])
    return rounded([c / length for c in q])
