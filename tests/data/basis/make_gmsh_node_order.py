"""Writes gmsh_node_order.txt: the node order of every full Lagrange element of Gmsh, asked of Gmsh itself.

One line per element: shape, order, then one word "ijk" per node (in Gmsh's order): its lattice coordinates 0..order as
hexadecimal digits, on the reference element whose corners are 0 and the unit vectors (times the order).
Needs Gmsh's Python module (python3-gmsh). Gmsh 4.8 cannot be asked for prisms above order 2: those come from a mesh of one
prism, raised to the order.

    python3 make_gmsh_node_order.py > gmsh_node_order.txt
"""
import gmsh

SHAPES = {  # our name: (Gmsh's name, highest order that Gmsh has, coordinates in [-1, 1] per axis)
    "line": ("line", 10, (True,)),
    "triangle": ("triangle", 10, (False, False)),
    "quadrilateral": ("quadrangle", 10, (True, True)),
    "tetrahedron": ("tetrahedron", 10, (False, False, False)),
    "hexahedron": ("hexahedron", 9, (True, True, True)),
    "pyramid": ("pyramid", 9, None),
}


def lattice(shape, order, local):
    _, _, symmetric = SHAPES[shape]
    if shape == "pyramid":  # base [-1, 1]^2 shrinking towards the apex (0, 0, 1)
        x, y, z = local
        local, symmetric = ((x + 1 - z) / 2, (y + 1 - z) / 2, z), (False,) * 3
    values = [(c + 1) / 2 if both else c for c, both in zip(local, symmetric)]
    scaled = [order * value for value in values] + [0] * (3 - len(values))
    assert all(abs(value - round(value)) < 1e-6 for value in scaled), (shape, order, local)
    return [round(value) for value in scaled]


def prism(order):
    """Nodes of one prism, mapped to the lattice through its six corners."""
    gmsh.clear()
    geo = gmsh.model.geo
    points = [geo.addPoint(*xy, 0) for xy in ((0, 0), (1, 0), (0, 1))]
    lines = [geo.addLine(points[i], points[(i + 1) % 3]) for i in range(3)]
    for line in lines:
        geo.mesh.setTransfiniteCurve(line, 2)
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    geo.extrude([(2, surface)], 0, 0, 1, [1], recombine=True)
    geo.synchronize()
    gmsh.model.mesh.generate(3)
    gmsh.model.mesh.setOrder(order)
    types, tags, nodes = gmsh.model.mesh.getElements(3)
    assert len(tags) == 1 and len(tags[0]) == 1, "one prism expected"
    x = [gmsh.model.mesh.getNode(node)[0] for node in nodes[0]]
    edges = [[x[corner][d] - x[0][d] for d in range(3)] for corner in (1, 2, 3)]  # axis-parallel or diagonal
    (a, b, c), (d, e, f), (g, h, i) = edges
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    assert det > 0
    result = []
    for point in x:
        p, q, r = (point[k] - x[0][k] for k in range(3))
        values = ((p * (e * i - f * h) - q * (d * i - f * g) + r * (d * h - e * g)) / det,
                  (a * (q * i - r * h) - b * (p * i - r * g) + c * (p * h - q * g)) / det,
                  (a * (e * r - f * q) - b * (d * r - f * p) + c * (d * q - e * p)) / det)
        assert all(abs(order * value - round(order * value)) < 1e-6 for value in values), values
        result.append([round(order * value) for value in values])
    return result


gmsh.initialize()
gmsh.option.setNumber("General.Terminal", 0)
for shape, (gmsh_name, highest, _) in SHAPES.items():
    for order in range(1, highest + 1):
        name, dim, _, count, local, _ = gmsh.model.mesh.getElementProperties(
            gmsh.model.mesh.getElementType(gmsh_name, order))
        nodes = [lattice(shape, order, local[i * dim:(i + 1) * dim]) for i in range(count)]
        print(shape, order, *("%x%x%x" % tuple(node) for node in nodes))
for order in range(1, 10):
    print("prism", order, *("%x%x%x" % tuple(node) for node in prism(order)))
gmsh.finalize()
