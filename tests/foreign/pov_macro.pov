#macro Ball(X, Z)
  sphere { <X, 1, Z>, 0.45 pigment { color rgb <X/10, 0.3, Z/10> } }
#end
#declare I = 0;
#while (I < 12)
  Ball(I, 2*I + 1)
  #declare I = I + 1;
#end
