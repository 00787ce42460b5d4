"""What the scripts beside the scenes share: making closed triangle meshes, checking and writing them.

A mesh is a pair: a list of vertices (x, y, z) in metres, and a list of triangles, three indices from 0 each, counter-clockwise seen from
outside. Plain Python, so that the scripts need nothing installed. y is up.
"""

import math


# ------------------------------------------------------------------------------------------------ checks and files ---


def signed_volume(vertices, triangles):
    total = 0.0
    for i, j, k in triangles:
        a, b, c = vertices[i], vertices[j], vertices[k]
        total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                  + a[2] * (b[0] * c[1] - b[1] * c[0]))
    return total / 6


def check(vertices, triangles):
    """Stops if the surface is not closed, not outward, or has a triangle without area."""
    edges = set()
    for triangle in triangles:
        for i in range(3):
            edge = (triangle[i], triangle[(i + 1) % 3])
            assert edge not in edges, f"edge {edge} is used twice in the same direction"
            edges.add(edge)
        a, b, c = (vertices[i] for i in triangle)
        u = [b[i] - a[i] for i in range(3)]
        v = [c[i] - a[i] for i in range(3)]
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        assert math.hypot(*normal) > 1e-10, f"triangle {triangle} has no area"
    assert all((b, a) in edges for a, b in edges), "the surface is open"
    assert signed_volume(vertices, triangles) > 0, "the surface is inside out"


def write_obj(path, name, description, mesh, digits=5):
    """Checks a mesh, writes it with a comment that says what it is, and reports its size."""
    vertices, triangles = mesh
    vertices = [tuple(round(x, digits) + 0.0 for x in vertex) for vertex in vertices]
    check(vertices, triangles)
    with open(path, "w", encoding="ascii") as file:
        file.write(f"# {description}\no {name}\n")
        for vertex in vertices:
            file.write("v %s %s %s\n" % tuple(f"{x:.{digits}f}".rstrip("0").rstrip(".") for x in vertex))
        for triangle in triangles:
            file.write("f %d %d %d\n" % tuple(i + 1 for i in triangle))
    low = [min(v[axis] for v in vertices) for axis in range(3)]
    high = [max(v[axis] for v in vertices) for axis in range(3)]
    print(f"{path}: {len(vertices)} vertices, {len(triangles)} triangles, "
          + " x ".join(f"{b - a:.3f}" for a, b in zip(low, high)) + f" m, {1000 * signed_volume(vertices, triangles):.3f} litres")


# ------------------------------------------------------------------------------------------------ solids of revolution


def revolve(rings, bottom, top, segments):
    """A surface about the y axis: `rings` of (radius, height) from the lower pole at `bottom` to the upper one at `top`."""
    vertices = [(0.0, bottom, 0.0)]
    for radius, height in rings:
        for s in range(segments):
            turn = 2 * math.pi * s / segments
            vertices.append((radius * math.cos(turn), height, radius * math.sin(turn)))
    vertices.append((0.0, top, 0.0))

    def at(ring, segment):
        return 1 + ring * segments + segment % segments

    triangles = []
    last = len(rings) - 1
    for s in range(segments):
        triangles.append((0, at(0, s), at(0, s + 1)))
        for ring in range(last):
            a, b = at(ring, s), at(ring, s + 1)
            c, d = at(ring + 1, s), at(ring + 1, s + 1)
            triangles.append((a, c, b))
            triangles.append((b, c, d))
        triangles.append((len(vertices) - 1, at(last, s + 1), at(last, s)))
    return vertices, triangles


def lathe(profile, segments):
    """A ring about the y axis: `profile` is a closed polygon of (radius, height), clockwise with the radius to the right."""
    vertices = []
    for radius, height in profile:
        for s in range(segments):
            turn = 2 * math.pi * s / segments
            vertices.append((radius * math.cos(turn), height, radius * math.sin(turn)))
    triangles = []
    for i in range(len(profile)):
        for s in range(segments):
            a, b = i * segments + s, i * segments + (s + 1) % segments
            j = (i + 1) % len(profile)
            c, d = j * segments + s, j * segments + (s + 1) % segments
            triangles.append((a, b, c))
            triangles.append((b, d, c))
    return oriented((vertices, triangles))


