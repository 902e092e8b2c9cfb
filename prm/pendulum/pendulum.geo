// Half (x > 0) of the pendulum of Gerstmayr and Schoeberl: a beam of length 1 m
// along y, height 50 mm along z and width 2.5 mm along x, and a thin cylinder
// (radius 2 mm, length 10 mm, axis x) at the end of the beam's axis as its hinge.
// Units: m. The option "Mirror = x" of the model adds the other half.
SetFactory("OpenCASCADE");

length = 1;
height = 0.05;
width  = 0.0025;
pin_radius = 0.002;
pin_length = 0.01;

Box(1) = {0, 0, -height / 2, width / 2, length, height};
Cylinder(2) = {0, 0, 0, pin_length / 2, 0, 0, pin_radius};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

e = 1e-5;
pin() = Surface In BoundingBox {pin_length / 2 - e, -pin_radius - e, -pin_radius - e,
                                pin_length / 2 + e,  pin_radius + e,  pin_radius + e};
tip() = Surface In BoundingBox {-e, length - e, -height / 2 - e,
                                width / 2 + e, length + e, height / 2 + e};
Physical Volume("beam") = {3};
Physical Surface("pin") = pin();
Physical Surface("tip") = tip();

// The pin needs small elements, the beam does not.
Field[1] = Distance;
Field[1].SurfacesList = {pin()};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = 0.0015;
Field[2].SizeMax = 0.05;
Field[2].DistMin = 0.005;
Field[2].DistMax = 0.1;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
