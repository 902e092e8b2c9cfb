// A surface without a volume: two triangles.
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 1, 1};
Transfinite Curve{1:4} = 2;
Transfinite Surface{1};
