// A tube of radius 1 and length 10 about an axis that is oblique to all coordinates, its middle at the origin.
//
// gmsh -3 -bin tube.geo -o tube.msh      (Gmsh 4.15 made the mesh beside this file)

SetFactory("OpenCASCADE");

radius = 1.0;
half = 5.0;       // half the length
x = 0.48;         // direction of the axis
y = 0.6;
z = 0.64;

Cylinder(1) = {-half * x, -half * y, -half * z, 2 * half * x, 2 * half * y, 2 * half * z, radius};

// The flat ends are known by where they are: no point of them is farther than the radius from their centre
r = radius + 1e-3;
first() = Surface In BoundingBox{-half * x - r, -half * y - r, -half * z - r, -half * x + r, -half * y + r, -half * z + r};
last() = Surface In BoundingBox{half * x - r, half * y - r, half * z - r, half * x + r, half * y + r, half * z + r};
wall() = Surface{:};
wall() -= first();
wall() -= last();

Physical Surface("inlet") = first();
Physical Surface("outlet") = last();
Physical Surface("wall") = wall();
Physical Volume("fluid") = {1};

Mesh.MeshSizeMin = 0.5;
Mesh.MeshSizeMax = 0.5;
Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
Mesh.SecondOrderLinear = 0;
Mesh.Optimize = 1;
