//! Outlines: closed, from each vertex to the next.

/// The edges of an outline, from each vertex to the next and from the last to the first; none where there is no vertex.
pub(crate) fn edges<V: Copy>(outline: &[V]) -> impl Iterator<Item = (V, V)> {
    outline.iter().copied().zip(outline.iter().copied().cycle().skip(1))
}

/// The outline of a polygon and then its holes, each from vertex to vertex. A triangle is held in place: meshes are of
/// thousands, and each is read for every view.
#[derive(Debug, Clone, PartialEq)]
pub enum Rings<V> {
    /// A triangle without holes.
    Triangle([V; 3]),
    /// Any others.
    Many(Vec<Vec<V>>),
}

impl<V: Copy> From<Vec<Vec<V>>> for Rings<V> {
    fn from(rings: Vec<Vec<V>>) -> Self {
        match &rings[..] {
            [ring] if ring.len() == 3 => Self::Triangle([ring[0], ring[1], ring[2]]),
            _ => Self::Many(rings),
        }
    }
}

impl<V: Copy> Rings<V> {
    /// The outline and then each hole.
    pub fn iter(&self) -> impl Iterator<Item = &[V]> {
        let (triangle, many) = match self {
            Self::Triangle(triangle) => (Some(&triangle[..]), &[][..]),
            Self::Many(many) => (None, &many[..]),
        };
        triangle.into_iter().chain(many.iter().map(Vec::as_slice))
    }

    /// The vertices of all.
    pub fn vertices(&self) -> impl Iterator<Item = V> {
        self.iter().flatten().copied()
    }

    /// The edges of all.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (V, V)> {
        self.iter().flat_map(edges)
    }

    /// The same with each vertex turned into something else.
    #[must_use]
    #[inline]
    pub fn map<W>(&self, to: impl Fn(V) -> W) -> Rings<W> {
        match self {
            Self::Triangle(triangle) => Rings::Triangle(triangle.map(to)),
            Self::Many(many) => Rings::Many(
                many.iter().map(|ring| ring.iter().copied().map(&to).collect()).collect(),
            ),
        }
    }

    /// Bytes that they take beside their own place.
    pub(crate) fn bytes_beside(&self) -> usize {
        match self {
            Self::Triangle(_) => 0,
            Self::Many(many) => {
                16 + many.iter().map(|r| size_of_val(r) + size_of_val(&r[..]) + 16).sum::<usize>()
            }
        }
    }
}
