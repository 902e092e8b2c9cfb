// A door: width 0.8 m along x, thickness 40 mm along y, height 2 m along z. Three
// strips of 0.1 m of its narrow face x = 0 carry hinges, a strip of the opposite
// face the handle. Units: m.
SetFactory("OpenCASCADE");

width     = 0.8;
thickness = 0.04;

// the door in pieces, one above the other: their faces are the strips
z() = {0, 0.15, 0.25, 0.95, 1.05, 1.75, 1.85, 2};
For k In {0 : 6}
  Box(k + 1) = {0, -thickness / 2, z(k), width, thickness, z(k + 1) - z(k)};
EndFor
BooleanFragments{ Volume{1}; Delete; }{ Volume{2 : 7}; Delete; }

e = 1e-5;
lower() = Surface In BoundingBox {-e, -1, z(1) - e, e, 1, z(2) + e};
middle() = Surface In BoundingBox {-e, -1, z(3) - e, e, 1, z(4) + e};
upper() = Surface In BoundingBox {-e, -1, z(5) - e, e, 1, z(6) + e};
handle() = Surface In BoundingBox {width - e, -1, z(3) - e, width + e, 1, z(4) + e};
Physical Volume("door") = {1 : 7};
Physical Surface("lower hinge") = lower();
Physical Surface("middle hinge") = middle();
Physical Surface("upper hinge") = upper();
Physical Surface("handle") = handle();
