// Family "hole": the square [-0.5, 0.5]^2 with a circular hole of radius 0.2 about the origin, uniform triangles; what
// curvewright-drag-frames drags. Level 0 has some 18,800 triangles, level 1 some 111,000.
//   gmsh -2 hole.geo -setnumber level 0 -o hole_0.msh
// Straight-sided, order 1; groups "outer" and "hole".
DefineConstant[ level = {0, Name "level"} ];
sizes[] = {0.0105, 0.0043};
h = sizes[level];
Point(1) = {-0.5, -0.5, 0, h}; Point(2) = {0.5, -0.5, 0, h}; Point(3) = {0.5, 0.5, 0, h}; Point(4) = {-0.5, 0.5, 0, h};
Point(5) = {0, 0, 0, h}; Point(6) = {0.2, 0, 0, h}; Point(7) = {0, 0.2, 0, h}; Point(8) = {-0.2, 0, 0, h};
Point(9) = {0, -0.2, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Circle(5) = {6, 5, 7}; Circle(6) = {7, 5, 8}; Circle(7) = {8, 5, 9}; Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4}; Curve Loop(2) = {5, 6, 7, 8}; Plane Surface(1) = {1, 2};
Physical Curve("outer") = {1, 2, 3, 4}; Physical Curve("hole") = {5, 6, 7, 8}; Physical Surface("domain") = {1};
Mesh.MshFileVersion = 4.1;
