//! The pictures, and what the mouse does on them.

use super::{
    Viewer,
    state::{Layout, SIDE_COLORS, SIDE_NAMES, Show, Tab, Zoom},
};
use crate::{
    session::Message,
    testimony::{self, TESTIMONY, Tried},
};
use eframe::egui::{self, Align2, Color32, CornerRadius, FontId, Pos2, Rect, RichText, Sense, Stroke, StrokeKind, Vec2, pos2, vec2};

/// Points around the split line in which it can be taken.
const GRIP: f32 = 6.0;
/// Of the inspector.
const MARK: Color32 = Color32::from_rgb(255, 60, 160);
/// Pixels across the loupe.
const LOUPE: i32 = 9;
/// Points of one of them.
const LOUPE_PIXEL: f32 = 14.0;
/// The largest zoom: a pixel fills the stage.
const LARGEST_ZOOM: f32 = 256.0;
/// Points that one notch of the wheel scrolls.
const NOTCH: f32 = 50.0;

/// Where a side's whole picture would lie, and which part of the stage shows it.
#[derive(Clone, Copy, Debug)]
struct Cell {
    side: usize,
    picture: Rect,
    clip: Rect,
}

impl Viewer {
    pub(super) fn stage(&mut self, ui: &mut egui::Ui) {
        let area = ui.available_rect_before_wrap();
        let response = ui.interact(area, ui.scope_id().with("stage"), Sense::click_and_drag());
        ui.painter().rect_filled(area, 0.0, if ui.visuals().dark_mode { Color32::from_gray(16) } else { Color32::from_gray(200) });
        let cells = self.cells(area);
        for cell in &cells {
            self.picture(ui, *cell);
        }
        if self.splits() {
            self.split_slider(ui, cells[0].picture, area);
        }
        self.mouse(ui, &response, &cells);
        if self.state.loupe {
            self.loupe(ui, &response, &cells);
        }
        self.inspected_mark(ui, &cells);
        self.remarks(ui, area);
    }

    fn splits(&self) -> bool {
        self.state.layout == Layout::Split && self.recipes.len() > 1 && self.state.show != Show::Apart
    }

    /// What is where.
    fn cells(&self, area: Rect) -> Vec<Cell> {
        let whole = |side: usize, clip: Rect| Cell { side, picture: self.place(clip), clip };
        let two = self.recipes.len() > 1 && self.state.show != Show::Apart;
        match self.state.layout {
            Layout::Beside if two => {
                let middle = area.center().x;
                let left = Rect::from_min_max(area.min, pos2(middle - 1.0, area.max.y));
                let right = Rect::from_min_max(pos2(middle + 1.0, area.min.y), area.max);
                vec![whole(0, left), whole(1, right)]
            }
            Layout::Split if two => {
                let picture = self.place(area);
                let x = picture.left() + self.state.split * picture.width();
                let left = Rect::from_min_max(area.min, pos2(x.clamp(area.left(), area.right()), area.max.y));
                let right = Rect::from_min_max(pos2(x.clamp(area.left(), area.right()), area.min.y), area.max);
                vec![Cell { side: 0, picture, clip: left }, Cell { side: 1, picture, clip: right }]
            }
            _ => vec![whole(self.state.front.min(self.recipes.len() - 1), area)],
        }
    }

    /// Where the whole picture lies, zoomed, in an area.
    fn place(&self, area: Rect) -> Rect {
        let size = self.board.sides.iter().find_map(|side| side.picture.as_ref()).map_or([16, 9], |picture| picture.film.size);
        let aspect = size[0] as f32 / size[1] as f32;
        let fitted = if area.width() > area.height() * aspect {
            vec2(area.height() * aspect, area.height())
        } else {
            vec2(area.width(), area.width() / aspect)
        };
        let Zoom { factor, centre } = self.state.zoom;
        let shown = fitted * factor;
        Rect::from_min_size(area.center() - shown * centre, shown)
    }

