//! Computes the verdict on a picture. In: the best hypothesis about the program that made the
//! picture, i.e. a set of mistakes. If the mistakes explain the picture and are plausible, the
//! verdict names them. Otherwise it reports them as guesses.

use super::{
    hypotheses::{Candidate, Mistake, Shows, mistakes, parameters},
    objects,
    scoring::WRONG,
    search::{Judge, JudgedCandidate},
    verdict::{Kind, NamedMistake, Verdict},
};
use crate::{
    color::srgb_to_linear,
    film::{Film, Jpeg},
    numbers::{short, significant},
    scene::Scene,
};

/// Minimum fraction of the picture's squared error that a mistake must explain to be reported. A
/// larger value would hide small mistakes. A smaller one would report mistakes that explain almost
/// nothing.
const LEAST_EXPLAINED: f64 = 1e-5;

/// Minimum number of wrong fields in one object at which a hypothesis is implausible. Few students
/// mistype two fields of an object, and hardly any mistype three.
const IMPLAUSIBLE_FIELDS: usize = 3;

/// Threshold of displacement, in pixels. Wrong numbers that displace every object by less are
/// considered implausible, because correct programs can cause such displacements. For example, if
/// all pixels use the same four random sample positions, the mean position is typically 0.2 pixels
/// from the pixel's middle.
const LEAST_DISPLACEMENT: f64 = 0.4;

/// Maximum fraction of the picture's squared error that guesses may leave unexplained. If they
/// leave more, the picture mostly shows something else. The guesses would mislead, so they are not
/// reported.
const USELESS_REST: f64 = 0.5;

/// Placeholder in a mistake's message for the factor by which light is scaled. The factor is
/// estimated from the picture.
const GAIN: &str = "{gain}";

/// Identifier of the mistake that rays are parallel. Parallel rays start in a window, whose size
/// depends on the distance of the view plane and the angle of view. If these fields are wrong as
/// well, the message says only that the window's size is wrong ([`PARALLEL_OF_OWN_SIZE`]).
const PARALLEL: &str = "parallel_rays";
const PARALLEL_OF_OWN_SIZE: &str =
    "the rays are parallel: they leave along −w, from a window whose size is not the scene's";

/// Returns the verdict on a picture. `found` is the result of the search: the best hypothesis about
/// the program that made the picture, and whether this hypothesis explains the picture.
pub fn conclude(judge: &Judge, film: &Film, found: Option<(JudgedCandidate, bool)>) -> Verdict {
    let (scene, jpeg) = (judge.scene, judge.fine.jpeg);
    let right = Candidate::correct(scene);
    // A search that explained the picture is complete, even if it used up its budget of work. So
    // the verdict says that the search was cut short only if the picture is unexplained.
    let is_explained = matches!(found, Some((_, true)));
    let is_cut = judge.work.is_cut() && !is_explained;
    let mut verdict = match found {
        Some((found, is_explained)) if !found.candidate().mistakes.is_empty() => {
            with_mistakes(judge, &found, is_explained)
        }
        Some((_, true)) if !has_other_colors(film, scene, jpeg) => {
            let judged = judge.judged(&right, &judge.fine);
            Verdict {
                samples: judged.and_then(|judged| judged.score.samples),
                ..Verdict::without_mistakes(Kind::Noise, scene)
            }
        }
        _ => {
            let (objects, is_background_right) = objects::judged(judge, &right);
            Verdict {
                objects,
                is_background_right,
                ..Verdict::without_mistakes(Kind::Unknown, scene)
            }
        }
    };
    (verdict.is_coded, verdict.is_cut) = (jpeg.is_some(), is_cut);
    verdict
}

/// Returns whether some pixel has a colour that is no mixture of the scene's colours. A correct
/// pixel is a mean of these colours. So its channels lie between the least and the greatest values
/// of all colours. Returns `false` for a JPEG, which is not tested.
fn has_other_colors(film: &Film, scene: &Scene, jpeg: Option<Jpeg>) -> bool {
    let colors = scene.objects.iter();
    let colors = colors.flat_map(|object| object.shape.colors());
    let all = colors.chain([scene.image.background]);
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for srgb in all.map(|color| color.srgb) {
        for i in 0..3 {
            (least[i], most[i]) = (least[i].min(srgb[i]), most[i].max(srgb[i]));
        }
    }
    let least = least.map(|srgb| srgb_to_linear((srgb - WRONG) / 255.0));
    let most = most.map(|srgb| srgb_to_linear((srgb + WRONG) / 255.0));
    let is_other = |pixel: &[f64; 3]| (0..3).any(|i| pixel[i] < least[i] || pixel[i] > most[i]);
    // JPEG coding makes colours overshoot at edges, so a JPEG is not tested.
    jpeg.is_none() && film.pixels().iter().any(is_other)
}

