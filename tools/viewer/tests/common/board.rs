//! Waiting for a session without a window.

use crate::waiting::until;
use aquifer_viewer::session::{Board, Session};

/// Waits until the board is as wanted.
pub fn wait(session: &Session, what: &str, wanted: impl Fn(&Board) -> bool) -> Board {
    until(what, || {
        let board = session.look();
        if wanted(&board) {
            return Ok(board);
        }
        let faults: Vec<_> = board.sides.iter().map(|side| &side.fault).collect();
        Err(format!("faults {faults:?}, trouble {:?}", board.trouble))
    })
}