def oriented(mesh):
    """The mesh, turned inside out if it was."""
    vertices, triangles = mesh
    if signed_volume(vertices, triangles) < 0:
        triangles = [(a, c, b) for a, b, c in triangles]
    return vertices, triangles


# ------------------------------------------------------------------------------------------------ shapes from distances


def surface_nets(distance, low, high, cell):
    """The surface where `distance(x, y, z)` is 0, negative inside, by naive surface nets (Gibson 1998): a vertex in each cell of a grid
    that the surface crosses, at the mean of the crossings of its edges, and a quadrilateral across each edge that it crosses."""
    count = [int(math.ceil((b - a) / cell)) + 1 for a, b in zip(low, high)]
    nx, ny, nz = count

    def at(i, j, k):
        return (k * ny + j) * nx + i

    level = [distance(low[0] + cell * i, low[1] + cell * j, low[2] + cell * k)
             for k in range(nz) for j in range(ny) for i in range(nx)]
    vertices, vertex_of = [], {}
    for k in range(nz - 1):
        for j in range(ny - 1):
            for i in range(nx - 1):
                corners = [level[at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))] for c in range(8)]
                inside = sum(value < 0 for value in corners)
                if inside in (0, 8):
                    continue
                total, crossings = [0.0, 0.0, 0.0], 0
                for c in range(8):
                    for axis in range(3):
                        d = c | 1 << axis
                        if d == c or (corners[c] < 0) == (corners[d] < 0):
                            continue
                        share = corners[c] / (corners[c] - corners[d])
                        for a in range(3):
                            total[a] += (c >> a & 1) + (share if a == axis else 0.0)
                        crossings += 1
                vertex_of[i, j, k] = len(vertices)
                vertices.append(tuple(low[a] + cell * ((i, j, k)[a] + total[a] / crossings) for a in range(3)))
    triangles = []
    for k in range(nz):
        for j in range(ny):
            for i in range(nx):
                here = (i, j, k)
                for axis in range(3):
                    if here[axis] + 1 >= count[axis]:
                        continue
                    there = [here[a] + (a == axis) for a in range(3)]
                    inside = level[at(i, j, k)] < 0
                    if inside == (level[at(*there)] < 0):
                        continue
                    u, v = (axis + 1) % 3, (axis + 2) % 3
                    ring = []
                    for du, dv in ((1, 1), (0, 1), (0, 0), (1, 0)):
                        place = list(here)
                        place[u] -= du
                        place[v] -= dv
                        ring.append(vertex_of[tuple(place)])
                    if not inside:
                        ring.reverse()
                    triangles.append((ring[0], ring[1], ring[2]))
                    triangles.append((ring[0], ring[2], ring[3]))
    return vertices, triangles


def ball(center, radius):
    return lambda x, y, z: math.dist((x, y, z), center) - radius


def capsule(a, b, radius, end_radius=None):
    """A rod from a to b with round ends; its radius may change along the way."""
    end_radius = radius if end_radius is None else end_radius
    along = [q - p for p, q in zip(a, b)]
    square = sum(d * d for d in along)

    def distance(x, y, z):
        p = (x, y, z)
        share = min(1.0, max(0.0, sum((p[i] - a[i]) * along[i] for i in range(3)) / square))
        return math.dist(p, [a[i] + share * along[i] for i in range(3)]) - (radius + share * (end_radius - radius))

    return distance


def ellipsoid(center, radii):
    """Not quite a distance, but 0 on the surface and as steep as one nearby."""

    def distance(x, y, z):
        p = [(x, y, z)[i] - center[i] for i in range(3)]
        scaled = math.hypot(*(p[i] / radii[i] for i in range(3)))
        slope = math.hypot(*(p[i] / radii[i] ** 2 for i in range(3)))
        return scaled * (scaled - 1) / slope if slope > 0 else -min(radii)

    return distance


