// Family "sphere": unit ball, uniform tetrahedra, levels 0-7 after table 2.2 of the thesis.
//   gmsh -3 sphere.geo -setnumber level 3 -o sphere_3.msh
// Straight-sided, order 1; group "sphere" is the boundary (centre (0,0,0), radius 1).
SetFactory("OpenCASCADE");
DefineConstant[ level = {0, Name "level"} ];
sizes[] = {0.355, 0.2785, 0.2113, 0.1696, 0.1291, 0.1016, 0.0806, 0.0634};  // fitted to the counts of table 2.2
h = sizes[level];
Sphere(1) = {0, 0, 0, 1};
boundary() = Boundary{ Volume{1}; };
Physical Surface("sphere") = {boundary()}; Physical Volume("domain") = {1};
Mesh.Algorithm = 6; Mesh.MeshSizeMin = h; Mesh.MeshSizeMax = h;
Mesh.MshFileVersion = 4.1;