    fn picture(&mut self, ui: &egui::Ui, cell: Cell) {
        let painter = ui.painter().with_clip_rect(cell.clip);
        let whole = Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
        match self.images.of(ui.ctx(), &self.board, &self.state, cell.side) {
            Some((texture, _)) => {
                painter.image(texture, cell.picture, whole, Color32::WHITE);
            }
            None => {
                let words = self.board.waiting.clone().unwrap_or_else(|| "compiling …".to_owned());
                painter.text(cell.clip.center(), Align2::CENTER_CENTER, words, FontId::proportional(16.0), ui.visuals().weak_text_color());
            }
        }
        if let Some(lacks) = self.lacks(cell.side) {
            tag(&painter, cell.clip.center_bottom() - vec2(0.0, 12.0), Align2::CENTER_BOTTOM, &lacks, Color32::WHITE);
        }
        if self.recipes.len() > 1 && self.state.show != Show::Apart {
            let right = self.state.layout == Layout::Split && cell.side == 1;
            let (corner, align) = if right {
                (cell.clip.right_top() + vec2(-8.0, 8.0), Align2::RIGHT_TOP)
            } else {
                (cell.clip.left_top() + vec2(8.0, 8.0), Align2::LEFT_TOP)
            };
            let name = format!("{}  {}", SIDE_NAMES[cell.side], self.recipes[cell.side].graph);
            tag(&painter, corner, align, &name, SIDE_COLORS[cell.side]);
        }
    }

    /// Why what was asked for is not what is seen.
    fn lacks(&self, side: usize) -> Option<String> {
        let board = self.board.sides.get(side).filter(|board| board.picture.is_some())?;
        if board.watched.as_ref().is_some_and(|watched| watched.film.is_none()) {
            return Some("this resource has no number a pixel".to_owned());
        }
        if !self.state.show.wants_truth() {
            return None;
        }
        if self.board.truth.is_none() {
            return Some("there is no reference yet: the picture is shown".to_owned());
        }
        if let Some(why) = self.board.unjudged(side) {
            return Some(format!("{why}: the picture is shown"));
        }
        let measures = self.state.show == Show::Flip && board.judged.as_ref().is_none_or(|judged| judged.flip.is_none());
        measures.then(|| "FLIP is being measured".to_owned())
    }

