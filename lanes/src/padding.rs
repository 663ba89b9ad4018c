//! Lengths of buffers that vectorised code reads and writes register by register.

/// Every vectorised buffer has a multiple of this many entries.
pub const PADDING: usize = 8;

/// `len` rounded up to the padding.
pub const fn padded(len: usize) -> usize {
    len.next_multiple_of(PADDING)
}
