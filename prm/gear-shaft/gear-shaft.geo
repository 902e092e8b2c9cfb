// Half of a hollow gear shaft with its wheel, a body of revolution about the x
// axis: the part y > 0; the option "Mirror = y" of the model adds the other
// half. All cells are hexahedra, and the sectors are equal, so that the centre
// of every seat is on the axis. Units: m.
SetFactory("OpenCASCADE");

sectors = 6; // of the half; 12 for finer results

// Circles become polygons with these corners; larger by this factor they have
// the area of the circles.
angle  = Pi / sectors;
factor = Sqrt(angle / Sin(angle));

// Corners of the section along the axis and in the radial direction, and the
// elements between them. Bearing seats from 0 to 30 mm and from 250 to 280 mm,
// wheel from 110 to 150 mm, coupling from 280 to 320 mm.
x() = {0, 0.03, 0.11, 0.123, 0.137, 0.15, 0.25, 0.28, 0.32};
elements_x() = {2, 4, 1, 1, 1, 4, 2, 2};
// bore, seats and coupling, shaft, hub, web, teeth
r() = {0.008, 0.02, 0.025, 0.035, 0.08, 0.1};
elements_r() = {1, 1, 1, 2, 1};
// Which of the rings from r(k) to r(k + 1) there are between x(j) and x(j + 1).
from_bore() = {1, 2, 3, 3, 3, 2, 1, 1};
has_web()   = {0, 0, 0, 1, 0, 0, 0, 0};
has_rim()   = {0, 0, 1, 1, 1, 0, 0, 0};

section() = {};
For j In {0 : 7}
  For k In {0 : 4}
    If (k < from_bore(j) || (k == 3 && has_web(j)) || (k == 4 && has_rim(j)))
      rectangle = newreg;
      Rectangle(rectangle) = {x(j), factor * r(k), 0, x(j + 1) - x(j), factor * (r(k + 1) - r(k))};
      Rotate {{1, 0, 0}, {0, 0, 0}, -Pi / 2} { Surface{rectangle}; }
      section() += rectangle;
    EndIf
  EndFor
EndFor
Coherence;

// the number of elements of each edge of the section
e = 1e-6;
For j In {0 : 7}
  edges() = Curve In BoundingBox {x(j) - e, -e, -1, x(j + 1) + e, e, 1};
  For i In {0 : #edges() - 1}
    box() = BoundingBox Curve{ edges(i) };
    If (box(3) - box(0) > e)
      Transfinite Curve{edges(i)} = elements_x(j) + 1;
    EndIf
  EndFor
EndFor
For k In {0 : 4}
  edges() = Curve In BoundingBox {-1, -e, -factor * r(k + 1) - e, 1, e, -factor * r(k) + e};
  For i In {0 : #edges() - 1}
    box() = BoundingBox Curve{ edges(i) };
    If (box(5) - box(2) > e)
      Transfinite Curve{edges(i)} = elements_r(k) + 1;
    EndIf
  EndFor
EndFor
Transfinite Surface{section()};
Recombine Surface{section()};
Extrude {{1, 0, 0}, {0, 0, 0}, Pi} { Surface{section()}; Layers{sectors}; Recombine; }

// Cylindrical faces: those that reach over the whole diameter, and along the axis.
radii()  = {0.02, 0.02, 0.02, 0.1};
starts() = {0, 0.25, 0.28, 0.11};
stops()  = {0.03, 0.28, 0.32, 0.15};
bearing_1() = {};
bearing_2() = {};
coupling()  = {};
teeth()     = {};
For k In {0 : 3}
  outer = factor * radii(k) + 1e-5;
  faces() = Surface In BoundingBox {starts(k) - e, -e, -outer, stops(k) + e, outer, outer};
  For i In {0 : #faces() - 1}
    box() = BoundingBox Surface{ faces(i) };
    If (box(3) - box(0) > e && box(5) - box(2) > 2 * (outer - 2e-5))
      If (k == 0)
        bearing_1() += faces(i);
      ElseIf (k == 1)
        bearing_2() += faces(i);
      ElseIf (k == 2)
        coupling() += faces(i);
      Else
        teeth() += faces(i);
      EndIf
    EndIf
  EndFor
EndFor
Physical Volume("shaft") = Volume{:};
Physical Surface("bearing 1") = {bearing_1()};
Physical Surface("bearing 2") = {bearing_2()};
Physical Surface("coupling") = {coupling()};
Physical Surface("teeth") = {teeth()};
