//! What a session puts on its board: pictures, times, records, and the reference that they are held against.

use super::Worker;
use crate::session::{
    judge::Task,
    live::Live,
    message::Moment,
    truth::{self, About, News, Wish},
};
use std::{sync::Arc, time::Duration};

impl Worker {
    pub(super) fn post_pictures(&mut self) {
        let frames = self.turns.frames();
        let Some(moment) = self.moment.clone() else { return };
        let mut done = Vec::new();
        for desk in &mut self.desks {
            let picture = desk.live.as_ref().and_then(|live| live.picture(&moment, self.updates)).map(Arc::new);
            if picture.is_some() && !std::mem::replace(&mut desk.announced, true) {
                tracing::info!("first picture of {} after {:.2} s", ["A", "B"][done.len()], self.began.elapsed().as_secs_f64());
            }
            let times = desk.live.as_ref().map(Live::times);
            let watched = match (&desk.watch, desk.live.as_mut()) {
                (Some(watch), Some(live)) if live.keeps(&watch.resource) => live.watched(watch).map(Arc::new),
                _ => None,
            };
            done.push((picture, times, watched));
        }
        let (updates, update) = (self.updates, Duration::from_secs_f64(self.update.max(0.0)));
        let pictures = self.board.post(|board| {
            (board.updates, board.update, board.moment) = (updates, update, Some(moment));
            for ((side, (picture, times, watched)), frames) in board.sides.iter_mut().zip(done).zip(frames) {
                side.picture = picture.or(side.picture.take());
                side.times = times.unwrap_or_default();
                side.frames = frames;
                side.spent = side.picture.as_ref().map_or(0.0, |picture| picture.spent);
                side.watched = watched;
            }
            board.sides.iter().map(|side| side.picture.clone()).collect()
        });
        self.post_records();
        if let Some(truth) = self.truth.clone() {
            // The judge ends with the session.
            let _ = self.judge.send(Task { pictures, truth, flip: self.flip });
        }
    }

    pub(super) fn post_records(&mut self) {
        let Some(place) = self.inspected else {
            return self.board.post(|board| board.sides.iter_mut().for_each(|side| side.records = Arc::default()));
        };
        let size = self.scale.size();
        let pixel = [0, 1].map(|axis| ((place[axis] * size[axis] as f32) as u32).min(size[axis] - 1));
        let records: Vec<_> = self.desks.iter().map(|desk| desk.live.as_ref().map_or_else(Vec::new, |live| live.records(pixel))).collect();
        self.board.post(|board| {
            for (side, records) in board.sides.iter_mut().zip(records) {
                side.records = Arc::new(records);
            }
        });
    }

    pub(super) fn hear(&mut self, news: News) {
        match news {
            News::Better(truth) => {
                self.truth = Some(truth.clone());
                self.board.post(|board| board.truth = Some(truth));
            }
            News::State(words) => self.board.post(|board| board.truth_state = words),
        }
    }

    /// Sees to it that there is a reference of what is rendered, if one is wanted.
    pub(super) fn wish_truth(&mut self) {
        let Some(goal) = self.goal else { return };
        let transport = self.desks.iter().find_map(|desk| Some(desk.live.as_ref()?.shown().graph.transport()));
        let about = match (&self.moment, transport) {
            (Some(Moment { name: Some(camera), time, .. }), Some(transport)) if !self.plays => {
                Some(About { camera: camera.clone(), time: *time, size: self.scale.size(), transport })
            }
            _ => None,
        };
        if about != self.truth.as_ref().map(|truth| truth.about.clone()) && self.truth.take().is_some() {
            self.board.post(|board| {
                board.truth = None;
                board.sides.iter_mut().for_each(|side| side.judged = None);
            });
        }
        let wished = about.map(|about| (about, goal));
        if wished == self.wished {
            return;
        }
        self.making = None;
        self.wished = wished.clone();
        let words =
            if wished.is_some() { "looking for the reference" } else { "references are of the scene's cameras, while nothing moves" };
        self.board.post(|board| board.truth_state = words.to_owned());
        self.making = wished.map(|(about, goal)| {
            let wish = Wish {
                about,
                goal,
                content: self.content.clone(),
                environment: self.environment.clone(),
                shaders: self.workshop.shaders.clone(),
                cache: self.cache.clone(),
                version: self.version.clone(),
            };
            truth::make(self.workshop.clone(), wish, self.outbox.clone())
        });
    }
}
