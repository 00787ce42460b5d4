#!/usr/bin/env python3
"""Makes a picture of loam-run small enough for the documentation.

    shrink_png.py IN.png OUT.png WIDTH [LEFT TOP RIGHT BOTTOM]

Cuts away the given shares of the picture at its sides (each 0 to 1; default none), averages it down to WIDTH pixels, and compresses it as
well as PNG can. Reads only what loam-run writes: 8 bits a channel, RGB, not interlaced.
"""

import math
import struct
import sys
import zlib


def paeth(a, b, c):
    p = a + b - c
    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        sys.exit(f"error: {path}: not a PNG file")
    at, packed, width, height = 8, b"", 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            if (depth, colour, interlaced) != (8, 2, 0):
                sys.exit(f"error: {path}: not 8-bit RGB without interlacing")
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    raw, stride, rows = zlib.decompress(packed), 3 * width, []
    above = bytearray(stride)
    for y in range(height):
        mode = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if mode == 1:
            for i in range(3, stride):
                row[i] = row[i] + row[i - 3] & 255
        elif mode == 2:
            for i in range(stride):
                row[i] = row[i] + above[i] & 255
        elif mode == 3:
            for i in range(stride):
                row[i] = row[i] + ((row[i - 3] if i >= 3 else 0) + above[i]) // 2 & 255
        elif mode == 4:
            for i in range(stride):
                row[i] = row[i] + paeth(row[i - 3] if i >= 3 else 0, above[i], above[i - 3] if i >= 3 else 0) & 255
        rows.append(row)
        above = row
    return width, height, rows


def overlaps(count, start, length, target):
    """For each target pixel the source pixels that it covers, with the share of each."""
    result = []
    step = length / target
    for i in range(target):
        low, high = start + i * step, start + (i + 1) * step
        parts = []
        for k in range(int(low), min(count, int(math.ceil(high - 1e-9)))):
            parts.append((k, (min(high, k + 1) - max(low, k)) / step))
        result.append(parts)
    return result


def shrink(width, height, rows, target, cut):
    left, top = cut[0] * width, cut[1] * height
    across, down = width * (1 - cut[0] - cut[2]), height * (1 - cut[1] - cut[3])
    target = min(target, int(across))
    target_height = max(1, round(down * target / across))
    columns = overlaps(width, left, across, target)
    result = []
    for parts in overlaps(height, top, down, target_height):
        sums = [0.0] * (3 * width)
        for k, share in parts:
            row = rows[k]
            sums = [s + share * v for s, v in zip(sums, row)]
        out = bytearray()
        for spots in columns:
            for channel in range(3):
                out.append(min(255, int(sum(share * sums[3 * k + channel] for k, share in spots) + 0.5)))
        result.append(out)
    return target, target_height, result


def write(path, width, height, rows):
    raw, above = bytearray(), bytearray(3 * width)
    for row in rows:
        before = bytearray(3) + row[:-3]
        corner = bytearray(3) + above[:-3]
        candidates = [row, bytes(a - b & 255 for a, b in zip(row, before)), bytes(a - b & 255 for a, b in zip(row, above)),
                      bytes(a - (b + c) // 2 & 255 for a, b, c in zip(row, before, above)),
                      bytes(a - paeth(b, c, d) & 255 for a, b, c, d in zip(row, before, above, corner))]
        costs = [sum(min(v, 256 - v) for v in line) for line in candidates]
        best = costs.index(min(costs))
        raw.append(best)
        raw += candidates[best]
        above = row

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(bytes(raw), 9)) + chunk(b"IEND", b""))


def main():
    if len(sys.argv) not in (4, 8):
        sys.exit(__doc__)
    cut = [float(a) for a in sys.argv[4:]] or [0.0] * 4
    width, height, rows = read(sys.argv[1])
    write(sys.argv[2], *shrink(width, height, rows, int(sys.argv[3]), cut))


if __name__ == "__main__":
    main()
