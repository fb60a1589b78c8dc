//! Handles: numbers that stand for objects, and are errors when the object is gone.
//!
//! ```text
//! bit  63 .. 60   59 .. 40   39 .. 20     19 .. 0
//!      kind       device     generation   place in the device's table
//! ```
//!
//! Numbers of devices are given once: a handle of a device that was destroyed names nothing ever after. A place is used
//! again with the next generation, and no more when generations are used up. The map from numbers to devices is all
//! that is global here; each device has a table of its own, so that two of them never wait for each other.

use super::device::Device;
use super::status::Failure;
use std::any::Any;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, TryLockError};

/// What a handle may stand for.
pub(super) trait Kind: Any + Send + Sync {
    /// Not 0: a handle of zero bits is none.
    const NUMBER: u64;
    /// As C calls it.
    const NAME: &'static str;
}

/// By their numbers.
const NAMES: [&str; 9] = [
    "",
    "sv_device",
    "sv_volume",
    "sv_transfer_function",
    "sv_renderer",
    "sv_submitter",
    "sv_update",
    "sv_lines",
    "sv_geometry",
];

const BITS: u32 = 20;
const MOST: u64 = 1 << BITS;

static DEVICES: Mutex<Devices> = Mutex::new(Devices {
    last: 0,
    there: BTreeMap::new(),
});

struct Devices {
    last: u64,
    there: BTreeMap<u64, Arc<Device>>,
}

/// The objects of one device.
#[derive(Default)]
pub(super) struct Table {
    places: Vec<Place>,
    free: Vec<usize>,
}

#[derive(Default)]
struct Place {
    generation: u64,
    object: Option<(u64, Arc<dyn Any + Send + Sync>)>,
}

/// What a handle says.
#[derive(Clone, Copy)]
struct Parts {
    kind: u64,
    device: u64,
    generation: u64,
    place: usize,
}

impl Parts {
    fn of(handle: u64) -> Self {
        let part = |from: u32| (handle >> from) & (MOST - 1);
        Self {
            kind: handle >> (3 * BITS),
            device: part(2 * BITS),
            generation: part(BITS),
            place: part(0) as usize,
        }
    }

    fn handle(self) -> u64 {
        self.kind << (3 * BITS)
            | self.device << (2 * BITS)
            | self.generation << BITS
            | self.place as u64
    }
}

/// Every step under these locks is a push or a pop: a panic elsewhere leaves them whole.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The object's own lock, for what one thread may use at a time.
pub(super) fn only<'a, T>(name: &str, mutex: &'a Mutex<T>) -> Result<MutexGuard<'a, T>, Failure> {
    match mutex.try_lock() {
        Ok(guard) => Ok(guard),
        Err(TryLockError::WouldBlock) => Err(Failure::state(format!(
            "this {name} is in use by another call: one thread at a time, and not from a callback"
        ))),
        Err(TryLockError::Poisoned(_)) => Err(Failure::state(format!(
            "this {name} met a mistake of stratavox before: it can only be destroyed"
        ))),
    }
}

/// Refuses what is no handle of this kind.
fn parts<T: Kind>(handle: u64) -> Result<Parts, Failure> {
    let (name, parts) = (T::NAME, Parts::of(handle));
    if handle == 0 {
        return Err(Failure::argument(format!("{name}: the handle is 0")));
    }
    if parts.kind == T::NUMBER {
        return Ok(parts);
    }
    let found = NAMES
        .get(parts.kind as usize)
        .filter(|name| !name.is_empty());
    Err(Failure::argument(match found {
        Some(found) => format!("wanted a handle of {name}, found one of {found}"),
        None => format!("{name}: {handle:#x} is no handle"),
    }))
}

fn gone(name: &str) -> Failure {
    Failure::argument(format!("{name}: the handle is of one that is destroyed"))
}

