difference {
  box { <-1, -1, -1>, <1, 1, 1> }
  sphere { <0, 0, 0>, 1.3 }
  translate <0, 1.5, 0>
  pigment { rgb <0.2, 0.4, 0.9> }
}
union { sphere { <2, 1, 4>, 1 } cylinder { <0, 0, 0>, <0, 3, 0>, 0.4 open } }
