// Family "circle": unit disc, uniform triangles. Levels 0-8 after table 2.1 of the thesis, level 9 has a million interior
// nodes at order 3.
//   gmsh -2 circle.geo -setnumber level 3 -o circle_3.msh
// Straight-sided, order 1; group "circle" is the boundary (centre (0,0,0), radius 1).
DefineConstant[ level = {0, Name "level"} ];
nb[] = {45, 64, 89, 135, 194, 262, 371, 523, 739, 1024};                             // boundary edges
factors[] = {0.946, 0.9625, 0.928, 0.9586, 0.944, 0.924, 0.9506, 0.932, 0.928, 0.928};  // size inside / boundary edge
n = nb[level];
h = 2*Pi/n;
Point(1) = {0, 0, 0};
Point(2) = {1, 0, 0, h}; Point(3) = {-1, 0, 0, h};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2};
Transfinite Curve{1} = Ceil(n/2) + 1; Transfinite Curve{2} = Floor(n/2) + 1;
Curve Loop(1) = {1, 2}; Plane Surface(1) = {1};
Physical Curve("circle") = {1, 2}; Physical Surface("domain") = {1};
Mesh.Algorithm = 6; Mesh.MeshSizeMin = h*factors[level]; Mesh.MeshSizeMax = h*factors[level];
Mesh.MshFileVersion = 4.1;
