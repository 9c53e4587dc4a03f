#!/usr/bin/python3
"""Makes the sample meshes and their deformations (needs Gmsh's Python module: package python3-gmsh).

    generate.py [NAME ...]        all samples that are kept, or those named

Each sample is a straight-sided mesh of order p with named boundary groups (MSH 4.1 ASCII, gzipped where large) and a
deformation.json that curves or moves its boundary. The examples follow chapters 2 and 4 of M. Stees, "Optimization-based
Methods in High-Order Mesh Generation and Untangling"; the dimensions, which the text does not give, are ours.

Meshes too large to be kept are made on demand: generate.py moving_spheres circle_family sphere_family.
"""
import gzip
import json
import math
import os
import random
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


def polygon_domain(loops, points=(), size=None, layer=None):
    """Plane domain between polygons, one mesh edge per side. loops: (group, corners, size at the corners), the outer one
    first. points: (x, y, size) that must be mesh vertices. size: element size as a function of x, y. layer: a boundary
    layer of triangles: its group, options of Gmsh's field BoundaryLayer, and a fan at the group's first corner."""
    geo = gmsh.model.geo
    curves, groups = [], []
    for group, corners, corner_size in loops:
        tags = [geo.addPoint(x, y, 0, corner_size) for x, y in corners]
        lines = [geo.addLine(tags[i], tags[(i + 1) % len(tags)]) for i in range(len(tags))]
        for line in lines:
            geo.mesh.setTransfiniteCurve(line, 2)
        curves.append(geo.addCurveLoop(lines))
        groups.append((group, lines))
        if layer and layer["group"] == group:
            layer_lines, fan = lines, tags[:1]
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
    if layer:
        field = gmsh.model.mesh.field
        tag = field.add("BoundaryLayer")
        field.setNumbers(tag, "CurvesList", layer_lines)
        field.setNumbers(tag, "FanPointsList", fan)
        for option, value in {**layer["options"], "Quads": 0, "IntersectMetrics": 1}.items():
            field.setNumber(tag, option, value)
        field.setAsBoundaryLayer(tag)
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


def moving_circles(name, motion):
    """About 1,500 cubic triangles between a square and four circles; motion: of each circle, in radii, from the signs
    of its centre."""
    begin(name, 6)
    radius, place, half, across = 0.13, 0.22, 0.5, 14
    sides = [(-half + 2 * half * k / across, -half) for k in range(across)]
    sides += [(half, -half + 2 * half * k / across) for k in range(across)]
    square = sides + [(-x, -y) for x, y in sides]
    circles, operations = [], []
    for k, (sx, sy) in enumerate(((1, 1), (-1, 1), (-1, -1), (1, -1))):
        group = "circle%d" % (k + 1)
        circles.append((group, [(sx * place + x, sy * place + y) for x, y in ring(radius, 16)], 0.04))
        across_x, across_y = motion(sx, sy)
        operations += [snap(group, "circle", [sx * place, sy * place, 0], radius),
                       {"group": group, "type": "translate", "vector": [radius * across_x, radius * across_y, 0]}]
    size = size_from_sides([(square, 1.0)] + [(corners, 0.58) for _, corners, _ in circles], 0.05)
    polygon_domain([("square", square, 0.04)] + circles, size=size)
    finish(name, 3, operations, compress=True)


def moving_circles2():
    """The circles of moving_circles1, each moved at random by up to 65 % of its radius across and up."""
    chance = random.Random(7)
    moving_circles("moving_circles2",
                   lambda sx, sy: [round(chance.uniform(-0.65, 0.65), 6), round(chance.uniform(-0.65, 0.65), 6)])


def naca_height(s):
    """Half the thickness of the NACA 0012 airfoil of chord 1 at s from its nose; closed at the tail."""
    return 0.6 * (0.2969 * math.sqrt(s) - 0.126 * s - 0.3516 * s ** 2 + 0.2843 * s ** 3 - 0.1036 * s ** 4)


def naca_p2():
    """About 2,350 quadratic triangles around an airfoil, stretched in its boundary layer."""
    begin("naca_p2", 6)
    nose, steps, half, per_side = 0.053, 44, 4.0, 17
    roots = [0.0] + [nose + (1 - nose) * k / steps for k in range(steps + 1)]
    upper = [(u * u, naca_height(u * u) if u < 1 else 0.0) for u in roots]
    airfoil = upper[::-1] + [(x, -y) for x, y in upper[1:-1]]
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    far = []
    for (ax, ay), (bx, by) in zip(corners, corners[1:] + corners[:1]):
        far += [(ax + (bx - ax) * k / per_side, ay + (by - ay) * k / per_side) for k in range(per_side)]
    polygon_domain([("far", far, 0.0), ("airfoil", airfoil, 0.0)], size=size_from_sides([(far, 1.0), (airfoil, 1.0)], 0.352),
                   layer={"group": "airfoil", "options": {"Size": 0.003, "Ratio": 1.3, "Thickness": 0.04}})
    finish("naca_p2", 2, [{"group": "airfoil", "type": "snap_to", "shape": "naca0012", "leading_edge": [0, 0, 0],
                           "chord": 1.0}], compress=True)


