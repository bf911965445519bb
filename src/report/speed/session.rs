//! Times renders, and compares them with the exact picture.
//!
//! The exact picture is rendered first, since all errors are differences from it. This render is
//! not timed, but warms up the caches and the processor. Then the methods are timed in several
//! rounds. In each round, every method renders once with every number of samples. If the user does
//! not choose these numbers, they are 1, 4, 16 and 64. Higher powers of 4 follow as long as two
//! conditions hold: there is time for a few rounds with the next number, and the error of some
//! method is still above the smallest requested error. After the first round, the order of the
//! renders is shuffled, so that other load on the machine affects all methods alike.
//!
//! A timed render starts with the scene in memory and ends with the picture in memory. It includes
//! preparing the objects and the samples, and starting the threads. Reading the scene, comparing
//! pictures and encoding them are not timed.

use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use rand::seq::SliceRandom;

use super::{
    machine::Machine,
    mixture::Mixture,
    results::{MeasuredScene, Measurement, MethodPicture, MethodSeries, Request, Run, SeriesPoint},
};
use crate::{
    area::Area,
    film::{self, Film, TooLarge},
    render::{Control, RenderError, Rendered, render_as_asked, render_exact},
    sampling::{Sampling, rng::Key},
    scene::{Count, Method, Sampler, Scene},
    threads,
    tracer::World,
};

/// Minimum and maximum length of the series 1, 4, 16, … of samples per pixel, if the user does not
/// choose the numbers. Slopes are fitted to the last three numbers, so four numbers are needed to
/// exclude one sample per pixel, whose error is untypical. The maximum allows up to 4^9 samples per
/// pixel, but the time limit usually ends the series earlier.
const RUNGS: (usize, usize) = (4, 10);

/// Usual and maximum number of runs of each render, if the user does not choose the number. More
/// samples are added to the series only if there is time for the usual number of runs. With three
/// runs, the median ignores a run that other load on the machine delayed. With more than nine, the
/// report would take longer for hardly better medians.
const RUNS: (u64, u64) = (3, 9);

/// Approximate number of samples per pixel with which the slowest method renders its picture for
/// the comparison on the page. The other methods get the same CPU time. With 16, noise is still
/// visible, and so are the differences between the methods.
const SHOWN: u64 = 16;

/// Makes the measurement that the request describes. After each timed render, calls `progress` with
/// the fraction of the work that is done. The progress callback in `control` is not called. If the
/// user cancels the measurement, returns the results so far, marked as interrupted.
///
/// # Errors
///
/// Fails if the user cancels before the exact picture is done, if there is not enough memory, or if
/// no thread can be started.
pub fn measure(
    subject: &MeasuredScene,
    scene: &Scene,
    request: &Request,
    control: &Control,
    progress: &dyn Fn(f64),
) -> Result<Measurement, RenderError> {
    let started = Instant::now();
    let control = &Control {
        progress: &|_| {},
        ..*control
    };
    let reference = {
        let world = World::new_unless(scene, control.cancel)?;
        render_exact(&world, world.picture(), control)?
    };
    let methods = Method::SAMPLED.into_iter();
    let series = methods.filter(|method| request.methods.contains(method));
    let series = series.map(|method| MethodSeries {
        method,
        points: Vec::new(),
        picture: None,
    });
    let mut samples = request.samples.clone();
    samples.sort_unstable();
    samples.dedup();
    let measured = Measurement {
        subject: subject.clone(),
        machine: Machine::here(),
        threads: threads::available(),
        seed: scene.sampler.seed,
        rungs: Vec::new(),
        errors: request.errors.clone(),
        exact: (request.methods.contains(&Method::Exact)).then(Vec::new),
        series: series.collect(),
        reference,
        mixture: Mixture::of(scene),
        interrupted: false,
    };
    let mut session = Benchmark {
        scene,
        request,
        samples,
        control,
        progress,
        started,
        measured,
    };
    match session.run() {
        Err(RenderError::Cancelled) => session.measured.interrupted = true,
        done => done?,
    }
    let mut measured = session.measured;
    measured.series.retain(|series| !series.points.is_empty());
    measured.exact = measured.exact.filter(|runs| !runs.is_empty());
    Ok(measured)
}

/// A measurement that is being made.
struct Benchmark<'a> {
    scene: &'a Scene,
    request: &'a Request,
    /// Numbers of samples that the user chose, in ascending order and without duplicates.
    samples: Vec<u64>,
    control: &'a Control<'a>,
    progress: &'a dyn Fn(f64),
    started: Instant,
    measured: Measurement,
}

/// A render in a round: the index of the method and the index of the number of samples. `None`
/// stands for the exact method.
type Task = Option<(usize, usize)>;

