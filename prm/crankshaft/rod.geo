// Half (x > 0) of the connecting rod: the big end around the origin, the small
// end above it on the z axis. The option "Mirror = x" of the model adds the
// other half. Units: m.
SetFactory("OpenCASCADE");

length     = 0.14;
big_bore   = 0.02;  // radii
big_eye    = 0.031;
small_bore = 0.011;
small_eye  = 0.018;
half_width = 0.015; // of the eyes, along x
shank_x    = 0.008; // half of the section of the shank
shank_y    = 0.012;

Cylinder(1) = {0, 0, 0, half_width, 0, 0, big_eye};
Cylinder(2) = {0, 0, length, half_width, 0, 0, small_eye};
Box(3) = {0, -shank_y, 0, shank_x, 2 * shank_y, length};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
Cylinder(5) = {0, 0, 0, half_width, 0, 0, big_bore};
Cylinder(6) = {0, 0, length, half_width, 0, 0, small_bore};
rod() = BooleanDifference{ Volume{4}; Delete; }{ Volume{5, 6}; Delete; };

e = 1e-5;
big() = Surface In BoundingBox {-e, -big_bore - e, -big_bore - e, half_width + e, big_bore + e, big_bore + e};
small() = Surface In BoundingBox {-e, -small_bore - e, length - small_bore - e,
                                  half_width + e, small_bore + e, length + small_bore + e};
Physical Volume("rod") = {rod()};
Physical Surface("big end") = {big()};
Physical Surface("small end") = {small()};

Mesh.MeshSizeFromCurvature = 12;
