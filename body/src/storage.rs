//! Memory for the matrices of all modes.

use memmap2::MmapMut;

/// Zeroed doubles, on huge pages where the system has them: the matrices of all modes are written
/// once from end to end, and with small pages the system would spend as long handing out that
/// memory as the solver filling it.
#[derive(Debug)]
pub enum Storage {
    Mapped(MmapMut),
    Allocated(Vec<f64>),
}

impl Storage {
    /// `length` zeros.
    pub fn zeros(length: usize) -> Self {
        let Ok(map) = MmapMut::map_anon(length * size_of::<f64>()) else {
            return Self::Allocated(vec![0.0; length]);
        };
        // This is advice to the system: where it is not followed the memory is the same, only
        // slower.
        #[cfg(target_os = "linux")]
        let _ = map.advise(memmap2::Advice::HugePage);
        Self::Mapped(map)
    }

    pub fn as_slice(&self) -> &[f64] {
        match self {
            Self::Mapped(map) => bytemuck::cast_slice(map),
            Self::Allocated(vec) => vec,
        }
    }

    pub fn as_mut_slice(&mut self) -> &mut [f64] {
        match self {
            Self::Mapped(map) => bytemuck::cast_slice_mut(map),
            Self::Allocated(vec) => vec,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn is_zero_and_holds_what_is_written() {
        for length in [0, 1, 1000, 1 << 20] {
            let mut storage = Storage::zeros(length);
            assert_eq!(storage.as_slice().len(), length);
            assert!(storage.as_slice().iter().all(|&x| x == 0.0));
            storage.as_mut_slice().fill(2.0);
            assert!(storage.as_slice().iter().all(|&x| x == 2.0));
        }
    }
}
