//! How far the pictures are from the reference, in a thread of its own: of several pictures that wait, only the newest is judged.

use super::{Shared, live::Picture, truth::Truth};
use aquifer_lab::{
    film::{Area, Film},
    metrics::{FlipMap, Metric, Pair},
};
use std::sync::{
    Arc,
    mpsc::{Receiver, Sender, channel},
};

/// Points of a curve; where there are more, every second goes.
const MOST_POINTS: usize = 400;

/// A point of an error curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Seconds spent on the picture.
    pub seconds: f64,
    /// Relative mean square error, the reference's own share taken out.
    pub rel_mse: f64,
    /// Samples a pixel.
    pub samples: u64,
}

/// Errors of one side.
#[derive(Clone, Debug, Default)]
pub struct Judged {
    /// By metric that was measured: its value over the image.
    pub metrics: Vec<(Metric, f64)>,
    /// Error against time, since the picture began.
    pub curve: Vec<Point>,
    /// HDR-FLIP of every pixel, where it was wanted.
    pub flip: Option<Arc<FlipMap>>,
}

/// Two pictures and what they are held against.
pub struct Task {
    pub pictures: Vec<Option<Arc<Picture>>>,
    pub truth: Arc<Truth>,
    pub flip: bool,
}

/// Begins to judge what is sent; ends when nobody can send any more.
pub fn start(board: Arc<Shared>) -> Sender<Task> {
    let (sender, tasks) = channel();
    std::thread::spawn(move || judge(&board, &tasks));
    sender
}

fn judge(board: &Shared, tasks: &Receiver<Task>) {
    let mut curves: Vec<Vec<Point>> = Vec::new();
    let mut before: Option<Arc<Truth>> = None;
    while let Ok(task) = tasks.recv() {
        let task = tasks.try_iter().last().unwrap_or(task);
        if before.replace(task.truth.clone()).is_none_or(|before| !Arc::ptr_eq(&before, &task.truth)) {
            curves.clear();
        }
        curves.resize(task.pictures.len(), Vec::new());
        for (side, picture) in task.pictures.iter().enumerate() {
            let judged = picture.as_ref().and_then(|picture| one(picture, &task, &mut curves[side])).map(Arc::new);
            board.post(|board| {
                // What was withdrawn meanwhile stays so.
                let stands = board.truth.as_ref().is_some_and(|truth| truth.about == task.truth.about);
                if let Some(side) = board.sides.get_mut(side).filter(|_| stands) {
                    side.judged = judged;
                }
            });
        }
    }
}

/// Errors of a picture; `None` where the reference is of something else.
fn one(picture: &Picture, task: &Task, curve: &mut Vec<Point>) -> Option<Judged> {
    if picture.transport != task.truth.about.transport {
        curve.clear();
        return None;
    }
    let pair = Pair::new(&picture.film, &task.truth.film).ok()?;
    let area = Area::whole(picture.film.size);
    let value = |metric: Metric| Some((metric, pair.measure(metric, &area).ok()??.value));
    let mut wanted = vec![Metric::RelMse, Metric::Mse, Metric::Mape];
    wanted.extend(task.flip.then_some(Metric::FlipHdr));
    let metrics: Vec<(Metric, f64)> = wanted.into_iter().filter_map(value).collect();
    let rel_mse = metrics.iter().find(|(metric, _)| *metric == Metric::RelMse)?.1;
    extend(curve, Point { seconds: picture.spent * 1e-3, rel_mse, samples: picture.samples });
    let flip = if task.flip { pair.flip_hdr().cloned().map(Arc::new) } else { None };
    Some(Judged { metrics, curve: curve.clone(), flip })
}

/// A picture that has cost less than the one before has begun anew.
fn extend(curve: &mut Vec<Point>, point: Point) {
    if curve.last().is_some_and(|last| last.seconds > point.seconds) {
        curve.clear();
    }
    if curve.last().is_none_or(|last| last.seconds < point.seconds) {
        curve.push(point);
    }
    if curve.len() > MOST_POINTS {
        let mut index = 0;
        curve.retain(|_| {
            index += 1;
            index % 2 == 1
        });
    }
}

/// |a − b| in every channel.
pub fn difference(a: &Film, b: &Film) -> Option<Film> {
    let apart = |(a, b): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|channel| (a[channel] - b[channel]).abs());
    (a.size == b.size).then(|| Film { size: a.size, color: a.color.iter().zip(&b.color).map(apart).collect(), ..Film::default() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_grow_stay_short_and_begin_anew() {
        let point = |seconds: f64| Point { seconds, rel_mse: 1.0 / seconds, samples: 1 };
        let mut curve = Vec::new();
        (1..=2000).for_each(|at| extend(&mut curve, point(f64::from(at))));
        assert!(curve.len() <= MOST_POINTS && curve.len() >= MOST_POINTS / 2);
        assert_eq!(curve.first().map(|point| point.seconds), Some(1.0), "the beginning stays");
        assert!(curve.windows(2).all(|pair| pair[0].seconds < pair[1].seconds));
        extend(&mut curve, point(0.5));
        assert_eq!(curve, [point(0.5)]);
    }

    #[test]
    fn differences_have_no_sign_and_one_size() {
        let film = |value: f32, width: u32| Film::new([width, 1], vec![[value; 3]; width as usize]).unwrap();
        assert_eq!(difference(&film(0.25, 2), &film(1.0, 2)).unwrap().color, [[0.75; 3]; 2]);
        assert!(difference(&film(0.25, 2), &film(1.0, 3)).is_none());
    }
}
