$fn = 64;
r = 1.25;
translate([-1.6, 1, 0]) sphere(r = r);
translate([2, 0.75, -0.5]) cube([0.5, 1.5, 2], center = true);
color("teal") cylinder(h = 3, r1 = 2, r2 = 0.5);
