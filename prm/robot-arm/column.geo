// Column of a robot arm: it stands on z = -0.45, the shoulder axis is the y
// axis, a pin between the ears of a fork. Units: m.
SetFactory("OpenCASCADE");

bottom      = -0.45;
radius      = 0.09;
top         = -0.08; // of the column; the fork stands on it
gap         = 0.035; // half of the distance of the ears, along y
ear         = 0.025; // thickness
ear_x       = 0.05;  // half of the width
pin_radius  = 0.025;

Cylinder(1) = {0, 0, bottom, 0, 0, top - bottom, radius};
Box(2) = {-ear_x, gap, top - 0.02, 2 * ear_x, ear, -top + 0.02};
Box(3) = {-ear_x, -gap - ear, top - 0.02, 2 * ear_x, ear, -top + 0.02};
Cylinder(4) = {0, gap, 0, 0, ear, 0, ear_x};
Cylinder(5) = {0, -gap, 0, 0, -ear, 0, ear_x};
BooleanUnion(6) = { Volume{1}; Delete; }{ Volume{2 : 5}; Delete; };
Cylinder(7) = {0, -gap, 0, 0, 2 * gap, 0, pin_radius};
parts() = BooleanFragments{ Volume{6}; Delete; }{ Volume{7}; Delete; };

e = 1e-5;
foot() = Surface In BoundingBox {-1, -1, bottom - e, 1, 1, bottom + e};
pin() = Surface In BoundingBox {-pin_radius - e, -gap - e, -pin_radius - e,
                                pin_radius + e, gap + e, pin_radius + e};
pin() -= Surface In BoundingBox {-1, -gap - e, -1, 1, -gap + e, 1};
pin() -= Surface In BoundingBox {-1, gap - e, -1, 1, gap + e, 1};
Physical Volume("column") = {parts()};
Physical Surface("foot") = {foot()};
Physical Surface("pin") = {pin()};

Mesh.MeshSizeFromCurvature = 12;
