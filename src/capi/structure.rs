//! Structures that say how long they are: older and newer ones than ours.
//!
//! ```text
//! struct_size < first version    refused
//! struct_size < ours             an older header: what it does not know is zero, the default
//! struct_size > ours             a newer header: refused unless all that we do not know is zero
//! next                           NULL: nothing extends a structure yet
//! ```

use super::status::{Failure, sv_status::SV_E_VERSION};
use std::ffi::c_void;
use std::mem::MaybeUninit;
use std::ptr::copy_nonoverlapping;

/// `struct_size`, a gap where pointers are long, and `next`.
pub(super) const HEADER_BYTES: usize = 2 * size_of::<*const c_void>();

/// No structure will ever be so long: what says so is no structure.
const LONGEST_BYTES: usize = 4096;

/// A structure with the header.
///
/// # Safety
/// It is `repr(C)`, begins with `struct_size: u32` and `next: *const c_void`, is as long as a header or longer, and all
/// bits are right for it: no `bool`, no `enum`, no reference.
pub(super) unsafe trait Versioned: Copy {
    /// As C calls it.
    const NAME: &'static str;
    /// Its length when it was first released.
    const FIRST_BYTES: usize = size_of::<Self>();
}

/// The header of what a caller points to.
///
/// # Safety
/// `pointer` is NULL or points to a header.
unsafe fn length<T: Versioned>(pointer: *const T) -> Result<usize, Failure> {
    let name = T::NAME;
    if pointer.is_null() {
        return Err(Failure::argument(format!("{name}: the pointer is NULL")));
    }
    // SAFETY: the caller's promise.
    let (bytes, next) = unsafe {
        let bytes = pointer.cast::<u32>().read_unaligned() as usize;
        let next = pointer.cast::<*const c_void>().add(1).read_unaligned();
        (bytes, next)
    };
    let first = T::FIRST_BYTES;
    if !(first..=LONGEST_BYTES).contains(&bytes) {
        let text = format!(
            "{name}: struct_size is {bytes}, wanted {} (`sizeof({name})`)",
            size_of::<T>()
        );
        return Err(Failure::new(SV_E_VERSION, text));
    }
    if !next.is_null() {
        let text = format!("{name}: next is not NULL, and this version knows no extension");
        return Err(Failure::new(SV_E_VERSION, text));
    }
    Ok(bytes)
}

/// What a caller gives.
///
/// # Safety
/// `pointer` is NULL, or points to as many bytes as stand at its beginning.
pub(super) unsafe fn read<T: Versioned>(pointer: *const T) -> Result<T, Failure> {
    // SAFETY: the caller's promise.
    let bytes = unsafe { length(pointer)? };
    let known = bytes.min(size_of::<T>());
    let mut made = MaybeUninit::<T>::zeroed();
    // SAFETY: as many bytes are there, and all bits are right for the type.
    let made = unsafe {
        copy_nonoverlapping(pointer.cast::<u8>(), made.as_mut_ptr().cast(), known);
        made.assume_init()
    };
    let start = pointer.cast::<u8>();
    // SAFETY: the structure is that long.
    let mut tail = (known..bytes).map(|at| unsafe { start.add(at).read() });
    if tail.any(|byte| byte != 0) {
        let text = format!(
            "{}: struct_size is {bytes}, {} are known, and what follows is not zero",
            T::NAME,
            size_of::<T>()
        );
        return Err(Failure::new(SV_E_VERSION, text));
    }
    Ok(made)
}

/// The same where NULL stands for a structure of zeros.
///
/// # Safety
/// As [`read`].
pub(super) unsafe fn read_or_zero<T: Versioned>(pointer: *const T) -> Result<T, Failure> {
    match pointer.is_null() {
        // SAFETY: all bits are right for the type.
        true => Ok(unsafe { MaybeUninit::zeroed().assume_init() }),
        // SAFETY: the caller's promise.
        false => unsafe { read(pointer) },
    }
}

/// Refuses what [`write`] would: before the work is done.
///
/// # Safety
/// As [`read`].
pub(super) unsafe fn check_room<T: Versioned>(pointer: *const T) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe { length(pointer).map(drop) }
}

