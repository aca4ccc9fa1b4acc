//! What an input can be guilty of, and what stops a run.

/// Why there is no result. Every text says what is wrong, where, and what to do.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// There is nothing to segment.
    #[error("no faces: a mesh of at least one triangle is needed")]
    Empty,
    /// Vertices without faces.
    #[error("{vertices} points but no faces: mesh the point cloud first")]
    PointsOnly {
        /// How many points there are.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} is not finite: remove it or export the mesh again")]
    NotFinite {
        /// The first such vertex, counted from 0.
        vertex: usize,
    },
    /// A face refers to a vertex that does not exist.
    #[error(
        "face {face} refers to vertex {vertex}, but there are {vertices}; was the file cut off?"
    )]
    IndexOutOfRange {
        /// The first such face, counted from 0.
        face: usize,
        /// The vertex it names.
        vertex: i64,
        /// How many vertices there are.
        vertices: usize,
    },
    /// Every face has zero area.
    #[error("all {faces} faces have zero area: is the mesh collapsed to a line or a point?")]
    Degenerate {
        /// How many faces there are.
        faces: usize,
    },
    /// The bytes of a file do not make a mesh.
    #[error("{format}: {reason}")]
    Format {
        /// The format that was tried, as users write it: "STL", "PLY", ...
        format: &'static str,
        /// What is wrong, where, and what to do.
        reason: String,
    },
    /// An option or a start that does not fit the mesh.
    #[error("{0}")]
    Option(String),
    /// The caller asked to stop.
    #[error("interrupted")]
    Cancelled,
}

/// A value, or why there is none.
pub type Result<T> = std::result::Result<T, Error>;
