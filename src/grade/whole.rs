//! Mistakes of the whole picture: turned, mirrored, its channels or its encoding confused.

use super::{
    Curve, Idea, Make, Turn, Verdict,
    evidence::FEWEST,
    level,
    noise::{is_off, with_colors},
    objects, size,
};
use crate::{
    color::{Color, linear_to_srgb, srgb_to_linear},
    film::{Film, TooLarge, rmse},
    scene::Scene,
};

/// What was done to a picture as a whole, so that it can be undone.
#[derive(Clone, Copy)]
pub enum Look {
    /// Its pixels are elsewhere.
    Turned { to: Turn, back: Turn },
    /// Its channels are.
    Ordered { to: Turn, back: Turn },
    /// Its light went through a curve.
    Curved(Curve),
}

impl Look {
    pub fn done(&self, film: &Film) -> Result<Film, TooLarge> {
        match self {
            Self::Turned { to, .. } | Self::Ordered { to, .. } => to(film),
            Self::Curved(curve) => level::map(film, curve.to),
        }
    }

    pub fn undone(&self, film: &Film) -> Result<Film, TooLarge> {
        match self {
            Self::Turned { back, .. } | Self::Ordered { back, .. } => back(film),
            Self::Curved(curve) => level::map(film, curve.back),
        }
    }

    /// The mistake of which the picture is made.
    pub fn make(self) -> Make {
        match self {
            Self::Turned { to, .. } | Self::Ordered { to, .. } => Make::Film(Box::new(to)),
            Self::Curved(curve) => Make::Light(curve),
        }
    }
}

fn film(
    mistake: &'static str,
    message: &str,
    help: &str,
    make: impl Fn(&Film) -> Result<Film, TooLarge> + 'static,
) -> Idea {
    Idea {
        mistake,
        message: message.to_owned(),
        help: help.to_owned(),
        make: Make::Film(Box::new(make)),
    }
}

fn light(mistake: &'static str, message: &str, help: &str, curve: Curve) -> Idea {
    Idea {
        mistake,
        message: message.to_owned(),
        help: help.to_owned(),
        make: Make::Light(curve),
    }
}

/// Light encoded with a power, which is decoded as sRGB, and back.
const POWER: Curve = Curve {
    to: |light| srgb_to_linear(libm::pow(light.max(0.0), 1.0 / 2.2)),
    back: |light| libm::pow(linear_to_srgb(light).max(0.0), 2.2),
};

/// The same with a square root.
const ROOT: Curve = Curve {
    to: |light| srgb_to_linear(light.max(0.0).sqrt()),
    back: |light| linear_to_srgb(light).max(0.0) * linear_to_srgb(light).max(0.0),
};

/// What may be turned: a word for programs, one for people, the way out, and how.
const TURNS: [(&str, &str, &str, Turn); 3] = [
    (
        "mirrored",
        "mirrored: left and right are exchanged",
        "u = (up × w)/|up × w| points to the right; (w × up) points to the left, as in a left-handed world",
        |film| {
            Film::from_fn(film.width(), film.height(), |x, y| {
                film.pixel(film.width() - 1 - x, y)
            })
        },
    ),
    (
        "upside_down",
        "upside down: top and bottom are exchanged",
        "rows are counted from the top, and y_v = s (height/2 − py) falls as they grow",
        |film| {
            Film::from_fn(film.width(), film.height(), |x, y| {
                film.pixel(x, film.height() - 1 - y)
            })
        },
    ),
    (
        "turned_180",
        "turned by 180 degrees",
        "as behind a real pinhole: the view plane lies before the eye, at −d w, so the picture stands upright",
        |film| {
            Film::from_fn(film.width(), film.height(), |x, y| {
                film.pixel(film.width() - 1 - x, film.height() - 1 - y)
            })
        },
    ),
];

/// Orders of the colour channels: how they are called, from the right one to them, and back.
const ORDERS: [(&str, Turn, Turn); 5] = [
    ("blue, green, red", ordered::<2, 1, 0>, ordered::<2, 1, 0>),
    ("red, blue, green", ordered::<0, 2, 1>, ordered::<0, 2, 1>),
    ("green, red, blue", ordered::<1, 0, 2>, ordered::<1, 0, 2>),
    ("green, blue, red", ordered::<1, 2, 0>, ordered::<2, 0, 1>),
    ("blue, red, green", ordered::<2, 0, 1>, ordered::<1, 2, 0>),
];

const HELP_OF_ORDER: &str = "a picture's channels are in the order red, green, blue";

fn ordered<const R: usize, const G: usize, const B: usize>(film: &Film) -> Result<Film, TooLarge> {
    Film::from_fn(film.width(), film.height(), |x, y| {
        [R, G, B].map(|i| film.pixel(x, y)[i])
    })
}

fn said_of_order(name: &str) -> String {
    format!("the colour channels are in the order {name}")
}

fn said_of_turn(how: &str) -> String {
    format!("the picture is {how}")
}