impl Benchmark<'_> {
    fn run(&mut self) -> Result<(), RenderError> {
        self.first_round()?;
        let first = self.started.elapsed();
        let series = 0..self.measured.series.len();
        let points = 0..self.measured.rungs.len();
        let sampled = series.flat_map(|series| points.clone().map(move |point| (series, point)));
        let mut tasks: Vec<Task> = [None].into_iter().chain(sampled.map(Some)).collect();
        for round in 1..self.request.runs.unwrap_or(RUNS.1) {
            let has_time = self.started.elapsed() + first <= self.request.budget;
            if self.request.runs.is_none() && !has_time {
                break;
            }
            // The random order depends only on the number of the round. So it is the same in every
            // measurement with these tasks.
            tasks.shuffle(&mut Key::new(round, 0).rng());
            for &task in &tasks {
                self.render(task, round)?;
            }
        }
        self.pictures()
    }

    /// Makes the first round: renders once by the exact method, and once by every sampling method
    /// with every number of samples. If the user chose no numbers, uses 1, 4, 16, …, as long as
    /// there is time.
    fn first_round(&mut self) -> Result<(), RenderError> {
        self.render(None, 0)?;
        if self.measured.series.is_empty() {
            return Ok(());
        }
        let is_open = self.samples.is_empty();
        let asked = if is_open {
            (0..RUNGS.1).map(|power| 1 << (2 * power)).collect()
        } else {
            self.samples.clone()
        };
        let mut before = Duration::ZERO;
        for (point, per_pixel) in asked.into_iter().enumerate() {
            let started = Instant::now();
            self.measured.rungs.push(per_pixel);
            for series in 0..self.measured.series.len() {
                self.render(Some((series, point)), 0)?;
            }
            let last = started.elapsed();
            // A render is assumed to take a constant time plus a time proportional to the number of
            // samples. Each number is four times the one before. So the time increases by four
            // times its last increase.
            let next = last + 4 * last.saturating_sub(before);
            if is_open && !self.goes_on(next) {
                break;
            }
            before = last;
        }
        Ok(())
    }

    /// Returns whether to continue with four times as many samples. `next` is the estimated time
    /// for one render by each method with this number. The minimum length of the series in
    /// [`RUNGS`] is always measured. Then, the series continues only if there is time for all runs,
    /// and if a method's error is still above the smallest requested error.
    fn goes_on(&self, next: Duration) -> bool {
        let least = self.request.errors.iter().copied().fold(1.0, f64::min);
        let error = |series: &MethodSeries| Some(series.points.last()?.typical().error);
        let mut errors = self.measured.series.iter().filter_map(error);
        let round = (self.started.elapsed() + next).as_secs_f64();
        let all = round * self.request.runs.unwrap_or(RUNS.0) as f64;
        let has_time = all <= self.request.budget.as_secs_f64();
        self.measured.rungs.len() < RUNGS.0 || (has_time && errors.any(|error| error > least))
    }

    fn render(&mut self, task: Task, round: u64) -> Result<(), RenderError> {
        let measured = &mut self.measured;
        if let Some((series, point)) = task {
            let per_pixel = measured.rungs[point];
            // Each run has its own seed, which also depends on the number of samples. So the errors
            // of different runs are independent.
            let seed = Key::new(measured.seed, per_pixel).bits(round) >> 11;
            let series = &mut measured.series[series];
            let samples = [per_pixel, seed];
            let (made, run) = timed(|| rendered(self.scene, series.method, samples, self.control))?;
            if series.points.len() == point {
                let runs = Vec::new();
                series.points.push(SeriesPoint { per_pixel, runs });
            }
            let error = error_of(made.film(), &measured.reference.film);
            series.points[point].runs.push(Run { error, ..run });
        } else if let Some(runs) = &mut measured.exact {
            let (_, run) = timed(|| rendered(self.scene, Method::Exact, [1, 0], self.control))?;
            runs.push(run);
        } else {
            return Ok(());
        }
        self.report_progress();
        Ok(())
    }

    /// Renders the pictures by which the page compares the sampling methods. All renders take about
    /// the same CPU time: the time of the slowest method with about [`SHOWN`] samples per pixel. Of
    /// each picture, only a small area is stored, which is the same for all methods.
    fn pictures(&mut self) -> Result<(), RenderError> {
        let measured = &mut self.measured;
        let Some(last) = measured.rungs.len().checked_sub(1) else {
            return Ok(());
        };
        let enough = measured.rungs.iter().position(|&rung| rung >= SHOWN);
        let rung = enough.unwrap_or(last);
        let time = |it: &MethodSeries| it.points[rung].typical().cpu;
        let cpu = measured.series.iter().map(time).fold(0.0, f64::max);
        let mut part = None;
        for series in &mut measured.series {
            let Some(per_pixel) = series.samples_in(cpu) else {
                continue;
            };
            let samples = [per_pixel, measured.seed];
            let (made, run) = timed(|| rendered(self.scene, series.method, samples, self.control))?;
            let (film, reference) = (made.film(), &measured.reference.film);
            let part = match part {
                Some(part) => part,
                None => *part.insert(worst_part(&World::new(self.scene), film, reference)?),
            };
            series.picture = Some(MethodPicture {
                per_pixel,
                cpu: run.cpu,
                rmse: error_of(film, reference),
                part,
                film: film.part(part)?,
            });
        }
        Ok(())
    }

    /// Reports the progress as the fraction of the samples that are done. If the total number of
    /// samples is not known beforehand, reports the fraction of the time budget that has passed.
    fn report_progress(&self) {
        let measured = &self.measured;
        let share = match self.request.runs {
            Some(runs) if !self.samples.is_empty() => {
                let points = measured.series.iter().flat_map(|series| &series.points);
                let done = points.map(|it| it.per_pixel as f64 * it.runs.len() as f64);
                let asked = self.samples.iter().map(|&rung| rung as f64);
                let all = asked.sum::<f64>() * (runs * measured.series.len() as u64) as f64;
                done.sum::<f64>() / all
            }
            _ => self.started.elapsed().as_secs_f64() / self.request.budget.as_secs_f64(),
        };
        (self.progress)(share.min(1.0));
    }
}

