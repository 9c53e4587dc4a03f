#!/usr/bin/python3
"""Makes the sample meshes and their deformations (needs Gmsh's Python module: package python3-gmsh).

    generate.py [NAME ...]        all samples, or those named

Each sample is a straight-sided mesh of order p with named boundary groups (MSH 4.1 ASCII, gzipped where large) and a
deformation.json that curves or moves its boundary. The examples follow chapters 2 and 4 of M. Stees, "Optimization-based
Methods in High-Order Mesh Generation and Untangling"; the dimensions, which the text does not give, are ours.
"""
import gzip
import json
import math
import os
import sys

import gmsh

HERE = os.path.dirname(os.path.abspath(__file__))


def ring(radius, count):
    """Corners of a regular polygon on a circle about the origin, counter-clockwise."""
    return [(radius * math.cos(2 * math.pi * k / count), radius * math.sin(2 * math.pi * k / count))
            for k in range(count)]


def begin(name, algorithm):
    gmsh.initialize(["gmsh", "-nopopup"])
    for option, value in (("General.Terminal", 0), ("General.NumThreads", 1), ("Mesh.Algorithm", algorithm),
                          ("Mesh.RandomSeed", 1), ("Mesh.MshFileVersion", 4.1), ("Mesh.Binary", 0),
                          ("Mesh.SecondOrderLinear", 1)):
        gmsh.option.setNumber(option, value)
    gmsh.model.add(name)


def finish(name, order, operations, compress=False):
    gmsh.model.mesh.setOrder(order)
    folder = os.path.join(HERE, name)
    os.makedirs(folder, exist_ok=True)
    mesh = os.path.join(folder, name + ".msh")
    gmsh.write(mesh)
    gmsh.finalize()
    if compress:
        with open(mesh, "rb") as source, gzip.GzipFile(mesh + ".gz", "wb", 9, mtime=0) as target:
            target.write(source.read())
        os.remove(mesh)
    with open(os.path.join(folder, "deformation.json"), "w") as file:
        json.dump({"operations": operations}, file, indent=1)
        file.write("\n")


def polygon_domain(loops, points=(), size=None):
    """Plane domain between polygons, one mesh edge per side. loops: (group, corners, size at the corners), the outer one
    first. points: (x, y, size) that must be mesh vertices. size: element size as a function of x, y."""
    geo = gmsh.model.geo
    curves, groups = [], []
    for group, corners, corner_size in loops:
        tags = [geo.addPoint(x, y, 0, corner_size) for x, y in corners]
        lines = [geo.addLine(tags[i], tags[(i + 1) % len(tags)]) for i in range(len(tags))]
        for line in lines:
            geo.mesh.setTransfiniteCurve(line, 2)
        curves.append(geo.addCurveLoop(lines))
        groups.append((group, lines))
    surface = geo.addPlaneSurface(curves)
    embedded = [geo.addPoint(x, y, 0, s) for x, y, s in points]
    geo.synchronize()
    if embedded:
        gmsh.model.mesh.embed(0, embedded, 2, surface)
    for k, (group, lines) in enumerate(groups):
        gmsh.model.setPhysicalName(1, gmsh.model.addPhysicalGroup(1, lines, k + 1), group)
    gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [surface], 1), "domain")
    if size:
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z: size(x, y))
    gmsh.model.mesh.generate(2)


def snap(group, shape, center, radius):
    return {"group": group, "type": "snap_to", "shape": shape, "center": center, "radius": radius}


def annulus():
    """30 cubic triangles, 16 of them on the two circles. The vertices above and below the inner circle sit so close to
    its polygon that two elements tangle when the circle is curved."""
    begin("annulus", 3)  # 3: initial triangulation only, no further points
    inner = 0.4
    points = []
    for k in range(6):
        angle = math.radians(30 + 60 * k)
        radius = 0.5604 if k in (1, 4) else 0.7
        points.append((radius * math.cos(angle), radius * math.sin(angle), 10.0))
    points.append((0.76, 0.0, 10.0))
    polygon_domain([("outer", ring(1.0, 10), 10.0), ("inner", ring(inner, 6), 10.0)], points)
    finish("annulus", 3, [snap("outer", "circle", [0, 0, 0], 1.0), snap("inner", "circle", [0, 0, 0], inner)])