    fn split_slider(&mut self, ui: &egui::Ui, picture: Rect, area: Rect) {
        let x = (picture.left() + self.state.split * picture.width()).clamp(area.left(), area.right());
        let grip = Rect::from_min_max(pos2(x - GRIP, area.top()), pos2(x + GRIP, area.bottom()));
        let response = ui.interact(grip, ui.scope_id().with("split"), Sense::drag());
        response.widget_info(|| egui::WidgetInfo::slider(true, f64::from(self.state.split), "split"));
        if response.hovered() || response.dragged() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::ResizeHorizontal);
        }
        if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            self.state.split = ((pointer.x - picture.left()) / picture.width()).clamp(0.0, 1.0);
        }
        let painter = ui.painter().with_clip_rect(area);
        painter.vline(x, area.y_range(), Stroke::new(3.0, Color32::from_black_alpha(120)));
        painter.vline(x, area.y_range(), Stroke::new(1.0, Color32::WHITE));
        let knob = pos2(x, area.center().y);
        painter.circle(knob, 7.0, Color32::WHITE, Stroke::new(1.5, Color32::from_gray(60)));
    }

    fn mouse(&mut self, ui: &egui::Ui, response: &egui::Response, cells: &[Cell]) {
        let Some(cell) = response.interact_pointer_pos().or(response.hover_pos()).and_then(|pointer| at(cells, pointer)) else { return };
        let (scroll, modifiers) = ui.input(|input| (input.smooth_scroll_delta.y, input.modifiers));
        let zoom = ui.input(egui::InputState::zoom_delta);
        if response.hovered() && zoom != 1.0 {
            self.zoom_at(cell, response.hover_pos().unwrap_or(cell.clip.center()), zoom);
        } else if response.hovered()
            && scroll != 0.0
            && let Some(mover) = self.mover()
        {
            mover.dolly(scroll / NOTCH);
            self.send_mover();
        }
        let drag = response.drag_delta();
        let heights: [f32; 2] = (drag / cell.picture.height() * self.state.zoom.factor).into();
        if drag != Vec2::ZERO {
            if modifiers.ctrl || modifiers.command {
                self.state.zoom.centre -= drag / cell.picture.size();
            } else if let Some(mover) = self.mover() {
                if response.dragged_by(egui::PointerButton::Secondary) {
                    mover.look(heights);
                } else if response.dragged_by(egui::PointerButton::Middle) || modifiers.shift {
                    mover.pan(heights);
                } else {
                    mover.orbit(heights);
                }
                self.send_mover();
            }
        }
        if response.clicked()
            && self.state.panel
            && self.state.tab == Tab::Inspector
            && let Some(pointer) = response.interact_pointer_pos()
        {
            let place = (pointer - cell.picture.min) / cell.picture.size();
            let inside = (0.0..1.0).contains(&place.x) && (0.0..1.0).contains(&place.y);
            self.state.inspected = inside.then(|| place.into());
            self.session.send(Message::Inspect(self.state.inspected));
        }
    }

    /// Zooms so that what is under the pointer stays there.
    fn zoom_at(&mut self, cell: Cell, pointer: Pos2, by: f32) {
        let before = self.state.zoom.factor;
        let after = (before * by).clamp(1.0, LARGEST_ZOOM);
        let place = (pointer - cell.picture.min) / cell.picture.size();
        let zoom = &mut self.state.zoom;
        zoom.centre = place + (zoom.centre - place) * (before / after);
        zoom.factor = after;
        if after == 1.0 {
            *zoom = Zoom::default();
        }
    }

    /// The pixels around the pointer, and the values under it.
    fn loupe(&mut self, ui: &egui::Ui, response: &egui::Response, cells: &[Cell]) {
        let Some(pointer) = response.hover_pos() else { return };
        let Some(cell) = at(cells, pointer) else { return };
        let Some((texture, size)) = self.images.of(ui.ctx(), &self.board, &self.state, cell.side) else { return };
        let place = (pointer - cell.picture.min) / cell.picture.size();
        if !(0.0..1.0).contains(&place.x) || !(0.0..1.0).contains(&place.y) {
            return;
        }
        let pixel = [(place.x * size[0] as f32) as i32, (place.y * size[1] as f32) as i32];
        let side = LOUPE as f32 * LOUPE_PIXEL;
        let lines = self.values(pixel);
        let extent = vec2(side.max(230.0) + 16.0, side + 20.0 * lines.len() as f32 + 16.0);
        let mut corner = pointer + vec2(24.0, 24.0);
        corner = corner.min(response.rect.max - extent).max(response.rect.min);
        let painter = ui.painter().with_clip_rect(response.rect);
        let frame = Rect::from_min_size(corner, extent);
        painter.rect(frame, CornerRadius::same(4), ui.visuals().window_fill(), ui.visuals().window_stroke(), StrokeKind::Inside);
        let glass = Rect::from_min_size(frame.min + vec2(8.0, 8.0), Vec2::splat(side));
        let share = |at: i32, axis: usize| at as f32 / size[axis] as f32;
        let half = LOUPE / 2;
        let uv = Rect::from_min_max(
            pos2(share(pixel[0] - half, 0), share(pixel[1] - half, 1)),
            pos2(share(pixel[0] + half + 1, 0), share(pixel[1] + half + 1, 1)),
        );
        painter.image(texture, glass, uv, Color32::WHITE);
        let middle = Rect::from_center_size(glass.center(), Vec2::splat(LOUPE_PIXEL));
        painter.rect_stroke(middle, CornerRadius::ZERO, Stroke::new(1.0, Color32::WHITE), StrokeKind::Outside);
        for (index, (color, line)) in lines.into_iter().enumerate() {
            let at = pos2(frame.left() + 8.0, glass.bottom() + 6.0 + 20.0 * index as f32);
            painter.text(at, Align2::LEFT_TOP, line, FontId::monospace(11.0), color.unwrap_or(ui.visuals().text_color()));
        }
    }

    /// The radiance of a pixel on every side and in the reference, in words.
    fn values(&self, [x, y]: [i32; 2]) -> Vec<(Option<Color32>, String)> {
        let mut lines = vec![(None, format!("pixel {x}, {y}"))];
        let text = |film: &aquifer_lab::film::Film| {
            let index = usize::try_from(y).ok()? * film.size[0] as usize + usize::try_from(x).ok()?;
            film.color.get(index).map(|[r, g, b]| format!("{r:9.4} {g:9.4} {b:9.4}"))
        };
        for (side, board) in self.board.sides.iter().enumerate() {
            let film =
                board.watched.as_ref().and_then(|watched| watched.film.as_ref()).or(board.picture.as_ref().map(|picture| &picture.film));
            if let Some(words) = film.and_then(text) {
                lines.push((Some(SIDE_COLORS[side]), format!("{} {words}", SIDE_NAMES[side])));
            }
        }
        lines.extend(self.board.truth.as_ref().and_then(|truth| text(&truth.film)).map(|words| (None, format!("R {words}"))));
        lines
    }

    fn inspected_mark(&self, ui: &egui::Ui, cells: &[Cell]) {
        let (Some(place), true) = (self.state.inspected, self.state.panel && self.state.tab == Tab::Inspector) else { return };
        let Some(size) = self.board.sides.iter().find_map(|side| side.picture.as_ref()).map(|picture| picture.film.size) else { return };
        for cell in cells {
            let pixel = vec2(cell.picture.width() / size[0] as f32, cell.picture.height() / size[1] as f32);
            let index = vec2((place[0] * size[0] as f32).floor(), (place[1] * size[1] as f32).floor());
            let rect = Rect::from_min_size(cell.picture.min + index * pixel, pixel).expand(1.0);
            let painter = ui.painter().with_clip_rect(cell.clip);
            painter.rect_stroke(rect, 0.0, Stroke::new(3.0, Color32::from_black_alpha(160)), StrokeKind::Outside);
            painter.rect_stroke(rect, 0.0, Stroke::new(1.5, MARK), StrokeKind::Outside);
            let records = self.board.sides.get(cell.side).into_iter().flat_map(|board| board.records.iter());
            let told = records.filter(|record| record.resource.ends_with(TESTIMONY));
            for line in told.flat_map(testimony::lines) {
                let at = cell.picture.min + (vec2(line.pixel[0] as f32, line.pixel[1] as f32) + Vec2::splat(0.5)) * pixel;
                tried(&painter, at, (0.5 * pixel.x).max(3.0), &line);
            }
        }
    }

    /// What is wrong, what is under way, and what is shown in place of a picture.
    fn remarks(&mut self, ui: &mut egui::Ui, area: Rect) {
        let mut lines: Vec<(String, String)> =
            self.board.trouble.iter().map(|words| ("The session has ended".to_owned(), words.clone())).collect();
        for (side, board) in self.board.sides.iter().enumerate() {
            let kept = if board.picture.is_some() { "; the last good graph goes on" } else { "" };
            lines.extend(board.fault.iter().map(|fault| (format!("{}: fault{kept}", SIDE_NAMES[side]), fault.clone())));
        }
        if lines.is_empty() {
            return;
        }
        let place = Rect::from_min_max(pos2(area.left() + 12.0, area.top() + 40.0), pos2(area.right() - 12.0, area.bottom() - 12.0));
        let mut inner = ui.new_child(egui::UiBuilder::new().max_rect(place));
        let frame = egui::Frame::popup(inner.style()).stroke(Stroke::new(1.5, inner.visuals().error_fg_color));
        frame.show(&mut inner, |ui| {
            egui::ScrollArea::both().max_height(0.5 * area.height()).show(ui, |ui| {
                for (head, words) in lines {
                    ui.label(RichText::new(head).color(ui.visuals().error_fg_color).strong());
                    ui.add(egui::Label::new(RichText::new(words).monospace()).extend());
                }
            });
        });
    }
}

