// A vessel of radius 1 that branches, in a ball, into two of radius 0.8, each turned by 40 degrees.
//
// gmsh -3 -bin vessel.geo -o vessel.msh      (Gmsh 4.15 made the mesh beside this file)

SetFactory("OpenCASCADE");

radius = 1.0;
branch = 0.8;
junction = 1.15;
angle = 40 * Pi / 180;
before = 4;       // length of the vessel before the junction
after = 5;        // length of each branch behind it

Cylinder(1) = {-before, 0, 0, before, 0, 0, radius};
Sphere(2) = {0, 0, 0, junction};
Cylinder(3) = {0, 0, 0, after * Cos(angle), after * Sin(angle), 0, branch};
Cylinder(4) = {0, 0, 0, after * Cos(angle), -after * Sin(angle), 0, branch};
BooleanUnion(5) = { Volume{1}; Delete; }{ Volume{2, 3, 4}; Delete; };

// The flat ends are known by where they are
e = 1e-3;
inlet() = Surface In BoundingBox{-before - e, -2, -2, -before + e, 2, 2};
x = after * Cos(angle);
y = after * Sin(angle);
w = branch + e;
upper() = Surface In BoundingBox{x - w * Sin(angle), y - w * Cos(angle), -w, x + w * Sin(angle), y + w * Cos(angle), w};
lower() = Surface In BoundingBox{x - w * Sin(angle), -y - w * Cos(angle), -w, x + w * Sin(angle), -y + w * Cos(angle), w};
all() = Surface{:};
wall() = all();
wall() -= inlet();
wall() -= upper();
wall() -= lower();

Physical Surface("inlet") = inlet();
Physical Surface("upper") = upper();
Physical Surface("lower") = lower();
Physical Surface("wall") = wall();
Physical Volume("fluid") = {5};

Mesh.MeshSizeMin = 0.52;
Mesh.MeshSizeMax = 0.52;
Mesh.ElementOrder = 2;
Mesh.SecondOrderLinear = 0;
Mesh.Optimize = 1;
