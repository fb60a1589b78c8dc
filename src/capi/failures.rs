//! The library's errors as statuses.

use super::status::{Failure, sv_status};
use crate::{camera, embed, gpu, technique, volume};
use sv_status::*;

impl From<gpu::Error> for Failure {
    fn from(error: gpu::Error) -> Self {
        use gpu::Error;
        let status = match &error {
            Error::Limit { .. } => SV_E_LIMIT,
            Error::Argument { .. } => SV_E_ARGUMENT,
            Error::OutOfMemory { .. } | Error::Allocation { .. } => SV_E_MEMORY,
            Error::DeviceLost { .. } => SV_E_DEVICE_LOST,
            Error::Vulkan { .. } => SV_E_DRIVER,
            Error::Binding { .. } => SV_E_INTERNAL,
            Error::Stopped => SV_E_STATE,
            Error::ApiVersion { .. }
            | Error::Unfit { .. }
            | Error::Format { .. }
            | Error::NoLoader { .. }
            | Error::NoDriver
            | Error::NoMatch { .. }
            | Error::NoValidation { .. }
            | Error::Environment { .. } => SV_E_UNSUPPORTED,
        };
        let mut failure = Self::new(status, error.to_string());
        if let Error::Limit {
            wanted, allowed, ..
        } = error
        {
            (failure.wanted, failure.allowed) = (wanted, allowed);
        }
        failure
    }
}

impl From<technique::Error> for Failure {
    fn from(error: technique::Error) -> Self {
        use technique::Error;
        let limit = |wanted: usize, limit: usize| (wanted as u64, limit as u64);
        let (status, (wanted, allowed)) = match &error {
            // What does not fit in 64 bits is as large as that.
            Error::TooManySamples { wanted, limit } => {
                (SV_E_LIMIT, (*wanted as u64, (*limit).into()))
            }
            Error::LoopsEnd { wanted, limit, .. } | Error::SplatLoopsEnd { wanted, limit } => {
                (SV_E_LIMIT, (*wanted as u64, *limit as u64))
            }
            Error::LevelCount { found, limit: most } => (SV_E_LIMIT, limit(*found, *most)),
            Error::TooManyLights {
                wanted,
                limit: most,
            }
            | Error::TooManyClipPlanes {
                wanted,
                limit: most,
            } => (SV_E_LIMIT, limit(*wanted, *most)),
            Error::SlabsTooLong { .. } => (SV_E_LIMIT, (0, 0)),
            Error::OutOfRange { .. } | Error::NoWayToLight | Error::NoTransferFunction => {
                (SV_E_ARGUMENT, (0, 0))
            }
            Error::WrongLayout { .. }
            | Error::WrongCoefficients { .. }
            | Error::WrongGradientSource { .. } => (SV_E_STATE, (0, 0)),
            _ => (SV_E_UNSUPPORTED, (0, 0)),
        };
        Self {
            wanted,
            allowed,
            ..Self::new(status, error.to_string())
        }
    }
}

impl From<camera::Error> for Failure {
    fn from(error: camera::Error) -> Self {
        Self::argument(error.to_string())
    }
}

impl From<volume::Problem> for Failure {
    fn from(problem: volume::Problem) -> Self {
        Self::argument(format!("sv_volume_desc: {problem}"))
    }
}

impl From<embed::Error> for Failure {
    fn from(error: embed::Error) -> Self {
        use embed::Error;
        let status = match error {
            Error::Technique(error) => return error.into(),
            Error::Gpu(error) => return error.into(),
            Error::Camera(error) => return error.into(),
            Error::NotEmbedded { .. } | Error::NoDepth { .. } => SV_E_UNSUPPORTED,
            Error::OtherDescription { .. }
            | Error::NotUploaded
            | Error::UpdateOrder { .. }
            | Error::HalfUpdated { .. }
            | Error::Uploaded
            | Error::NotRecorded { .. }
            | Error::NotBegun { .. }
            | Error::NotPicked { .. } => SV_E_STATE,
            Error::FramesInFlight { .. }
            | Error::TargetState { .. }
            | Error::Update { .. }
            | Error::NoFrame { .. }
            | Error::Geometry { .. }
            | Error::HostDepth { .. }
            | Error::NoPixel { .. } => SV_E_ARGUMENT,
        };
        Self::new(status, error.to_string())
    }
}
