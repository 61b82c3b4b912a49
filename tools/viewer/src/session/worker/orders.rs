//! What a session is told about its graphs: other ones, other settings, changed files, resources to look at.

use super::{Desk, Worker};
use crate::{
    Recipe,
    session::{
        Side,
        build::{Built, Order, Refused, files_of},
        guard::guard,
        message::{Inbox, Watch},
    },
};
use aquifer_graph::{Contracts as _, Graph, Value};
use aquifer_lab::watch::{Watch as FileWatch, Watched as WatchedFiles};
use std::collections::BTreeSet;

impl Worker {
    /// Other settings, or another graph.
    pub(super) fn change(&mut self, side: usize, recipe: Recipe) {
        if let Some(desk) = self.desks.get_mut(side) {
            let old = std::mem::replace(&mut desk.recipe, recipe.clone());
            self.board.post(|board| board.sides[side].recipe = recipe);
            if !self.change_live(side, &old) {
                self.order(side);
            }
        } else if self.desks.len() < 2 {
            self.desks.push(Desk::new(recipe.clone()));
            self.board.post(|board| board.sides.push(Side { recipe, ..Side::default() }));
            self.order(self.desks.len() - 1);
        }
    }

    /// Where only live parameters differ, they are set: nothing needs to be compiled.
    pub(super) fn change_live(&mut self, side: usize, old: &Recipe) -> bool {
        let (desk, workshop) = (&mut self.desks[side], &self.workshop);
        let keys = changed(old, &desk.recipe);
        let Some(live) = desk.live.as_mut().filter(|_| !desk.builds && old.graph == desk.recipe.graph) else { return false };
        if !keys.iter().all(|key| live_param(&live.shown().graph, key).is_some()) {
            return false;
        }
        let outcome = workshop.checked(&desk.recipe).map_err(|faults| faults.to_string()).and_then(|graph| {
            for (pass, name, value) in keys.iter().filter_map(|key| live_param(&graph, key)) {
                live.set(pass, name, value).map_err(|error| error.to_string())?;
            }
            live.show(graph);
            Ok(())
        });
        let (shown, fault) = (live.shown().clone(), outcome.err());
        self.board.post(|board| (board.sides[side].shown, board.sides[side].fault) = (Some(shown), fault));
        self.begin_anew();
        true
    }

    pub(super) fn close(&mut self) {
        self.desks.truncate(1);
        self.board.post(|board| board.sides.truncate(1));
        self.scale.look_again();
        self.begin_anew();
    }

    /// Asks for what a side's recipe says; while one order is at work, only the newest of the others waits.
    pub(super) fn order(&mut self, side: usize) {
        let desk = &mut self.desks[side];
        let order = Order {
            side,
            recipe: desk.recipe.clone(),
            size: self.scale.size(),
            keep: desk.watch.iter().map(|watch| watch.resource.clone()).collect(),
            reservoirs: self.inspected.is_some(),
        };
        if desk.builds {
            desk.next = Some(order);
        } else {
            desk.builds = true;
            let (workshop, outbox) = (self.workshop.clone(), self.outbox.clone());
            std::thread::spawn(move || {
                let outcome = guard(|| workshop.make(&order)).unwrap_or_else(|words| Err(Refused::Panic(words)));
                // Nobody listens when the session has ended.
                let _ = outbox.send(Inbox::Built(Box::new(Built { order, outcome })));
            });
        }
        self.board.post(|board| board.sides[side].building = true);
    }

    pub(super) fn adopt(&mut self, Built { order, outcome }: Built) {
        let side = order.side;
        let Some(desk) = self.desks.get_mut(side) else { return };
        desk.builds = false;
        let superseded = desk.next.take().is_some();
        let fault = match outcome {
            Ok(mut live) => {
                desk.suspects.clear();
                let fits = live.size() == self.scale.size();
                let resized = if fits { Ok(()) } else { live.resize(self.scale.size()) };
                let shown = live.shown().clone();
                desk.live = Some(live);
                self.board.post(|board| board.sides[side].shown = Some(shown));
                self.scale.look_again();
                self.begin_anew();
                resized.err().map(|error| error.to_string())
            }
            Err(refused) => {
                desk.suspects = refused.files();
                Some(refused.to_string())
            }
        };
        self.board.post(|board| {
            board.sides[side].building = superseded;
            board.sides[side].fault = fault;
        });
        self.follow_files();
        if superseded {
            self.order(side);
        }
    }

    pub(super) fn follow_files(&mut self) {
        let of_graph = |desk: &Desk| desk.live.as_ref().map_or_else(Vec::new, |live| files_of(live.shown().graph.sources().iter()));
        let files = self.desks.iter().flat_map(|desk| [of_graph(desk), desk.suspects.clone()].concat()).collect();
        let watched = WatchedFiles { files, folders: self.workshop.shaders.clone() };
        if let Some(Err(error)) = self.files.as_mut().map(|files| files.follow(&watched)) {
            tracing::warn!(%error, "no hot reload");
        }
    }

    /// Reads graphs and shaders anew when they have changed.
    pub(super) fn look_after_files(&mut self) {
        if !self.files.as_ref().is_some_and(FileWatch::changed) {
            return;
        }
        match self.workshop.reload() {
            Ok(()) => {
                let slots = self.workshop.registry.slots();
                self.board.post(|board| board.slots = slots);
                (0..self.desks.len()).for_each(|side| self.order(side));
            }
            Err(words) => {
                self.board.post(|board| board.sides.iter_mut().for_each(|side| side.fault = Some(words.clone())));
            }
        }
    }

    pub(super) fn watch(&mut self, side: usize, watch: Option<Watch>) {
        let Some(desk) = self.desks.get_mut(side) else { return };
        desk.watch = watch;
        let missing = desk.watch.as_ref().is_some_and(|watch| desk.live.as_ref().is_none_or(|live| !live.keeps(&watch.resource)));
        if desk.watch.is_none() {
            self.board.post(|board| board.sides[side].watched = None);
        }
        if missing {
            self.order(side);
        }
    }

    pub(super) fn inspect(&mut self, pixel: Option<[f32; 2]>) {
        let began = self.inspected.is_none() && pixel.is_some();
        self.inspected = pixel;
        if began {
            // Reservoirs must be kept from now on.
            (0..self.desks.len()).for_each(|side| self.order(side));
        }
        self.post_records();
    }
}

/// Keys whose settings differ.
fn changed(old: &Recipe, new: &Recipe) -> BTreeSet<String> {
    let only = |a: &Recipe, b: &Recipe| {
        a.settings.iter().filter(|setting| !b.settings.contains(setting)).map(|(key, _)| key.clone()).collect::<Vec<_>>()
    };
    only(old, new).into_iter().chain(only(new, old)).collect()
}

/// The live parameter that a key means, if it means one: pass, name and value.
fn live_param<'a>(graph: &'a Graph, key: &'a str) -> Option<(&'a str, &'a str, Value)> {
    let (pass, name) = key.split_once('.')?;
    let node = graph.nodes().iter().find(|node| node.pass == pass)?;
    let param = node.contract.params.iter().find(|param| param.name == name && param.live)?;
    Some((pass, name, *node.params.get(&param.name)?))
}
