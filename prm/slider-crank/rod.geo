// Half (x > 0) of the rod of the slider-crank of Gerstmayr and Schoeberl: length
// 1 m along y, height 50 mm along z and width 5 mm along x. Units: m. The option
// "Mirror = x" of the model adds the other half, so that the mesh is symmetric
// to the plane of motion.
SetFactory("OpenCASCADE");

length = 1;
height = 0.05;
width  = 0.005;

Box(1) = {0, 0, -height / 2, width / 2, length, height};

e = 1e-5;
start() = Surface In BoundingBox {-e, -e, -height / 2 - e, width / 2 + e, e, height / 2 + e};
end() = Surface In BoundingBox {-e, length - e, -height / 2 - e,
                                width / 2 + e, length + e, height / 2 + e};
Physical Volume("rod") = {1};
Physical Surface("start") = start();
Physical Surface("end") = end();
