"""Cores as closed STL files, made of rings of points round the axis. Lengths in mm."""

import math
import struct


def rounded_box(width, height, corner, grown, chords):
    """Points (x, z) round a rounded rectangle that has grown by so much on every side."""
    middle = (width / 2 - corner, height / 2 - corner)
    points = []
    for quarter, (sx, sz) in enumerate([(1, 1), (-1, 1), (-1, -1), (1, -1)]):
        for k in range(chords + 1):
            angle = math.tau / 4 * (quarter + k / chords)
            points.append((sx * middle[0] + (corner + grown) * math.cos(angle),
                           sz * middle[1] + (corner + grown) * math.sin(angle)))
    return points


def divided(points, longest):
    """The same ring with more points, none farther from the next than `longest`."""
    result = []
    for (x, z), (xn, zn) in zip(points, points[1:] + points[:1]):
        parts = math.ceil(math.hypot(xn - x, zn - z) / longest)
        result += [(x + (xn - x) * k / parts, z + (zn - z) * k / parts) for k in range(parts)]
    return result


def write_stl(path, rings):
    """Writes rings `(y, points)`, as many points each, from -y to +y, with flat ends as a closed binary STL; returns how many triangles it has."""
    rings = [[(x, y, z) for x, z in points] for y, points in rings]
    triangles = []
    count = len(rings[0])
    for low, high in zip(rings, rings[1:]):
        for k in range(count):
            a, b, c, d = low[k], low[(k + 1) % count], high[(k + 1) % count], high[k]
            triangles += [(a, c, b), (a, d, c)]
    for k in range(count):
        following = (k + 1) % count
        triangles.append(((0, rings[0][0][1], 0), rings[0][k], rings[0][following]))
        triangles.append(((0, rings[-1][0][1], 0), rings[-1][following], rings[-1][k]))
    with open(path, "wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for triangle in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in corner), 0))
    return len(triangles)
