use crate::counts::existing;
use std::io;

use ::gltf::binary;

/// Error of a file that is no glTF or none that can be used.
#[non_exhaustive]
#[derive(Debug, thiserror::Error)]
#[expect(missing_docs, reason = "each variant's message names its fields")]
pub enum GltfError {
    #[error("the GLB header claims {claimed} bytes, but the file has {found}; copy it again")]
    Cut { claimed: usize, found: usize },
    #[error("is not a whole GLB file: {problem}; export it again as glTF 2.0")]
    BadGlb { problem: String },
    #[error("is no glTF: {cause}; it must be a GLB file or glTF 2.0 JSON in UTF-8")]
    BadJson { cause: String },
    #[error("{place} is not lawful glTF 2.0: {problem}; export the file again")]
    Invalid { place: String, problem: String },
    #[error("needs the extension {name:?}, which is not read; export the file without it")]
    Extension { name: String },
    #[error("is glTF {found}; export it again as glTF 2.0")]
    Version { found: String },
    #[error("node {node}: {problem} of EXT_mesh_gpu_instancing; export the file again")]
    Instances { node: usize, problem: &'static str },
    #[error("buffer {buffer}: cannot read {uri:?}: {cause}; put that file beside the glTF file")]
    BufferUnreadable { buffer: usize, uri: String, cause: io::Error },
    #[error("buffer {buffer}: {uri:?} is not a relative path or a base64 data URI; write one")]
    BadUri { buffer: usize, uri: String },
    #[error("buffer {buffer} has {found} bytes of the {claimed} that it claims; copy it again")]
    ShortBuffer { buffer: usize, claimed: usize, found: usize },
    #[error("there is no accessor {accessor} among {count}; export the file again")]
    NoSuchAccessor { accessor: usize, count: usize },
    #[error("accessor {accessor} reaches beyond its buffer; export the file again")]
    BeyondBuffer { accessor: usize },
    #[error("accessor {accessor} has no buffer view; export the file with all positions in one")]
    NoData { accessor: usize },
    #[error("accessor {accessor} does not hold {wanted}; export the file again")]
    WrongType { accessor: usize, wanted: &'static str },
    #[error("index {index} names no vertex, and there {}; export the file again", existing(.count, "vertex"))]
    NoSuchVertex { index: u32, count: usize },
    #[error("coordinate {value:e} m is too large to keep; check the file and its unit")]
    TooFar { value: f64 },
    #[error("node {node} is reached twice; nodes of a scene must form trees")]
    NodeTwice { node: usize },
}

impl GltfError {
    pub(super) fn from_crate(error: ::gltf::Error) -> Self {
        match error {
            ::gltf::Error::Binary(binary::Error::Io(_)) => {
                Self::BadGlb { problem: "it ends within a header".to_owned() }
            }
            ::gltf::Error::Binary(problem) => Self::BadGlb { problem: problem.to_string() },
            ::gltf::Error::Validation(problems) => {
                let (place, problem) = problems.into_iter().next().map_or_else(
                    || (String::new(), String::new()),
                    |(place, problem)| (place.to_string(), problem.to_string().to_lowercase()),
                );
                Self::Invalid { place, problem }
            }
            other => Self::BadJson { cause: other.to_string() },
        }
    }
}