def union(parts, blend):
    """The union of shapes, with fillets of about `blend` metres between them (polynomial smooth minimum)."""

    def distance(x, y, z):
        result = parts[0](x, y, z)
        for part in parts[1:]:
            other = part(x, y, z)
            share = max(blend - abs(result - other), 0.0) / blend
            result = min(result, other) - share * share * blend / 4
        return result

    return distance


def difference(shape, hole):
    return lambda x, y, z: max(shape(x, y, z), -hole(x, y, z))


# ------------------------------------------------------------------------------------------------ flat-sided shapes


def prism(polygon, depth, fan):
    """A polygon of (x, y), counter-clockwise, extruded along z from -depth/2 to depth/2. `fan` is the index of a corner that sees all of
    the polygon."""
    n = len(polygon)
    vertices = [(x, y, depth / 2) for x, y in polygon] + [(x, y, -depth / 2) for x, y in polygon]
    triangles = []
    for i in range(1, n - 1):
        a, b, c = fan, (fan + i) % n, (fan + i + 1) % n
        triangles.append((a, b, c))
        triangles.append((n + a, n + c, n + b))
    for i in range(n):
        j = (i + 1) % n
        triangles.append((i, n + i, j))
        triangles.append((j, n + i, n + j))
    return oriented((vertices, triangles))


def square_tube(inner, wall, bottom, top):
    """Four walls about the y axis, open above and below; `inner` is half the inner width."""
    outer = inner + wall
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1))
    vertices = [(half * x, y, half * z) for half, y in ((inner, bottom), (outer, bottom), (outer, top), (inner, top))
                for x, z in corners]
    triangles = []
    for ring in range(4):
        following = (ring + 1) % 4
        for side in range(4):
            a, b = 4 * ring + side, 4 * ring + (side + 1) % 4
            c, d = 4 * following + side, 4 * following + (side + 1) % 4
            triangles.append((a, b, c))
            triangles.append((b, d, c))
    return oriented((vertices, triangles))


def plate_with_holes(tiles, pitch, hole_radius, thickness, segments):
    """A square plate of tiles x tiles tiles, each with a round hole through its middle. Its upper face is y = 0. `segments` around a hole,
    a multiple of 8."""
    vertices, triangles, index = [], [], {}

    def vertex(x, y, z):
        key = (round(x, 6), round(y, 6), round(z, 6))
        if key not in index:
            index[key] = len(vertices)
            vertices.append(key)
        return index[key]

    def quad(a, b, c, d):
        triangles.append((a, b, c))
        triangles.append((a, c, d))

    half = pitch * tiles / 2
    for row in range(tiles):
        for column in range(tiles):
            cx, cz = (column + 0.5) * pitch - half, (row + 0.5) * pitch - half
            for s in range(segments):
                spokes = []
                for turn in (2 * math.pi * s / segments, 2 * math.pi * (s + 1) / segments):
                    c, z = math.cos(turn), math.sin(turn)
                    reach = pitch / 2 / max(abs(c), abs(z))
                    spokes.append(((cx + hole_radius * c, cz + hole_radius * z), (cx + reach * c, cz + reach * z)))
                (a, b), (d, c) = spokes  # hole, rim; rim and hole of the next spoke
                quad(*(vertex(x, 0.0, z) for x, z in (a, d, c, b)))
                quad(*(vertex(x, -thickness, z) for x, z in (a, b, c, d)))
                quad(vertex(a[0], 0.0, a[1]), vertex(a[0], -thickness, a[1]), vertex(d[0], -thickness, d[1]), vertex(d[0], 0.0, d[1]))
                on_edge = [axis for axis in (0, 1) if abs(abs(b[axis]) - half) < 1e-9 and abs(abs(c[axis]) - half) < 1e-9]
                if on_edge:
                    quad(vertex(b[0], 0.0, b[1]), vertex(c[0], 0.0, c[1]), vertex(c[0], -thickness, c[1]),
                         vertex(b[0], -thickness, b[1]))
    return oriented((vertices, triangles))
