//! Tests of data that no text of a scene can produce, but that another program can pass to the
//! library. The library refuses such data, or reports an error; it never makes a picture that looks
//! right.

use std::io::Cursor;

use pinhole::{
    Scene, SceneData,
    area::Area,
    film::{self, Film, Rounding, SizesDiffer, write_exr},
    glam::{DVec2, DVec3},
    grading::{Kind, Reference},
    refine::coarse,
    render::{self, Control, RenderError, render_as_asked, render_exact},
    scene::{Count, Lens, Object, Shape, Sphere, TriangleOutline, View},
    tracer::World,
};

use crate::scenes::{exact, example, read, sampling};

/// Returns the scene of figure 9.9, with a small picture, after the change `change`.
fn changed(change: impl Fn(&mut SceneData)) -> SceneData {
    let mut data = example("figure_9_9", 32, 18);
    change(&mut data);
    data
}

#[test]
fn data_that_break_a_condition_are_no_scene() {
    let ball = |radius: f64| Sphere {
        center: DVec3::Y,
        radius,
        color: pinhole::Color::BLACK,
    };
    type Change = (&'static str, fn(&mut SceneData));
    let changes: [Change; 18] = [
        ("`radius` must be more than 0", |it| {
            if let Shape::Sphere(sphere) = &mut it.objects_mut()[0].shape {
                sphere.radius = -1.0;
            }
        }),
        ("stands on the point that it looks at", |it| {
            it.camera.view = View::Lookat(it.camera.eye);
        }),
        ("`eye` is not finite", |it| it.camera.eye.x = f64::NAN),
        ("`eye` is not finite", |it| {
            it.camera.eye.z = f64::NEG_INFINITY
        }),
        ("`roll` is not finite", |it| {
            it.camera.roll.radians = f64::NAN
        }),
        ("`far` is not finite", |it| {
            it.camera.far = Some(f64::INFINITY)
        }),
        ("`background` is not finite", |it| {
            it.image.background.srgb[2] = f64::NAN;
        }),
        ("`far` must be more than `near`", |it| {
            it.camera.far = Some(0.0)
        }),
        ("`near` must be at least 0", |it| it.camera.near = -1.0),
        ("`d` must be more than 0", |it| {
            it.camera.lens = Lens::Distance(0.0)
        }),
        ("`up` must be other than (0, 0, 0)", |it| {
            it.camera.up = DVec3::ZERO
        }),
        ("`direction` must be other than", |it| {
            it.camera.view = View::Direction(DVec3::ZERO);
        }),
        ("`width` must be at least 1", |it| it.image.width = 0),
        ("`height` must be at most", |it| it.image.height = u32::MAX),
        ("`per_pixel` must be at least 1", |it| {
            it.sampler.count = Count::PerPixel(0);
        }),
        ("Ball", |it| {
            let again = it.objects[0].clone();
            it.objects_mut().push(again);
        }),
        ("lie on one line", |it| {
            if let Shape::Triangle(triangle) = &mut it.objects_mut()[1].shape {
                triangle.outline = TriangleOutline::Vertices([DVec3::ZERO; 3]);
            }
        }),
        ("no extent along", |it| {
            if let Shape::Box(cuboid) = &mut it.objects_mut()[2].shape {
                cuboid.max = cuboid.min;
            }
        }),
    ];
    for (message, change) in changes {
        let data = changed(change);
        let told = Scene::from_data(&data).unwrap_err().to_string();
        assert!(told.contains(message), "{message}:\n{told}");
        assert!(World::try_new(&data).is_err(), "{message}");
    }
    for name in ["my ball", "camera", "for", "Ball {"] {
        let data = changed(|it| it.objects_mut().push(Object::new(ball(1.0)).named(name)));
        assert!(Scene::from_data(&data).is_err(), "{name}");
    }
    let data = changed(|it| it.objects_mut().push(Object::new(ball(1.0)).named("Other")));
    assert!(World::try_new(&data).is_ok());
}

#[test]
fn a_name_that_the_language_does_not_have_is_one_mistake() {
    let ball = Sphere {
        center: DVec3::Y,
        radius: 1.0,
        color: pinhole::Color::BLACK,
    };
    for name in [
        "",
        " ",
        "A ",
        "A for i < 3",
        "A { center (9, 9, 9)  radius 5  color red } sphere B",
        "B[0]",
        "7up",
        "Bäll",
        "let",
        "for",
    ] {
        let data = changed(|it| it.objects_mut().push(Object::new(ball).named(name)));
        let errors = [
            Scene::from_data(&data).unwrap_err(),
            World::try_new(&data).unwrap_err(),
        ];
        for error in errors {
            let mistakes: Vec<_> = error.iter().collect();
            assert_eq!(mistakes.len(), 1, "{name}: {error}");
            assert_eq!(mistakes[0].code, "pinhole::bad_name", "{name}: {error}");
            assert_eq!(error.sources().text(mistakes[0].labels[0].span), name);
        }
    }
    let mut repeated = read(
        "camera { eye (0, 2, 8)  lookat (0, 1, 0) }
        sphere A for i < 2, j < 2 { center (i, j, 0) }",
    );
    assert!(repeated.check().is_ok());
    repeated.objects_mut()[1].name = Some("A[0, 1] { } sphere B".to_owned());
    assert_eq!(repeated.check().unwrap_err().iter().count(), 1);
}

#[test]
fn a_part_beyond_the_picture_is_an_error() {
    let scene = changed(|_| ());
    let (world, sampling, control) = (World::new(&scene), sampling(&scene), Control::default());
    let mut exact_scene = scene.clone();
    exact_scene.sampler.method = pinhole::Method::Exact;
    let without_samples = crate::scenes::sampling(&exact_scene);
    for part in [
        Area::whole(33, 18),
        Area::whole(32, 0),
        "31,17,2,1".parse().unwrap(),
        "40,3,1,1".parse().unwrap(),
        "4294967295,0,4294967295,1".parse().unwrap(),
    ] {
        let ways = [
            render::render(&world, &sampling, part, &control).err(),
            render::render(&world, &without_samples, part, &control).err(),
            render_as_asked::<[u8; 3]>(&world, &sampling, part, &control).err(),
            render_exact(&world, part, &control).err(),
            coarse(&world, part, 4, &control).err(),
            Reference::new(&scene, part, Rounding::Byte, &control).err(),
        ];
        for error in ways {
            assert!(matches!(error, Some(RenderError::Outside { .. })), "{part}");
        }
    }
    let all = Area::whole(32, 18);
    let film = render::render(&world, &without_samples, all, &control).unwrap();
    assert_eq!(film, exact(&scene).film);
}

#[test]
fn films_of_different_sizes_are_not_compared_or_written_as_parts() {
    let film = |width, height| Film::from_fn(width, height, |x, _| [f64::from(x); 3]).unwrap();
    let (a, b) = (film(4, 2), film(2, 4));
    assert_eq!(film::rmse(&a, &b), Err(SizesDiffer([4, 2], [2, 4])));
    assert_eq!(film::rmse(&a, &a), Ok(0.0));
    for (part, whole) in [
        (Area::whole(2, 4), Area::whole(4, 4)),
        (Area::whole(4, 1), Area::whole(4, 4)),
        ("1,0,4,2".parse().unwrap(), Area::whole(4, 4)),
        (Area::whole(4, 2), Area::whole(2, 4)),
    ] {
        let mut file = Cursor::new(Vec::new());
        let error = write_exr(&a, part, whole, None, &mut file).unwrap_err();
        assert!(error.to_string().contains("4 × 2 pixels"), "{error}");
        assert!(file.into_inner().is_empty());
    }
    assert_eq!(a.into_pixels().len(), 8);
}

#[test]
fn a_picture_with_values_that_are_no_numbers_is_wrong() {
    let scene = read(
        "image { width 24  height 16 } camera { eye (0, 2, 8)  lookat (0, 1, 0) }
        sphere { center (0, 1, 0) } checkerboard {}",
    );
    let control = Control::default();
    let reference = Reference::new(&scene, Area::whole(24, 16), Rounding::Float, &control).unwrap();
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for wrong in [1, 24 * 16] {
            let mut film = reference.exact.film.clone();
            film.pixels_mut()[..wrong].fill([0.0, value, 0.0]);
            let comparison = reference.compare(&film, 0.5).unwrap();
            assert_eq!(comparison.beyond, wrong as u64);
            let picture = film::Picture::new(film, Rounding::Float);
            let verdict = reference
                .judge(&picture, None, &comparison, control.cancel)
                .unwrap();
            assert_eq!(verdict.kind, Kind::Wrong);
            assert_eq!(verdict.mistakes[0].id, "not_finite");
        }
    }
}

