"""Pixels of a result folder's layers."""

import json
import struct


def names(folder):
    return [layer["name"] for layer in json.loads((folder / "layers.json").read_text())["layers"]]


def channels(folder, name):
    """Of a layer, each channel's values; "": of the picture."""
    told = json.loads((folder / "layers.json").read_text())
    found = next(at for at in told["layers"] if at["name"] == name)
    count = len(found["channels"])
    n = told["width"] * told["height"] * count
    values = (folder / "layers.half").read_bytes()[found["offset"]:found["offset"] + 2 * n]
    halves = [found["scale"] * half for half in struct.unpack(f"<{n}e", values)]
    return [halves[c::count] for c in range(count)]
