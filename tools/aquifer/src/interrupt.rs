//! Ctrl-C: the first asks to finish with what there is, the second ends at once.

use std::sync::{
    OnceLock,
    atomic::{AtomicBool, Ordering},
};

/// Exit code of a program that was ended by SIGINT, as shells give it.
const ENDED: i32 = 130;

static ASKED: AtomicBool = AtomicBool::new(false);
static LISTENING: OnceLock<()> = OnceLock::new();

/// Begins to listen for Ctrl-C, SIGTERM and SIGHUP.
pub fn listen() {
    LISTENING.get_or_init(|| {
        let listening = ctrlc::set_handler(|| {
            if ASKED.swap(true, Ordering::Relaxed) {
                std::process::exit(ENDED);
            }
        });
        if let Err(error) = listening {
            tracing::warn!("Ctrl-C will end the program without writing anything: {error}");
        }
    });
}

/// Has the user asked to finish?
pub fn asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}