#[test]
fn what_lies_outside_of_a_picture_is_nothing() {
    let scene = example("figure_9_9", 96, 54);
    let world = World::new(&scene);
    let pixels = [(48, 53), (96, 53), (48, 54), (1000, 1000), (u32::MAX, 0)];
    let is_seen = pixels.map(|(x, y)| world.object_at(x, y).is_some());
    assert_eq!(is_seen, [true, false, false, false, false]);
    for (method, _) in pinhole::schema::METHODS {
        assert!(pinhole::sampling::tilings(*method, 0).is_empty());
    }
    let empty: Film = Film::new(0, 0).unwrap();
    assert_eq!(film::rmse(&empty, &empty), Ok(0.0));
    let numbers = Film::from_fn(2, 1, |_, _| [f64::NAN; 3]).unwrap();
    assert!(film::rmse(&numbers, &numbers).unwrap().is_nan());
}

#[test]
#[should_panic(expected = "there is not one error bound for each pixel")]
fn pixels_without_error_bounds_are_not_certified() {
    film::certified(&Film::new(2, 1).unwrap(), &[]);
}

#[test]
#[should_panic(expected = "is not finite")]
fn a_point_that_is_not_finite_is_not_probed() {
    pinhole::probe::probe(&changed(|_| ()), DVec2::NAN);
}

