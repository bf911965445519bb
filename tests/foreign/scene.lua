local ball = { -1.6, 1, 0 } -- the ball
camera = { eye = { 3, 3.5, 8 }, lookat = ball, fov = math.rad(45) }
sphere { center = ball, radius = 1.25, color = "olive" }
for i = 1, 9 do box { center = { i, 0.5, 2 * i } } end
