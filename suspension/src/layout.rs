//! Where each body's numbers are in a vector for all of them.

/// Where each body's numbers are in a vector for all of them.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// The bodies' first numbers, and the end.
    starts: Vec<usize>,
}

impl Layout {
    /// Bodies with so many numbers each, one after the other.
    pub fn new(lengths: impl Iterator<Item = usize>) -> Self {
        let mut starts = vec![0];
        for length in lengths {
            starts.push(starts[starts.len() - 1] + length);
        }
        Self { starts }
    }

    /// Numbers of all bodies.
    pub fn len(&self) -> usize {
        self.starts[self.starts.len() - 1]
    }

    /// Where a body's numbers are.
    pub fn of(&self, body: usize) -> std::ops::Range<usize> {
        self.starts[body]..self.starts[body + 1]
    }

    /// Every body's part of a vector.
    pub fn split<'v, T>(&self, mut vector: &'v mut [T]) -> Vec<&'v mut [T]> {
        let mut parts = Vec::with_capacity(self.starts.len() - 1);
        for pair in self.starts.windows(2) {
            let (part, rest) = vector.split_at_mut(pair[1] - pair[0]);
            parts.push(part);
            vector = rest;
        }
        parts
    }
}
