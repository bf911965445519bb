% a ball
eye = [3 3.5 8];
r = 1.25;
c = [-1.6; 1; 0];
fov = 45 * pi / 180;
d = sqrt((eye(1) - c(1))^2 + (eye(2) - c(2))^2);
