//! Why the viewer stops, in a sentence, and the exit code that says so to a script: those of `stratavox`.

use ash::vk;
use std::path::PathBuf;

#[derive(Debug, thiserror::Error)]
pub enum Error {
    #[error("{0}")]
    Arguments(String),
    #[error("{}, line {line}: {problem}", path.display())]
    Script {
        path: PathBuf,
        line: usize,
        problem: String,
    },
    #[error(transparent)]
    Read(#[from] stratavox::volume::ReadError),
    #[error(transparent)]
    Write(#[from] stratavox::picture::OutputError),
    #[error(transparent)]
    Drawing(#[from] stratavox::embed::Error),
    #[error("no small frame to fit the eye by: {0}")]
    Fit(#[from] stratavox::offscreen::Error),
    #[error("{0}")]
    Window(String),
    #[error("no device that can draw and show: {0}")]
    NoDevice(String),
    #[error(
        "the device was lost while the viewer wanted to {0}: its driver gave up, or it is gone"
    )]
    DeviceLost(&'static str),
    #[error("the window's surface was lost: the window is gone, or its display")]
    SurfaceLost,
    #[error("cannot {doing}: {cause:?}")]
    Vulkan {
        doing: &'static str,
        cause: vk::Result,
    },
    #[error("the validation layer had {0} messages, see above")]
    Validation(usize),
}

impl Error {
    pub fn exit_code(&self) -> u8 {
        use stratavox::gpu::Error as Gpu;
        use stratavox::volume::Problem;
        match self {
            Self::Arguments(_) | Self::Script { .. } => 2,
            Self::Read(error) => match error.problem {
                Problem::Limit { .. } => 6,
                _ => 3,
            },
            Self::Write(_) => 4,
            Self::Drawing(stratavox::embed::Error::Gpu(
                Gpu::OutOfMemory { .. } | Gpu::Limit { .. },
            )) => 6,
            Self::Vulkan {
                cause: vk::Result::ERROR_OUT_OF_HOST_MEMORY | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY,
                ..
            } => 6,
            Self::Drawing(_)
            | Self::Fit(_)
            | Self::Window(_)
            | Self::NoDevice(_)
            | Self::DeviceLost(_)
            | Self::SurfaceLost
            | Self::Vulkan { .. }
            | Self::Validation(_) => 5,
        }
    }
}

impl From<stratavox::gpu::Error> for Error {
    fn from(error: stratavox::gpu::Error) -> Self {
        Self::Drawing(error.into())
    }
}

/// Says what a call of Vulkan was for.
pub trait Doing<T> {
    fn doing(self, doing: &'static str) -> Result<T, Error>;
}

impl<T> Doing<T> for Result<T, vk::Result> {
    fn doing(self, doing: &'static str) -> Result<T, Error> {
        self.map_err(|cause| match cause {
            vk::Result::ERROR_DEVICE_LOST => Error::DeviceLost(doing),
            vk::Result::ERROR_SURFACE_LOST_KHR => Error::SurfaceLost,
            cause => Error::Vulkan { doing, cause },
        })
    }
}
