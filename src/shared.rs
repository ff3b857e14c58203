//! Arrays that entities share: made once, never changed, compared by identity.

use std::ops::Deref;
use std::sync::Arc;

/// An array that is immutable once made and shared by pointer; equality is identity, so comparing costs nothing.
#[derive(Debug)]
pub struct Shared<T>(Arc<Vec<T>>);

impl<T> Shared<T> {
    /// Takes the array without copying it.
    #[must_use]
    pub fn new(values: Vec<T>) -> Self {
        Self(Arc::new(values))
    }

    /// Bytes that the array takes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        (self.0.len() * size_of::<T>()) as u64
    }
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<T> PartialEq for Shared<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<T> Deref for Shared<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}
