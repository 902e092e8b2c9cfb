// The pendulum of prm/pendulum/pendulum.geo in one piece: a mesh of it has no
// plane of symmetry. Units: m.
SetFactory("OpenCASCADE");

length = 1;
height = 0.05;
width  = 0.0025;
pin_radius = 0.002;
pin_length = 0.01;

Box(1) = {-width / 2, 0, -height / 2, width, length, height};
Cylinder(2) = {-pin_length / 2, 0, 0, pin_length, 0, 0, pin_radius};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };

e = 1e-5;
r = pin_radius + e;
right() = Surface In BoundingBox {pin_length / 2 - e, -r, -r, pin_length / 2 + e, r, r};
left()  = Surface In BoundingBox {-pin_length / 2 - e, -r, -r, -pin_length / 2 + e, r, r};
tip()   = Surface In BoundingBox {-width, length - e, -height, width, length + e, height};
Physical Volume("beam") = {3};
Physical Surface("right") = right();
Physical Surface("left") = left();
Physical Surface("tip") = tip();

// The pin needs small elements, the beam does not.
Field[1] = Distance;
Field[1].SurfacesList = {right(), left()};
Field[2] = Threshold;
Field[2].InField = 1;
Field[2].SizeMin = 0.0015;
Field[2].SizeMax = 0.05;
Field[2].DistMin = 0.005;
Field[2].DistMax = 0.1;
Background Field = 2;
Mesh.MeshSizeExtendFromBoundary = 0;