/// Returns the mistakes of the hypothesis `last` in words. For each, computes which fraction of the
/// picture's squared error it explains. `is_explained` says whether all mistakes together explain
/// the picture.
fn attributed(judge: &Judge, last: &Candidate, is_explained: bool) -> Vec<NamedMistake> {
    let scene = judge.scene;
    // Most mistakes are visible on the grid of medium resolution. Shifted samples and a wrong pixel
    // width are visible only at full resolution, so they are measured in the central crop.
    let level = if last.behaviour.is_shifted() || last.is_filtered() {
        judge.central_crop()
    } else {
        &judge.middle
    };
    let judged = |candidate: &Candidate| judge.judged(candidate, level);
    let noise = judged(last).map_or(0.0, |last| last.score.noise);
    let beyond = |candidate: &Candidate| {
        judged(candidate).map_or(0.0, |found| (found.score.squares - noise).max(0.0))
    };
    let shown = judge.predicted(last, &judge.fine);
    let gain = shown.map_or(1.0, |shown| shown.gain);
    let gain = short(significant(gain, 3));
    let mut before = Candidate::correct(scene);
    let all = beyond(&before).max(1e-12);
    let mut left = all;
    let mut mistakes = Vec::new();
    let is_size = |mistake: &&Mistake| mistake.is_size() && last.has_parallel_rays();
    let (sizes, mut others): (Vec<&Mistake>, Vec<_>) = last.mistakes.iter().partition(is_size);
    // Adds the mistakes to a correct program one by one. Each time, adds the mistake that leaves
    // the least difference from the picture. The order matters, because one mistake may hide the
    // effect of another.
    while !others.is_empty() {
        let with = |(at, mistake): (usize, &&Mistake)| {
            let mut after = before.with((*mistake).clone())?;
            if after.has_parallel_rays() && !before.has_parallel_rays() {
                let mut sizes = sizes.iter();
                after = sizes.try_fold(after, |after, &size| after.with(size.clone()))?;
            }
            Some((beyond(&after), at, after))
        };
        let with = others.iter().enumerate().filter_map(with);
        let Some((now, at, after)) = with.min_by(|one, other| one.0.total_cmp(&other.0)) else {
            break;
        };
        let mistake = others.remove(at);
        let has_own_size = mistake.id() == PARALLEL && !sizes.is_empty();
        let mut set = parameters::arguments(&before.scene, &after.scene);
        let mut message = mistake.message(scene);
        if has_own_size {
            set.clear();
            message = PARALLEL_OF_OWN_SIZE.to_owned();
        }
        if let (Mistake::Row(..), [_]) = (mistake, &set[..])
            && let [changed] = &parameters::changed(&before.scene, &after.scene)[..]
            && let Some(should) = changed.value(&before.scene)
            && let Some(is) = changed.value(&after.scene)
        {
            message = format!("{message}: {is} instead of {should}");
        }
        if message.contains(GAIN) && gain == "1" {
            // The estimated factor rounds to 1, so no scaling of light is reported.
            (left, before) = (now, after);
            continue;
        }
        let equivalent =
            (is_explained && !has_own_size).then(|| equivalent_rows(judge, last, mistake));
        for other in equivalent.iter().flatten() {
            let other = other.message(scene);
            message = format!("{message}; or, in a picture like this, {other}");
        }
        mistakes.push(NamedMistake {
            id: mistake.id(),
            object: mistake.object(),
            message: message.replace(GAIN, &gain),
            help: mistake.help(scene),
            set,
            explains: ((left - now) / all).clamp(0.0, 1.0),
        });
        (left, before) = (now, after);
    }
    mistakes
}

