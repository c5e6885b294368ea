"""Images from functions of pixel coordinates: PNG for textures, Radiance HDR for environments."""

import math
import struct
import zlib


def png(width, height, pixel):
    """A PNG whose pixel (x, y), row 0 on top, has the bytes pixel(x, y): (r, g, b) or (r, g, b, a).

    The data are stored, not compressed: other zlib versions compress to other bytes.
    """
    rows = [[pixel(x, y) for x in range(width)] for y in range(height)]
    colour_type = {3: 2, 4: 6}[len(rows[0][0])]
    raw = b"".join(b"\0" + bytes(c for p in row for c in p) for row in rows)
    header = struct.pack(">IIBBBBB", width, height, 8, colour_type, 0, 0, 0)
    chunks = [(b"IHDR", header), (b"IDAT", stored_zlib(raw)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(png_chunk(*c) for c in chunks)


def png_chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def stored_zlib(raw):
    """A zlib stream of stored blocks (RFC 1951, 3.2.4)."""
    out = bytearray(b"\x78\x01")
    for at in range(0, len(raw), 65535):
        part = raw[at : at + 65535]
        out += struct.pack("<BHH", at + 65535 >= len(raw), len(part), len(part) ^ 0xFFFF) + part
    return bytes(out) + struct.pack(">I", zlib.adler32(raw))


def hdr(width, height, radiance):
    """A Radiance HDR file; pixel (x, y), row 0 on top, holds the colour radiance(x, y)."""
    head = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    rows = ([rgbe(radiance(x, y)) for x in range(width)] for y in range(height))
    return head + b"".join(map(hdr_row, rows))


def hdr_row(row):
    """One scanline in the run-length format, with literal runs only."""
    out = bytearray(struct.pack(">BBH", 2, 2, len(row)))
    for channel in range(4):
        values = bytes(p[channel] for p in row)
        for at in range(0, len(values), 128):
            part = values[at : at + 128]
            out += bytes([len(part)]) + part
    return bytes(out)


def rgbe(colour):
    """Ward's shared-exponent pixel."""
    largest = max(colour)
    if largest < 1e-32:
        return (0, 0, 0, 0)
    exponent = math.frexp(largest)[1]
    return tuple(int(math.ldexp(c, 8 - exponent)) for c in colour) + (exponent + 128,)


def checker(dark, light, size=32):
    """Two by two cells: one repeat of a checker board."""
    return png(size, size, lambda x, y: light if (x * 2 // size + y * 2 // size) % 2 else dark)


def tiles(stone, joint, size=32):
    """One floor tile with a joint along two sides, a little mottled."""

    def pixel(x, y):
        if x < 1 or y < 1:
            return joint
        grain = (x * 37 + y * 101 + x * y * 13) % 17 - 8
        return tuple(c + grain for c in stone)

    return png(size, size, pixel)


# One leaf a row: centre, half length, half width, angle in degrees, in shares of the image.
LEAVES = [
    (0.22, 0.24, 0.21, 0.10, 35),
    (0.62, 0.18, 0.22, 0.09, -20),
    (0.42, 0.46, 0.24, 0.11, 65),
    (0.80, 0.50, 0.19, 0.09, 100),
    (0.17, 0.68, 0.18, 0.08, -50),
    (0.55, 0.80, 0.23, 0.10, 10),
    (0.86, 0.84, 0.13, 0.07, 55),
]


def leaves(size=64):
    """Green leaves with alpha 255 on nothing with alpha 0."""

    def pixel(x, y):
        u, v = (x + 0.5) / size, (y + 0.5) / size
        for index, (cu, cv, length, width, degrees) in enumerate(LEAVES):
            c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
            along, across = (u - cu) * c + (v - cv) * s, (v - cv) * c - (u - cu) * s
            if (along / length) ** 2 + (across / width) ** 2 < 1:
                vein = 18 if abs(across) < 0.012 else 0
                return (52 + 9 * (index % 4) + vein, 112 + 11 * (index % 3) + vein, 38 + vein, 255)
        return (60, 110, 40, 0)

    return png(size, size, pixel)


def sky(width=64, height=32):
    """Row 0 is the zenith; a pale gradient, a dim ground, and a sun of two by two pixels."""
    sun_column, sun_row = 40, 9

    def radiance(x, y):
        if x - sun_column in (0, 1) and y - sun_row in (0, 1):
            return (120.0, 105.0, 80.0)
        up = math.cos(math.pi * (y + 0.5) / height)
        if up < 0:
            return (0.10, 0.09, 0.08)
        return (0.75 - 0.50 * up, 0.80 - 0.35 * up, 0.85 - 0.05 * up)

    return hdr(width, height, radiance)
