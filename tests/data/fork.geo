// Two faces at a distance that is large in comparison with their size.
SetFactory("OpenCASCADE");
Box(1) = {-0.5, -0.05, -0.05, 1, 0.1, 0.1};
Physical Volume("fork")    = {1};
Physical Surface("cheeks") = {1, 2};
Mesh.MeshSizeMax = 0.1;
