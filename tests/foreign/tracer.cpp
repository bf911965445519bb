auto eye = Vec3(3, 3.5, 8);
Sphere ball(Point3(-1.6, 1, 0), 1.25, Color(128, 128, 0));
world.add(make_shared<sphere>(point3(0, -100.5, -1), 100));
cam.vfov = 20; cam.lookfrom = point3(13, 2, 3); cam.lookat = point3(0, 0, 0);
