//! What some blocks in a row keep of a sample array: one color each, and more where they are opened.

/// That of some blocks, `L` of each and `F` of each that is opened; none where nothing is kept.
#[derive(Default)]
pub(crate) struct Part<'b, L, F> {
    pub lattice: &'b mut [L],
    pub fine: &'b mut [F],
}

impl<L, F> Part<'_, L, F> {
    /// Takes the first blocks off, by how many there are and how many of them are opened.
    pub fn take(&mut self, blocks: usize, opened: usize) -> Self {
        Self {
            lattice: self.lattice.split_off_mut(..blocks).unwrap_or_default(),
            fine: self.fine.split_off_mut(..opened).unwrap_or_default(),
        }
    }
}
