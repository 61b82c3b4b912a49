//! Why a command did not do what it should, as an exit code and a message.

use crate::{faults, ui::Ui};
use aquifer_graph::Faults;
use aquifer_lab::{capture::CaptureError, compare::error::CompareError, explain::ExplainError, stage::StageError};
use std::{error::Error, process::ExitCode};

/// A command's failure.
#[derive(Debug)]
pub enum Failure {
    /// Something is wrong, and will be next time.
    Failed(Box<dyn Error>),
    /// Something is wrong with a graph file.
    Graph(Box<Faults>),
    /// Something is wrong now, and may not be next time.
    Temporary(Box<dyn Error>),
    /// Nobody reads stdout any longer: no failure of ours, and nothing to say.
    ReaderGone,
}

impl Failure {
    /// A failure in words.
    pub fn new(message: impl Into<String>) -> Self {
        Self::Failed(message.into().into())
    }

    /// As sysexits.h has it for temporary failures, and as everyone has it for the rest.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Failed(_) | Self::Graph(_) => ExitCode::from(1),
            Self::Temporary(_) => ExitCode::from(75),
            Self::ReaderGone => ExitCode::SUCCESS,
        }
    }

    /// What is wrong, in plain words.
    #[cfg(feature = "viewer")]
    pub fn words(&self) -> String {
        match self {
            Self::Failed(error) | Self::Temporary(error) => chain(error.as_ref()),
            Self::Graph(list) => list.to_string(),
            Self::ReaderGone => String::new(),
        }
    }

    /// Says what is wrong.
    pub fn report(&self, ui: &Ui) {
        match self {
            Self::Failed(error) | Self::Temporary(error) => ui.error(&chain(error.as_ref())),
            Self::Graph(list) => ui.raw(&faults::render(list, ui.color())),
            Self::ReaderGone => {}
        }
    }
}

/// A message with its causes, leaving out what has been said already.
fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut next = error.source();
    while let Some(cause) = next {
        let words = cause.to_string();
        if !text.contains(&words) {
            text.push_str(": ");
            text.push_str(&words);
        }
        next = cause.source();
    }
    text
}

impl From<Faults> for Failure {
    fn from(faults: Faults) -> Self {
        Self::Graph(Box::new(faults))
    }
}

impl From<aquifer_render::Error> for Failure {
    fn from(error: aquifer_render::Error) -> Self {
        if error.is_temporary() { Self::Temporary(error.into()) } else { Self::Failed(error.into()) }
    }
}

impl From<CaptureError> for Failure {
    fn from(error: CaptureError) -> Self {
        match error {
            CaptureError::Render(error) => error.into(),
            other => Self::Failed(other.into()),
        }
    }
}

impl From<ExplainError> for Failure {
    fn from(error: ExplainError) -> Self {
        match error {
            ExplainError::Graph(faults) => faults.into(),
            ExplainError::Render(error) => error.into(),
            other => Self::Failed(other.into()),
        }
    }
}

impl From<CompareError> for Failure {
    fn from(error: CompareError) -> Self {
        match error {
            CompareError::Graph(faults) => Self::Graph(faults),
            CompareError::Render(error) => error.into(),
            CompareError::Capture(error) => error.into(),
            other => Self::Failed(other.into()),
        }
    }
}

impl From<StageError> for Failure {
    fn from(error: StageError) -> Self {
        match error {
            StageError::Render(error) => error.into(),
            other => Self::Failed(other.into()),
        }
    }
}

/// Errors that are never temporary.
macro_rules! failed {
    ($($error:ty),+ $(,)?) => {
        $(impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                Self::Failed(error.into())
            }
        })+
    };
}

failed!(
    aquifer_lab::atomic::WriteError,
    aquifer_lab::film::AreaError,
    aquifer_lab::watch::WatchError,
    aquifer_lab::film::FilmError,
    aquifer_lab::page::PageError,
    aquifer_lab::stats::SizesDiffer,
    aquifer_scenes::ExportError,
    aquifer_scene::SceneError,
    aquifer_scene::LoadError,
    aquifer_graph::PlanError,
    aquifer_graph::ContractError,
    aquifer_graph::ReadError,
);

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, thiserror::Error)]
    #[error("cannot read `a`")]
    struct Outer(#[source] std::io::Error);

    #[derive(Debug, thiserror::Error)]
    #[error("cannot read `a`: {0}")]
    struct Repeating(#[source] std::io::Error);

    #[test]
    fn causes_are_said_once() {
        let cause = || std::io::Error::other("disk on fire");
        assert_eq!(chain(&Outer(cause())), "cannot read `a`: disk on fire");
        assert_eq!(chain(&Repeating(cause())), "cannot read `a`: disk on fire");
    }

    #[test]
    fn memory_may_be_free_later() {
        let full = aquifer_render::Error::OutOfMemory { what: "pool".into(), message: "full".into() };
        assert!(matches!(Failure::from(full), Failure::Temporary(_)));
        assert!(matches!(Failure::from(aquifer_render::Error::NoAdapter), Failure::Failed(_)));
    }
}
