// A monoblock sleeper shaped like the German B70: 2.60 m long, waist in the middle, inclined sides.
// Stations along x with base width b and height h; the sides lean inwards by `lean` per metre height,
// so that every face is plane. Build the mesh with:  gmsh -3 -format msh22 sleeper_b70.geo
lean = 0.30;
across = 3;  // cells over the width
high = 2;    // cells over the height

//     x      b      h     cells to the next station
x[] = {-1.30, -0.90, -0.60, -0.40, 0.40, 0.60, 0.90, 1.30};
b[] = { 0.30,  0.30,  0.30,  0.22, 0.22, 0.30, 0.30, 0.30};
h[] = { 0.20,  0.21,  0.21, 0.175, 0.175, 0.21, 0.21, 0.20};
n[] = {    4,     3,     2,     8,    2,    3,    4};

For i In {0:7}
  t = b[i] / 2 - lean * h[i];
  Point(4*i+1) = {x[i], -b[i] / 2, 0};
  Point(4*i+2) = {x[i],  b[i] / 2, 0};
  Point(4*i+3) = {x[i],  t, h[i]};
  Point(4*i+4) = {x[i], -t, h[i]};
  For k In {1:4}
    Line(100*i + k) = {4*i + k, 4*i + k % 4 + 1};
  EndFor
  Transfinite Curve {100*i + 1, 100*i + 3} = across + 1;
  Transfinite Curve {100*i + 2, 100*i + 4} = high + 1;
  Curve Loop(100*i + 1) = {100*i + 1, 100*i + 2, 100*i + 3, 100*i + 4};
  Plane Surface(100*i + 1) = {100*i + 1};
EndFor
For i In {0:6}
  For k In {1:4}
    Line(100*i + 10 + k) = {4*i + k, 4*i + 4 + k};
    Transfinite Curve {100*i + 10 + k} = n[i] + 1;
  EndFor
  For k In {1:4}
    Curve Loop(100*i + 10 + k) = {100*i + k, 100*i + 10 + k % 4 + 1, -(100*i + 100 + k), -(100*i + 10 + k)};
    Plane Surface(100*i + 10 + k) = {100*i + 10 + k};
  EndFor
  Surface Loop(100*i + 1) = {100*i + 1, 100*i + 101, 100*i + 11, 100*i + 12, 100*i + 13, 100*i + 14};
  Volume(i + 1) = {100*i + 1};
EndFor
Transfinite Surface "*";
Recombine Surface "*";
Transfinite Volume "*";

Physical Surface("x_min") = {1};
Physical Surface("x_max") = {701};
Physical Surface("bottom") = {11, 111, 211, 311, 411, 511, 611};
Physical Surface("y_max") = {12, 112, 212, 312, 412, 512, 612};
Physical Surface("top") = {13, 113, 213, 313, 413, 513, 613};
Physical Surface("y_min") = {14, 114, 214, 314, 414, 514, 614};
Physical Volume("concrete") = {1:7};
