// Two unit cubes in a row; groups that overlap, one without a name.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Box(2) = {1, 0, 0, 1, 1, 1};
Coherence;
e = 1e-3;
Physical Volume("left", 1) = {1};
Physical Volume("all", 2) = {1, 2};
start() = Surface In BoundingBox{-e, -e, -e, e, 1 + e, 1 + e};
end() = Surface In BoundingBox{2 - e, -e, -e, 2 + e, 1 + e, 1 + e};
bottom() = Surface In BoundingBox{-e, -e, -e, 2 + e, 1 + e, e};
Physical Surface("start", 1) = start();
Physical Surface("ends", 2) = {start(), end()};
Physical Surface(5) = bottom();
Mesh.MeshSizeMax = 0.5;