/// Takes a device in.
pub(super) fn add_device(make: impl FnOnce(u64) -> Device) -> Result<u64, Failure> {
    let mut devices = lock(&DEVICES);
    let serial = devices.last + 1;
    if serial == MOST {
        return Err(Failure::limit("count another device", serial, MOST - 1));
    }
    devices.last = serial;
    devices.there.insert(serial, Arc::new(make(serial)));
    let parts = Parts {
        kind: Device::NUMBER,
        device: serial,
        generation: 0,
        place: 0,
    };
    Ok(parts.handle())
}

/// The device of a handle.
pub(super) fn device(handle: u64) -> Result<Arc<Device>, Failure> {
    let parts = parts::<Device>(handle)?;
    let found = lock(&DEVICES).there.get(&parts.device).map(Arc::clone);
    // What a handle of a device has nothing to say with is zero.
    let found = found.filter(|_| parts.generation == 0 && parts.place == 0);
    found.ok_or_else(|| gone(Device::NAME))
}

/// Takes the device away from all who look for it.
pub(super) fn remove_device(handle: u64) -> Result<Arc<Device>, Failure> {
    device(handle)?;
    let found = lock(&DEVICES).there.remove(&Parts::of(handle).device);
    found.ok_or_else(|| gone(Device::NAME))
}

/// Takes an object of a device in.
pub(super) fn add<T: Kind>(device: &Device, object: T) -> Result<u64, Failure> {
    let mut table = lock(&device.objects);
    let place = match table.free.pop() {
        Some(place) => place,
        None if table.places.len() as u64 == MOST => {
            return Err(Failure::limit("keep another object", MOST + 1, MOST));
        }
        None => {
            table.places.push(Place::default());
            table.places.len() - 1
        }
    };
    let found = &mut table.places[place];
    found.object = Some((T::NUMBER, Arc::new(object)));
    let parts = Parts {
        kind: T::NUMBER,
        device: device.serial,
        generation: found.generation,
        place,
    };
    Ok(parts.handle())
}

/// The object of a handle, and its device.
pub(super) fn find<T: Kind>(handle: u64) -> Result<(Arc<Device>, Arc<T>), Failure> {
    let parts = parts::<T>(handle)?;
    let found = lock(&DEVICES).there.get(&parts.device).map(Arc::clone);
    let device = found.ok_or_else(|| gone(T::NAME))?;
    let object = {
        let table = lock(&device.objects);
        let place = table.places.get(parts.place);
        let place = place.filter(|place| place.generation == parts.generation);
        let object = place.and_then(|place| place.object.as_ref());
        object
            .filter(|(kind, _)| *kind == T::NUMBER)
            .map(|(_, object)| Arc::clone(object))
    };
    let object = object.and_then(|object| object.downcast::<T>().ok());
    Ok((device, object.ok_or_else(|| gone(T::NAME))?))
}

/// The same, of this very device.
pub(super) fn find_on<T: Kind>(device: &Device, handle: u64) -> Result<Arc<T>, Failure> {
    let (found, object) = find::<T>(handle)?;
    match found.serial == device.serial {
        true => Ok(object),
        false => Err(Failure::argument(format!(
            "{}: the handle is of one on another sv_device",
            T::NAME
        ))),
    }
}

/// Takes an object away from all who look for it. Who uses it at this moment keeps it until then.
pub(super) fn remove<T: Kind>(handle: u64) -> Result<Arc<T>, Failure> {
    let (device, object) = find::<T>(handle)?;
    let Parts { place, .. } = Parts::of(handle);
    let mut table = lock(&device.objects);
    let there = &mut table.places[place];
    // Two threads may destroy it at once: one of them does.
    if there.generation != Parts::of(handle).generation || there.object.take().is_none() {
        return Err(gone(T::NAME));
    }
    there.generation += 1;
    let is_used_up = there.generation == MOST;
    if !is_used_up {
        table.free.push(place);
    }
    Ok(object)
}

impl Table {
    /// How many objects there are.
    pub fn len(&self) -> usize {
        let places = self.places.iter();
        places.filter(|place| place.object.is_some()).count()
    }
}
