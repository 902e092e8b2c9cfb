// Its second-order elements are curved.
SetFactory("OpenCASCADE");
Cylinder(1) = {0, 0, 0, 0, 0, 1, 0.5};
Mesh.MeshSizeMax = 0.4;