/// An input of the inspected pixel: a cross where it was rejected, a ring where it was carried, a disk where it was kept.
fn tried(painter: &egui::Painter, at: Pos2, radius: f32, line: &Tried) {
    match line.carried {
        Some(carried) if carried.kept => {
            painter.circle(at, radius, Color32::from_rgb(80, 220, 100), Stroke::new(1.0, Color32::BLACK));
        }
        Some(_) => {
            painter.circle_stroke(at, radius, Stroke::new(3.0, Color32::from_black_alpha(160)));
            painter.circle_stroke(at, radius, Stroke::new(1.5, Color32::WHITE));
        }
        None => {
            for slope in [1.0, -1.0] {
                let arm = vec2(radius, slope * radius);
                painter.line_segment([at - arm, at + arm], Stroke::new(1.5, MARK));
            }
        }
    }
}

fn at(cells: &[Cell], pointer: Pos2) -> Option<Cell> {
    cells.iter().copied().find(|cell| cell.clip.contains(pointer))
}

/// Words on a picture.
fn tag(painter: &egui::Painter, at: Pos2, align: Align2, words: &str, color: Color32) {
    let galley = painter.layout_no_wrap(words.to_owned(), FontId::proportional(13.0), color);
    let rect = align.anchor_size(at, galley.size() + vec2(12.0, 6.0));
    painter.rect_filled(rect, CornerRadius::same(4), Color32::from_black_alpha(170));
    painter.galley(rect.min + vec2(6.0, 3.0), galley, color);
}
