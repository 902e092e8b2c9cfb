// Half (x > 0) of the piston with its pin, whose centre is the origin; z is the
// axis of the cylinder. The option "Mirror = x" of the model adds the other
// half. Units: m.
SetFactory("OpenCASCADE");

radius     = 0.043;
bottom     = -0.025;
top        = 0.035;
crown      = 0.01;   // thickness
skirt      = 0.006;  // thickness
pin_radius = 0.011;
pin_free   = 0.015;  // half of the length that the small end of the rod covers
boss       = 0.018;  // radius of the boss around the pin
boss_start = 0.018;

// the part x > 0 of the cup
Cylinder(1) = {0, 0, bottom, 0, 0, top - bottom, radius};
Cylinder(2) = {0, 0, bottom, 0, 0, top - bottom - crown, radius - skirt};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Cylinder(4) = {boss_start, 0, 0, radius - boss_start - skirt / 2, 0, 0, boss};
Cylinder(5) = {pin_free, 0, 0, radius - pin_free - skirt / 2, 0, 0, pin_radius};
BooleanUnion(6) = { Volume{3}; Delete; }{ Volume{4, 5}; Delete; };
Box(7) = {0, -radius, bottom, radius, 2 * radius, top - bottom};
BooleanIntersection(8) = { Volume{6}; Delete; }{ Volume{7}; Delete; };
Cylinder(9) = {0, 0, 0, pin_free, 0, 0, pin_radius};
parts() = BooleanFragments{ Volume{8}; Delete; }{ Volume{9}; Delete; };

e = 1e-5;
pin() = Surface In BoundingBox {-e, -pin_radius - e, -pin_radius - e,
                                pin_free + e, pin_radius + e, pin_radius + e};
pin_ends() = Surface In BoundingBox {-e, -1, -1, e, 1, 1};
pin_ends() += Surface In BoundingBox {pin_free - e, -1, -1, pin_free + e, 1, 1};
pin() -= pin_ends();
crown_face() = Surface In BoundingBox {-e, -1, top - e, 1, 1, top + e};
// the outside of the skirt: what reaches from the bottom to the top
outside() = {};
faces() = Boundary{ Volume{parts()}; };
For k In {0 : #faces() - 1}
  box() = BoundingBox Surface{ faces(k) };
  If (box(3) > radius - e && box(5) - box(2) > top - bottom - e)
    outside() += faces(k);
  EndIf
EndFor

Physical Volume("piston") = {parts()};
Physical Surface("pin") = {pin()};
Physical Surface("crown") = {crown_face()};
Physical Surface("skirt") = {outside()};

Mesh.MeshSizeFromCurvature = 12;
