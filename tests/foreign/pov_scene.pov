#version 3.7;
#include "colors.inc"
#declare R = 0.75;
global_settings { assumed_gamma 1.0 }
camera {
  location <0, 2.5, -8>
  look_at <0.2, 0.8, 0>
  right x*image_width/image_height
  angle 45
}
light_source { <10, 20, -10> color White }
plane { y, 0 pigment { checker color Gray50, color White scale 2 } }
sphere { <-1.6, 1, 0>, R pigment { Green } finish { phong 0.9 } }
box { <1.75, 0, -1.5>, <2.25, 1.5, 0.5> pigment { rgb <1, 0.65, 0> } rotate y*30 }
