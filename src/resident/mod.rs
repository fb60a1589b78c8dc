//! Data put on a device: a volume as bricks or as stacks of slices, a transfer function as table and points.
//!
//! Making them only creates objects. Their content is uploaded by recorded copies (or, where the host
//! reaches the memory, written at once); nothing here submits or waits.

mod mask;
mod stacks;
mod texel;
mod transfer;
mod volume;

pub use mask::GpuMask;
pub use stacks::GpuStack;
pub use texel::{Coding, TexelFormat};
pub use transfer::{GpuTransfer, TransferLayout};
pub use volume::GpuVolume;