/// What may have happened to the light: a word for programs, one for people, the way out, and the curve.
const CURVES: [(&str, &str, &str, Curve); 4] = [
    (
        "not_encoded",
        "the colours are too dark: linear light was written where sRGB is expected",
        "encode each channel before it is written: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055",
        Curve {
            to: srgb_to_linear,
            back: linear_to_srgb,
        },
    ),
    (
        "encoded_twice",
        "the colours are too bright: they were encoded as sRGB twice, or a scene's sRGB colours were not decoded",
        "decode a scene's colours to linear light, average there, and encode once",
        Curve {
            to: linear_to_srgb,
            back: srgb_to_linear,
        },
    ),
    (
        "gamma_22",
        "the colours were encoded with the power 1/2.2, which is near sRGB but not it",
        "use the curve of sRGB: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055",
        POWER,
    ),
    (
        "gamma_2",
        "the colours were encoded with the square root, the power 1/2, which is not the curve of sRGB",
        "use the curve of sRGB: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055",
        ROOT,
    ),
];

/// What can be seen of two pictures alone.
pub fn films() -> Vec<Idea> {
    let turns =
        TURNS.map(|(mistake, how, help, turn)| film(mistake, &said_of_turn(how), help, turn));
    let mut ideas = Vec::from(turns);
    ideas.push(film(
        "transposed",
        "rows and columns are exchanged",
        "a pixel's place in a row-by-row array is y · width + x",
        |film| match film.width() == film.height() {
            true => transposed(film),
            false => Ok(film.clone()),
        },
    ));
    ideas.extend(lights());
    for (name, order, _) in ORDERS {
        ideas.push(film("channels", &said_of_order(name), HELP_OF_ORDER, order));
    }
    ideas
}

/// What may have been done to a whole picture that can be undone: each turn, order and curve, as it is said of it alone.
pub fn looks() -> Vec<(&'static str, String, &'static str, Look)> {
    let turns = TURNS.map(|(mistake, how, help, turn)| {
        // Each of them undoes itself.
        let look = Look::Turned {
            to: turn,
            back: turn,
        };
        (mistake, said_of_turn(how), help, look)
    });
    let orders = ORDERS.map(|(name, to, back)| {
        let look = Look::Ordered { to, back };
        ("channels", said_of_order(name), HELP_OF_ORDER, look)
    });
    let curves = CURVES.map(|(mistake, message, help, curve)| {
        (mistake, message.to_owned(), help, Look::Curved(curve))
    });
    turns.into_iter().chain(orders).chain(curves).collect()
}

/// A picture that is turned, and whose light is wrong, too: two mistakes, for pictures that none explains alone.
pub fn pairs() -> Vec<Idea> {
    let turned = |(mistake, how, help, turn): (&'static str, &str, &str, Turn)| {
        CURVES.map(|(_, message, help_of_curve, curve)| Idea {
            mistake,
            message: format!("the picture is {how}; and {message}"),
            help: format!("{help}; and {help_of_curve}"),
            make: Make::Turned(turn, curve),
        })
    };
    TURNS.into_iter().flat_map(turned).collect()
}

fn transposed(film: &Film) -> Result<Film, TooLarge> {
    Film::from_fn(film.height(), film.width(), |x, y| film.pixel(y, x))
}

/// What happened to the light, before samples were averaged or after it.
pub fn curves(scene: &Scene) -> Vec<Idea> {
    let mut ideas = Vec::from(lights());
    ideas.extend(averages(scene));
    ideas
}

fn lights() -> [Idea; 4] {
    CURVES.map(|(mistake, message, help, curve)| light(mistake, message, help, curve))
}

/// Samples that were averaged as other numbers than their light.
fn averages(scene: &Scene) -> Vec<Idea> {
    let encoded = with_colors(scene, |color| Color {
        srgb: color
            .srgb
            .map(|channel| 255.0 * linear_to_srgb(channel / 255.0)),
    });
    let mut ideas = vec![Idea {
        mistake: "averaged_encoded",
        message: "samples were averaged as sRGB numbers, not as light: flat colours are right, and edges too dark".to_owned(),
        help: "decode a scene's colours to linear light, average there, and encode once".to_owned(),
        make: Make::Curved(
            Box::new(encoded),
            Curve {
                to: srgb_to_linear,
                back: linear_to_srgb,
            },
        ),
    }];
    let power = with_colors(scene, |color| Color {
        srgb: color
            .srgb
            .map(|channel| 255.0 * linear_to_srgb(libm::pow(channel / 255.0, 2.2))),
    });
    ideas.push(Idea {
        mistake: "gamma_22_averaged",
        message: "colours were decoded with the power 2.2 and encoded with 1/2.2, which is near sRGB but not it: flat colours are right, and \
                  edges a little off"
            .to_owned(),
        help: "use the curve of sRGB both ways: 12.92 c up to 0.0031308, else 1.055 c^(1/2.4) − 0.055, and its inverse"
            .to_owned(),
        make: Make::Curved(
            Box::new(power),
            POWER,
        ),
    });
    ideas
}