/// What a caller gets: as much as it has room for. Its own header stays.
///
/// # Safety
/// As [`read`], and all of it may be written.
pub(super) unsafe fn write<T: Versioned>(pointer: *mut T, value: &T) -> Result<(), Failure> {
    // SAFETY: the caller's promise.
    unsafe {
        let known = length(pointer)?.min(size_of::<T>());
        let from = (&raw const *value).cast::<u8>().add(HEADER_BYTES);
        let to = pointer.cast::<u8>().add(HEADER_BYTES);
        copy_nonoverlapping(from, to, known - HEADER_BYTES);
    }
    Ok(())
}

/// An array of a caller's.
///
/// # Safety
/// `pointer` points to `count` values, or `count` is 0; they live and do not change for `'a`.
pub(super) unsafe fn array<'a, T>(
    name: &str,
    pointer: *const T,
    count: u64,
    most: u64,
) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    if pointer.is_null() {
        let text = format!("{name}: the pointer is NULL, and there are to be {count} of them");
        return Err(Failure::argument(text));
    }
    if count > most {
        return Err(Failure::limit(format!("take {name}"), count, most));
    }
    if !pointer.is_aligned() {
        let text = format!("{name}: the pointer is not aligned to {}", align_of::<T>());
        return Err(Failure::argument(text));
    }
    // SAFETY: the caller's promise; `most` of every caller of ours is far below the largest count.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count as usize) })
}

/// A place that the result of a call is written to.
pub(super) fn out<T>(name: &str, pointer: *mut T) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::argument(format!("{name}: the pointer is NULL")));
    }
    match pointer.is_aligned() {
        true => Ok(()),
        false => Err(Failure::argument(format!(
            "{name}: the pointer is not aligned to {}",
            align_of::<T>()
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[repr(C)]
    #[derive(Clone, Copy)]
    struct Older {
        struct_size: u32,
        next: *const c_void,
        a: u64,
    }

    #[repr(C)]
    #[derive(Clone, Copy)]
    struct Ours {
        struct_size: u32,
        next: *const c_void,
        a: u64,
        b: u64,
    }

    #[repr(C)]
    #[derive(Clone, Copy)]
    struct Newer {
        struct_size: u32,
        next: *const c_void,
        a: u64,
        b: u64,
        c: u64,
    }

    // SAFETY: as the trait wants it.
    unsafe impl Versioned for Ours {
        const NAME: &'static str = "ours";
        const FIRST_BYTES: usize = size_of::<Older>();
    }

    const NULL: *const c_void = std::ptr::null();

    fn newer(c: u64) -> Newer {
        Newer {
            struct_size: size_of::<Newer>() as u32,
            next: NULL,
            a: 1,
            b: 2,
            c,
        }
    }

    #[test]
    fn an_older_client_leaves_the_default_and_a_newer_one_is_heard_as_far_as_it_is_understood() {
        let older = Older {
            struct_size: size_of::<Older>() as u32,
            next: NULL,
            a: 5,
        };
        let (right, wrong) = (newer(0), newer(3));
        // SAFETY: each is as long as it says.
        unsafe {
            let found = read((&raw const older).cast::<Ours>()).unwrap();
            assert_eq!((found.a, found.b), (5, 0));
            let found = read((&raw const right).cast::<Ours>()).unwrap();
            assert_eq!((found.a, found.b), (1, 2));
            let refused = read((&raw const wrong).cast::<Ours>()).map(drop);
            assert_eq!(refused.unwrap_err().status, SV_E_VERSION);
        }
    }

    #[test]
    fn a_result_is_written_as_far_as_there_is_room_and_leaves_the_header() {
        let value = Ours {
            struct_size: 0,
            next: NULL,
            a: 8,
            b: 9,
        };
        let mut older = Older {
            struct_size: size_of::<Older>() as u32,
            next: NULL,
            a: 5,
        };
        let mut longer = newer(3);
        // SAFETY: each is as long as it says.
        unsafe {
            write((&raw mut older).cast::<Ours>(), &value).unwrap();
            write((&raw mut longer).cast::<Ours>(), &value).unwrap();
        }
        assert_eq!((older.struct_size, older.a), (24, 8));
        assert_eq!((longer.a, longer.b, longer.c), (8, 9, 3));
    }
}
