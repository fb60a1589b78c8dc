//! Something on the device, and what it was made of: made anew where that has changed.

/// One of a kind, with its key.
#[derive(Debug)]
pub struct Keyed<K, V>(Option<(K, V)>);

impl<K, V> Default for Keyed<K, V> {
    fn default() -> Self {
        Self(None)
    }
}

impl<K: PartialEq, V> Keyed<K, V> {
    /// What was made last.
    pub fn get(&self) -> Option<&V> {
        self.0.as_ref().map(|(_, made)| made)
    }

    /// What belongs to `key`, made by `make` where it is not there. What was there is dropped before: its memory serves
    /// the next one.
    ///
    /// # Errors
    /// Those of `make`; nothing is there then.
    pub fn of<E>(&mut self, key: K, make: impl FnOnce(&K) -> Result<V, E>) -> Result<&V, E> {
        let there = match self.0.take() {
            Some(there) if there.0 == key => there,
            stale => {
                drop(stale);
                let made = make(&key)?;
                (key, made)
            }
        };
        Ok(&self.0.insert(there).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;

    #[test]
    fn what_is_there_is_made_anew_only_for_another_key_and_never_beside_the_old_one() {
        struct Made<'a>(&'a Cell<u32>, u32);
        impl Drop for Made<'_> {
            fn drop(&mut self) {
                self.0.set(self.0.get() - 1);
            }
        }
        let (alive, makes) = (Cell::new(0), Cell::new(0));
        let mut keyed = Keyed::default();
        for (key, wanted_makes) in [(1, 1), (1, 1), (2, 2), (1, 3)] {
            let made = keyed.of(key, |&key| {
                assert_eq!(alive.get(), 0, "the old one is gone");
                alive.set(1);
                makes.set(makes.get() + 1);
                Ok::<_, ()>(Made(&alive, key))
            });
            assert_eq!(made.map(|made| made.1), Ok(key));
            assert_eq!(makes.get(), wanted_makes);
        }
        assert!(keyed.of(5, |_| Err("no memory")).is_err());
        assert!(keyed.get().is_none() && alive.get() == 0);
    }
}