/// Returns the root mean square of a picture's differences from the exact picture.
fn error_of(film: &Film, reference: &Film) -> f64 {
    film::rmse(film, reference).expect("pictures of one scene have one size")
}

/// Renders the scene with the given method, samples per pixel and seed. The exact method ignores
/// the number of samples and the seed.
fn rendered(
    scene: &Scene,
    method: Method,
    [per_pixel, seed]: [u64; 2],
    control: &Control,
) -> Result<Rendered, RenderError> {
    let sampler = Sampler {
        method,
        count: Count::PerPixel(per_pixel),
        seed,
    };
    let world = World::new_unless(scene, control.cancel)?;
    let sampling = Sampling::new(&sampler, scene.image.width, scene.image.height);
    render_as_asked(&world, &sampling, world.picture(), control)
}

/// Maximum width and height, in pixels, of the area in which the page compares the methods. Several
/// magnified areas must fit beside each other on the page. A smaller area would show fewer edges.
const PART: (u32, u32) = (48, 27);

/// Minimum fraction of an area's pixels that must show something else than the area's most frequent
/// object (or the background, if this is more frequent). If the fraction is smaller, the area is
/// treated as having no edge, and other areas are preferred for comparing the methods. With a
/// quarter, an edge runs near the middle of the area rather than through a corner.
const OTHER_OBJECT: f64 = 0.25;

/// Returns the area in which the page compares the methods. Prefers areas that show an edge between
/// objects and no background, and then other areas with an edge. Among equally preferred areas,
/// returns the one with the greatest error. Neighbouring areas overlap by half.
fn worst_part(world: &World, film: &Film, exact: &Film) -> Result<Area, TooLarge> {
    let whole = world.picture();
    let (width, height) = (whole.width.min(PART.0), whole.height.min(PART.1));
    let objects: Vec<_> = whole.iter().map(|(x, y)| world.object_at(x, y)).collect();
    let places = |length: u32, size: u32| {
        let last = length - size;
        (0..last).step_by((size / 2).max(1) as usize).chain([last])
    };
    let (mut worst, mut most) = (Area::whole(width, height), (0, 0.0));
    for y in places(whole.height, height) {
        for x in places(whole.width, width) {
            let part = Area { x, y, ..worst };
            let error = error_of(&film.part(part)?, &exact.part(part)?);
            let mut seen: Vec<_> = part
                .iter()
                .map(|(x, y)| objects[whole.index(x, y)])
                .collect();
            seen.sort_unstable();
            let has_no_sky = seen[0].is_some();
            let runs = seen.chunk_by(|a, b| a == b).map(<[_]>::len);
            let others = seen.len() - runs.max().unwrap_or(0);
            let has_edge = error > 0.0 && others as f64 >= OTHER_OBJECT * seen.len() as f64;
            let rank = u8::from(has_edge) + u8::from(has_edge && has_no_sky);
            if (rank, error) > most {
                (worst, most) = (part, (rank, error));
            }
        }
    }
    Ok(worst)
}

/// Calls `work` and measures its times. The CPU time is that of the whole process, which does
/// nothing else at the same time except show a progress bar. The error in the returned run is NaN,
/// since the picture is compared with the exact one later.
fn timed<T>(work: impl FnOnce() -> Result<T, RenderError>) -> Result<(T, Run), RenderError> {
    let (cpu, wall) = (ProcessTime::try_now().ok(), Instant::now());
    let done = work()?;
    let wall = wall.elapsed().as_secs_f64();
    let cpu = cpu.and_then(|cpu| cpu.try_elapsed().ok());
    let run = Run {
        cpu: cpu.map_or(f64::NAN, |cpu| cpu.as_secs_f64()),
        wall,
        error: f64::NAN,
    };
    Ok((done, run))
}