def named_surfaces(group_of):
    """Names the surfaces by group_of(kind of surface, bounding box), the volume "domain"."""
    groups = {}
    for dim, tag in gmsh.model.getEntities(2):
        box = gmsh.model.getBoundingBox(dim, tag)
        groups.setdefault(group_of(gmsh.model.getType(dim, tag), box), []).append(tag)
    for k, (group, tags) in enumerate(groups.items()):
        gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, tags, k + 1), group)
    volumes = [tag for dim, tag in gmsh.model.getEntities(3)]
    gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, volumes, 1), "domain")


def spheres_in_cube(name, order, spheres, radius, near, far, grow):
    """Tetrahedra between the cube [-1, 1]^3 and spheres that move. spheres: (group, centre, vector in radii)."""
    begin(name, 6)
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(-1, -1, -1, 2, 2, 2))], [(3, occ.addSphere(*center, radius)) for _, center, _ in spheres])
    occ.synchronize()

    def group_of(kind, box):
        if kind != "Sphere":
            return "cube"
        middle = [(box[k] + box[k + 3]) / 2 for k in range(3)]
        return min(spheres, key=lambda sphere: math.dist(sphere[1], middle))[0]

    named_surfaces(group_of)
    gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 0)
    gmsh.model.mesh.setSizeCallback(lambda dim, tag, x, y, z: min(far, near + grow * max(
        0.0, min(math.dist(center, (x, y, z)) for _, center, _ in spheres) - radius)))
    gmsh.model.mesh.generate(3)
    operations = []
    for group, center, vector in spheres:
        operations += [snap(group, "sphere", list(center), radius),
                       {"group": group, "type": "translate", "vector": [radius * v for v in vector]}]
    finish(name, order, operations, compress=True)


def moving_sphere(name, near, far, grow):
    """Cubic tetrahedra; the sphere moves by 30 % of its radius."""
    spheres_in_cube(name, 3, [("sphere", (0, 0, 0), (0.3, 0, 0))], 0.35, near, far, grow)


def moving_spheres():
    """Some 50,000 quadratic tetrahedra; four spheres, each moved at random by up to 40 % of its radius in x, y and z."""
    chance = random.Random(1)
    centers = [(0.45, 0.45, 0.0), (-0.45, 0.45, 0.0), (-0.45, -0.45, 0.0), (0.45, -0.45, 0.0)]
    spheres = [("sphere%d" % (k + 1), center, [round(chance.uniform(-0.4, 0.4), 6) for _ in range(3)])
               for k, center in enumerate(centers)]
    spheres_in_cube("moving_spheres", 2, spheres, 0.25, 0.0535, 0.12, 0.12)


def shell1():
    """Some 8,700 cubic tetrahedra in a hollow cylinder, which becomes wider, thicker and shorter."""
    begin("shell1", 6)
    inner, outer, length, size = 0.7, 1.0, 3.0, 0.148
    occ = gmsh.model.occ
    occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, length, outer))], [(3, occ.addCylinder(0, 0, 0, 0, 0, length, inner))])
    occ.synchronize()

    def group_of(kind, box):
        if kind == "Cylinder":
            return "outer" if box[3] - box[0] > inner + outer else "inner"
        return "bottom" if box[5] < length / 2 else "top"

    named_surfaces(group_of)
    for option in ("Mesh.MeshSizeMin", "Mesh.MeshSizeMax"):
        gmsh.option.setNumber(option, size)
    gmsh.model.mesh.generate(3)
    new_inner, new_outer, new_length = 1.15, 1.8, 1.5
    stretch = (new_outer - new_inner) / (outer - inner)
    factor = "(%.15g/sqrt(x*x+y*y) + %.15g)" % (new_inner - stretch * inner, stretch)
    operations = [{**snap(group, "cylinder", [0, 0, 0], radius), "axis": "z"}
                  for group, radius in (("inner", inner), ("outer", outer))]
    operations.append({"group": "all_boundary", "type": "expression", "x": "x*" + factor, "y": "y*" + factor,
                       "z": "%.15g*z" % (new_length / length)})
    finish("shell1", 3, operations, compress=True)


def family(name, group, level):
    """A mesh of the scaling families, order 3, whose boundary is curved."""
    begin(name, 6)
    gmsh.onelab.set(json.dumps([{"type": "number", "name": "level", "values": [level]}]))
    gmsh.merge(os.path.join(HERE, "families", group + ".geo"))
    gmsh.model.mesh.generate(2 if group == "circle" else 3)
    finish(name, 3, [snap(group, group, [0, 0, 0], 1.0)], compress=True)


SAMPLES = {
    "annulus": annulus,
    "naca_p2": naca_p2,
    "moving_circle": moving_circle,
    "moving_circles1": lambda: moving_circles("moving_circles1", lambda sx, sy: (-0.375 * sx, -0.375 * sy)),
    "moving_circles2": moving_circles2,
    "moving_sphere": lambda: moving_sphere("moving_sphere", 0.0755, 0.155, 0.1),
    "moving_sphere_small": lambda: moving_sphere("moving_sphere_small", 0.147, 0.315, 0.2),
    "shell1": shell1,
}

# Too large to be kept: made on demand.
LARGE = {
    "moving_spheres": moving_spheres,
    "circle_family": lambda: family("circle_family", "circle", 6),
    "sphere_family": lambda: family("sphere_family", "sphere", 5),
}

if __name__ == "__main__":
    for name in sys.argv[1:] or SAMPLES:
        make = {**SAMPLES, **LARGE}.get(name)
        if not make:
            sys.exit(f"There is no sample '{name}'; there are {', '.join({**SAMPLES, **LARGE})}.")
        make()
        print(name)