def size_from_sides(polygons, growth):
    """Element size: length of the nearest side times its polygon's factor, growing with the distance from it."""
    sides = []  # start, end, length, factor
    for corners, factor in polygons:
        for a, b in zip(corners, corners[1:] + corners[:1]):
            sides.append((a, b, math.dist(a, b), factor))

    def size(x, y):
        best = 1e22
        for (ax, ay), (bx, by), length, factor in sides:
            t = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length ** 2
            t = min(1.0, max(0.0, t))
            there = math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay))
            best = min(best, factor * length + growth * there)
        return best

    return size


def moving_circle():
    """About 1,700 quadratic triangles between a rectangle and a circle that moves by its radius."""
    begin("moving_circle", 6)
    radius, width, height, across, up = 0.13, 1.5, 1.0, 36, 24
    half = [(-width / 2 + width * k / across, -height / 2) for k in range(across)]
    half += [(width / 2, -height / 2 + height * k / up) for k in range(up)]
    rectangle = half + [(-x, -y) for x, y in half]
    circle = ring(radius, 20)
    size = size_from_sides([(rectangle, 1.0), (circle, 1.0)], 0.033)
    polygon_domain([("rectangle", rectangle, 0.04), ("circle", circle, 0.04)], size=size)
    finish("moving_circle", 2, [snap("circle", "circle", [0, 0, 0], radius),
                                {"group": "circle", "type": "translate", "vector": [radius, 0, 0]}])


def moving_circles1():
    """About 1,500 cubic triangles between a square and four circles, each of which moves towards the middle."""
    begin("moving_circles1", 6)
    radius, place, half, across = 0.13, 0.22, 0.5, 14
    sides = [(-half + 2 * half * k / across, -half) for k in range(across)]
    sides += [(half, -half + 2 * half * k / across) for k in range(across)]
    square = sides + [(-x, -y) for x, y in sides]
    circles, operations = [], []
    for k, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        group = "circle%d" % (k + 1)
        circles.append((group, [(sx * place + x, sy * place + y) for x, y in ring(radius, 16)], 0.04))
        shift = 0.375 * radius
        operations += [snap(group, "circle", [sx * place, sy * place, 0], radius),
                       {"group": group, "type": "translate", "vector": [-shift * sx, -shift * sy, 0]}]
    size = size_from_sides([(square, 1.0)] + [(corners, 0.58) for _, corners, _ in circles], 0.05)
    polygon_domain([("square", square, 0.04)] + circles, size=size)
    finish("moving_circles1", 3, operations, compress=True)


def sphere_in_cube(name, near, far, grow):
    """Cubic tetrahedra between the cube [-1, 1]^3 and a sphere that moves by 30 % of its radius."""
    begin(name, 6)
    radius = 0.35
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(-1, -1, -1, 2, 2, 2))], [(3, occ.addSphere(0, 0, 0, radius))])
    occ.synchronize()
    sphere = [tag for dim, tag in gmsh.model.getEntities(2) if gmsh.model.getType(dim, tag) == "Sphere"]
    cube = [tag for dim, tag in gmsh.model.getEntities(2) if tag not in sphere]
    for k, (group, tags) in enumerate((("sphere", sphere), ("cube", cube))):
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, tags, k + 1), group)
    volumes = [tag for dim, tag in gmsh.model.getEntities(3)]
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, volumes, 1), "domain")
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.model.mesh.setSizeCallback(
        lambda dim, tag, x, y, z: min(far, near + grow * max(0.0, math.sqrt(x * x + y * y + z * z) - radius)))
    gmsh.model.mesh.generate(3)
    finish(name, 3, [snap("sphere", "sphere", [0, 0, 0], radius),
                     {"group": "sphere", "type": "translate", "vector": [0.3 * radius, 0, 0]}], compress=True)


SAMPLES = {
    "annulus": annulus,
    "moving_circle": moving_circle,
    "moving_circles1": moving_circles1,
    "moving_sphere": lambda: sphere_in_cube("moving_sphere", 0.0755, 0.155, 0.1),
    "moving_sphere_small": lambda: sphere_in_cube("moving_sphere_small", 0.147, 0.315, 0.2),
}

if __name__ == "__main__":
    for name in sys.argv[1:] or SAMPLES:
        if name not in SAMPLES:
            sys.exit(f"There is no sample '{name}'; there are {', '.join(SAMPLES)}.")
        SAMPLES[name]()
        print(name)