#[test]
#[should_panic(expected = "the picture to judge has another size")]
fn a_comparison_of_another_size_is_refused() {
    let scene = changed(|_| ());
    let control = Control::default();
    let new = |part| Reference::new(&scene, part, Rounding::Float, &control).unwrap();
    let (reference, small) = (new(Area::whole(32, 18)), new(Area::whole(16, 18)));
    let black = Film::new(16, 18).unwrap();
    let comparison = small.compare(&black, 0.5).unwrap();
    let picture = film::Picture::new(black, Rounding::Float);
    let _ = reference.judge(&picture, None, &comparison, control.cancel);
}

#[test]
#[should_panic(expected = "the sampling is of a picture of another size")]
fn a_sampling_of_another_size_is_refused() {
    let [small, large] = [16, 32].map(|width| example("figure_9_9", width, 9));
    let (world, part) = (World::new(&small), Area::whole(16, 9));
    let _ = render::render(&world, &sampling(&large), part, &Control::default());
}

#[test]
fn pixels_that_do_not_fit_their_part_of_a_picture_are_refused() {
    let put = |part: &str, count: usize| {
        let mut film: Film<[u8; 3]> = Film::new(4, 3).unwrap();
        film.put(part.parse().unwrap(), &vec![[7; 3]; count]);
        film.into_pixels()
            .iter()
            .filter(|pixel| **pixel == [7; 3])
            .count()
    };
    assert_eq!(put("1,0,3,2", 6), 6);
    // All these parts are refused: the number of pixels does not fit the part, or the part extends
    // beyond the picture of 4 × 3 pixels.
    for (part, count) in [
        ("1,0,3,2", 3),
        ("2,0,3,2", 6),
        ("0,2,4,2", 8),
        ("1,0,3,2", 9),
    ] {
        let refused = std::panic::catch_unwind(|| put(part, count)).unwrap_err();
        let message = refused.downcast_ref::<String>().unwrap();
        assert!(message.contains("pixels for the part"), "{part}: {message}");
    }
}
