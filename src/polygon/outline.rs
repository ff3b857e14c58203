//! Outlines: closed, from each vertex to the next.

/// The edges of an outline, from each vertex to the next and from the last to the first; none where there is no vertex.
pub(crate) fn edges<V: Copy>(outline: &[V]) -> impl Iterator<Item = (V, V)> {
    outline.iter().copied().zip(outline.iter().copied().cycle().skip(1))
}
