let eye = Vec3::new(3.0, 3.5, 8.0);
let ball = Sphere { center: vec3(-1.6, 1.0, 0.0), radius: 1.25 };
let mut samples: u32 = 16;
for i in 0..12 { world.push(Sphere { center: vec3(i as f64, 0.5, 2.0), radius: 0.25 }); }
