// Three volumes in a row, a physical volume each.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Box(3) = {2, 0, 0, 2, 1, 1};
Coherence;
e = 1e-3;
Physical Volume("shaft") = {1};
Physical Volume("disk") = {2};
Physical Volume("nose") = {3};
start() = Surface In BoundingBox{-e, -e, -e, e, 1 + e, 1 + e};
bottom() = Surface In BoundingBox{-e, -e, -e, 4 + e, 1 + e, e};
Physical Surface("start") = start();
Physical Surface("bottom") = bottom();
Mesh.MeshSizeMin = 1;
Mesh.MeshSizeMax = 1;
