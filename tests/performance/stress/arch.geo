// Shallow arch, half a wave of a sine: span 1 m, rise 4 radii of gyration of its
// section (height 10 mm, width 20 mm along z). Units: m.
n      = 24;
height = 0.01;
width  = 0.02;
rise   = 4 * height / Sqrt(12);

For i In {0 : n}
  x = i / n;
  y = rise * Sin(Pi * x);
  s = rise * Pi * Cos(Pi * x);
  r = Sqrt(1 + s * s);
  Point(2 * i + 1) = {x + height / 2 * s / r, y - height / 2 / r, 0};
  Point(2 * i + 2) = {x - height / 2 * s / r, y + height / 2 / r, 0};
  Line(3 * i + 1) = {2 * i + 1, 2 * i + 2};
EndFor
For i In {0 : n - 1}
  Line(3 * i + 2) = {2 * i + 1, 2 * i + 3};
  Line(3 * i + 3) = {2 * i + 2, 2 * i + 4};
  Line Loop(i + 1) = {3 * i + 2, 3 * i + 4, -(3 * i + 3), -(3 * i + 1)};
  Plane Surface(i + 1) = {i + 1};
  Transfinite Surface {i + 1};
EndFor
Transfinite Line {:} = 2;
Recombine Surface {:};
Extrude {0, 0, width} { Surface {:}; Layers {1}; Recombine; }

left()  = Surface In BoundingBox {-1e-3, -1, -1, 1e-3, 1, 1};
right() = Surface In BoundingBox {1 - 1e-3, -1, -1, 1 + 1e-3, 1, 1};
Physical Volume("arch") = Volume {:};
Physical Surface("left")  = left();
Physical Surface("right") = right();
