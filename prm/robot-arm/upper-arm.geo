// Upper arm of a robot: a box section along x between the bore of the shoulder
// around the y axis and the elbow, a pin that sticks out along y. Units: m.
SetFactory("OpenCASCADE");

length     = 0.6;
half_y     = 0.03;   // of the section and the hubs
half_z     = 0.035;
wall       = 0.004;
bore       = 0.025;
hub        = 0.045;
pin_radius = 0.02;
pin_start  = half_y;
pin_end    = 0.095;
pin_bore   = 0.035;  // where the bore of the forearm begins

Cylinder(1) = {0, -half_y, 0, 0, 2 * half_y, 0, hub};
Cylinder(2) = {length, -half_y, 0, 0, 2 * half_y, 0, hub};
Box(3) = {0, -half_y, -half_z, length, 2 * half_y, 2 * half_z};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
// hollow between the hubs
Box(5) = {hub, -half_y + wall, -half_z + wall, length - 2 * hub, 2 * (half_y - wall), 2 * (half_z - wall)};
Cylinder(6) = {0, -half_y, 0, 0, 2 * half_y, 0, bore};
BooleanDifference(7) = { Volume{4}; Delete; }{ Volume{5, 6}; Delete; };
Cylinder(8) = {length, pin_start, 0, 0, pin_bore - pin_start, 0, pin_radius};
Cylinder(9) = {length, pin_bore, 0, 0, pin_end - pin_bore, 0, pin_radius};
parts() = BooleanFragments{ Volume{7}; Delete; }{ Volume{8, 9}; Delete; };

e = 1e-5;
bore() = Surface In BoundingBox {-bore - e, -half_y - e, -bore - e, bore + e, half_y + e, bore + e};
pin() = Surface In BoundingBox {length - pin_radius - e, pin_bore - e, -pin_radius - e,
                                length + pin_radius + e, pin_end + e, pin_radius + e};
pin() -= Surface In BoundingBox {-1, pin_bore - e, -1, 1, pin_bore + e, 1};
pin() -= Surface In BoundingBox {-1, pin_end - e, -1, 1, pin_end + e, 1};
Physical Volume("upper arm") = {parts()};
Physical Surface("shoulder") = {bore()};
Physical Surface("elbow") = {pin()};

Mesh.MeshSizeFromCurvature = 12;