/// Returns the verdict for a hypothesis with mistakes. If the mistakes together explain the picture
/// and are plausible, they are named. Otherwise, they are reported as guesses.
fn with_mistakes(judge: &Judge, found: &JudgedCandidate, is_explained: bool) -> Verdict {
    let (scene, last) = (judge.scene, found.candidate());
    let mut mistakes = attributed(judge, last, is_explained);
    let square = |candidate: &Candidate| {
        let shown = judge.predicted(candidate, &judge.fine);
        shown.map_or(f64::INFINITY, |shown| shown.unexplained_errors().square())
    };
    let correct = Candidate::correct(scene);
    let rest = (!is_explained).then(|| square(last) / square(&correct));
    let mut rest = rest.filter(|rest| *rest > 0.0).map(|rest| rest.min(1.0));
    let explains = |mistake: &NamedMistake| mistake.explains >= LEAST_EXPLAINED;
    if !is_explained || mistakes.iter().any(explains) {
        mistakes.retain(explains);
    }
    let is_certain = is_explained && !is_made_up(last) && !is_slight(scene, last, &mistakes);
    let is_named = is_certain && !mistakes.is_empty();
    let (kind, mistakes, guesses) = if is_named {
        (Kind::Wrong, mistakes, Vec::new())
    } else if is_explained && mistakes.is_empty() {
        (Kind::Noise, mistakes, Vec::new())
    } else if rest.is_some_and(|rest| rest > USELESS_REST) {
        rest = None;
        (Kind::Unknown, Vec::new(), Vec::new())
    } else {
        (Kind::Unknown, Vec::new(), mistakes)
    };
    // Named mistakes say which objects are wrong. Guesses do not explain the picture. So if only
    // guesses are reported, the objects are compared with the correct scene.
    let known = if is_named { last } else { &correct };
    let (mut objects, is_background_right) = objects::judged(judge, known);
    for object in mistakes.iter().filter_map(|mistake| mistake.object) {
        objects[object].is_right = false;
    }
    Verdict {
        samples: found.score.samples,
        rest,
        mistakes,
        guesses,
        objects,
        is_background_right,
        ..Verdict::without_mistakes(kind, scene)
    }
}

/// Returns whether all mistakes in `named` are wrong numbers that hardly move anything in the
/// picture. Nobody types such numbers. More likely, the samples are not centred in their pixels,
/// and the wrong numbers have the same effect. Mistakes of `candidate` that are not in `named` are
/// ignored.
fn is_slight(scene: &Scene, candidate: &Candidate, named: &[NamedMistake]) -> bool {
    let is_named = |mistake: &&Mistake| {
        let mut named = named.iter();
        named.any(|one| (one.id, one.object) == (mistake.id(), mistake.object()))
    };
    // A wrong near or far plane displaces nothing, but cuts objects off. So it is never treated as
    // slight.
    let is_place = |mistake: &Mistake| match mistake {
        Mistake::Numbers(parameter, _) => {
            !parameter.is_color() && !matches!(parameter.fields[..], ["near" | "far"])
        }
        _ => false,
    };
    let mut objects = 0..scene.objects.len();
    candidate.mistakes.iter().filter(is_named).all(is_place)
        && objects.all(|object| objects::off(scene, &candidate.scene, object) < LEAST_DISPLACEMENT)
}

/// Returns whether at least [`IMPLAUSIBLE_FIELDS`] fields of one object are wrong in the
/// hypothesis. More likely, the program has a wrong formula for this object, and the wrong fields
/// happen to have the same effect.
fn is_made_up(candidate: &Candidate) -> bool {
    let mistakes = candidate.mistakes.iter();
    let numbers = mistakes.filter(|mistake| matches!(mistake, Mistake::Numbers(..)));
    let objects: Vec<usize> = numbers.filter_map(Mistake::object).collect();
    let count = |object: &usize| objects.iter().filter(|other| *other == object).count();
    objects
        .iter()
        .any(|object| count(object) >= IMPLAUSIBLE_FIELDS)
}

/// Returns other mistakes that also explain the picture, so that the picture alone cannot tell
/// which one the program makes. They are other rows of the table of mistakes with the same
/// identifier. Rows that are visible only weakly or only at edges are left out.
fn equivalent_rows(judge: &Judge, candidate: &Candidate, mistake: &Mistake) -> Vec<Mistake> {
    let Mistake::Row(row, object) = mistake else {
        return Vec::new();
    };
    let rows = mistakes::ROWS.iter().chain(mistakes::OBJECT_ROWS);
    // A program that multiplies light by a factor and one that multiplies bytes by a factor can
    // make almost the same JPEG. So each of these two mistakes is tried in place of the other,
    // although their identifiers differ.
    let [gain, of_bytes] = ["not_divided", "bytes_scaled"];
    let is_alike = |id: &str| {
        id == row.id || [gain, of_bytes].contains(&id) && [gain, of_bytes].contains(&row.id)
    };
    let others = rows.filter(|other| is_alike(other.id) && **other != **row);
    let others = others.filter(|other| other.shows == Shows::InAreas);
    let others = others.map(|other| Mistake::Row(other, *object));
    let explains = |other: &Mistake| {
        let mut mistakes = candidate.mistakes.clone();
        for one in mistakes.iter_mut().filter(|one| one.is_same_kind(mistake)) {
            *one = other.clone();
        }
        let replaced = Candidate::of(judge.scene, mistakes);
        replaced.is_some_and(|replaced| judge.explains(&replaced))
    };
    others.filter(explains).collect()
}
