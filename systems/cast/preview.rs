//! Pictures of a view whose rays are still being cast, for whoever looks on (paper §6).

use crate::components::{Color, PixelFilter, Sampling, View};
use crate::shared::Shared;
use crate::view::picture::Picture;
use crate::view::resampling::resample;
use crate::view::samples::{POSITIONS, SampleArray};
use crate::view::viewer::Viewer;

/// Positions between the rays of the first picture.
pub(crate) const FIRST: u32 = 32;

/// What is shown of a view, and to whom.
pub(crate) struct Preview<'a> {
    viewer: &'a Viewer,
    filter: PixelFilter,
    background: Option<Color>,
    /// The picture before the running level of the refinement.
    last: Option<Picture>,
}

impl<'a> Preview<'a> {
    /// Nothing is shown yet.
    pub fn new(viewer: &'a Viewer, view: &View, sampling: &Sampling) -> Self {
        let (filter, background) = (sampling.pixel_filter, view.background);
        Self { viewer, filter, background, last: None }
    }

    /// Whether it is time for a picture.
    pub(crate) fn is_due(&self) -> bool {
        self.viewer.is_due()
    }

    /// Keeps, and shows if it is time, what an array tells of which a level is done.
    pub fn level(&mut self, array: &SampleArray) {
        let picture = resample(array, self.filter, self.background);
        if self.is_due() {
            self.viewer.show(picture.clone());
        }
        self.last = Some(picture);
    }

    /// Shows what an array tells of which the running level is done in the first `rows` of positions; the other rows of
    /// pixels are those of before.
    pub fn rows(&self, array: &SampleArray, rows: usize) {
        let Some(last) = &self.last else { return };
        let layout = &array.layout;
        // What a pixel is made of lies within the filter's reach, and is interpolated over a region at most.
        let beyond = layout.margin + self.filter.reach() + layout.coarsest.max(POSITIONS);
        let done = (rows.saturating_sub(beyond) / POSITIONS).min(layout.size[1]);
        let mut pixels = resample(array, self.filter, self.background).pixels.to_vec();
        let first = done * layout.size[0];
        pixels[first..].copy_from_slice(&last.pixels[first..]);
        self.viewer.show(Picture { size: layout.size, pixels: Shared::new(pixels) });
    }
}

/// How densely a view is sampled for its first pictures, which have fewer rays than `sampling` begins with: all together
/// they cost a twelfth of those.
pub fn before(sampling: &Sampling) -> impl Iterator<Item = Sampling> {
    let steps = (0..6).map(|halvings| FIRST >> halvings);
    steps
        .take_while(|&step| step > sampling.coarsest * if step == FIRST { 1 } else { 3 })
        .map(|step| Sampling { coarsest: step, finest: step, outlines: false, ..sampling.clone() })
}
