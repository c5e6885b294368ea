"""Reads a GLB on its own terms, sharing no code with the writer, and lists what is wrong."""

import json
import math
import struct

MAX_BYTES = 300_000
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
FORMATS = {5123: "H", 5126: "f"}
LEAST_COSINE = 0.3  # cosine between a triangle's normal and those of its vertices


def faults(data):
    """A list of sentences; empty for a sound file."""
    magic, version, length, json_length, kind = struct.unpack_from("<4sIII4s", data)
    if (magic, version, length, kind) != (b"glTF", 2, len(data), b"JSON"):
        return ["its GLB header is wrong"]
    document = json.loads(data[20 : 20 + json_length])
    binary_length, kind = struct.unpack_from("<I4s", data, 20 + json_length)
    binary = data[28 + json_length :]
    if kind != b"BIN\0" or len(binary) != binary_length:
        return ["its binary chunk is wrong"]
    found = [f"{len(data)} bytes, more than {MAX_BYTES}"] if len(data) > MAX_BYTES else []
    if document["buffers"] != [{"byteLength": binary_length}]:
        found.append("the buffer's length is not the binary chunk's")
    if not document.get("cameras"):
        found.append("no camera")
    found += [f for node in document["nodes"] for f in node_faults(node)]
    for mesh in document.get("meshes", []):
        for primitive in mesh["primitives"]:
            wrong = primitive_faults(document, binary, primitive)
            found += [f"mesh {mesh['name']}: {fault}" for fault in wrong]
    return found


def node_faults(node):
    q = node.get("rotation", (0, 0, 0, 1))
    if abs(math.hypot(*q) - 1) > 1e-6:
        yield f"node {node['name']}: rotation {q} is not a unit quaternion"


def primitive_faults(document, binary, primitive):
    material = document["materials"][primitive["material"]]
    arrays = {k: read(document, binary, i) for k, i in primitive["attributes"].items()}
    positions, normals = arrays["POSITION"], arrays.get("NORMAL")
    flat_indices = [i for (i,) in read(document, binary, primitive["indices"])]
    if any(len(a) != len(positions) for a in arrays.values()):
        yield "its attributes differ in length"
    if not all(math.isfinite(c) for a in arrays.values() for v in a for c in v):
        yield "a number is not finite"
    if len(flat_indices) % 3 or max(flat_indices) >= len(positions):
        yield "its indices are out of range"
        return
    triangles = list(zip(*[iter(flat_indices)] * 3))
    if set(flat_indices) != set(range(len(positions))):
        yield "it has vertices that no triangle uses"
    accessor = document["accessors"][primitive["attributes"]["POSITION"]]
    bounds = [[f(c) for c in zip(*positions)] for f in (min, max)]
    if [as_floats(accessor[k]) for k in ("min", "max")] != bounds:
        yield "its bounds are not those of its positions"
    yield from triangle_faults(positions, normals, triangles)
    if "KHR_materials_transmission" in material.get("extensions", {}):
        yield from solid_faults(positions, triangles)
    textured = "Texture" in json.dumps(material)
    if textured != ("TEXCOORD_0" in arrays):
        yield "it has texture coordinates without a texture, or the reverse"


def triangle_faults(positions, normals, triangles):
    if len(set(map(frozenset, triangles))) != len(triangles):
        yield "a triangle occurs twice"
    against = False
    for t in triangles:
        n = area_normal(positions, t)
        size = math.hypot(*n)
        if size < 1e-9:
            yield f"triangle {t} has no area"
        against |= bool(normals) and min(dot(n, normals[i]) for i in t) < LEAST_COSINE * size
    if against:
        yield "its windings and its normals disagree"
    if normals and any(abs(math.hypot(*n) - 1) > 1e-5 for n in normals):
        yield "a normal is not of unit length"


def solid_faults(positions, triangles):
    """Glass must be closed (the triangles at an edge run along it in opposite ways), facing out."""
    edges = {(positions[t[k]], positions[t[(k + 1) % 3]]) for t in triangles for k in range(3)}
    if len(edges) != 3 * len(triangles) or any((b, a) not in edges for a, b in edges):
        yield "it refracts and is not closed"
    volume = math.fsum(dot(positions[t[0]], area_normal(positions, t)) for t in triangles)
    if volume <= 0:
        yield "it refracts and faces inward"


def read(document, binary, index):
    accessor = document["accessors"][index]
    view = document["bufferViews"][accessor["bufferView"]]
    size, form = COMPONENTS[accessor["type"]], FORMATS[accessor["componentType"]]
    layout = f"<{size * accessor['count']}{form}"
    if struct.calcsize(layout) != view["byteLength"]:
        raise ValueError(f"accessor {index} does not fill its buffer view")
    if view["byteOffset"] + view["byteLength"] > len(binary):
        raise ValueError(f"accessor {index}: its buffer view leaves the buffer")
    values = struct.unpack_from(layout, binary, view["byteOffset"])
    return list(zip(*[iter(values)] * size))


def as_floats(values):
    """What a reader that stores single precision makes of numbers written in decimal."""
    return [struct.unpack("<f", struct.pack("<f", v))[0] for v in values]


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def area_normal(positions, triangle):
    """Normal of the counter-clockwise side; its length is twice the area."""
    a, b, c = (positions[i] for i in triangle)
    u, v = [q - p for p, q in zip(a, b)], [q - p for p, q in zip(a, c)]
    return (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
