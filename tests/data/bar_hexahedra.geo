// A bar 2 x 1 x 1 of 4 x 2 x 3 hexahedra.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 2, 1};
Transfinite Curve{1, 3} = 5;
Transfinite Curve{2, 4} = 3;
Transfinite Surface{1};
Recombine Surface{1};
Extrude{0, 0, 1}{ Surface{1}; Layers{3}; Recombine; }
Physical Volume("bar") = {1};
Physical Surface("bottom") = {1};
