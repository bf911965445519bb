sphere { <1.25, -2, 3.5>, R texture { T_Gold } }
sphere { <0.5, 1.75, -4>, 0.25 pigment { color rgb <1, 0.5, 0> } }
sphere { <-3, 2, 8> 1.5 }
