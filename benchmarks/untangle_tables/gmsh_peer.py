#!/usr/bin/python3
"""Runs an optimizer of Gmsh on a curved mesh:   gmsh_peer.py IN.msh METHOD OUT.txt

Prints the seconds that the optimizer took and writes "tag x y z" of every node.
METHOD  opt           optimize("HighOrder"), threshold 0.1
        opt0.5        the same with Mesh.HighOrderThresholdMin = 0.5
        elastic       optimize("HighOrderElastic")
        elastic+opt   both
        fastcurving   optimize("HighOrderFastCurving")
        METHOD@S      with all coordinates times S: the optimizers depend on the unit of length
        METHOD*       the file as it is: boundary nodes may slide along their discrete curves and surfaces
Gmsh 4.8 has no option that fixes the boundary. So, without *, the mesh is put into a discrete model whose boundary nodes
are all classified on a point, which no optimizer moves.
"""
import sys
import time

import gmsh
import numpy as np

source, method, target = sys.argv[1:4]
gmsh.initialize(["gmsh", "-nopopup"])
for option, value in (("General.Terminal", 0), ("General.NumThreads", 1), ("General.AbortOnError", 0)):
    gmsh.option.setNumber(option, value)
gmsh.open(source)
mesh = gmsh.model.mesh
dimension = gmsh.model.getDimension()
is_pinned = not method.endswith("*")
name, _, factor = method.rstrip("*").partition("@")
factor = float(factor or 1)


def nodes():
    tags, xyz, _ = mesh.getNodes()
    return np.asarray(tags, dtype=np.int64), np.asarray(xyz).reshape(-1, 3)


if is_pinned:
    tags, xyz = nodes()
    cells = [(d, kind, np.asarray(of_kind, dtype=np.int64)) for d in (dimension - 1, dimension)
             for kinds, _, all_nodes in [mesh.getElements(d)] for kind, of_kind in zip(kinds, all_nodes)]
    on_boundary = np.isin(tags, np.concatenate([c for d, _, c in cells if d < dimension]))
    # optimize() renumbers nodes entity by entity: use that order at once.
    old = np.concatenate([tags[on_boundary], tags[~on_boundary]])
    new = np.zeros(old.max() + 1, dtype=np.int64)
    new[old] = np.arange(1, len(old) + 1)
    gmsh.model.add("pinned")
    gmsh.model.addDiscreteEntity(0, 1)
    gmsh.model.addDiscreteEntity(dimension - 1, 1, [1] if dimension == 2 else [])
    gmsh.model.addDiscreteEntity(dimension, 1, [1])
    mesh = gmsh.model.mesh
    mesh.addNodes(0, 1, new[tags[on_boundary]].tolist(), (factor * xyz[on_boundary]).ravel().tolist())
    mesh.addNodes(dimension, 1, new[tags[~on_boundary]].tolist(), (factor * xyz[~on_boundary]).ravel().tolist())
    for d, kind, of_kind in cells:
        mesh.addElements(d, 1, [kind], [[]], [new[of_kind].tolist()])
if name == "opt0.5":
    gmsh.option.setNumber("Mesh.HighOrderThresholdMin", 0.5)
steps = {"opt": ["HighOrder"], "opt0.5": ["HighOrder"], "elastic": ["HighOrderElastic"],
         "elastic+opt": ["HighOrderElastic", "HighOrder"], "fastcurving": ["HighOrderFastCurving"]}[name]
start = time.perf_counter()
for step in steps:
    mesh.optimize(step)
seconds = time.perf_counter() - start
tags, xyz = nodes()
if is_pinned:
    tags, xyz = old[tags - 1], xyz / factor
with open(target, "w") as file:
    for tag, (x, y, z) in zip(tags, xyz):
        file.write("%d %.17g %.17g %.17g\n" % (tag, x, y, z))
print(seconds)
gmsh.finalize()