/// All of them.
pub fn ideas(scene: &Scene) -> Vec<Idea> {
    let mut ideas = films();
    ideas.extend(averages(scene));
    if scene.image.width != scene.image.height {
        ideas.push(Idea {
            mistake: "squeezed",
            message: "the picture is stretched: its window is as wide as it is high, though the picture is not".to_owned(),
            help: "pixels are square: one scale s = view_height/height for both x and y".to_owned(),
            make: Make::Squeezed,
        });
    }
    ideas
}

/// What is said of a picture of one colour, if the right one has several: all else that explains it is a guess.
pub fn one_color(a: &Film, right: &Film, scene: Option<&Scene>) -> Option<Verdict> {
    let first = a.pixels().first()?;
    let is_one = |film: &Film, light: &[f64; 3]| film.pixels().iter().all(|p| !is_off((p, light)));
    let wrong = right.pixels().iter().filter(|p| is_off((first, p))).count();
    if !is_one(a, first) || is_one(right, right.pixels().first()?) || (wrong as u64) < FEWEST {
        return None;
    }
    let color = Color {
        srgb: first.map(|light| (255.0 * linear_to_srgb(light)).clamp(0.0, 255.0)),
    };
    let is_shown = |other: Color| !is_off((&other.to_linear(), first));
    let owner = scene.and_then(|scene| {
        let mut colors = scene.objects.iter().map(|object| {
            let mut shape = object.shape;
            objects::color(&mut shape)
                .into_iter()
                .any(|own| is_shown(*own))
        });
        colors.position(|is_own| is_own)
    });
    let (what, help) = match (scene, owner) {
        (Some(scene), _) if is_shown(scene.image.background) => (
            format!("the background's {color}: nothing was drawn, or no ray hits anything"),
            "does the camera look along −w, and is a hit one with t > 0? `pinhole probe SCENE X Y` shows what a ray should hit",
        ),
        (Some(scene), Some(index)) => (
            format!(
                "{color}: {} hides all else, or the eye is in it",
                objects::called(scene, index)
            ),
            "keep the least t > 0 of all hits of a ray; `pinhole probe SCENE X Y` shows what a ray should hit",
        ),
        _ => (
            format!("{color}: nothing was drawn"),
            "are the colours that rays find stored in the picture, and is it that one that is written?",
        ),
    };
    Some(Verdict {
        mistake: "one_color",
        message: format!("the whole picture is one colour, {what}"),
        help: help.to_owned(),
        rmse: Some(rmse(a, right)),
        explains: None,
        off: None,
    })
}

/// The way out where a picture has another resolution than a scene, and than another picture.
pub const OF_SCENE: &str = "render it in the size that the scene says, or set the scene's: `--set image.width=…` and `--set image.height=…`";
pub const OF_PICTURES: &str = "pictures can be compared that have the same size: render one of them again in that of the other";

/// What can be said of pictures of different sizes.
pub fn sizes(a: &Film, b: &Film, way_out: &str) -> Vec<Verdict> {
    let ([width, height], [b_width, b_height]) = (size(a), size(b));
    let verdict = |mistake, message: String, help: &str| Verdict {
        mistake,
        message,
        help: help.to_owned(),
        rmse: None,
        explains: None,
        off: None,
    };
    if (width, height) == (b_height, b_width) {
        let turned = [
            ("rows and columns are exchanged", transposed(b)),
            (
                "the picture is turned by a quarter, clockwise",
                Film::from_fn(width, height, |x, y| b.pixel(y, b_height - 1 - x)),
            ),
            (
                "the picture is turned by a quarter, counter-clockwise",
                Film::from_fn(width, height, |x, y| b.pixel(b_width - 1 - y, x)),
            ),
        ];
        let black = rmse(
            a,
            &Film::from_fn(width, height, |_, _| [0.0; 3]).unwrap_or_else(|_| a.clone()),
        );
        let nearest = turned
            .into_iter()
            .filter_map(|(message, film)| Some((message, rmse(a, &film.ok()?))))
            .min_by(|p, q| p.1.total_cmp(&q.1));
        let message = match nearest {
            Some((message, left)) if left < super::LEFT * black => message.to_owned(),
            _ => "width and height are exchanged".to_owned(),
        };
        return vec![verdict(
            "transposed",
            message,
            "the picture is width columns by height rows; a pixel's place in a row-by-row array is y · width + x",
        )];
    }
    if u64::from(width) * u64::from(b_height) == u64::from(height) * u64::from(b_width) {
        return vec![verdict(
            "resolution",
            format!(
                "the same shape in another resolution: {width} × {height} pixels where {b_width} × {b_height} are wanted"
            ),
            way_out,
        )];
    }
    vec![verdict(
        "shape",
        format!("another shape: {width} × {height} pixels where {b_width} × {b_height} are wanted"),
        way_out,
    )]
}
