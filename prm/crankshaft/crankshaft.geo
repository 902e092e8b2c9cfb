// Half (x > 0) of the crankshaft of a single-cylinder engine: the axis is the x
// axis, the throw points along z. The option "Mirror = x" of the model adds the
// other half. Units: m.
SetFactory("OpenCASCADE");

radius         = 0.04;  // of the crank: half of the stroke
pin_radius     = 0.02;
pin_end        = 0.016; // half of the length of the crank pin
web_end        = 0.034; // the web is 18 mm thick
web_radius     = 0.028; // around the crank pin, and half of the width
weight_radius  = 0.07;  // of the counterweight
journal_radius = 0.022;
journal_end    = 0.062;
end_radius     = 0.018; // shaft outside of the main bearing
end            = 0.092;

Cylinder(1) = {0, 0, radius, pin_end, 0, 0, pin_radius};

// the web: around the crank pin, around the axis, and the counterweight
thickness = web_end - pin_end;
Cylinder(2) = {pin_end, 0, radius, thickness, 0, 0, web_radius};
Box(3) = {pin_end, -web_radius, 0, thickness, 2 * web_radius, radius};
Cylinder(4) = {pin_end, 0, 0, thickness, 0, 0, weight_radius};
Box(5) = {pin_end, -weight_radius, -weight_radius, thickness, 2 * weight_radius, weight_radius};
BooleanIntersection(6) = { Volume{4}; Delete; }{ Volume{5}; Delete; };
BooleanUnion(7) = { Volume{2}; Delete; }{ Volume{3, 6}; Delete; };

Cylinder(8) = {web_end, 0, 0, journal_end - web_end, 0, 0, journal_radius};
Cylinder(9) = {journal_end, 0, 0, end - journal_end, 0, 0, end_radius};
parts() = BooleanFragments{ Volume{1}; Delete; }{ Volume{7, 8, 9}; Delete; };

e = 1e-5;
pin() = Surface In BoundingBox {-e, -pin_radius - e, radius - pin_radius - e,
                                pin_end + e, pin_radius + e, radius + pin_radius + e};
pin_faces() = Surface In BoundingBox {pin_end - e, -1, -1, pin_end + e, 1, 1};
middle() = Surface In BoundingBox {-e, -1, -1, e, 1, 1};
pin() -= pin_faces();
pin() -= middle();
journal() = Surface In BoundingBox {web_end - e, -journal_radius - e, -journal_radius - e,
                                    journal_end + e, journal_radius + e, journal_radius + e};
journal_faces() = Surface In BoundingBox {web_end - e, -1, -1, web_end + e, 1, 1};
journal_faces() += Surface In BoundingBox {journal_end - e, -1, -1, journal_end + e, 1, 1};
journal() -= journal_faces();
end_face() = Surface In BoundingBox {end - e, -1, -1, end + e, 1, 1};

Physical Volume("crankshaft") = {parts()};
Physical Surface("pin") = {pin()};
Physical Surface("journal") = {journal()};
Physical Surface("end") = {end_face()};

// twelve edges around a circle, smaller ones where the pin and the journal meet the web
Mesh.MeshSizeFromCurvature = 12;
