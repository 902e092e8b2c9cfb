// Forearm of a robot: a box section along x from the bore of the elbow around
// the y axis to the flange for the tool. Units: m.
SetFactory("OpenCASCADE");

length = 0.5;    // from the elbow to the face of the flange
half_y = 0.025;  // of the section
half_z = 0.025;
wall   = 0.003;
bore   = 0.02;
hub    = 0.036;
hub_y  = 0.03;   // half of the length of the bore
flange = 0.012;  // thickness

Cylinder(1) = {0, -hub_y, 0, 0, 2 * hub_y, 0, hub};
Box(2) = {0, -half_y, -half_z, length, 2 * half_y, 2 * half_z};
Cylinder(3) = {length - flange, 0, 0, flange, 0, 0, 0.04};
BooleanUnion(4) = { Volume{1}; Delete; }{ Volume{2, 3}; Delete; };
Box(5) = {hub, -half_y + wall, -half_z + wall, length - flange - hub, 2 * (half_y - wall), 2 * (half_z - wall)};
Cylinder(6) = {0, -hub_y, 0, 0, 2 * hub_y, 0, bore};
forearm() = BooleanDifference{ Volume{4}; Delete; }{ Volume{5, 6}; Delete; };

e = 1e-5;
bore() = Surface In BoundingBox {-bore - e, -hub_y - e, -bore - e, bore + e, hub_y + e, bore + e};
flange() = Surface In BoundingBox {length - e, -1, -1, length + e, 1, 1};
Physical Volume("forearm") = {forearm()};
Physical Surface("elbow") = {bore()};
Physical Surface("flange") = {flange()};

Mesh.MeshSizeFromCurvature = 12;
