#!/usr/bin/python3
"""Makes coarse, tangled tetrahedral meshes of CAD shapes (needs Gmsh's Python module: package python3-gmsh).

    generate.py FOLDER [NAME ...]        all shapes, or those named

Every shape is meshed coarsely, raised to orders 2, 3 and 4 with its nodes on the true surface, and not optimised
(Mesh.HighOrderOptimize = 0). Writes FOLDER/NAME_pP.msh (MSH 4.1 ASCII); faces of the shape are the groups face1, face2, ...
"""
import os
import sys

import gmsh


def torus():
    gmsh.model.occ.addTorus(0, 0, 0, 1, 0.4)
    return 0.6


def fine_torus():
    gmsh.model.occ.addTorus(0, 0, 0, 1, 0.4)
    return 0.4


def drilled_block():
    occ = gmsh.model.occ
    block = occ.addBox(-1, -1, 0, 2, 2, 1)
    drills = [(3, occ.addCylinder(x, y, -0.5, 0, 0, 2, 0.3)) for x, y in ((0.45, 0.45), (-0.45, -0.45))]
    occ.cut([(3, block)], drills)
    return 0.8


def filleted_box():
    occ = gmsh.model.occ
    box = occ.addBox(0, 0, 0, 2, 1.5, 1)
    occ.synchronize()
    edges = [tag for _, tag in gmsh.model.getBoundary([(2, t) for _, t in gmsh.model.getBoundary([(3, box)])],
                                                      combined=False, oriented=False)]
    occ.fillet([box], sorted(set(edges)), [0.3])
    return 0.6


def block_with_cavity():
    occ = gmsh.model.occ
    occ.cut([(3, occ.addBox(-1, -1, -1, 2, 2, 2))], [(3, occ.addSphere(0.2, 0.1, 0, 0.65))])
    return 0.9


def crossing_pipes():
    occ = gmsh.model.occ
    occ.fuse([(3, occ.addCylinder(-1.5, 0, 0, 3, 0, 0, 0.5))], [(3, occ.addCylinder(0, -1.5, 0, 0, 3, 0, 0.4))])
    return 0.7


def cone():
    gmsh.model.occ.addCone(0, 0, 0, 0, 0, 2, 1, 0.25)
    return 0.8


SHAPES = {shape.__name__: shape
          for shape in (torus, fine_torus, drilled_block, filleted_box, block_with_cavity, crossing_pipes, cone)}


def main(folder, names):
    os.makedirs(folder, exist_ok=True)
    for name in names or SHAPES:
        for order in (2, 3, 4):
            gmsh.initialize(["gmsh", "-nopopup"])
            for option, value in (("General.Terminal", 0), ("General.NumThreads", 1), ("Mesh.RandomSeed", 1),
                                  ("Mesh.MshFileVersion", 4.1), ("Mesh.HighOrderOptimize", 0)):
                gmsh.option.setNumber(option, value)
            gmsh.model.add(name)
            size = SHAPES[name]()
            gmsh.model.occ.synchronize()
            gmsh.option.setNumber("Mesh.MeshSizeMin", size)
            gmsh.option.setNumber("Mesh.MeshSizeMax", size)
            for _, face in gmsh.model.getEntities(2):
                gmsh.model.setPhysicalName(2, gmsh.model.addPhysicalGroup(2, [face]), "face%d" % face)
            volumes = [tag for _, tag in gmsh.model.getEntities(3)]
            gmsh.model.setPhysicalName(3, gmsh.model.addPhysicalGroup(3, volumes), "domain")
            gmsh.model.mesh.generate(3)
            gmsh.model.mesh.setOrder(order)
            gmsh.write(os.path.join(folder, "%s_p%d.msh" % (name, order)))
            gmsh.finalize()


if __name__ == "__main__":
    if len(sys.argv) < 2 or any(name not in SHAPES for name in sys.argv[2:]):
        sys.exit("usage: generate.py FOLDER [NAME ...], names: " + ", ".join(SHAPES))
    main(sys.argv[1], sys.argv[2:])
